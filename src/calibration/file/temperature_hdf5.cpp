#include <cmath>

#include "calibration/file/calibration_hdf5.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

constexpr const char* kTemperatureGroup = "/temperature";
constexpr const char* kTemperatureScores = "/scores/temperature";

double number(const char* name, double low, double high, const hdf5::Reader& reader) {
  const double value = reader.numbers(kTemperatureGroup, name, 1)[0];
  if (value >= low && value <= high) return value;
  throw settings::InputError("its " + std::string(kTemperatureGroup) + " has a " + name + " of " +
                             std::to_string(value) + ", but must have " + std::to_string(low) + " to " +
                             std::to_string(high));
}

}  // namespace

void writeTemperature(const compensation::TemperatureModel& model, hdf5::Writer& writer) {
  if (!model.present()) return;
  const auto write = [&](const std::string& name, double value, const char* unit) {
    writer.attribute(kTemperatureGroup, name, std::vector<double>{value});
    writer.attribute(kTemperatureGroup, name + "_unit", unit);
  };
  writer.group(kTemperatureGroup);
  writer.attribute(
      kTemperatureGroup, "meaning",
      "p = p_0 (1 + sensitivity (T_lag - reference)), T_lag = low-pass of the measured temperature "
      "with the time constant lag; low, high, spread: of training");
  write("sensitivity", model.sensitivity, "1/K");
  write("reference", model.reference, "degree Celsius");
  write("lag", model.lag, "s");
  write("low", model.low, "degree Celsius");
  write("high", model.high, "degree Celsius");
  write("spread", model.spread, "K");
}

compensation::TemperatureModel readTemperature(const hdf5::Reader& reader) {
  if (!reader.has(kTemperatureGroup)) return {};
  compensation::TemperatureModel model;
  model.sensitivity = number("sensitivity", -1, 1, reader);
  model.reference = number("reference", -273.15, 1000, reader);
  model.lag = number("lag", 0, 1e6, reader);
  model.low = number("low", -273.15, 1000, reader);
  model.high = number("high", model.low, 1000, reader);
  model.spread = number("spread", 0, 1000, reader);
  if (!model.present()) throw settings::InputError("its /temperature has a sensitivity of 0");
  return model;
}

void writeTemperatureScores(const TemperatureScore& score, hdf5::Writer& writer) {
  if (score.choice.empty()) return;
  writer.group(kTemperatureScores);
  writer.attribute(kTemperatureScores, "choice", score.choice);
  if (score.groups.empty()) return;
  std::vector<std::string> names;
  std::vector<double> rmse;
  for (const TemperatureScore::Group& group : score.groups) {
    names.push_back(group.name);
    rmse.insert(rmse.end(), {group.without, group.with});
  }
  const std::string path = kTemperatureScores;
  writer.texts(path + "/groups", names, "protocols and recordings; each was left out in turn");
  writer.dataset(path + "/group_rmse", rmse, {names.size(), 2}, "Pa",
                 "of means over half a second: without and with the model of the temperature");
}

TemperatureScore readTemperatureScores(const hdf5::Reader& reader) {
  TemperatureScore score;
  if (!reader.has(kTemperatureScores)) return score;
  score.choice = reader.text(kTemperatureScores, "choice");
  const std::string path = kTemperatureScores;
  if (!reader.has(path + "/groups")) return score;
  const std::vector<std::string> names = reader.texts(path + "/groups");
  const auto rmse = reader.dataset<double>(path + "/group_rmse", {names.size(), 2});
  for (std::size_t g = 0; g < names.size(); ++g)
    score.groups.push_back({names[g], rmse[2 * g], rmse[2 * g + 1]});
  return score;
}

}  // namespace fsr::calibration
