// Steps in a planted course of force, and the rows of a recording whose integrals are known.
#include "exports/trial_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "exports/scan_examples.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/content_of.h"
#include "support/holds.h"
#include "support/program_output.h"
#include "support/pty.h"

namespace fsr::exports {
namespace {

constexpr double kNone = ScanRecord::kUnknown;

std::vector<double> times(std::size_t scans, double rate) {
  std::vector<double> time;
  for (std::size_t i = 0; i < scans; ++i) time.push_back(double(i) / rate);
  return time;
}

// Half sines of 100 N that last 0.6 s, one each second, at 50 Hz, from `begin` [s] on.
std::vector<double> walk(std::size_t scans, double begin, double rest) {
  std::vector<double> force;
  for (std::size_t i = 0; i < scans; ++i) {
    const double phase = std::fmod(double(i) / 50 - begin + 10, 1.0);
    force.push_back(rest + (phase < 0.6 ? 100 * std::sin(M_PI * phase / 0.6) : 0));
  }
  return force;
}

TEST(Steps, AreThoseOfAWalkWithoutThoseThatAreCutOff) {
  const std::vector<double> force = walk(500, 0.7, 20);  // it begins in a step and ends in one
  EXPECT_NEAR(stepThreshold(force), 30, 0.5);
  const std::vector<Step> steps = findSteps(force, times(500, 50), stepThreshold(force));
  ASSERT_EQ(steps.size(), 9u);
  for (std::size_t s = 0; s < steps.size(); ++s) {
    EXPECT_NEAR(double(steps[s].first) / 50, 0.7 + double(s) + 0.02, 0.021);
    EXPECT_NEAR(double(steps[s].second) / 50, 1.3 + double(s) - 0.02, 0.021);
  }
}

TEST(Steps, AreNotMadeByNoiseAtTheThresholdOrByAForceThatRests) {
  std::vector<double> force = walk(500, 0.7, 20);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] += i % 2 == 0 ? 1.5 : -1.5;
  EXPECT_EQ(findSteps(force, times(500, 50), stepThreshold(force)).size(), 9u);
  const std::vector<double> rests(500, 0.0);
  EXPECT_TRUE(findSteps(rests, times(500, 50), stepThreshold(rests)).empty());
  EXPECT_TRUE(findSteps({kNone, kNone}, {0, 1}, stepThreshold({kNone, kNone})).empty());
}

// At rest 0 N, threshold 10 N: a dip to 8 N is above the middle between them, one to 4 N is not.
TEST(Steps, EndHalfWayBackToTheLowestForce) {
  std::vector<double> force(200, 0.0);
  std::fill(force.begin() + 20, force.begin() + 90, 100.0);
  std::fill(force.begin() + 110, force.begin() + 180, 100.0);
  std::fill(force.begin() + 90, force.begin() + 110, 8.0);
  EXPECT_EQ(findSteps(force, times(200, 50), 10), (std::vector<Step>{{20, 179}}));
  std::fill(force.begin() + 90, force.begin() + 110, 4.0);
  EXPECT_EQ(findSteps(force, times(200, 50), 10), (std::vector<Step>{{20, 89}, {110, 179}}));
}

class RegionTables : public testing::Test {
 protected:
  // Ten scans a second. All six taxels of 1 cm x 8 mm have the pressure [kPa].
  static std::vector<ScanRecord> scans(const std::vector<double>& kilopascals) {
    std::vector<ScanRecord> scans;
    for (const double pressure : kilopascals) {
      ScanRecord scan = export_test::exampleScan();
      scan.since_ns = static_cast<std::int64_t>(scans.size()) * 100000000;
      scan.event = "";
      scan.surface = std::make_shared<matrix::Surface>(matrix::Surface{"flat", 3, {}, {}});
      scan.map->pressure.assign(6, static_cast<float>(1e3 * pressure));
      scan.map->deviation.assign(6, 2e3f);
      scan.map->flags.assign(6, 0);
      scans.push_back(scan);
    }
    return scans;
  }

  std::vector<std::string> lines(const std::string& format, const std::vector<ScanRecord>& scans,
                                 const StatisticsOptions& options) {
    const std::string path = folder_.path("table.csv");
    export_test::write(format, path, scans, options);
    std::istringstream text(test_support::contentOf(path));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(RegionTables, OfATrialHaveItsPeaksForcesAndIntegrals) {
  StatisticsOptions options;
  options.above = 45e3;
  // One step: 0, 20, 50, 100, 50, 20, 0 kPa on 4.8 cm2, between rests.
  const std::vector<std::string> rows = lines("trial", scans({0, 0, 20, 50, 100, 50, 20, 0, 0}), options);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(
      rows[0],
      "bag,session,surface,mount,region,step,begin_s,end_s,peak_kPa,peak_deviation_kPa,peak_row,peak_column,"
      "mean_peak_kPa,mean_contact_kPa,force_N,impulse_N_s,peak_integral_kPa_s,contact_time_s,time_above_s,"
      "contact_area_cm2,at_least,step_force_N,contact_threshold_kPa,above_kPa");
  // Mean of the five peaks in contact 48; impulse 24 kPa s x 4.8 cm2; in contact from 20 to 20 kPa.
  EXPECT_EQ(rows[1],
            "2_cylinder.bag,2026-03-01,flat,3,whole_matrix,0,0,0.8,100,2,0,0,48,48,48,11.52,24,0.5,0."
            "3,4.8,0,"
            "4.8,10,45");
  EXPECT_EQ(rows[2],
            "2_cylinder.bag,2026-03-01,flat,3,whole_matrix,1,0.2,0.6,100,2,0,0,48,48,48,10.56,22,0.4,"
            "0.3,4.8,0,"
            "4.8,10,45");
}

TEST_F(RegionTables, RefuseATrialWithoutLoad) {
  const std::string refusal = test_support::refusal([&] { lines("trial", scans({0, 9, 0}), {}); });
  EXPECT_TRUE(test_support::holds(refusal, {"2_cylinder.bag", "without load", "10 kPa", "--contact"}))
      << refusal;
}

TEST_F(RegionTables, AreInMillimetresOfMercuryWhereAsked) {
  StatisticsOptions options;
  options.unit = view::PressureUnit::kMillimetreOfMercury;
  const std::vector<std::string> rows = lines("statistics", scans({13.3322387415}), options);
  EXPECT_TRUE(test_support::holds(rows[0], {",peak_mmHg,", ",integral_mmHg_s,"}));
  EXPECT_TRUE(
      test_support::holds(rows[1], {",whole_matrix,100,15.00123,0,0,100,100,15.00123,6.399474,0.96,4.8,"}));
}

TEST_F(RegionTables, MarkWhatIsAtLeastAndKeepRegionsApart) {
  std::vector<ScanRecord> taken = scans({50, 50});
  taken[0].map->pressure[5] = 620e3f;
  taken[0].map->flags[5] = map::taxel_flag::kSaturated;
  taken[1].map->pressure[0] = std::nanf("");
  taken[1].map->flags[0] = map::taxel_flag::kDead;
  StatisticsOptions options;
  options.regions = folder_.path("regions.yaml");
  std::ofstream(options.regions) << "regions:\n  - {name: left, rows: [0, 1], columns: [0, 0]}\n";
  const std::vector<std::string> rows = lines("statistics", taken, options);
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_TRUE(test_support::holds(rows[1], {",whole_matrix,620,2,1,2,"}));
  EXPECT_EQ(rows[1].substr(rows[1].size() - 7), ",1,0,OK");
  EXPECT_TRUE(test_support::holds(rows[2], {",left,50,2,0,0,"}));
  EXPECT_EQ(rows[2].substr(rows[2].size() - 7), ",0,0,OK");
  EXPECT_EQ(rows[4].substr(rows[4].size() - 7), ",0,1,OK") << "the dead taxel is in this region";
  const std::vector<std::string> trial = lines("trial", taken, options);
  EXPECT_TRUE(test_support::holds(trial[1], {",whole_matrix,0,", ",620,2,1,2,", ",4.8,1,"}))
      << "one scan of two";
  EXPECT_TRUE(test_support::holds(trial[2], {",left,0,", ",50,2,0,0,", ",1.6,0,"}));
}

// The command is that of docs/exports.md.
TEST_F(RegionTables, BecomeATableByRegionAndSurfaceInR) {
  if (!test_support::hasProgram("Rscript"))
    GTEST_SKIP() << "Rscript is not installed (Debian package r-base-core): R was NOT tried";
  lines("trial", scans({0, 0, 60, 0, 0, 80, 0, 0}), {});
  const auto r = test_support::outputOf("cd " + folder_.path() +
                                        " && Rscript -e 'print(aggregate(peak_kPa ~ region + surface, "
                                        "subset(read.csv(\"table.csv\"), step > 0), mean))'");
  EXPECT_TRUE(test_support::holds(r.text, {"1 whole_matrix    flat       70"}));
}

TEST_F(RegionTables, RefuseARecordingWithoutMaps) {
  EXPECT_THROW(export_test::write("statistics", folder_.path("a.csv"), {}, {}, false), settings::InputError);
}

}  // namespace
}  // namespace fsr::exports
