#include "example_discrepancy.h"

#include <cmath>

namespace test_support {

namespace {

// A curve of the residual over a covariate from `low` to `high`.
fsr::discrepancy::ResidualCurve curve(const std::string& covariate, const std::string& unit, double low,
                                      double high) {
  fsr::discrepancy::ResidualCurve curve;
  curve.covariate = covariate;
  curve.unit = unit;
  for (int i = 0; i < 20; ++i) {
    const double x = (i + 0.5) / 20;
    curve.at.push_back(low + x * (high - low));
    curve.before.push_back(0.03 * std::sin(3.1 * x) - 0.01);
    curve.after.push_back(0.002 * std::sin(9 * x));
    curve.error.push_back(0.001);
  }
  return curve;
}

fsr::discrepancy::Gap gap() {
  fsr::discrepancy::Gap gap;
  gap.before = 0.031;
  gap.after = 0.008;
  gap.floor = 0.006;
  gap.closed = 0.92;
  gap.before_interval = {0.029, 0.033};
  gap.after_interval = {0.0075, 0.0086};
  gap.floor_interval = {0.0058, 0.0063};
  gap.closed_interval = {0.9, 0.94};
  gap.before_pressure = 19220;
  gap.after_pressure = 4960;
  gap.floor_pressure = 3720;
  gap.floor_bracket = {0.006, 0.0071};
  gap.surfaces = {{"flat", 0.03, 0.007}, {"cylinder_7cm", 0.032, 0.009}};
  gap.covered = {{"flat", {0, 620e3}}, {"cylinder_7cm", {0, 615e3}}};
  gap.left_out = 12;
  gap.held_out_by = {"cycles", "condition"};
  gap.foretold = {{"condition", 0.88, {0.84, 0.91}, {{"flat", 0.9}, {"cylinder_7cm", 0.86}}}};
  gap.missing = {"No second protocol was recorded, so none was held out."};
  return gap;
}

fsr::discrepancy::FoundEffect loop() {
  fsr::discrepancy::FoundEffect effect;
  effect.id = "hysteresis";
  effect.summary = "loading and unloading differ, at any speed";
  effect.parameters = {{"loop_width", 0.062, "fraction of full scale", {0.058, 0.067}}};
  effect.z = 14.1;
  effect.share_of_explainable = 0.93;
  return effect;
}

}  // namespace

fsr::discrepancy::DiscrepancyReport exampleDiscrepancy() {
  fsr::discrepancy::DiscrepancyReport report;
  report.verdict = fsr::discrepancy::Verdict::kNamed;
  report.sentence =
      "Best explanation among 3 effects tested, under this protocol: hysteresis (loop_width 0.062, 0.058 to "
      "0.067).";
  report.effects = {loop()};
  report.credible_set = {{"hysteresis"}};
  report.depends_on = {"direction", "pressure"};
  report.not_identifiable = {{"crosstalk", "uneven_load", "The static curve takes all of it."},
                             {"wear", "many_cycles", "60 cycles wear nothing off."}};
  report.covariates = {{"direction x pressure", "predictive_density", 3e-3, 3e-3, 20e3, true},
                       {"cycle", "predictive_density", 0.4, 1, 0, false}};
  report.where.taxels = {0, 3};
  report.where.conditions = {"flat", "cylinder_7cm"};
  report.where.pressure = {50e3, 400e3};
  report.gap = gap();
  report.recompute =
      "rosrun fsr_pressure_map simulate --gap found/verdict.yaml --drive 1_flat.bag 2_bent.bag";
  report.map_gain =
      "On protocols that were left out, the error of the map falls from 21.00 to 7.50 kPa with a model of "
      "plays.";
  report.hold_out = {
      {"1_flat.bag", {{946684875100000000, 946684950000000000}}},
      {"2_bent.bag", {{946685000000000001, 946685074900000000}, {946685150000000000, 946685224900000000}}}};
  report.in_use = {{"ramp", 21e3, 5e3}, {"stance", 18e3, 4e3}, {"standing", 9e3, NAN}};
  report.next_experiment = {{"two_speeds",
                             "Run five cycles at 5 kPa/s and five at 40 kPa/s: a loop stays as wide, a short "
                             "memory does not.",
                             6.2,
                             {{"hysteresis", "creep"}},
                             20}};
  report.candidates = {{{"hysteresis"}, false, "named", 812, 0.0033, 14.1, 0.93, 21e3},
                       {{"hysteresis", "creep"}, false, "refused", 809, 0.0033, 14.2, 0.935, 21e3},
                       {{"direction x pressure"}, true, "refused", 411, 0.0033, 6.0, 0.34, 9e3}};
  report.smallest_seen = {{"hysteresis", 1300}, {"creep", 2400}, {"wear", NAN}};
  report.scatter = {{"cycle_gain", "share", 0.012, {0.009, 0.016}, 3100, 0.71},
                    {"cycle_offset", "share of full scale", 0, {0, 0.0004}, 0, 0},
                    {"wandering", "share of full scale", 0.0011, {0.0008, 0.0014}, 650, 0.2}};
  report.options.ask = {"crosstalk"};
  report.answers = {{"crosstalk", "not_identifiable", NAN, "The static curve takes all of it."}};
  report.at_map = 20e3;
  report.p = 0.0033;
  report.least_gap = 1240;
  report.tested = {"hysteresis", "creep", "time_skew"};
  report.limitations = {"No temperature was recorded, so slow effects cannot be told apart."};
  report.curves = {curve("pressure", "Pa", 0, 620e3),
                   curve("direction", "Pa, venting negative", -620e3, 620e3)};
  report.steps = {{"hysteresis", "hysteresis was added; it explains 86 % of the squared error", 21e3}};
  report.base.name = "core";
  report.base.effects = {{"white_noise", {{"deviation", 2}}}};
  report.added = report.base;
  report.prediction.effects = {
      {"hysteresis", {{"loop_width", 0.062000000000000003}, {"threshold", 1.0 / 3}}}};
  report.prediction.rivals = {{{"creep", {{"strength", 0.04}}}}, {{"time_skew", {{"delay", 0.12}}}}};
  report.prediction.size = {0.93, 1.08};
  report.prediction.hash = std::string(64, 'c');
  report.prediction.weights = {0.75, 0.15, 0.1};
  report.prediction.spread = {
      {{0, "loop_width", false}, {0, "threshold", true}}, {{4e-6, 1e-7}, {1e-7, 0.01}}, 24, 1e-4, 3};
  report.inputs = {{"1_flat.bag", std::string(64, 'a'), 4460, 1},
                   {"2_bent.bag", std::string(64, 'b'), 4460, 3}};
  report.seed = 1;
  report.version = "0.1.0";
  return report;
}

}  // namespace test_support
