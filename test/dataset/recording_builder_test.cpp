#include "dataset/recording_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"

namespace fsr::dataset {
namespace {

using Event = std::function<void(RecordingBuilder&)>;

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;  // [ns]
constexpr std::int64_t ms(std::int64_t milliseconds) {
  return kStart + milliseconds * 1'000'000;
}

Event scan(std::int64_t stamp, std::uint32_t sequence, std::uint16_t count) {
  return [=](RecordingBuilder& builder) {
    builder.addScan(stamp, sequence, matrix::view(matrix::Scan{{1, 2}, 4095, {count, 7}}));
  };
}
Event chamber(std::int64_t stamp, double absolute) {
  return [=](RecordingBuilder& builder) { builder.addChamberPressure(stamp, absolute); };
}
Event surface(std::int64_t stamp, const std::string& name, double curvature) {
  return [=](RecordingBuilder& builder) {
    builder.addSurface(stamp, {name, 1, {matrix::Curvature{curvature, 0, 0}}, {}});
  };
}
Event description(double ambient, const std::string& serial = "0001", matrix::MatrixSize size = {1, 2}) {
  return [=](RecordingBuilder& builder) {
    MatrixDescription described;
    described.sensor.serial = serial;
    described.layout = {size, 0.012, 0.008};
    described.full_scale = 4095;
    described.ambient_pressure = ambient;
    builder.addDescription(ms(0), described);
  };
}

RecordingOptions withAmbient(double ambient) {
  RecordingOptions options;
  options.ambient_pressure = ambient;
  return options;
}

Recording build(const std::vector<Event>& events, const RecordingOptions& options = {}) {
  RecordingBuilder builder;
  for (const Event& event : events) event(builder);
  return builder.build(options);
}

// Ten seconds at 10 Hz, flat and from 5 s on bent; chamber at 4 Hz.
std::vector<Event> session() {
  std::vector<Event> events = {description(100e3)};
  for (std::uint16_t i = 0; i <= 100; ++i) {
    events.push_back(scan(ms(100 * i), 50u + i, static_cast<std::uint16_t>(10 * i)));
  }
  for (int i = 0; i <= 40; ++i) events.push_back(chamber(ms(250 * i), 100e3 + 1e3 * i));
  for (int i = 0; i <= 9; ++i) {
    const bool bent = i >= 5;
    events.push_back(surface(ms(1000 * i), bent ? "cylinder_7cm" : "flat", bent ? 14.3 : 0.0));
  }
  return events;
}

void expectSame(const Recording& a, const Recording& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.counts, b.counts);
  EXPECT_EQ(a.pressure, b.pressure);
  EXPECT_EQ(a.condition, b.condition);
  EXPECT_EQ(a.temperature, b.temperature);
  EXPECT_EQ(a.start_ns, b.start_ns);
  EXPECT_EQ(a.warnings, b.warnings);
}

TEST(RecordingBuilder, InterpolatesTheReferenceToTheScans) {
  const Recording recording = build(session());
  EXPECT_EQ(recording.start_ns, ms(0));
  ASSERT_GE(recording.scans(), 4u);
  EXPECT_DOUBLE_EQ(recording.time[3], 0.3);
  EXPECT_EQ(recording.pressure[0], 0.0);
  EXPECT_NEAR(recording.pressure[1], 400.0, 1e-9);  // 0.1 s of 4 kPa/s
  EXPECT_NEAR(recording.pressure[3], 1200.0, 1e-9);
  EXPECT_EQ(recording.scan(3)[0], 30);
  EXPECT_EQ(recording.scan(3)[1], 7);
  EXPECT_EQ(recording.layout.pitch_x, 0.012);
  EXPECT_EQ(recording.sensor.serial, "0001");
}

// A triangle that is read ten times a cycle, at any phase. Its error is known, because the scans between the
// readings are simulated.
TEST(RecordingBuilder, EstimatesTheErrorOfTheReference) {
  const auto triangle = [](int ms) { return 1e3 * std::abs(ms % 2000 - 1000); };
  double error = 0, estimate = 0;
  for (int phase = 0; phase < 200; phase += 20) {
    std::vector<Event> events = {description(100e3), surface(ms(0), "flat", 0)};
    for (int i = 0; i <= 1000; ++i)
      events.push_back(scan(ms(20 * i), static_cast<std::uint32_t>(i), static_cast<std::uint16_t>(i)));
    for (int at = phase; at <= 20000; at += 200) events.push_back(chamber(ms(at), 100e3 + triangle(at)));
    const Recording recording = build(events);
    double square = 0;
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      const auto at = static_cast<int>(std::lround(1e3 * recording.time[i])) +
                      static_cast<int>((recording.start_ns - ms(0)) / 1'000'000);
      square += std::pow(recording.pressure[i] - triangle(at), 2);
    }
    error += square / static_cast<double>(recording.scans());
    estimate += std::pow(recording.reference_error, 2);
  }
  EXPECT_NEAR(std::sqrt(estimate / error), 1, 0.1);
  EXPECT_EQ(build(session()).reference_error, 0) << "a straight course";
}

TEST(RecordingBuilder, TheOrderOfTheEventsDoesNotMatter) {
  std::vector<Event> events = session();
  for (std::uint32_t i = 0; i < 10; ++i) events.push_back(scan(ms(100 * i), 50 + i, 4000));  // duplicates
  events.push_back(chamber(ms(500), 120e3));
  events.push_back(surface(ms(0), "also_flat", 0.0));
  events.push_back([](RecordingBuilder& builder) { builder.addTemperature(ms(400), 21.0); });
  events.push_back([](RecordingBuilder& builder) { builder.addTemperature(ms(9000), 24.0); });
  const Recording expected = build(events);
  EXPECT_EQ(expected.losses.duplicates, 10u);
  std::mt19937 random(1);
  for (int round = 0; round < 5; ++round) {
    std::shuffle(events.begin(), events.end(), random);
    expectSame(build(events), expected);
  }
}

TEST(RecordingBuilder, DropsScansWithinASecondOfAChangeOfSurface) {
  const Recording recording = build(session());
  EXPECT_EQ(recording.losses.near_change, 21u);  // 4.0 to 6.0 s, ends included
  EXPECT_EQ(recording.scans(), 80u);
  ASSERT_EQ(recording.conditions.size(), 2u);
  EXPECT_EQ(recording.conditions[1].name, "cylinder_7cm");
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    EXPECT_EQ(recording.condition[i], recording.time[i] < 5.0 ? 0u : 1u);
    EXPECT_GT(std::abs(recording.time[i] - 5.0), 1.0);
  }
}

TEST(RecordingBuilder, ScansBeforeTheFirstSurfaceBelongToIt) {
  const Recording recording = build({scan(ms(0), 1, 5), scan(ms(100), 2, 5), surface(ms(900), "flat", 0.0)});
  EXPECT_EQ(recording.scans(), 2u);
  EXPECT_EQ(recording.losses.near_change, 0u);
  EXPECT_EQ(recording.conditions.at(recording.condition[0]).name, "flat");
}

TEST(RecordingBuilder, TreatsAScatteringMeasuredCurvatureAsOneCondition) {
  const Recording recording = build({scan(ms(0), 1, 5), scan(ms(5000), 2, 5), surface(ms(0), "limb", 12.00),
                                     surface(ms(1000), "limb", 12.04), surface(ms(2000), "limb", 11.97)});
  EXPECT_EQ(recording.conditions.size(), 1u);
  EXPECT_EQ(recording.scans(), 2u);
}

TEST(RecordingBuilder, TreatsARemountAsAChangeAlsoAtTheSameCurvature) {
  const auto mounted = [](std::int64_t stamp, std::uint32_t mount) {
    return [=](RecordingBuilder& builder) {
      builder.addSurface(stamp, {"flat", mount, {matrix::Curvature{}}, {}});
    };
  };
  const Recording recording = build({scan(ms(0), 1, 5), scan(ms(5000), 2, 5), scan(ms(9000), 3, 5),
                                     mounted(ms(0), 1), mounted(ms(5000), 2)});
  EXPECT_EQ(recording.losses.near_change, 1u);
  EXPECT_EQ(recording.conditions.size(), 2u);
}

TEST(RecordingBuilder, CountsGapsOfTheBoardsCounter) {
  const Recording recording =
      build({scan(ms(0), 4294967294u, 5), scan(ms(100), 4294967295u, 5), scan(ms(200), 0, 5),  // wraps round
             scan(ms(300), 4, 5), scan(ms(400), 5, 5), scan(ms(500), 2, 5)});  // the board restarts
  EXPECT_EQ(recording.losses.sequence_gaps, 2u);
  EXPECT_EQ(recording.losses.lost_scans, 3u);
  EXPECT_EQ(recording.warnings.back(), "2 gaps between scans, 3 scans lost by the board's counter");
}

TEST(RecordingBuilder, CountsAndNamesTimesWithoutAScanThatNoCounterShows) {
  std::vector<Event> events;
  for (std::uint32_t i = 0; i < 50; ++i) {
    const std::int64_t late = i < 20 ? 0 : i < 40 ? 276'000 : 278'000;
    events.push_back(scan(ms(100 * i + late), i, 5));
  }
  const Recording recording = build(events);
  EXPECT_EQ(recording.losses.sequence_gaps, 2u);
  EXPECT_EQ(recording.losses.lost_scans, 0u);
  const auto says = [&](const std::string& sentence) {
    return std::count(recording.warnings.begin(), recording.warnings.end(), sentence) == 1;
  };
  EXPECT_TRUE(says("no scan came for 276.1 s (1.9 to 278.0 s), the longest of 2 such gaps"));
  EXPECT_TRUE(says("2 gaps between scans, 0 scans lost by the board's counter"));
}

TEST(RecordingBuilder, CountsAGapOnceThatTimeAndCounterShow) {
  std::vector<Event> events;
  for (std::uint32_t i = 0; i < 50; ++i)
    events.push_back(scan(ms(i < 20 ? 10 * i : 10 * i + 150), i < 20 ? i : i + 15, 5));
  events.push_back(scan(ms(700), 65, 5));  // five usual steps: a busy computer
  const Recording recording = build(events);
  EXPECT_EQ(recording.losses.sequence_gaps, 1u);
  EXPECT_EQ(recording.losses.lost_scans, 15u);
}

TEST(RecordingBuilder, DropsScansWithoutAReferenceBeforeAndAfter) {
  const Recording recording =
      build({scan(ms(0), 1, 5), scan(ms(1000), 2, 5), scan(ms(3000), 3, 5), scan(ms(9000), 4, 5),
             chamber(ms(500), 100e3), chamber(ms(1500), 101e3), chamber(ms(4000), 102e3)},
            withAmbient(100e3));
  EXPECT_EQ(recording.scans(), 1u);  // 3 s lies in a gap of 2.5 s, 0 and 9 s outside
  EXPECT_DOUBLE_EQ(recording.pressure.front(), 500.0);
  EXPECT_EQ(recording.losses.no_reference, 3u);
}

TEST(Recording, ReportsGapsButNotTheScansAtABagsEnds) {
  RecordingLosses losses;
  losses.no_reference = 2;
  EXPECT_TRUE(describeLosses(losses).empty());
  losses.no_reference = 200;
  losses.duplicates = 1;
  EXPECT_EQ(describeLosses(losses),
            (std::vector<std::string>{"dropped 1 scan with the stamp of another one",
                                      "dropped 200 scans in gaps of chamber_pressure"}));
}

TEST(RecordingBuilder, IgnoresAChamberPressureThatIsNotFinite) {
  const Recording recording = build(
      {scan(ms(100), 1, 5), chamber(ms(0), 100e3), chamber(ms(100), std::nan("")), chamber(ms(200), 102e3)},
      withAmbient(100e3));
  EXPECT_DOUBLE_EQ(recording.pressure.at(0), 1e3);
  EXPECT_EQ(recording.losses.bad_reference, 1u);
}

// Cycles of 20 s up to 100 kPa; reference and scans at 10 Hz. The sheet reads one count for 100 Pa.
std::vector<Event> cycles(const std::function<double(int)>& wrong, const std::function<double(int)>& felt) {
  std::vector<Event> events = {description(100e3), surface(ms(0), "flat", 0)};
  for (int i = 0; i < 3000; ++i) {
    const double load = 1e3 * std::min(i % 200, 200 - i % 200) + felt(i);
    events.push_back(
        scan(ms(100 * i), static_cast<std::uint32_t>(i), static_cast<std::uint16_t>(load / 100)));
    events.push_back(chamber(ms(100 * i), 100e3 + load + wrong(i)));
  }
  return events;
}

double nothing(int) {
  return 0;
}

TEST(RecordingBuilder, LeavesOutSpikesOfTheReferenceThatTheSheetDoesNotFeel) {
  const auto spike = [](int i) {
    return i == 130 ? 80e3 : i == 333 || i == 610 ? -30e3 : i == 720 ? 3e9 : 0;
  };
  const auto spell = [](int i) { return i >= 850 && i < 858 ? 40e3 : 0.0; };
  const Recording expected = build(cycles(nothing, nothing));
  const Recording recording = build(cycles([&](int i) { return spike(i) + spell(i); }, nothing));
  EXPECT_EQ(expected.losses.reference_spikes, 0u);
  EXPECT_EQ(recording.losses.reference_spikes, 12u);
  ASSERT_EQ(recording.scans(), expected.scans());
  for (std::size_t i = 0; i < recording.scans(); ++i)
    EXPECT_NEAR(recording.pressure[i], expected.pressure[i], 1e3) << i;
  EXPECT_TRUE(test_support::holds(recording.warnings.back(), {"left out 12 chamber pressures"}));
}

TEST(RecordingBuilder, KeepsPulsesThatTheSheetFeelsAndAReferenceThatIsNotOfTheSheet) {
  const auto pulse = [](int i) { return i == 130 || (i >= 850 && i < 858) ? 40e3 : 0.0; };
  EXPECT_EQ(build(cycles(nothing, pulse)).losses.reference_spikes, 0u);
  const auto often = [](int i) { return i % 10 == 0 ? 40e3 : 0.0; };
  EXPECT_EQ(build(cycles(often, nothing)).losses.reference_spikes, 0u);
  // A fast cycle that the sheet feels 0.3 s later: clocks that differ are no spikes.
  const auto fast = [](int i) { return i >= 400 && i < 408 ? 15e3 * std::min(i - 399, 408 - i) : 0.0; };
  const auto late = [&](int i) { return fast(i - 3); };
  EXPECT_EQ(build(cycles([&](int i) { return fast(i) - late(i); }, late)).losses.reference_spikes, 0u);
}

TEST(RecordingBuilder, TakesAmbientPressureFromTheOptionThenTheMatrixThenTheStandard) {
  std::vector<Event> events = {scan(ms(0), 1, 5), chamber(ms(0), 150e3)};
  const Recording assumed = build(events);
  EXPECT_EQ(assumed.pressure.at(0), 150e3 - 101325.0);
  EXPECT_TRUE(test_support::holds(assumed.warnings.at(0), {"matrix_info", "0.010 m"}));
  EXPECT_TRUE(test_support::holds(assumed.warnings.at(1), {"101325 Pa", "no ambient pressure is recorded"}));
  events.push_back(description(110e3));
  EXPECT_EQ(build(events).pressure.at(0), 40e3);
  EXPECT_TRUE(build(events).warnings.empty());
  EXPECT_EQ(build(events, withAmbient(120e3)).pressure.at(0), 30e3);
}

TEST(RecordingBuilder, WarnsOfGaugeReadingsInTheChamberTopic) {
  const Recording recording = build({description(100e3), scan(ms(0), 1, 5), chamber(ms(0), 0.0)});
  ASSERT_EQ(recording.warnings.size(), 1u);
  EXPECT_TRUE(test_support::holds(recording.warnings.front(),
                                  {"pressure is -100 kPa", "chamber_pressure", "--ambient"}));
}

TEST(RecordingBuilder, BuildsARecordingWithoutReferenceAndSurface) {
  const Recording recording = build({scan(ms(0), 1, 5), scan(ms(100), 2, 6)});
  EXPECT_EQ(recording.scans(), 2u);
  EXPECT_TRUE(recording.pressure.empty());
  EXPECT_TRUE(recording.temperature.empty());
  ASSERT_EQ(recording.conditions.size(), 1u);
  EXPECT_FALSE(recording.conditions.front().known());
}

TEST(RecordingBuilder, ScansOnAnUnknownSurfaceAreDroppedWhereOthersAreKnown) {
  const auto unknown = [](RecordingBuilder& builder) { builder.addSurface(ms(5000), {"", 0, {}, {}}); };
  const Recording recording =
      build({scan(ms(0), 1, 5), scan(ms(9000), 2, 5), surface(ms(0), "flat", 0.0), unknown});
  EXPECT_EQ(recording.scans(), 1u);
  EXPECT_EQ(recording.losses.unknown_surface, 1u);
  EXPECT_EQ(recording.conditions.size(), 1u);
}

TEST(RecordingBuilder, InterpolatesTheTemperatureAndHoldsItAtTheEnds) {
  const auto warm = [](std::int64_t stamp, double celsius) {
    return [=](RecordingBuilder& builder) { builder.addTemperature(stamp, celsius); };
  };
  const Recording recording =
      build({scan(ms(0), 1, 5), scan(ms(2000), 2, 5), scan(ms(9000), 3, 5), warm(ms(1000), 20.0),
             warm(ms(3000), 22.0), warm(ms(1500), std::nan(""))});
  EXPECT_EQ(recording.temperature, (std::vector<double>{20.0, 21.0, 22.0}));
}

std::string complaint(const std::vector<Event>& events) {
  return test_support::refusal([&] { build(events); }, "accepted");
}

TEST(RecordingBuilder, RefusesEventsOfTwoMatrices) {
  const auto other = [](RecordingBuilder& builder) {
    builder.addScan(ms(1), 1, matrix::view(matrix::Scan{{2, 2}, 4095, {1, 2, 3, 4}}));
  };
  EXPECT_TRUE(test_support::holds(complaint({scan(ms(0), 1, 5), other}),
                                  {"1 x 2 taxels", "full_scale 4095", "2 x 2"}));
  EXPECT_TRUE(test_support::holds(complaint({scan(ms(0), 1, 5), description(0, "0001", {7, 10})}),
                                  {"matrix_info", "7 x 10 taxels", "full_scale 4095", "1 x 2"}));
  EXPECT_TRUE(
      test_support::holds(complaint({scan(ms(0), 1, 5), description(0, "0001"), description(0, "0002")}),
                          {"matrix_info", "\"0001\" and \"0002\""}));
}

TEST(RecordingBuilder, MalformedEventsAreRefused) {
  const auto malformed = [](const matrix::Scan& bad) {
    return [bad](RecordingBuilder& builder) { builder.addScan(ms(0), 1, matrix::view(bad)); };
  };
  EXPECT_TRUE(
      test_support::holds(complaint({malformed({{1, 2}, 4095, {1}})}), {"1 counts", "size is 1 x 2"}));
  EXPECT_TRUE(
      test_support::holds(complaint({malformed({{1, 1}, 1023, {1024}})}), {"1024", "full_scale", "1023"}));
  EXPECT_TRUE(test_support::holds(complaint({malformed({{0, 0}, 1023, {}})}), {"0 x 0 taxels", "1 to 64"}));
  EXPECT_EQ(complaint({}), "raw has no scan");
  const auto wide = [](RecordingBuilder& builder) {
    builder.addSurface(ms(0), {"limb", 1, std::vector<matrix::Curvature>(3), {}});
  };
  EXPECT_TRUE(test_support::holds(complaint({scan(ms(0), 1, 5), wide}),
                                  {"\"limb\"", "3 values", "2 taxels", "1 x 2"}));
}

// The training node gathers in one builder while it copies another.
TEST(RecordingBuilder, AppendingABuilderIsAddingItsEvents) {
  const std::vector<Event> events = session();
  for (const std::size_t most : {std::size_t{1} << 20, std::size_t{100}}) {  // in memory, in a file
    RecordingBuilder first(most), second(most);
    for (std::size_t i = 0; i < events.size(); ++i) events[i](i % 3 == 0 ? second : first);
    first.append(second);
    const Recording all = build(events), appended = first.build({}), again = first.build({});
    EXPECT_EQ(first.events().scans, all.scans() + all.losses.near_change + all.losses.no_reference);
    EXPECT_EQ(appended.time, all.time);
    EXPECT_EQ(appended.pressure, all.pressure);
    EXPECT_EQ(appended.count_file != nullptr, most == 100);
    EXPECT_EQ(again.time, all.time) << "the builder keeps its events";
    if (most > 100) {
      EXPECT_EQ(appended.counts, all.counts);
    }
  }
}

TEST(RecordingBuilder, ClearForgetsEverything) {
  RecordingBuilder builder;
  for (const Event& event : session()) event(builder);
  EXPECT_EQ(builder.events().scans, 101u);
  EXPECT_EQ(builder.events().chamber_pressures, 41u);
  EXPECT_EQ(builder.events().surfaces, 10u);
  builder.clear();
  EXPECT_EQ(builder.events().scans, 0u);
  EXPECT_THROW(builder.build({}), settings::InputError);
}

}  // namespace
}  // namespace fsr::dataset
