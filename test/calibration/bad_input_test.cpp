// Training on bad input: a calibration with warnings, or one sentence. Every row is valid for every model.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "regression/regressors.h"
#include "support/synthetic_recording.h"

namespace fsr::calibration {
namespace {

using test_support::syntheticRecording;
using test_support::SyntheticRig;

using Bags = std::vector<dataset::Recording>;

SyntheticRig rig() {
  SyntheticRig rig;
  rig.name = "a.bag";
  rig.surfaces = {{"flat", 0.0}, {"cylinder_5cm", 20.0}};
  rig.size = {2, 2};
  rig.scans_per_cycle = 40;
  return rig;
}

Bags oneBag(const std::function<void(dataset::Recording&)>& spoil) {
  dataset::Recording recording = syntheticRecording(rig());
  spoil(recording);
  return {recording};
}

// Removes the scans of each condition after the first `number`.
void keepOfEach(dataset::Recording& recording, std::size_t number) {
  dataset::Recording kept = recording;
  kept.time.clear();
  kept.counts.clear();
  kept.pressure.clear();
  kept.condition.clear();
  std::vector<std::size_t> seen(recording.conditions.size());
  const std::size_t taxels = recording.layout.size.taxels();
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (seen[recording.condition[i]]++ >= number) continue;
    kept.time.push_back(recording.time[i]);
    kept.counts.insert(kept.counts.end(), recording.scan(i), recording.scan(i) + taxels);
    kept.pressure.push_back(recording.pressure[i]);
    kept.condition.push_back(recording.condition[i]);
  }
  recording = kept;
}

void holdTaxel(dataset::Recording& recording, std::size_t taxel) {
  const std::size_t taxels = recording.layout.size.taxels();
  for (std::size_t i = 0; i < recording.scans(); ++i) recording.counts[i * taxels + taxel] = 7;
}

Bags oneSurface() {
  SyntheticRig flat = rig();
  flat.surfaces = {{"flat", 0.0}};
  return {syntheticRecording(flat)};
}

Bags twoMatrices() {
  SyntheticRig other = rig();
  other.name = "b.bag";
  other.size = {3, 3};
  return {syntheticRecording(rig()), syntheticRecording(other)};
}

struct Case {
  std::string what;
  std::function<Bags()> bags;
  compensation::Scheme scheme;
  std::string outcome;  // "trained" with the warnings, or the error message
};

std::string fewCycles(const std::string& surface, const std::string& number) {
  return "a.bag, \"" + surface + "\": " + number +
         " fewer than the 5 sections, which are cut by time instead: a cycle then stands on both sides of a "
         "split, and the scores flatter";
}

const compensation::Scheme kEach = compensation::Scheme::kPerCurvature;

std::vector<Case> cases() {
  const auto spoilt = [](auto spoil) { return [spoil] { return oneBag(spoil); }; };
  return {
      {"nothing bad", spoilt([](dataset::Recording&) {}), kEach, "trained"},
      {"a constant taxel", spoilt([](dataset::Recording& r) { holdTaxel(r, 3); }), kEach,
       "trained; these taxels (row * columns + column) read the same count throughout a condition and get no "
       "model: 3"},
      {"one sample a condition", spoilt([](dataset::Recording& r) {
         keepOfEach(r, 1);
         r.pressure[1] = 5e3;
       }),
       kEach, "a.bag: every taxel is masked or reads the same count throughout; is the matrix connected?"},
      {"two samples a condition", spoilt([](dataset::Recording& r) { keepOfEach(r, 2); }), kEach,
       "trained; " + fewCycles("flat", "1 cycle is") + "; " + fewCycles("cylinder_5cm", "1 cycle is")},
      {"one condition", oneSurface, kEach, "trained"},
      {"one condition, all in one model", oneSurface, compensation::Scheme::kBaseline, "trained"},
      {"pressure that never changes",
       spoilt([](dataset::Recording& r) { std::fill(r.pressure.begin(), r.pressure.end(), 3e3); }), kEach,
       "a.bag: the chamber pressure never changes (3000 to 3000 Pa gauge), but training needs cycles"},
      {"pressure that is zero throughout",
       spoilt([](dataset::Recording& r) { std::fill(r.pressure.begin(), r.pressure.end(), 0.0); }), kEach,
       "a.bag: the chamber pressure never changes (0 to 0 Pa gauge), but training needs cycles"},
      {"pressure that is zero on one surface",
       spoilt([](dataset::Recording& r) { std::fill(r.pressure.begin(), r.pressure.begin() + 200, 0.0); }),
       kEach,
       "trained; a.bag, \"flat\": the chamber pressure never changes, so that there is nothing to learn "
       "from"},
      {"fewer cycles than sections",
       [] {
         SyntheticRig few = rig();
         few.cycles = 3;
         few.surfaces = {{"flat", 0.0}};
         return Bags{syntheticRecording(few)};
       },
       kEach, "trained; " + fewCycles("flat", "3 cycles are")},
      {"a pressure that is no number", spoilt([](dataset::Recording& r) { r.pressure[7] = std::nan(""); }),
       kEach, "trained"},
      {"no pressure at all",
       spoilt([](dataset::Recording& r) { std::fill(r.pressure.begin(), r.pressure.end(), std::nan("")); }),
       kEach, "a.bag: no scan on \"flat\" has a chamber pressure"},
      {"an infinite pressure", spoilt([](dataset::Recording& r) { r.pressure[7] = INFINITY; }), kEach,
       "trained"},
      {"bags of different matrices", twoMatrices, kEach,
       "b.bag: the matrix is 3 x 3, but that of a.bag is 2 x 2; a calibration is of one matrix"},
      {"no bag", [] { return Bags{}; }, kEach, "there is no recording to train on; give one bag or more"},
  };
}

// Every taxel has a finite answer with a deviation at each code, or none throughout.
void expectSound(const Calibration& calibration, const std::string& what) {
  const std::size_t classes = calibration.tables.classes.size();
  for (std::size_t i = 0; i < calibration.tables.tables.size(); ++i) {
    const regression::CodeTable& table = calibration.tables.tables[i];
    const bool model = calibration.no_model[i / classes] == 0;
    for (std::size_t code = 0; code < table.pressure.size(); ++code) {
      ASSERT_EQ(std::isfinite(table.pressure[code]), model) << what << ", code " << code;
      ASSERT_EQ(std::isfinite(table.support[code]), model) << what << ", code " << code;
      ASSERT_EQ(table.deviation[code] > 0, model) << what << ", code " << code;
    }
  }
}

std::string outcomeOf(const Case& row, const std::string& model) {
  CalibrationProblem problem{row.bags(), {}};
  problem.options.scheme = row.scheme;
  problem.options.regressor.name = model;
  problem.options.regressor.forest.trees = 10;
  try {
    const Calibration calibration = calibrate(problem);
    expectSound(calibration, row.what + " by " + model);
    std::string outcome = "trained";
    for (const std::string& warning : calibration.warnings) outcome += "; " + warning;
    return outcome;
  } catch (const settings::InputError& error) {
    return error.what();
  }
}

class BadInput : public testing::TestWithParam<std::string> {};

TEST_P(BadInput, HasADocumentedOutcome) {
  for (const Case& row : cases()) EXPECT_EQ(outcomeOf(row, GetParam()), row.outcome) << row.what;
}

INSTANTIATE_TEST_SUITE_P(Models, BadInput, testing::ValuesIn(regression::regressorNames()),
                         [](const auto& model) { return model.param; });

}  // namespace
}  // namespace fsr::calibration
