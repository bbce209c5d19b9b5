// Recordings that are sound but unusual, of a rig with nothing hidden: nothing is found in them. The damage
// that nobody can see in the answer is refused, see Investigate.RefusesWhatCannotBeJudged.
#include <gtest/gtest.h>

#include <string>

#include "discrepancy/planted.h"
#include "discrepancy/samples/admission.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/random_stream.h"
#include "support/holds.h"

namespace fsr::discrepancy {
namespace {

// Removes the scans for which `keep` is false.
template <typename Keep>
void keepScans(dataset::Recording& recording, Keep keep) {
  dataset::Recording kept = recording;
  kept.time.clear();
  kept.pressure.clear();
  kept.condition.clear();
  kept.temperature.clear();
  kept.counts.clear();
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (!keep(i)) continue;
    kept.time.push_back(recording.time[i]);
    kept.pressure.push_back(recording.pressure[i]);
    kept.condition.push_back(recording.condition[i]);
    if (!recording.temperature.empty()) kept.temperature.push_back(recording.temperature[i]);
    kept.counts.insert(kept.counts.end(), recording.scan(i), recording.scan(i) + kept.layout.size.taxels());
  }
  recording = kept;
}

std::string rigOf(const std::string& size, const std::string& session) {
  return "simulation: unusual\nseed: 7\nmatrix: " + size +
         "\nboard: {scan_rate: 2.5, transducer_rate: 2.5}\nchamber: {cycles: 6}\nsession:\n" + session +
         R"(effects:
  static_curve: {conductance: 3.2e-4, exponent: 0.85, conductance_scatter: 0.05}
  bending_preload: {amplitude: 30000}
  bending_gain: {change: -0.15}
  white_noise: {absolute: 8}
  converter: {}
)";
}

const char* const kSmall = "{rows: 3, columns: 4}";

std::string station(const std::string& name, double radius, const std::string& cycles) {
  const std::string surface =
      radius > 0 ? "cylinder: {radius: " + std::to_string(radius) + ", axis: y}, pause: 120" : "flat: true";
  return "  - {surface: " + name + ", " + surface + ", program: [{cycles: {" + cycles + "}}]}\n";
}

void expectSilent(const DiscrepancyProblem& problem) {
  const DiscrepancyReport report = investigate(problem);
  EXPECT_EQ(report.verdict, Verdict::kNone) << report.sentence;
}

TEST(UnusualBags, HaveSurfacesThatNeverReachThePressureOfTheOthers) {
  expectSilent(
      planted::problem(rigOf(kSmall, station("flat", 0, "peak: 620000, rate: 20000, cycles: 6") +
                                         station("wide", 0.09, "peak: 200000, rate: 10000, cycles: 6") +
                                         station("tight", 0.05, "peak: 60000, rate: 3000, cycles: 6")),
                       ""));
}

TEST(UnusualBags, HaveSurfacesWithoutACommonPressure) {
  DiscrepancyProblem problem = planted::problem(planted::kOneSpeed, "");
  const std::vector<double> low = problem.recordings[0].pressure, high = problem.recordings[1].pressure;
  keepScans(problem.recordings[0], [&](std::size_t i) { return low[i] < 200e3; });
  keepScans(problem.recordings[1], [&](std::size_t i) { return high[i] > 300e3; });
  expectSilent(problem);
}

TEST(UnusualBags, AreCutAtBothEnds) {
  DiscrepancyProblem problem = planted::problem(planted::kOneSpeed, "");
  std::size_t cut = 20;  // in a ramp, in the dwell, in a ramp
  for (dataset::Recording& recording : problem.recordings) {
    const std::size_t last = recording.scans() - 2 * cut;
    keepScans(recording, [&](std::size_t i) { return i >= cut && i < last; });
    cut += 30;
  }
  expectSilent(problem);
}

// Every cycle has a static curve of its own. Nothing could be found, so nothing must be said.
TEST(UnusualBags, AreRefusedWithOneCycleOnEachSurface) {
  const std::string once = "peak: 620000, rate: 10000, cycles: 1";
  const DiscrepancyProblem problem =
      planted::problem(rigOf(kSmall, station("flat", 0, once) + station("a", 0.05, once) +
                                         station("b", 0.07, once) + station("c", 0.09, once)),
                       "  hysteresis: {loop_width: 0.06}\n");
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] { admit(problem); }),
                                  {"no surface has more than one cycle"}));
}

// The sheet lies beside the chamber: its readings are noise, whatever the pressure is.
DiscrepancyProblem besideTheChamber() {
  DiscrepancyProblem problem = planted::problem(planted::kOneSpeed, "");
  for (dataset::Recording& recording : problem.recordings) {
    const statistics::RandomStream stream = statistics::randomStream(1, recording.name);
    for (std::size_t k = 0; k < recording.counts.size(); ++k)
      recording.counts[k] = static_cast<std::uint16_t>(700 + stream.bits(k) % 41);
  }
  return problem;
}

TEST(UnusualBags, ThatAreNotFitNeverGiveNone) {
  DiscrepancyProblem problem = besideTheChamber();
  problem.options.ask = {"creep"};
  const Admission admission = inspectRecordings(problem.recordings);
  ASSERT_FALSE(admission.fit());
  const DiscrepancyReport report = investigate(problem);
  EXPECT_EQ(report.verdict, Verdict::kNotIdentifiable) << report.sentence;
  EXPECT_EQ(report.sentence, "Nothing was found, but these recordings could not have shown it: " +
                                 admission.problems.front() + ".");
  EXPECT_TRUE(report.smallest_seen.empty());
  EXPECT_EQ(report.answers.at(0).answer, "not_identifiable");
}

// One cycle on each of two surfaces: nothing can be compared, but a question has an answer.
TEST(UnusualBags, WithTooFewCyclesAnswerWhatIsAsked) {
  const std::string once = "peak: 620000, rate: 10000, cycles: 1";
  DiscrepancyProblem problem =
      planted::problem(rigOf(kSmall, station("flat", 0, once) + station("a", 0.05, once)), "");
  problem.options.ask = {"hysteresis", "converter"};
  const DiscrepancyReport report = investigate(problem);
  EXPECT_EQ(report.verdict, Verdict::kNotIdentifiable) << report.sentence;
  EXPECT_EQ(report.credible_set, (std::vector<std::vector<std::string>>{{"hysteresis"}}));
  EXPECT_NE(report.answers.at(0).sentence.find("at least 3 are needed"), std::string::npos);
  EXPECT_EQ(report.answers.at(1).answer, "in_simulation");
  problem.options.ask = {"converter"};
  EXPECT_THROW(investigate(problem), settings::InputError);
}

TEST(UnusualBags, AreOfOtherMatrices) {
  for (const char* size : {"{rows: 4, columns: 4}", "{rows: 16, columns: 10}"})
    expectSilent(planted::problem(rigOf(size, planted::kTwoSurfaces), ""));
}

}  // namespace
}  // namespace fsr::discrepancy
