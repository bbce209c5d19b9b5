// The firmware of firmware/, built with avr-gcc and run on a simulated ATmega2560 (avr_board.cpp), decoded by
// the decoder of the driver. Without avr-gcc or simavr these cases report SKIPPED.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "protocol/wire_decoder.h"
#include "support/holds.h"
#include "support/program_output.h"
#include "support/pty.h"
#include "support/source_dir.h"

namespace {

using fsr::protocol::PacketHeader;
using fsr::protocol::PacketType;
using test_support::outputOf;
using test_support::ProgramOutput;

constexpr double kCyclesPerMicrosecond = 16;

struct Scan {
  PacketHeader header;
  std::uint32_t duration = 0;
  std::vector<std::uint16_t> counts;
  bool operator<(const Scan& other) const { return header.sequence < other.header.sequence; }
};

/// What the driver's decoder makes of the bytes.
class Received : public fsr::protocol::PacketHandler {
 public:
  void onScan(const PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    scans.push_back({header, scan.duration, {scan.counts, scan.counts + scan.size.taxels()}});
    size = scan.size;
    full_scale = scan.full_scale;
  }
  void onTransducer(const PacketHeader& header, std::int32_t counts) override {
    transducer.emplace_back(header, counts);
  }
  void onTemperature(const PacketHeader& header, std::int32_t millidegrees) override {
    temperatures.emplace_back(header, millidegrees);
  }
  void onIdentity(const PacketHeader& header, const fsr::protocol::IdentityPacket& identity) override {
    identity_times.push_back(header.device_time);
    serials.emplace_back(identity.serial);
    models.emplace_back(identity.model);
    period = identity.scan_period;
  }

  void onTrigger(const PacketHeader& header, const fsr::protocol::TriggerPacket& trigger) override {
    triggers.emplace_back(header, trigger);
  }

  std::vector<Scan> scans;
  std::vector<std::pair<PacketHeader, fsr::protocol::TriggerPacket>> triggers;
  std::vector<std::pair<PacketHeader, std::int32_t>> transducer, temperatures;
  std::vector<std::string> serials, models;
  std::vector<std::uint32_t> identity_times;
  fsr::matrix::MatrixSize size;
  std::uint16_t full_scale = 0;
  std::uint32_t period = 0;
};

/// What the simulated board wrote into its log.
struct Log {
  std::vector<double> starts;                      // row 0 is driven [cycles]
  std::vector<std::vector<std::uint16_t>> counts;  // that were fed
  std::vector<double> in, out;                     // edges of the trigger pins [us of the simulator]
};

struct Session {
  Received received;
  fsr::protocol::DecoderCounts decoder;
  Log log;
  std::size_t bytes = 0;
};

class Firmware : public testing::Test {
 protected:
  void SetUp() override {
    if (!test_support::hasProgram("avr-gcc")) GTEST_SKIP() << "avr-gcc is not installed";
    std::ifstream there(board());
    if (!there) GTEST_SKIP() << "simavr was not installed when the tests were built: there is no " << board();
  }

  /// Beside this test; empty libraries have their path in the executable.
  static std::string board() {
    char path[4096] = "";
    const ssize_t size = ::readlink("/proc/self/exe", path, sizeof path - 1);
    const std::string self(path, size > 0 ? static_cast<std::size_t>(size) : 0);
    return self.substr(0, self.rfind('/')) + "/avr_board";
  }

  static std::string source() { return test_support::sourceDir(); }

  /// Standard output and standard error of `make`.
  ProgramOutput make(const std::string& settings) const {
    return outputOf("make --no-print-directory -C " + source() + "/firmware OUT=" + folder_.path() + " " +
                    settings + " 2>&1");
  }

  void build(const std::string& settings) const {
    const ProgramOutput output = make(settings);
    ASSERT_EQ(output.status, 0) << output.text;
  }

  /// The tests' rig with a matrix of another size.
  std::string rig(int rows, int columns) const {
    std::ifstream in(source() + "/test/firmware/rig.yaml");
    std::stringstream text;
    text << in.rdbuf();
    std::string yaml = text.str();
    const std::string size = "rows: 7, columns: 10";
    yaml.replace(yaml.find(size), size.size(),
                 "rows: " + std::to_string(rows) + ", columns: " + std::to_string(columns));
    std::ofstream(folder_.path("rig.yaml")) << yaml;
    return folder_.path("rig.yaml");
  }

  Session run(const std::string& options, int rows = 7, int columns = 10) const {
    Session result;
    const ProgramOutput output = outputOf(board() + " " + folder_.path("firmware.elf") + " --simulation " +
                                          rig(rows, columns) + " --bytes " + folder_.path("bytes") +
                                          " --log " + folder_.path("log") + " " + options + " 2>&1");
    EXPECT_EQ(output.status, 0) << output.text;
    decode(result);
    readLog(result.log);
    return result;
  }

 private:
  void decode(Session& result) const {
    std::ifstream in(folder_.path("bytes"), std::ios::binary);
    std::stringstream bytes;
    bytes << in.rdbuf();
    const std::string text = bytes.str();
    result.bytes = text.size();
    fsr::protocol::WireDecoder decoder(result.received);
    decoder.feed(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    result.decoder = decoder.counts();
  }

  void readLog(Log& log) const {
    std::ifstream in(folder_.path("log"));
    std::string line, kind;
    while (std::getline(in, line)) {
      std::istringstream words(line);
      double cycle = 0;
      words >> kind >> cycle;
      if (kind == "start") log.starts.push_back(cycle);
      if (kind == "in") log.in.push_back(cycle / kCyclesPerMicrosecond);
      if (kind == "out") log.out.push_back(cycle / kCyclesPerMicrosecond);
      if (kind != "scan") continue;
      log.counts.emplace_back();
      for (std::uint16_t count = 0; words >> count;) log.counts.back().push_back(count);
    }
  }

  test_support::TemporaryFolder folder_;
};

void expectNoDamage(const fsr::protocol::DecoderCounts& decoder) {
  EXPECT_EQ(decoder.skipped_bytes, 0u);
  EXPECT_EQ(decoder.bad_header_check + decoder.bad_packet_check + decoder.bad_length + decoder.bad_content,
            0u);
}

/// The clock runs on evenly, and no scan takes longer than its period.
void expectEvenStamps(const Received& received) {
  for (std::size_t i = 0; i < received.scans.size(); ++i) {
    EXPECT_LT(received.scans[i].duration, received.period) << "scan " << i;
    if (i == 0) continue;
    const PacketHeader &now = received.scans[i].header, &before = received.scans[i - 1].header;
    const double periods = now.sequence - before.sequence;
    // The middle moves by what the interrupts of the serial line add to a scan.
    EXPECT_NEAR(now.device_time - before.device_time, periods * received.period, 0.05 * received.period) << i;
  }
}

void expectNothingLost(const Session& session) {
  expectNoDamage(session.decoder);
  expectEvenStamps(session.received);
  for (const auto& sequence : session.decoder.sequences) EXPECT_EQ(sequence.lost, 0u);
}

/// Deviations of the starts of scans from an even beat [us], smallest and largest.
std::pair<double, double> jitter(const std::vector<double>& starts, double period) {
  double least = 0, most = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const double late = (starts[i] - starts[0]) / kCyclesPerMicrosecond - static_cast<double>(i) * period;
    least = std::min(least, late);
    most = std::max(most, late);
  }
  return {least, most};
}

TEST_F(Firmware, SendsTheCodesOfItsConverter) {
  build("");
  const Session session = run("--seconds 4.01");
  expectNothingLost(session);
  ASSERT_GT(session.received.scans.size(), 195u);
  EXPECT_EQ(session.received.size.rows, 7u);
  EXPECT_EQ(session.received.size.columns, 10u);
  EXPECT_EQ(session.received.full_scale, 1023);
  unsigned largest = 0;
  for (std::size_t i = 0; i < session.received.scans.size(); ++i) {
    EXPECT_EQ(session.received.scans[i].counts, session.log.counts[i]) << "scan " << i;
    for (const std::uint16_t count : session.log.counts[i]) largest = std::max<unsigned>(largest, count);
  }
  EXPECT_GT(largest, 300u);  // it was loaded
}

TEST_F(Firmware, SendsItsIdentityAtTheStartAndOnceASecond) {
  build("");
  const Session session = run("--seconds 3.5 --serial FSR-0042");
  EXPECT_EQ(session.received.serials, std::vector<std::string>(4, "FSR-0042"));
  EXPECT_EQ(session.received.period, 20000u);
  const auto& times = session.received.identity_times;
  EXPECT_LT(times.front(), 1000u);
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_NEAR(times[i], static_cast<double>(i) * 1e6, 40e3);
}

TEST_F(Firmware, AnEmptyEepromGivesTheDefaultSerialNumber) {
  build("");
  EXPECT_EQ(run("--seconds 0.1").received.serials, std::vector<std::string>(1, "mega2560"));
}

TEST_F(Firmware, MeasuresPressureAndTemperature) {
  build("");
  const Session session = run("--seconds 4.01");
  ASSERT_EQ(session.received.temperatures.size(), 3u);
  for (const auto& [header, millidegrees] : session.received.temperatures)
    EXPECT_NEAR(millidegrees, 23000, 150);
  // From 1 s to 3 s the chamber fills to 300 kPa, which is then held; a reading is (1034 + 103) kPa / 16368.
  const auto& transducer = session.received.transducer;
  ASSERT_EQ(transducer.size(), session.received.scans.size());
  double worst = 0;
  for (const auto& [header, counts] : transducer) {
    const double time = header.device_time * 1e-6;
    const double pressure = 300e3 * std::clamp((time - 1) / 2, 0.0, 1.0);
    worst = std::max(worst, std::abs(-103e3 + counts * 1137e3 / 16368 - pressure));
  }
  EXPECT_LT(worst, 900);  // [Pa]; one count of 10 bits is 1,111 Pa
}

TEST_F(Firmware, TheStampIsTheMiddleOfTheScan) {
  build("");
  const Session session = run("--seconds 1");
  ASSERT_GT(session.received.scans.size(), 40u);
  const Scan& scan = session.received.scans[20];
  EXPECT_NEAR(scan.duration, 69 * (104 + 5) + 6 * 50, 100);
  const Scan& next = session.received.scans[21];
  EXPECT_NEAR(next.header.device_time - scan.header.device_time, 20000, 50);
  // The transducer is read right behind the matrix.
  EXPECT_NEAR(session.received.transducer[20].first.device_time - scan.header.device_time,
              scan.duration / 2 + 900, 100);
}

std::string edge(double time, bool high) {
  std::ostringstream option;
  option << std::fixed << " --event " << time << (high ? ":1" : ":0");
  return option.str();
}

/// The simulator's time less the board's [us]: scans begin with a settled row.
double clockOffset(const Session& session) {
  double least = INFINITY;
  for (std::size_t i = 0; i < session.received.scans.size(); ++i) {
    const Scan& scan = session.received.scans[i];
    const double first = scan.header.device_time - scan.duration / 2 - 50 - 12;
    least = std::min(least, session.log.starts.at(i) / kCyclesPerMicrosecond - first);
  }
  return least;
}

TEST_F(Firmware, StampsEdgesAtTheTriggerWithinTheStatedDeviation) {
  build("");
  std::string edges;
  for (int i = 0; i < 60; ++i) edges += edge(0.2 + 0.0123456 * i, i % 2 == 1);  // all over the scan
  const Session session = run("--seconds 1.2" + edges);
  expectNothingLost(session);
  const auto& triggers = session.received.triggers;
  ASSERT_EQ(triggers.size(), 60u);
  double least = INFINITY, most = -INFINITY;
  for (std::size_t i = 0; i < triggers.size(); ++i) {
    const auto& [header, trigger] = triggers[i];
    EXPECT_EQ(header.sequence, i);
    EXPECT_EQ(trigger.high, i % 2 == 1);
    EXPECT_EQ(trigger.deviation, 2u);
    const double error = header.device_time + clockOffset(session) - session.log.in.at(i);
    least = std::min(least, error);
    most = std::max(most, error);
  }
  std::cout << "stamps of edges: " << least << " to " << most << " us beside the edge\n";
  EXPECT_LE(most - least, 4);
  EXPECT_LT(std::abs(least), 15);  // what is known of the offset of the clocks
  const auto [early, late] = jitter(session.log.starts, 20000);
  std::cout << "starts of scans: " << early << " to " << late << " us from an even beat\n";
  EXPECT_LT(late - early, 20);
}

TEST_F(Firmware, CountsAnEdgeThatBouncesOnceAndAShortPulseTwice) {
  build("");
  std::string edges;
  for (int i = 0; i < 9; ++i) edges += edge(0.3 + 0.0004 * i, i % 2 == 1);  // a switch that closes
  edges += edge(0.4, true) + edge(0.5, false) + edge(0.501, true);          // a pulse of 1 ms
  const Session session = run("--seconds 0.8" + edges);
  const auto& triggers = session.received.triggers;
  ASSERT_EQ(triggers.size(), 4u);
  const std::vector<std::size_t> at = {0, 9, 10, 11};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& [header, trigger] = triggers[i];
    EXPECT_EQ(trigger.high, i % 2 == 1);
    EXPECT_EQ(trigger.deviation, i == 3 ? 2500u : 2u);
    EXPECT_NEAR(header.device_time + clockOffset(session), session.log.in.at(at[i]), trigger.deviation + 15);
  }
}

TEST_F(Firmware, ThePulseAtTheTriggerOutputHasTheStampOfItsScanInTheMiddle) {
  build("PERIOD=12000");
  const Session session = run("--seconds 3");
  const auto& out = session.log.out;
  ASSERT_EQ(out.size(), 6u);  // scans 0, 100 and 200
  for (std::size_t i = 0; i < 3; ++i) {
    const PacketHeader& header = session.received.scans.at(100 * i).header;
    EXPECT_EQ(header.sequence, 100 * i);
    EXPECT_NEAR((out[2 * i] + out[2 * i + 1]) / 2 - clockOffset(session), header.device_time, 30);
  }
}

TEST_F(Firmware, ScansStartInAnEvenBeat) {
  // At a million baud an interrupt of the serial line can be under way when a scan is due.
  build("BAUD=1000000 PERIOD=4900 ADC_PRESCALER=16");
  const Session session = run("--seconds 5");
  expectNothingLost(session);
  ASSERT_GT(session.log.starts.size(), 1000u);
  const auto [least, most] = jitter(session.log.starts, 4900);
  RecordProperty("jitter_us", std::to_string(most - least));
  std::cout << "starts of scans: " << least << " to " << most << " us from an even beat\n";
  EXPECT_LT(most - least, 20);
}

TEST_F(Firmware, StampsAreRightWhileTheTimerTurnsOver) {
  // The timer turns over every 32,768 us. A scan starts 1 us earlier in each turn, so that every step of it
  // meets the moment, at which the interrupt that counts the turn has not run yet.
  build("PERIOD=32767");
  const Session session = run("--seconds 4");
  expectNothingLost(session);
  EXPECT_GT(session.received.scans.size(), 115u);
}

TEST_F(Firmware, APeriodLongerThanTheTimerIsKept) {
  build("BAUD=115200 PERIOD=100001");
  const Session session = run("--seconds 3");
  ASSERT_GT(session.log.starts.size(), 28u);
  const auto [least, most] = jitter(session.log.starts, 100001);
  EXPECT_LT(most - least, 20);
  EXPECT_EQ(session.received.period, 100001u);
}

struct Limit {
  std::string settings;
  int rows, columns;
  std::string why;
};

void PrintTo(const Limit& limit, std::ostream* out) {
  *out << limit.rows << " x " << limit.columns << " " << limit.settings;
}

class ShortestPeriod : public Firmware, public testing::WithParamInterface<Limit> {};

TEST_P(ShortestPeriod, ThatMakeAcceptsLosesNothing) {
  const Limit& limit = GetParam();
  const std::string settings =
      limit.settings + " ROWS=" + std::to_string(limit.rows) + " COLUMNS=" + std::to_string(limit.columns);
  const ProgramOutput refused = make(settings + " PERIOD=3000");
  EXPECT_NE(refused.status, 0);
  EXPECT_NE(refused.text.find(limit.why), std::string::npos) << refused.text;
  const std::string mark = "the shortest is PERIOD=";
  const std::size_t at = refused.text.find(mark);
  ASSERT_NE(at, std::string::npos) << refused.text;
  const int period = std::stoi(refused.text.substr(at + mark.size()));
  build(settings + " PERIOD=" + std::to_string(period));
  std::string edges;  // one a scan at most, and none within the bounces of the one before
  for (double time = 0.2; time < 2; time += std::max(1e-6 * period, 0.006))
    edges += edge(time, edges.size() / edge(time, true).size() % 2 == 1);
  const Session session = run("--seconds 2.2" + edges, limit.rows, limit.columns);
  expectNothingLost(session);
  EXPECT_NEAR(static_cast<double>(session.received.scans.size()), 2.2e6 / period, 3);
}

INSTANTIATE_TEST_SUITE_P(
    Firmware, ShortestPeriod,
    testing::Values(Limit{"BAUD=115200", 7, 10, "a line of 115200 baud needs 19002 us"},
                    Limit{"BAUD=250000", 7, 10,
                          "the converter with ADC_PRESCALER=128 and SETTLING_US=50 needs"},
                    Limit{"BAUD=1000000 ADC_PRESCALER=16", 7, 10, "the processor needs"},
                    Limit{"BAUD=500000 ADC_PRESCALER=64", 16, 10, "the converter with ADC_PRESCALER=64"},
                    Limit{"BAUD=1000000 ADC_PRESCALER=16", 16, 14, "the processor needs"}));

TEST_F(Firmware, AnOverrunDropsWholePacketsAndTheSequenceShowsIt) {
  build("UNCHECKED=1 BAUD=115200 PERIOD=12500");
  const Session session = run("--seconds 5");
  expectNoDamage(session.decoder);
  const auto& scans = session.decoder.of(PacketType::kScan);
  EXPECT_GT(scans.lost, 50u);
  // Received and lost ones are all that were made, but for the few that still wait in the ring.
  EXPECT_NEAR(static_cast<double>(scans.packets + scans.lost), static_cast<double>(session.log.counts.size()),
              8);
  for (const Scan& scan : session.received.scans) {
    EXPECT_EQ(scan.counts, session.log.counts.at(scan.header.sequence)) << "scan " << scan.header.sequence;
  }
  // The line itself stays full.
  EXPECT_GT(static_cast<double>(session.bytes), 0.97 * 5 * 117647 / 10);
}

TEST_F(Firmware, AResetRestartsSequenceAndClock) {
  build("");
  const Session session = run("--seconds 3 --event 1.5:reset");
  EXPECT_EQ(session.decoder.of(PacketType::kScan).restarts, 1u);
  EXPECT_EQ(session.received.models.front(), "mega power-on");
  EXPECT_EQ(session.received.models.back(), "mega reset pin");
  EXPECT_LE(session.decoder.bad_header_check + session.decoder.bad_packet_check,
            2u);  // a packet that was under way
}

TEST_F(Firmware, ABrownOutIsNamed) {
  build("");
  EXPECT_EQ(run("--seconds 3 --event 1.5:brown-out").received.models.back(), "mega brown-out");
}

TEST_F(Firmware, TheWatchdogRestartsAProgramThatRanAstray) {
  build("");
  const Session session = run("--seconds 4 --event 1.5:stray");
  EXPECT_EQ(session.decoder.of(PacketType::kScan).restarts, 1u);
  EXPECT_EQ(session.received.models.back(), "mega watchdog");
  EXPECT_GT(session.received.scans.back().header.sequence, 40u);  // about 1.4 s behind the restart
}

TEST_F(Firmware, TheWatchdogRestartsAConverterThatStandsStill) {
  build("");
  const Session session = run("--seconds 4 --event 1.5:converter");
  EXPECT_EQ(session.decoder.of(PacketType::kScan).restarts, 1u);
  EXPECT_EQ(session.received.models.back(), "mega watchdog");
}

TEST_F(Firmware, SettingsThatDoNotFitAreRefusedWithTheLargestThatDo) {
  const auto refusal = [&](const std::string& settings) {
    const ProgramOutput output = make(settings);
    EXPECT_NE(output.status, 0) << settings;
    const std::size_t begin = output.text.find("firmware: ");
    return begin == std::string::npos ? output.text
                                      : output.text.substr(begin, output.text.find('\n', begin) - begin);
  };
  EXPECT_EQ(refusal("ROWS=16 COLUMNS=64"),
            "firmware: ROWS=16 COLUMNS=64 does not fit the board, which has 16 row pins and 14 column "
            "inputs: the largest "
            "matrix is 16 x 14");
  EXPECT_EQ(refusal("RING=8192"),
            "firmware: RING=8192 does not fit the 8192 bytes of RAM: the largest is 4096");
  EXPECT_TRUE(
      test_support::holds(refusal("ROWS=16 BAUD=115200"),
                          {"115200", "16 x 10", "shortest is PERIOD=34764", "PERIOD=20000", "7 x 10"}));
  EXPECT_TRUE(
      test_support::holds(refusal("BAUD=230400"), {"BAUD", "230400", "makes is 222222", "2.5 %", "1000000"}));
  EXPECT_TRUE(test_support::holds(refusal("PERIOD=ten"), {"PERIOD", "\"ten\""}));
}

TEST_F(Firmware, TheCompilerRefusesWhatDoesNotFitWithoutMakeToo) {
  const ProgramOutput output = make("UNCHECKED=1 ROWS=16 COLUMNS=64");
  EXPECT_NE(output.status, 0);
  EXPECT_NE(output.text.find("the largest matrix is 16 x 14"), std::string::npos) << output.text;
}

TEST_F(Firmware, ThePrintedSizesFitTheBoard) {
  const ProgramOutput output = make("ROWS=16 COLUMNS=14 RING=4096 PERIOD=50000");
  const std::size_t at = output.text.find("flash ");
  ASSERT_NE(at, std::string::npos) << output.text;
  int flash = 0, ram = 0;
  ASSERT_EQ(
      std::sscanf(output.text.c_str() + at, "flash %d of 253952 bytes, RAM %d of 8192 bytes", &flash, &ram),
      2);
  EXPECT_LT(flash, 8000);
  EXPECT_LT(ram, 7000);  // the largest settings leave more than 1 KiB of stack
}

// The encoder on two other controllers: `wire.c` needs no C library.
TEST(WireEncoder, CompilesForOtherControllersWithoutAWarning) {
  const std::string source = test_support::sourceDir();
  const std::string options =
      " -std=c99 -Os -Wall -Wextra -Wconversion -Werror -ffreestanding -c -o /dev/null -I " + source +
      "/include/fsr_pressure_map/protocol " + source + "/src/protocol/wire.c 2>&1";
  int compilers = 0;
  for (const std::string compiler :
       {"avr-gcc -mmcu=atmega2560", "avr-gcc -mmcu=atmega328p",
        "arm-none-eabi-gcc -mcpu=cortex-m0plus -mthumb", "arm-none-eabi-gcc -mcpu=cortex-m7 -mthumb"}) {
    if (!test_support::hasProgram(compiler.substr(0, compiler.find(' ')))) continue;
    ++compilers;
    const ProgramOutput output = outputOf(compiler + options);
    EXPECT_EQ(output.status, 0) << compiler << "\n" << output.text;
  }
  if (compilers == 0) GTEST_SKIP() << "neither avr-gcc nor arm-none-eabi-gcc is installed";
}

}  // namespace
