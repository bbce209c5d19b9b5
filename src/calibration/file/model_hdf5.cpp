#include <cmath>

#include "calibration/file/calibration_hdf5.h"

// The models beside the tables: curvature rule, history, session, temperature, shape.
namespace fsr::calibration {

namespace {

constexpr double kLargestPressure = 1e9;  // [Pa]
constexpr double kAboveZero = 1e-12;

const hdf5::Names<compensation::BlendRule> kBlends = {{compensation::BlendRule::kNearest, "nearest"},
                                                      {compensation::BlendRule::kKernel, "kernel"},
                                                      {compensation::BlendRule::kInterpolate, "interpolate"},
                                                      {compensation::BlendRule::kByName, "by_name"}};
const hdf5::Names<SessionTare> kTares = {{SessionTare::kNone, "none"},
                                         {SessionTare::kTablesAlone, "tables_alone"},
                                         {SessionTare::kTrained, "trained"}};
const hdf5::Names<FieldFamily> kFamilies = {{FieldFamily::kGaussian, "gaussian"},
                                            {FieldFamily::kMatern, "matern"}};

// Values at ascending knots. `name`: of the columns together.
void requireKnots(const hdf5::Members& file, const std::string& name, const std::vector<double>& knots,
                  const std::vector<std::vector<double>>& values) {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const bool ascends = i == 0 || knots[i - 1] < knots[i];
    file.require(std::isfinite(knots[i]) && ascends, name, "has knots that do not ascend");
  }
  for (const std::vector<double>& column : values)
    file.require(column.size() == knots.size(), name, "has columns that differ in length");
}

// Two evenly spaced knots or more, with a value for each.
void requireEven(const hdf5::Members& file, const std::string& name, const std::vector<double>& knots,
                 const std::vector<double>& values) {
  const bool fits = knots.size() >= 2 && knots.size() == values.size();
  file.require(fits, name, "needs two knots or more and a value for each");
  if (!fits) return;
  const double step = (knots.back() - knots.front()) / static_cast<double>(knots.size() - 1);
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const double even = knots.front() + step * static_cast<double>(k);
    file.require(step > 0 && std::abs(knots[k] - even) <= 1e-6 * step, name,
                 "has knots that are not evenly spaced");
  }
}

void weightMembers(hdf5::Members& file, compensation::CurvatureTables& tables) {
  std::vector<std::vector<float>*> columns;
  for (regression::CodeTable& table : tables.tables) columns.push_back(&table.log_weight);
  std::vector<float> weights;
  for (const std::vector<float>* column : columns)
    weights.insert(weights.end(), column->begin(), column->end());
  const std::size_t codes = tables.full_scale + 1u;
  file.dataset("log_weight", weights, {tables.size.taxels(), tables.classes.size(), codes}, "",
               "[taxels x models x codes], logarithm of the kernel sum of each reading");
  auto first = weights.begin();
  for (std::vector<float>* column : columns) {
    column->assign(first, first + static_cast<std::ptrdiff_t>(codes));
    first += static_cast<std::ptrdiff_t>(codes);
  }
}

}  // namespace

void ruleMembers(hdf5::Members& file, compensation::CurvatureTables& tables) {
  compensation::CurvatureRule& rule = tables.rule;
  if (!file.group("/rule")) return;  // a file of schema 1: nearest
  file.attribute("blend", rule.blend, kBlends);
  file.note("meaning", "how the tables of the classes become the table of any curvature");
  file.column("model_of_class", rule.model_of_class, "",
              "classes of one number share their tables; absent = each has its own");
  file.column("length_scale", rule.length_scale, "1/m",
              "distance in curvature at which a class's weight falls by exp(-1/2), one for all taxels or one "
              "each");
  file.column("law_curvature", rule.law.curvature, "1/m", "knots of the matrix's law of bending");
  file.column("law_gain", rule.law.gain, "", "pressure = gain x pressure without bending effects + offset");
  file.column("law_offset", rule.law.offset, "Pa", "likewise");
  file.column("unseen_pressure", rule.unseen.pressure, "Pa", "knots of the deviation of an unseen curvature");
  file.column("unseen_deviation", rule.unseen.deviation, "Pa",
              "midway between classes, beside the tables' own");
  file.require(rule.model_of_class.empty() || rule.model_of_class.size() == tables.classes.size(),
               "model_of_class", "must have one number for each class");
  requireKnots(file, "law", rule.law.curvature, {rule.law.gain, rule.law.offset});
  requireKnots(file, "unseen", rule.unseen.pressure, {rule.unseen.deviation});
  if (rule.blend != compensation::BlendRule::kKernel) return;
  file.require(rule.length_scale.size() == 1 || rule.length_scale.size() == tables.size.taxels(),
               "length_scale", "has neither one value nor one for each taxel");
  weightMembers(file, tables);
}

void historyMembers(hdf5::Members& file, HistoryModel& model) {
  constexpr double kShortest = 1e-6, kLongest = 1e12;  // of a time constant [s]
  constexpr double kLargestWeight = 100;
  constexpr std::size_t kMost = 64;  // knots or operators
  if (!file.group("/history", model.present())) return;
  std::string family = historyName(model.family);
  file.attribute("family", family);
  model.family = historyFromName(family);
  file.require(model.present(), "family", "is none");
  file.note("meaning",
            "p = x + c(x) + sum_j w_j (play_j(x) - x) + sum_k v_k (ema_k(x) - x), x = answer of the table");
  const auto column = [&](const char* name, std::vector<double>& values, const char* unit,
                          const char* meaning, double low, double high) {
    file.column(name, values, unit, meaning);
    file.within(name, values, low, high);
    file.require(values.size() <= kMost, name, "has too many values");
  };
  column("knot", model.knot, "Pa", "evenly spaced knots of c", -kLargestPressure, kLargestPressure);
  column("correction", model.correction, "Pa", "c at each knot, constant beyond", -kLargestPressure,
         kLargestPressure);
  column("radius", model.radius, "Pa", "of the plays", kAboveZero, kLargestPressure);
  column("play_weight", model.play_weight, "", "w", -kLargestWeight, kLargestWeight);
  column("time_constant", model.time_constant, "s", "of the memories", kShortest, kLongest);
  column("memory_weight", model.memory_weight, "", "v", -kLargestWeight, kLargestWeight);
  if (file.reads() ? file.has("memory_spread") : !model.memory_spread.empty())  // not in earlier versions
    column("memory_spread", model.memory_spread, "Pa", "of the memories: deviation where nothing is known", 0,
           kLargestPressure);
  if (file.reads() ? file.has("least_change") : !model.least_change.empty()) {  // likewise
    const char* const meaning = "p - x is not beyond that of training: limit at each knot";
    column("least_change", model.least_change, "Pa", meaning, -kLargestPressure, kLargestPressure);
    column("largest_change", model.largest_change, "Pa", meaning, -kLargestPressure, kLargestPressure);
    requireEven(file, "least_change", model.knot, model.least_change);
    requireEven(file, "largest_change", model.knot, model.largest_change);
  }
  column("deviation_knot", model.deviation_knot, "Pa", "evenly spaced pressures", -kLargestPressure,
         kLargestPressure);
  column("loading_deviation", model.loading_deviation, "Pa", "of a reading of a protocol that was left out",
         kAboveZero, kLargestPressure);
  column("unloading_deviation", model.unloading_deviation, "Pa", "likewise", kAboveZero, kLargestPressure);
  requireEven(file, "correction", model.knot, model.correction);
  requireEven(file, "loading_deviation", model.deviation_knot, model.loading_deviation);
  requireEven(file, "unloading_deviation", model.deviation_knot, model.unloading_deviation);
  file.require(model.radius.size() == model.play_weight.size(), "play_weight",
               "must have one for each radius");
  file.require(model.time_constant.size() == model.memory_weight.size(), "memory_weight",
               "must have one for each time_constant");
  file.require(model.memory_spread.empty() || model.memory_spread.size() == model.time_constant.size(),
               "memory_spread", "must have one for each time_constant");
}

void sessionMembers(hdf5::Members& file, SessionZero& zero, std::size_t tables) {
  if (!file.group("/session", zero.expected() || !zero.at_rest.empty())) return;
  file.attribute("tare", zero.tare, kTares);
  file.note("meaning",
            "a tare is due at rest at the start of a session (one surface and mount); RMSE on sessions "
            "that were left out, without and with it");
  file.attribute("rmse_without", zero.rmse_without);
  file.attribute("rmse", zero.rmse);
  file.note("unit", "Pa");
  const auto within = [&](const char* name, double rmse) {
    if (!std::isnan(rmse)) file.within(name, {rmse}, 0, kLargestPressure);
  };
  within("rmse_without", zero.rmse_without);
  within("rmse", zero.rmse);
  file.column("at_rest", zero.at_rest, "Pa",
              "[taxels x classes] what each table answers too much at the rests of its training");
  file.within("at_rest", {zero.at_rest.begin(), zero.at_rest.end()}, -kLargestPressure, kLargestPressure);
  file.require(zero.at_rest.empty() || zero.at_rest.size() == tables, "at_rest",
               "must have one value for each table");
}

void temperatureMembers(hdf5::Members& file, TemperatureModel& model) {
  constexpr double kColdest = -273.15, kHottest = 1000;  // [degree Celsius]
  if (!file.group("/temperature", model.present())) return;
  file.note("meaning",
            "p = p_0 (1 + sensitivity (T_lag - reference)), T_lag = low-pass of the measured temperature "
            "with the time constant lag; low, high, spread: of training");
  const auto number = [&](const std::string& name, double& value, const char* unit, double low, double high) {
    file.attribute(name, value);
    file.note(name + "_unit", unit);
    file.within(name, {value}, low, high);
  };
  number("sensitivity", model.sensitivity, "1/K", -1, 1);
  number("reference", model.reference, "degree Celsius", kColdest, kHottest);
  number("lag", model.lag, "s", 0, 1e6);
  number("low", model.low, "degree Celsius", kColdest, kHottest);
  number("high", model.high, "degree Celsius", model.low, kHottest);
  number("spread", model.spread, "K", 0, 1000);
  file.require(model.present(), "sensitivity", "is 0");
}

namespace {

// Beyond these, squares are no numbers that a covariance can be made of.
constexpr double kLeastOfShape = 1e-9;
constexpr double kMostOfShape = 1e12;

void shapeLawMembers(hdf5::Members& file, ShapeModel& model) {
  MountScatter& s = model.scatter;
  ShapeLaw& l = model.law;
  matrix::Curvature& d = model.direction;
  file.attribute("family", s.family, kFamilies);
  file.attribute("contrasts", s.contrasts);
  file.numbers("scatter", std::tie(s.deviation, s.length, s.common, s.white, s.history));
  file.note("scatter_meaning",
            "of mounts: deviation [Pa], length [m], common [Pa], white [Pa], history [Pa]");
  file.numbers("law", std::tie(l.common, l.common_length, l.own_offset, l.own_share, l.own, l.own_length,
                               l.own_white));
  file.note(
      "law_meaning",
      "common [Pa], its length; own_offset [Pa], own_share, own [Pa], its length [1/m], own_white [Pa]");
  file.numbers("direction", std::tie(d.x, d.y, d.xy));
  file.attribute("one_direction", model.one_direction);
  file.require(s.contrasts > 0, "contrasts", "is 0, but the scatter was learnt from some");
  file.within("scatter", {s.deviation, s.length, s.common, s.white}, kLeastOfShape, kMostOfShape);
  file.within("scatter", {s.history}, 0, kMostOfShape);
  file.within("law", {l.common, l.common_length, l.own_offset, l.own_share, l.own, l.own_length, l.own_white},
              kLeastOfShape, kMostOfShape);
  file.within("direction", {d.x, d.y, d.xy}, -kMostOfShape, kMostOfShape);
}

void requireShape(const hdf5::Members& file, const ShapeModel& model) {
  std::vector<double> scales;
  for (std::size_t t = 0; t < model.used.size(); ++t) {
    if (model.used[t] != 0) scales.push_back(model.scale[t]);
  }
  file.require(!scales.empty(), "used", "has no taxel that takes part");
  file.within("scale", scales, kLeastOfShape, kMostOfShape);
  file.within("curvature", model.curvature, -kMostOfShape, kMostOfShape);
  file.within("gain", model.gain, kLeastOfShape, kMostOfShape);
  file.within("zero_share", model.zero_share, 0, 1);
  file.within("rest", model.rest, -kMostOfShape, kMostOfShape);
  file.within("history", model.history, -kMostOfShape, kMostOfShape);
  for (std::size_t s = 0; s < model.curvature.size(); ++s) {
    file.require(s == 0 || model.curvature[s] > model.curvature[s - 1], "curvature", "does not ascend");
    file.require(model.mounts[s] > 0, "mounts", "has a surface without a mount");
  }
}

}  // namespace

void shapeMembers(hdf5::Members& file, ShapeModel& model) {
  if (!file.group("/shape")) return;
  file.attribute("missing", model.missing);
  file.note("meaning", "how the unloaded sheet reads on each surface of training");
  if (!model.present()) return;
  shapeLawMembers(file, model);
  file.texts("surfaces", model.surfaces, "by ascending curvature");
  const std::size_t surfaces = model.surfaces.size(), taxels = model.layout.size.taxels();
  file.require(surfaces >= 2, "surfaces", "has fewer than two surfaces");
  file.dataset("curvature", model.curvature, {surfaces}, "1/m", "principal");
  file.dataset("mounts", model.mounts, {surfaces}, "", "behind each mean");
  file.dataset("gain", model.gain, {surfaces}, "", "how strongly a mount acts on the surface");
  file.dataset("zero_share", model.zero_share, {surfaces}, "", "readings at rest that are 0");
  file.dataset("error_between", model.error_between, {surfaces - 1}, "1/m",
               "of an estimate between two neighbours; NaN = not known");
  file.dataset("used", model.used, {taxels}, "", "1 = the taxel takes part");
  file.dataset("scale", model.scale, {taxels}, "Pa", "pressure that a reading of full scale would stand for");
  std::vector<double> pattern = model.history.empty() ? std::vector<double>(taxels, 1.0) : model.history;
  file.dataset("history", pattern, {taxels}, "", "pattern that a load leaves behind, mean 1");
  file.dataset("rest", model.rest, {surfaces, taxels}, "Pa", "mean over mounts, by that scale");
  if (!file.reads()) return;
  model.history = pattern;
  requireShape(file, model);
}

}  // namespace fsr::calibration
