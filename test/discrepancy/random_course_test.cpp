// A random walk is no curve: it is named by its likelihood, located, and reproduced in its statistics.

#include "discrepancy/fit/candidate_terms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "discrepancy/planted.h"
#include "simulation/effects/effect_library.h"
#include "simulation/rig.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy {
namespace {

constexpr double kScanRate = 0.6;  // [Hz]; 44 scans a cycle, about as many as a cycle has bins

// Twenty-four cycles on two surfaces, with a thermometer.
std::string rigOf(int seed, double scan_rate = kScanRate, int cycles = 12) {
  const std::string rate = std::to_string(scan_rate);
  std::string text = planted::kOneSpeed;
  const auto replace = [&](const std::string& old, const std::string& by) {
    text.replace(text.find(old), old.size(), by);
  };
  replace("seed: 7", "seed: " + std::to_string(seed));
  replace("{scan_rate: 2.5, transducer_rate: 2.5}",
          "{scan_rate: " + rate + ", transducer_rate: " + rate + "}");
  replace("{cycles: 8}", "{cycles: " + std::to_string(cycles) + "}");
  return text + "climate: {room: [{time: 0, temperature: 23}]}\n";
}

DiscrepancyProblem problemOf(int seed, const std::string& effects) {
  std::string with = rigOf(seed);
  with.insert(with.find("climate:"), effects);
  DiscrepancyProblem problem;
  problem.simulation = planted::simulation(rigOf(seed));
  problem.recordings = simulation::simulateSession(planted::simulation(with));
  problem.options.threads = 1;
  problem.options.null_draws = 199;  // the fewest by which twice the least p is the level
  return problem;
}

// Multiplies the readings of each cycle by a gain of its own.
void scatterGains(DiscrepancyProblem& problem, double deviation, std::uint64_t seed) {
  const Measured measured = admit(problem);
  const statistics::RandomStream stream = statistics::randomStream(seed, "cycle gains");
  for (std::size_t m = 0; m < measured.samples(); ++m) {
    dataset::Recording& recording = problem.recordings[measured.visits[measured.visit[m]].recording];
    const std::size_t taxels = measured.taxels();
    for (std::size_t t = 0; t < taxels; ++t) {
      std::uint16_t& counts = recording.counts[measured.first_scan[m] * taxels + t];
      counts = static_cast<std::uint16_t>(
          std::lround(counts * (1 + deviation * stream.normal(measured.cycle[m]))));
    }
  }
}

// Rms of the steps of the mean reading, beyond a quiet simulation, from each window of 20 s to the next.
double stepOf(const std::vector<double>& beyond) {
  constexpr auto kWindow = static_cast<std::size_t>(20 * kScanRate);
  std::vector<double> means;
  for (std::size_t i = 0; i + kWindow <= beyond.size(); i += kWindow) {
    double sum = 0;
    for (std::size_t k = 0; k < kWindow; ++k) sum += beyond[i + k];
    means.push_back(sum / kWindow);
  }
  double square = 0;
  for (std::size_t i = 1; i < means.size(); ++i) square += std::pow(means[i] - means[i - 1], 2);
  return std::sqrt(square / static_cast<double>(means.size() - 1));
}

std::vector<double> meanCounts(const simulation::SimulationSettings& settings,
                               const std::vector<dataset::Recording>& recordings) {
  std::vector<double> means;
  simulation::DrivenRig rig(settings);
  for (const dataset::Recording& recording : recordings) {
    rig.run(recording, [&](std::size_t, const simulation::SensorChain& chain) {
      double sum = 0;
      for (const double reading : chain.reading()) sum += reading;
      means.push_back(sum / static_cast<double>(chain.reading().size()));
    });
  }
  return means;
}

std::vector<double> beyond(std::vector<double> all, const std::vector<double>& quiet) {
  for (std::size_t i = 0; i < all.size(); ++i) all[i] -= quiet[i];
  return all;
}

std::vector<double> recorded(const DiscrepancyProblem& problem) {
  std::vector<double> means;
  for (const dataset::Recording& recording : problem.recordings) {
    const std::size_t taxels = recording.counts.size() / recording.scans();
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      double sum = 0;
      for (std::size_t t = 0; t < taxels; ++t) sum += recording.counts[i * taxels + t];
      means.push_back(sum / static_cast<double>(taxels));
    }
  }
  return means;
}

TEST(RandomCourses, HaveTheCovarianceOfAWalk) {
  const DiscrepancyProblem problem = problemOf(7, "");
  const Measured measured = admit(problem);
  const CommonTraces common = commonTraces(measured);
  const StaticFit fit(measured, CurvePer::kClass, common.all);
  const simulation::EffectInfo& info = simulation::findEffect("drift")->info;
  const auto courses = randomCourses(measured, fit, info);
  const auto walk = std::find_if(courses.begin(), courses.end(), [](const RandomCourse& course) {
    return course.step == "zero_walk" && std::isinf(course.shape.at("time_constant"));
  });
  ASSERT_NE(walk, courses.end());
  const auto loadedFrom = [&](std::size_t sample) {
    while (measured.pressure[sample] < 300e3) ++sample;
    return static_cast<Eigen::Index>(sample);
  };
  const Eigen::Index early = loadedFrom(measured.samples() / 3), late = loadedFrom(measured.samples() - 50);
  const auto covariance = [&](Eigen::Index a, Eigen::Index b) {
    double sum = 0;
    for (const Trace& column : walk->columns) sum += column[a] * column[b];
    return sum;
  };
  const auto hours = [&](Eigen::Index i) {
    return (measured.time[static_cast<std::size_t>(i)] - measured.time[0]) / 3600;
  };
  EXPECT_NEAR(covariance(late, late), hours(late), 0.05 * hours(late));
  EXPECT_NEAR(covariance(early, early), hours(early), 0.1 * hours(early));
  EXPECT_NEAR(covariance(early, late), hours(early), 0.05 * hours(early));
  EXPECT_TRUE(randomCourses(measured, fit, simulation::findEffect("creep")->info).empty());
}

// Without load the taxels read 0, and the zero is not seen.
TEST(RandomCourses, OfTheZeroDoNotShowWhereTheReadingsAreAtTheEndOfTheRange) {
  DiscrepancyProblem problem = problemOf(7, "");
  dataset::Recording& flat = problem.recordings.front();
  const std::size_t taxels = flat.counts.size() / flat.scans();
  const Measured before = admit(problem);
  const std::size_t at_rest = before.samples() / 4;
  for (std::size_t t = 0; t < taxels; ++t)
    flat.counts[before.first_scan[at_rest] * taxels + t] = t < taxels / 4 ? 100 : 0;
  const Measured measured = admit(problem);
  const CommonTraces common = commonTraces(measured);
  const StaticFit fit(measured, CurvePer::kClass, common.all);
  const auto sample = static_cast<Eigen::Index>(at_rest);
  for (const RandomCourse& course : randomCourses(measured, fit, simulation::findEffect("drift")->info)) {
    if (course.step != "zero_walk") continue;
    for (const Trace& column : course.columns)
      EXPECT_NEAR(column[sample], 0.25 * (column[sample - 1] + column[sample + 1]) / 2, 0.02);
  }
}

// The step, its interval, and what the written simulation does with other random numbers.
TEST(RandomWalk, IsNamedLocatedAndReproduced) {
  constexpr double kStep = 120;  // [counts/sqrt(h)]
  const DiscrepancyProblem problem = problemOf(2, "  drift: {rate_per_hour: 0, zero_walk: 120}\n");
  const DiscrepancyReport report = investigate(problem);
  ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  ASSERT_EQ(report.effects.size(), 1u);
  EXPECT_EQ(report.effects[0].id, "drift");
  const FittedParameter& step = report.effects[0].parameters.at(0);
  EXPECT_EQ(step.name, "zero_walk");
  EXPECT_LT(step.interval.low, kStep);
  EXPECT_GT(step.interval.high, kStep);
  EXPECT_LE(step.interval.high, 3 * step.interval.low);
  EXPECT_TRUE(report.where.taxels.empty());
  EXPECT_TRUE(std::isnan(report.gap.closed));
  EXPECT_GE(report.at_map, report.least_gap);
  EXPECT_LE(report.p, report.options.level);
  EXPECT_TRUE(report.prediction.effects.empty());

  simulation::SimulationSettings base = report.base, added = report.added;
  for (simulation::SimulationSettings* one : {&base, &added}) {
    auto& effects = one->effects;
    effects.erase(std::remove_if(effects.begin(), effects.end(),
                                 [](const auto& effect) { return effect.id == "white_noise"; }),
                  effects.end());
  }
  const double measured = stepOf(beyond(recorded(problem), meanCounts(base, problem.recordings)));
  for (const std::uint64_t again : {101u, 102u}) {
    base.seed = added.seed = again;
    added.taxel_curves = base.taxel_curves;
    const std::vector<double> quiet = meanCounts(base, problem.recordings);
    EXPECT_NEAR(stepOf(beyond(meanCounts(added, problem.recordings), quiet)), measured, 0.4 * measured);
  }
}

// Without a thermometer it may be the room.
TEST(RandomWalk, OfSomeTaxelsIsFoundOnThemAndNotNamedAloneWithoutAThermometer) {
  DiscrepancyProblem problem =
      problemOf(7, "  drift: {rate_per_hour: 0, zero_walk: 300, only_taxels: [1, 4, 6, 11]}\n");
  for (dataset::Recording& recording : problem.recordings) recording.temperature.clear();
  const DiscrepancyReport report = investigate(problem);
  ASSERT_EQ(report.verdict, Verdict::kAmbiguous) << report.sentence;
  ASSERT_EQ(report.credible_set.size(), 2u);
  EXPECT_EQ(report.credible_set[0], std::vector<std::string>{"drift"});
  EXPECT_EQ(report.credible_set[1], std::vector<std::string>{"temperature"});
  ASSERT_FALSE(report.next_experiment.empty());
  EXPECT_EQ(report.next_experiment[0].protocol, "two_ambients");
  EXPECT_EQ(report.gap.after, report.gap.before) << "what is random is in neither";
  EXPECT_TRUE(std::isnan(report.gap.closed));
  EXPECT_EQ(report.where.taxels, (std::vector<std::size_t>{1, 4, 6, 11}));
  EXPECT_LT(report.effects.at(0).parameters.at(0).interval.low, 300);
  EXPECT_GT(report.effects.at(0).parameters.at(0).interval.high, 300);
}

// A leak follows this walk well, but leaves something; the walk leaves nothing but `besides`, and excludes
// the leak.
DiscrepancyReport walkOrLeak(const std::string& besides) {
  const std::string rig = rigOf(4, 2.5, 15);
  std::string with = rig;
  with.insert(with.find("climate:"), "  drift: {rate_per_hour: 0, zero_walk: 120}\n" + besides);
  DiscrepancyProblem problem;
  problem.simulation = planted::simulation(rig);
  problem.recordings = simulation::simulateSession(planted::simulation(with));
  problem.options.threads = 1;
  problem.options.null_draws = 199;
  for (const std::string& id : simulation::effectIds()) {
    if (id != "seal_leak" && id != "drift") problem.options.leave_out.push_back(id);
  }
  return investigate(problem);
}

TEST(RandomWalk, TakesThePlaceOfAnEffectThatLeavesMore) {
  const DiscrepancyReport report = walkOrLeak("");
  EXPECT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  EXPECT_EQ(report.effects.at(0).id, "drift") << report.sentence;
}

TEST(RandomWalk, TakesThePlaceOfAnEffectThatItExcludesWhateverElseIsLeft) {
  const DiscrepancyReport report = walkOrLeak("  hysteresis: {loop_width: 0.004}\n");
  EXPECT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  EXPECT_EQ(report.effects.at(0).id, "drift") << report.sentence;
}

TEST(RandomWalk, IsNotTakenForScatterOfTheCycles) {
  DiscrepancyProblem problem = problemOf(7, "");
  scatterGains(problem, 0.02, 1);
  const DiscrepancyReport report = investigate(problem);
  EXPECT_EQ(report.verdict, Verdict::kNone) << report.sentence;
  ASSERT_FALSE(report.scatter.empty());
  EXPECT_GT(report.scatter[0].size, 0.01);
}

TEST(RandomWalk, LeavesATrendToTheEffectsThatHaveOne) {
  const DiscrepancyReport report = investigate(problemOf(7, "  drift: {rate_per_hour: 0.1}\n"));
  for (const FoundEffect& effect : report.effects) {
    for (const FittedParameter& parameter : effect.parameters) {
      EXPECT_NE(parameter.name, "zero_walk") << report.sentence;
      EXPECT_NE(parameter.name, "rate_walk") << report.sentence;
    }
  }
  EXPECT_NE(report.verdict, Verdict::kNone);
}

}  // namespace
}  // namespace fsr::discrepancy
