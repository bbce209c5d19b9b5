#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "simulation/rig.h"

namespace fsr::emulator {

/// The board's clock.
struct BoardClock {
  std::uint32_t offset = 0;  ///< its value when the board starts [us]
  double drift = 0;          ///< rate error, positive = too fast [parts per million]
};

/// The board: it scans the matrix, samples transducer and temperature, and makes packets of the wire format.
/// It uses rig time only, does no input or output, and is not thread-safe.
class Board {
 public:
  /// Gauge pressure of the chamber [Pa] at a rig time [s].
  using Pressure = simulation::PressureCourse;

  /// A board that is switched on at rig time 0. Throws InputError.
  Board(const simulation::SimulationSettings& simulation, const BoardClock& clock);

  /// Time at which the board sends the next packet [s rig time].
  double nextDue() const;

  /// Makes that packet. The reference is valid until the next call.
  std::vector<std::uint8_t>& next(const Pressure& pressure);

  /// Mounts the matrix on a surface; `pattern` is the loaded part of it. Throws InputError.
  void mount(const matrix::Surface& surface, const simulation::LoadPattern& pattern = {}) {
    rig_.mount(surface, pattern);
  }

  /// Breaks the contact of a taxel: it reads 0 from now on. `taxel` counts row-major.
  void loseTaxel(std::size_t taxel);
  /// Every taxel has contact again.
  void fixTaxels() { lost_taxels_.clear(); }

  /// The transducer's plug and its supply.
  enum class TransducerLine {
    kWorks,
    kUnplugged,  ///< it reads 0 counts, the lower end of its range
    kSilent,     ///< no packets of the transducer are sent
  };
  void setTransducer(TransducerLine line, double time);

  /// Sets the trigger input: an edge at `time`, sent at once.
  void setTrigger(bool high, double time);

  /// Switches the board off and on at `time`: clock and counters restart.
  void reset(double time);

  /// Makes the board's clock jump by `seconds`, forwards or backwards, like a fault of its crystal.
  void jumpClock(double seconds);

  /// Value of the board's clock at a rig time [us]. In packets it wraps at 2^32.
  std::uint64_t deviceTime(double time) const;
  /// The inverse, since the last reset.
  double rigTime(std::uint64_t device_time) const;

  std::uint64_t scans() const { return rig_.scans(); }

  /// Bit rate that the link must carry [bits per second of rig time].
  double bitsPerSecond() const;

 private:
  enum Kind { kIdentity, kTemperature, kTransducer, kScan, kTrigger, kKinds };
  /// Packets of one kind are sampled at `start` + `number` * `period` and sent `delay` later.
  struct Source {
    double start = 0;          // [s rig time]
    double period = 0;         // [s], 0 = never
    double delay = 0;          // [s]
    std::uint64_t number = 0;  // of the next packet
    std::uint32_t sequence = 0;

    double time() const { return start + static_cast<double>(number) * period; }
    double due() const;
  };
  Kind nextKind() const;
  std::size_t encode(Kind kind, double time, const Pressure& pressure);
  std::size_t encodeScan(std::uint32_t sequence, double time, const Pressure& pressure);
  std::size_t encodeIdentity(std::uint32_t sequence, std::uint32_t device_time);

  simulation::SimulationSettings settings_;
  BoardClock clock_;
  simulation::Rig rig_;
  std::array<Source, kKinds> sources_;
  double switched_on_ = 0;  // [s rig time]
  TransducerLine transducer_ = TransducerLine::kWorks;
  bool trigger_high_ = false;
  std::vector<std::size_t> lost_taxels_;
  std::vector<std::uint16_t> counts_;  // of a scan with lost taxels
  std::vector<std::uint8_t> packet_;
};

}  // namespace fsr::emulator
