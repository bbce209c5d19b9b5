// Runs the firmware of firmware/ on a simulated ATmega2560: its converter reads a simulated rig, and the
// bytes of its serial line go to a file or a pseudo-terminal.
//
//     avr_board FIRMWARE.elf [OPTION VALUE]...
//       --simulation FILE   the rig; its matrix must be that of the firmware, its converter one of 10 bits
//       --surface FILE      surface under the matrix; without it: flat
//       --serial TEXT       what the EEPROM contains; without it: nothing
//       --bytes FILE        writes the bytes that the board sends
//       --link PATH         sends them to a pseudo-terminal behind this link instead
//       --log FILE          writes what happened, one line each: "start CYCLE" when row 0 is driven,
//                           "scan CYCLE COUNT..." with what was fed, "restart CYCLE CAUSE",
//                           "in CYCLE LEVEL" and "out CYCLE LEVEL" of the trigger pins,
//                           "end CYCLE BUSY" with the cycles in which the processor did not sleep
//       --seconds S         ends after this simulated time; without it: never
//       --pace N            seconds of simulated time in a second; without it: as fast as possible
//       --event S:CAUSE     at S seconds: reset, brown-out, stray (the program runs into an endless loop) or
//                           converter (the converter stands still); 1 or 0: level of the trigger input
//       --clock yes         prints the simulated time [s] every 10 ms
//
// The simulator, simavr, is under the GPL, and so is a program that links it. This one is a helper of tests;
// it is not installed, and nothing else links it.

#include <simavr/avr_adc.h>
#include <simavr/avr_eeprom.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_interrupts.h>
#include <simavr/sim_regbit.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "emulator/emulator.h"
#include "emulator/pseudo_terminal.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/surface_file.h"
#include "simulation/rig.h"

namespace {

using fsr::settings::InputError;

constexpr double kFrequency = 16e6;                           // [Hz]
constexpr double kSupply = 5000;                              // [mV]
constexpr double kFullScale = 1023;                           // of the converter
constexpr double kSamples = 16;                               // of the transducer, whose sum is one reading
constexpr unsigned kTransducer = 14;                          // inputs
constexpr unsigned kThermometer = 15;                         // a TMP36: 500 mV + 10 mV per degree Celsius
constexpr unsigned kBitsPerByte = 10;                         // 8N1
constexpr unsigned kUcsra = 0xC0, kU2x = 0x02, kUbrr = 0xC4;  // registers
constexpr unsigned kAdmux = 0x7C, kAdcsra = 0x7A, kAdcsrb = 0x7B, kMux5 = 0x08;  // registers

using Options = std::map<std::string, std::string>;

/// The rig in the time of the simulator.
class Rig {
 public:
  Rig(const fsr::simulation::SimulationSettings& settings, const std::string& surface)
      : settings_(settings), rig_(settings), dither_(-kDither, kDither) {
    if (settings.fullScale() != kFullScale) {
      throw InputError(settings.origin + ": effects.converter.full_scale must be 1023, the board's");
    }
    if (!surface.empty()) rig_.mount(fsr::matrix::readSurfaceFile(surface, settings.layout.size));
    chamber_.startCycles(0, settings.chamber);
  }

  void scan(double time) { counts_ = rig_.scan(time, pressure()); }
  const std::vector<std::uint16_t>& counts() const { return counts_; }
  std::size_t columns() const { return settings_.layout.size.columns; }

  /// Voltages at the pins [mV].
  unsigned taxel(std::size_t row, std::size_t column) const {
    const std::size_t index = row * columns() + column;
    if (column >= columns() || index >= counts_.size()) return 0;
    return static_cast<unsigned>(std::ceil(counts_[index] * kSupply / kFullScale));
  }
  /// With a noise of half a count, which the firmware's mean of many samples needs.
  unsigned transducer(double time) {
    const double volts = rig_.transducer(time, pressure()) * kSupply / (kFullScale * kSamples);
    return millivolts(volts + kHalfCount);
  }
  unsigned thermometer(double time) {
    return millivolts(500 + 10 * rig_.temperature(time, pressure()) + kHalfCount);
  }

 private:
  static constexpr double kHalfCount = kSupply / kFullScale / 2;
  static constexpr double kDither = kHalfCount;

  fsr::simulation::PressureCourse pressure() const {
    return [this](double time) { return chamber_.gaugePressure(time); };
  }
  unsigned millivolts(double value) {
    return static_cast<unsigned>(std::lround(std::clamp(value + dither_(random_), 0.0, kSupply)));
  }

  fsr::simulation::SimulationSettings settings_;
  fsr::simulation::Rig rig_;
  fsr::emulator::Chamber chamber_;
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> dither_;  // [mV]
  std::vector<std::uint16_t> counts_;
};

/// The microcontroller, with what is wired to it.
class Board {
 public:
  Board(const std::string& firmware, const Options& options, Rig& rig) : rig_(rig) {
    const auto given = [&](const std::string& name) {
      const auto found = options.find(name);
      return found == options.end() ? std::string() : found->second;
    };
    if (!given("--bytes").empty()) bytes_.open(given("--bytes"), std::ios::binary);
    if (!given("--log").empty()) log_.open(given("--log"));
    if (!given("--link").empty()) {
      port_ = std::make_unique<fsr::emulator::PseudoTerminal>(given("--link"), 0);
    }
    load(firmware);
    store(given("--serial"));
    wire();
    setReason(&avr_->reset_flags.porf);
  }

  double time() const { return static_cast<double>(avr_->cycle) / kFrequency; }

  void step() {
    // The simulator knows no shift register behind the data register, and takes a byte of 8N1 for 11 bits. So
    // the time until the data register is free again is set before each instruction.
    uart_->cycles_per_byte = line_free_ > avr_->cycle ? line_free_ - avr_->cycle : 1;
    const avr_cycle_count_t before = avr_->cycle;
    constexpr avr_cycle_count_t kLongestInstruction = 5;  // more was sleep
    const int state = avr_run(avr_);
    busy_ += std::min(avr_->cycle - before, kLongestInstruction);
    if (state == cpu_Done || state == cpu_Crashed) throw InputError("the simulated program has ended");
  }

  void end() { note("end", std::to_string(busy_)); }

  void happen(const std::string& cause) {
    if (cause == "reset") {
      restart(cause, &avr_->reset_flags.extrf);
    } else if (cause == "brown-out") {
      restart(cause, &avr_->reset_flags.borf);
    } else if (cause == "stray") {
      constexpr std::uint8_t kJumpToItself[2] = {0xFF, 0xCF};
      avr_->pc = avr_->flashend - 1;
      std::copy_n(kJumpToItself, 2, avr_->flash + avr_->pc);
      avr_->sreg[S_I] = 0;
    } else if (cause == "converter") {
      avr_->data[kAdcsra] = 0;
      note(cause);
    } else if (cause == "1" || cause == "0") {
      avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_IOPORT_GETIRQ('L'), 0), cause == "1" ? 1 : 0);
      note("in", cause);
    } else {
      throw InputError("--event " + cause + " must be reset, brown-out, stray, converter, 1 or 0");
    }
  }

 private:
  void load(const std::string& path) {
    elf_firmware_t firmware{};
    if (elf_read_firmware(path.c_str(), &firmware) != 0) throw InputError(path + ": no firmware");
    avr_ = avr_make_mcu_by_name("atmega2560");
    avr_init(avr_);
    avr_->log = LOG_ERROR;
    avr_load_firmware(avr_, &firmware);
    avr_->frequency = static_cast<std::uint32_t>(kFrequency);
    avr_->vcc = avr_->avcc = avr_->aref = static_cast<std::uint32_t>(kSupply);
    avr_->run_cycle_limit = 1;
    avr_->sleep = [](avr_t*, avr_cycle_count_t) {};
  }

  void store(std::string serial) {
    if (serial.empty()) return;
    serial.resize(16, '\0');
    avr_eeprom_desc_t content{};
    content.ee = reinterpret_cast<std::uint8_t*>(serial.data());
    content.size = 16;
    avr_ioctl(avr_, AVR_IOCTL_EEPROM_SET, &content);
  }

  void wire() {
    std::uint32_t flags = 0;  // no output on the terminal, no waiting
    avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    listen(AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT, [](avr_irq_t*, std::uint32_t value, void* board) {
      static_cast<Board*>(board)->send(static_cast<std::uint8_t>(value));
    });
    listen(AVR_IOCTL_IOPORT_GETIRQ('A'), 0, [](avr_irq_t*, std::uint32_t value, void* board) {
      if (value != 0) static_cast<Board*>(board)->note("start");
    });
    listen(AVR_IOCTL_IOPORT_GETIRQ('G'), 5, [](avr_irq_t* pin, std::uint32_t value, void* board) {
      if (value != pin->value) static_cast<Board*>(board)->note("out", std::to_string(value));
    });
    listen(AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER,
           [](avr_irq_t*, std::uint32_t, void* board) { static_cast<Board*>(board)->convert(); });
    for (avr_io_t* io = avr_->io_port; io != nullptr; io = io->next) {
      if (std::strcmp(io->kind, "adc") == 0) adc_ = reinterpret_cast<avr_adc_t*>(io);
      if (std::strcmp(io->kind, "uart") == 0 && reinterpret_cast<avr_uart_t*>(io)->name == '0') {
        uart_ = reinterpret_cast<avr_uart_t*>(io);
      }
    }
    // The simulator keeps voltages of eight inputs only: every input reads the first of them, which gets the
    // voltage of the input that is selected.
    for (auto& mode : adc_->muxmode) {
      if (mode.kind == ADC_MUX_SINGLE) mode.src = 0;
    }
  }

  void listen(std::uint32_t what, int index, avr_irq_notify_t callback) {
    avr_irq_register_notify(avr_io_getirq(avr_, what, index), callback, this);
  }

  void convert() {
    const unsigned input = (avr_->data[kAdmux] & 7u) | ((avr_->data[kAdcsrb] & kMux5) != 0 ? 8u : 0u);
    adc_->adc_values[0] = static_cast<std::uint16_t>(voltage(input));
  }

  unsigned voltage(unsigned input) {
    if (input == kTransducer) return rig_.transducer(time());
    if (input == kThermometer) return rig_.thermometer(time());
    const std::size_t row = drivenRow();
    if (row == 0 && input == 0) {
      rig_.scan(time() + duration_ / 2);
      began_ = time();
    }
    const bool last = (row * rig_.columns() + input + 1) == rig_.counts().size();
    if (last) {
      duration_ = time() - began_;
      noteScan();
    }
    return rig_.taxel(row, input);
  }

  /// Row 0 to 7 = PA0 to PA7, 8 to 15 = PC7 to PC0. A large number where not exactly one is driven.
  std::size_t drivenRow() const {
    const unsigned pins = avr_->data[0x22] | (reversed(avr_->data[0x28]) << 8u);
    if (pins == 0 || (pins & (pins - 1)) != 0) return 1000;
    return static_cast<std::size_t>(std::lround(std::log2(pins)));
  }
  static unsigned reversed(unsigned byte) {
    unsigned result = 0;
    for (unsigned bit = 0; bit < 8; ++bit) result |= ((byte >> bit) & 1u) << (7 - bit);
    return result;
  }

  void send(std::uint8_t byte) {
    const avr_cycle_count_t divider = avr_->data[kUbrr] + 256u * avr_->data[kUbrr + 1] + 1u;
    const unsigned oversampling = (avr_->data[kUcsra] & kU2x) != 0 ? 8 : 16;
    line_free_ = std::max(line_free_, avr_->cycle) + kBitsPerByte * oversampling * divider;
    if (bytes_.is_open()) bytes_.put(static_cast<char>(byte));
    if (!port_) return;
    waiting_.push_back(byte);
    if (waiting_.size() < 16) return;
    port_->waitForRoom(std::chrono::milliseconds(500));
    port_->write(waiting_.data(), waiting_.size());
    waiting_.clear();
  }

  void setReason(const avr_regbit_t* flag) {
    avr_regbit_clear(avr_, avr_->reset_flags.porf);
    avr_regbit_clear(avr_, avr_->reset_flags.extrf);
    avr_regbit_clear(avr_, avr_->reset_flags.borf);
    avr_regbit_clear(avr_, avr_->reset_flags.wdrf);
    avr_regbit_set(avr_, *flag);
  }

  void restart(const std::string& cause, const avr_regbit_t* flag) {
    avr_reset(avr_);
    setReason(flag);
    note("restart", cause);
  }

  void note(const std::string& what, const std::string& more = "") {
    if (log_.is_open()) log_ << what << " " << avr_->cycle << (more.empty() ? "" : " " + more) << "\n";
  }
  void noteScan() {
    if (!log_.is_open()) return;
    log_ << "scan " << avr_->cycle;
    for (const std::uint16_t count : rig_.counts()) log_ << " " << count;
    log_ << "\n";
  }

  Rig& rig_;
  avr_t* avr_ = nullptr;
  avr_adc_t* adc_ = nullptr;
  avr_uart_t* uart_ = nullptr;
  avr_cycle_count_t busy_ = 0;       // cycles in which the processor did not sleep
  avr_cycle_count_t line_free_ = 0;  // cycle at which the last byte has left the board
  std::ofstream bytes_, log_;
  std::unique_ptr<fsr::emulator::PseudoTerminal> port_;
  std::vector<std::uint8_t> waiting_;
  double began_ = 0, duration_ = 0;  // of the scan before [s]
};

/// Holds simulated time back where it is faster than the pace.
class Pace {
 public:
  explicit Pace(double pace) : pace_(pace) {}
  void keep(double time) {
    if (pace_ <= 0) return;
    const std::chrono::duration<double> due(time / pace_);
    const auto now = std::chrono::steady_clock::now();
    const auto then = begin_ + std::chrono::duration_cast<std::chrono::nanoseconds>(due);
    if (then > now) std::this_thread::sleep_until(then);
    if (now - then > std::chrono::milliseconds(50)) begin_ += now - then;  // it is slower: do not catch up
  }

 private:
  double pace_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

int run(int argc, char** argv) {
  if (argc < 2 || argc % 2 != 0) throw InputError("avr_board FIRMWARE.elf [OPTION VALUE]...");
  Options options;
  std::multimap<double, std::string> events;
  for (int i = 2; i < argc; i += 2) {
    const std::string name = argv[i], value = argv[i + 1];
    if (name == "--event") {
      events.emplace(std::stod(value), value.substr(value.find(':') + 1));
    } else {
      options[name] = value;
    }
  }
  const auto number = [&](const std::string& name) {
    return options.count(name) ? std::stod(options[name]) : 0;
  };
  Rig rig(fsr::simulation::readSimulationFile(options["--simulation"]), options["--surface"]);
  Board board(argv[1], options, rig);
  Pace pace(number("--pace"));
  const double end = options.count("--seconds") ? number("--seconds") : INFINITY;
  double tick = 0;
  while (board.time() < end) {
    board.step();
    while (!events.empty() && events.begin()->first <= board.time()) {
      board.happen(events.begin()->second);
      events.erase(events.begin());
    }
    if (board.time() < tick) continue;
    tick += 0.01;
    pace.keep(board.time());
    if (options.count("--clock")) std::cout << board.time() << std::endl;
  }
  board.end();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "avr_board: " << error.what() << "\n";
    return 1;
  }
}
