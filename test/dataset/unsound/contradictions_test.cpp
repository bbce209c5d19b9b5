#include "dataset/unsound_spans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "dataset/count_readers.h"
#include "dataset/table_recording.h"
#include "support/source_dir.h"

namespace fsr::dataset {
namespace {

constexpr std::size_t kCycle = 300, kTenCycles = 10 * kCycle;  // 10 Hz

// Cycles of 30 s to 600 kPa: 5 s of rest, filling, 5 s at the peak, venting, rest.
double load(std::size_t i) {
  const double t = double(i % kCycle) / 10;
  return 600e3 * std::clamp(std::min((t - 5) / 8, (26 - t) / 8), 0.0, 1.0);
}

// The sheet reads the root of its load, with a loop of a tenth, slow recovery and noise; the transducer has
// 1 kPa of noise.
ScanCourse sheet(double (*loadAt)(std::size_t) = load) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  ScanCourse course;
  double felt = 0, memory = 0;
  for (std::size_t i = 0; i < kTenCycles; ++i) {
    const double now = loadAt(i);
    felt = std::clamp(felt, now - 30e3, now + 30e3);
    memory += (now - memory) / 200;
    course.stamp_ns.push_back(static_cast<std::int64_t>(i) * 100'000'000);
    course.pressure.push_back(now + 1e3 * noise(random));
    course.reading.push_back(2 * std::sqrt(std::max(0.0, felt) + 0.05 * memory) + 5 * noise(random));
    course.condition.push_back(0);
  }
  return course;
}

std::string found(const ScanCourse& course) {
  std::string text;
  for (const UnsoundSpan& span : contradictions(course)) {
    text += std::to_string(span.first) + " to " + std::to_string(span.end - 1) + ": " + span.why + "; ";
  }
  return text;
}

// The one span that is found covers what is wrong but for 2 s at each end, and 5 s more at most.
void expectOne(const ScanCourse& course, std::size_t first, std::size_t last, const std::string& why) {
  const auto spans = contradictions(course);
  ASSERT_EQ(spans.size(), 1u) << found(course);
  EXPECT_EQ(spans[0].why, why);
  EXPECT_NEAR(double(spans[0].first), double(first) - 15, 35) << found(course);
  EXPECT_NEAR(double(spans[0].end - 1), double(last) + 15, 35) << found(course);
}

TEST(Contradictions, AreNotInSoundData) {
  EXPECT_EQ(found(sheet()), "");
}

TEST(Contradictions, ATransducerThatIsUnpluggedWhateverItReadsThen) {
  for (const double zero : {0.0, -101e3, 20e3}) {
    ScanCourse course = sheet();
    std::fill(course.pressure.begin() + 400, course.pressure.begin() + 431, zero);  // filling, 3 s
    SCOPED_TRACE(zero);
    expectOne(course, 400, 430, zero < -30e3 ? "pressure below rest" : "reading without pressure");
  }
}

TEST(Contradictions, ATransducerThatJumpsToItsFullScale) {
  ScanCourse course = sheet();
  std::fill(course.pressure.begin() + 1500, course.pressure.begin() + 1531, 1000e3);  // at rest, 3 s
  expectOne(course, 1500, 1530, "pressure without reading");
}

TEST(Contradictions, ATransducerThatIsPluggedInAgainAfterTheLoad) {
  ScanCourse course = sheet();
  std::fill(course.pressure.begin() + 450, course.pressure.begin() + 580, 0.0);
  expectOne(course, 450, 560, "reading without pressure");
  course = sheet();
  std::fill(course.pressure.begin() + 320, course.pressure.begin() + 480, 0.0);  // dead before the load
  expectOne(course, 350, 479, "reading without pressure");
}

TEST(Contradictions, ATransducerThatReadsLessThanNothingAtRest) {
  ScanCourse course = sheet();
  std::fill(course.pressure.begin() + 1160, course.pressure.begin() + 1230, -101e3);
  EXPECT_EQ(found(course), "1160 to 1229: pressure below rest; ");
}

TEST(Contradictions, ASheetThatFallsSilentUnderLoad) {
  ScanCourse course = sheet();
  std::fill(course.reading.begin() + 1000, course.reading.begin() + 1031, 0.0);
  expectOne(course, 1000, 1030, "pressure without reading");
  std::fill(course.reading.begin() + 1000, course.reading.begin() + 1160, 0.0);  // until it is unloaded
  expectOne(course, 1000, 1150, "pressure without reading");
}

TEST(Contradictions, OneTenthOfAllScans) {
  ScanCourse course = sheet();
  std::fill(course.reading.begin() + 1250, course.reading.begin() + 1460, 0.0);
  expectOne(course, 1250, 1460, "pressure without reading");
}

// No lag of clocks, slow sheet or saturation contradicts the pressure.
TEST(Contradictions, AreNotClocksThatDifferNorSlowSheets) {
  const auto step = [](std::size_t i) { return i % kCycle < 100 ? 0.0 : i % kCycle < 200 ? 300e3 : 600e3; };
  for (const int late : {-40, -15, 0, 5, 15, 40}) {  // tenths of a second
    ScanCourse course = sheet(step);
    const std::vector<double> pressure = course.pressure;
    for (std::size_t i = 0; i < kTenCycles; ++i)
      course.pressure[i] = pressure[static_cast<std::size_t>(
          std::clamp(static_cast<int>(i) - late, 0, static_cast<int>(kTenCycles) - 1))];
    EXPECT_EQ(found(course), "") << late;
  }
  ScanCourse flat = sheet();
  for (double& reading : flat.reading) reading = std::min(reading, 900.0);
  EXPECT_EQ(found(flat), "");
}

TEST(Contradictions, AreNotFoundWhereTheSheetDoesNotFollowAnyway) {
  ScanCourse course = sheet();
  std::mt19937 random(2);
  std::shuffle(course.reading.begin(), course.reading.end(), random);
  EXPECT_EQ(found(course), "");
  course = sheet();
  std::fill(course.reading.begin(), course.reading.end(), 100.0);
  EXPECT_EQ(found(course), "");
}

// Real recordings of others; see test/data/README.md.
TEST(Contradictions, AreNotInMeasuredData) {
  std::string insole = "time=time_s,reference=pressure_row_kPa:kPa";
  for (const char* taxel : {"001", "024", "045", "064", "182", "262", "271"})
    insole += std::string(",reading=c") + taxel + ":V";
  const std::string fluid =
      "time=time_s,reading=pressure_left_V:V,reading=pressure_right_V:V,reference=force_N:N";
  const std::string piston = "time=1:ms,reading=4:V,reference=5:10000Pa";
  for (const auto& [table, columns] :
       {std::pair{"belli_four_cycles.csv.gz", insole}, std::pair{"belli_staircase.csv.gz", insole},
        std::pair{"fluid_air_4hz.csv.gz", fluid}, std::pair{"fluid_oil_20min.csv.gz", fluid},
        std::pair{"piston_o_ring_3bar.txt.gz", piston}, std::pair{"piston_o_ring_7bar.txt.gz", piston}}) {
    TablePlan plan;
    plan.columns = parseColumns(columns);
    plan.curvature = 0;
    plan.start_ns = 946684800'000'000'000;  // 2000-01-01
    if (columns == fluid) plan.area = 2e-5;
    if (columns == insole) plan.range = {{255, 0}};
    if (columns == piston) plan.range = {{10, 0}};
    const Recording recording =
        readTable(test_support::sourceDir() + "/test/data/measured/" + table, plan).recording;
    ScanCourse course{{}, recording.pressure, {}, recording.condition};
    ScanCounts counts(recording);
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      course.stamp_ns.push_back(std::llround(1e9 * recording.time[i]));
      const auto* const scan = counts[i];
      const std::size_t taxels = recording.layout.size.taxels();
      course.reading.push_back(0);
      for (std::size_t t = 0; t < taxels; ++t) course.reading.back() += scan[t] / double(taxels);
    }
    EXPECT_EQ(found(course), "") << table;
  }
}

}  // namespace
}  // namespace fsr::dataset
