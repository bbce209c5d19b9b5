#include <algorithm>
#include <cmath>

#include "calibration/file/calibration_hdf5.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

constexpr const char* kHistoryGroup = "/history";
constexpr const char* kHistoryScores = "/scores/history";
constexpr double kShortest = 1e-6;        // of a time constant [s]
constexpr double kLargestPressure = 1e9;  // [Pa]
constexpr double kLargestWeight = 100;
constexpr std::size_t kMost = 64;  // knots or operators

std::vector<double> column(const std::string& name, const hdf5::Reader& reader) {
  const std::string path = std::string(kHistoryGroup) + "/" + name;
  if (!reader.has(path)) return {};
  const std::vector<double> values = reader.dataset<double>(path, reader.shape(path));
  const auto finite = [](double value) { return std::isfinite(value); };
  if (values.size() > kMost || !std::all_of(values.begin(), values.end(), finite))
    throw settings::InputError("its " + path + " has a value that is not finite, or too many");
  return values;
}

// A finite weight of 1e300 would make no finite pressure.
void requireSmall(const std::vector<double>& values, double limit, const char* name) {
  for (const double value : values) {
    if (std::abs(value) > limit)
      throw settings::InputError("its " + std::string(kHistoryGroup) + "/" + name + " has a value of " +
                                 std::to_string(value) + ", which is too large");
  }
}

void requireAbove(const std::vector<double>& values, double limit, const char* name) {
  for (const double value : values) {
    if (!(value > limit))
      throw settings::InputError("its " + std::string(kHistoryGroup) + "/" + name + " has a value of " +
                                 std::to_string(value) + ", which is too small");
  }
}

void requireLine(const std::vector<double>& knots, const std::vector<double>& values, const char* name) {
  const auto refuse = [&](const char* what) {
    throw settings::InputError("its " + std::string(kHistoryGroup) + "/" + name + " " + what);
  };
  if (knots.size() < 2 || knots.size() != values.size())
    refuse("needs two knots or more and a value for each");
  const double step = (knots.back() - knots.front()) / static_cast<double>(knots.size() - 1);
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const double even = knots.front() + step * static_cast<double>(k);
    if (!(step > 0) || std::abs(knots[k] - even) > 1e-6 * step)
      refuse("has knots that are not evenly spaced");
  }
}

}  // namespace

void writeHistory(const compensation::HistoryModel& model, hdf5::Writer& writer) {
  if (!model.present()) return;
  writer.group(kHistoryGroup);
  writer.attribute(kHistoryGroup, "family", compensation::historyName(model.family));
  writer.attribute(
      kHistoryGroup, "meaning",
      "p = x + c(x) + sum_j w_j (play_j(x) - x) + sum_k v_k (ema_k(x) - x), x = answer of the table");
  const auto write = [&](const char* name, const std::vector<double>& values, const char* unit,
                         const char* meaning) {
    if (values.empty()) return;
    writer.dataset(std::string(kHistoryGroup) + "/" + name, values, {values.size()}, unit, meaning);
  };
  write("knot", model.knot, "Pa", "evenly spaced knots of c");
  write("correction", model.correction, "Pa", "c at each knot, constant beyond");
  write("radius", model.radius, "Pa", "of the plays");
  write("play_weight", model.play_weight, "", "w");
  write("time_constant", model.time_constant, "s", "of the memories");
  write("memory_weight", model.memory_weight, "", "v");
  write("deviation_knot", model.deviation_knot, "Pa", "evenly spaced pressures");
  write("loading_deviation", model.loading_deviation, "Pa", "of a reading of a protocol that was left out");
  write("unloading_deviation", model.unloading_deviation, "Pa", "likewise");
}

compensation::HistoryModel readHistory(const hdf5::Reader& reader) {
  compensation::HistoryModel model;
  if (!reader.has(kHistoryGroup)) return model;
  model.family = compensation::historyFromName(reader.text(kHistoryGroup, "family"));
  if (!model.present()) throw settings::InputError("its /history has no family");
  model.knot = column("knot", reader);
  model.correction = column("correction", reader);
  model.radius = column("radius", reader);
  model.play_weight = column("play_weight", reader);
  model.time_constant = column("time_constant", reader);
  model.memory_weight = column("memory_weight", reader);
  model.deviation_knot = column("deviation_knot", reader);
  model.loading_deviation = column("loading_deviation", reader);
  model.unloading_deviation = column("unloading_deviation", reader);
  requireLine(model.knot, model.correction, "correction");
  requireLine(model.deviation_knot, model.loading_deviation, "loading_deviation");
  requireLine(model.deviation_knot, model.unloading_deviation, "unloading_deviation");
  requireAbove(model.radius, 0, "radius");
  requireAbove(model.time_constant, kShortest, "time_constant");
  requireAbove(model.loading_deviation, 0, "loading_deviation");
  requireAbove(model.unloading_deviation, 0, "unloading_deviation");
  requireSmall(model.correction, kLargestPressure, "correction");
  requireSmall(model.loading_deviation, kLargestPressure, "loading_deviation");
  requireSmall(model.unloading_deviation, kLargestPressure, "unloading_deviation");
  requireSmall(model.play_weight, kLargestWeight, "play_weight");
  requireSmall(model.memory_weight, kLargestWeight, "memory_weight");
  if (model.radius.size() != model.play_weight.size() ||
      model.time_constant.size() != model.memory_weight.size()) {
    throw settings::InputError("its /history has another number of weights than of operators");
  }
  return model;
}

void writeHistoryScores(const HistoryScore& score, hdf5::Writer& writer) {
  if (score.choice.empty()) return;
  writer.group(kHistoryScores);
  writer.attribute(kHistoryScores, "choice", score.choice);
  std::vector<std::string> names, parts;
  std::vector<std::uint64_t> readings;
  std::vector<double> rmse, errors;
  for (const HistoryScore::Protocol& protocol : score.protocols) {
    names.push_back(protocol.name);
    rmse.insert(rmse.end(), protocol.rmse.begin(), protocol.rmse.end());
    rmse.push_back(protocol.corrected_rmse);
  }
  for (const HistoryScore::Part& part : score.parts) {
    parts.push_back(part.name);
    readings.push_back(part.readings);
    errors.insert(errors.end(), {part.static_rmse, part.rmse, part.within_one_deviation});
  }
  const std::string group = kHistoryScores;
  if (!names.empty()) {
    writer.texts(group + "/protocols", names, "each was left out in turn");
    writer.dataset(group + "/protocol_rmse", rmse, {names.size(), 5}, "Pa",
                   "of means over half a second: static, plays, memories, both, correction c alone");
  }
  if (parts.empty()) return;
  writer.texts(group + "/parts", parts, "readings of all protocols that were left out");
  writer.dataset(group + "/part_readings", readings, {readings.size()}, "", "scans x taxels");
  writer.dataset(group + "/part_errors", errors, {parts.size(), 3}, "",
                 "RMSE of the static answer [Pa], RMSE with the model [Pa], share within one deviation");
}

HistoryScore readHistoryScores(const hdf5::Reader& reader) {
  HistoryScore score;
  if (!reader.has(kHistoryScores)) return score;
  score.choice = reader.text(kHistoryScores, "choice");
  const std::string group = kHistoryScores;
  if (reader.has(group + "/protocols")) {
    const std::vector<std::string> names = reader.texts(group + "/protocols");
    const auto rmse = reader.dataset<double>(group + "/protocol_rmse", {names.size(), 5});
    for (std::size_t g = 0; g < names.size(); ++g) {
      const double* const row = &rmse[5 * g];
      score.protocols.push_back({names[g], {row[0], row[1], row[2], row[3]}, row[4]});
    }
  }
  if (!reader.has(group + "/parts")) return score;
  const std::vector<std::string> parts = reader.texts(group + "/parts");
  const auto readings = reader.dataset<std::uint64_t>(group + "/part_readings", {parts.size()});
  const auto errors = reader.dataset<double>(group + "/part_errors", {parts.size(), 3});
  for (std::size_t p = 0; p < parts.size(); ++p)
    score.parts.push_back({parts[p], readings[p], errors[3 * p], errors[3 * p + 1], errors[3 * p + 2]});
  return score;
}

}  // namespace fsr::calibration
