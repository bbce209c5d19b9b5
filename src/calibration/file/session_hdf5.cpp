#include <array>
#include <cmath>

#include "calibration/file/calibration_hdf5.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

constexpr const char* kSessionGroup = "/session";
constexpr const char* kSessionScores = "/scores/session";
constexpr const char* kTablesAlone = "tables_alone";
constexpr const char* kTrained = "trained";

double readError(const hdf5::Reader& reader, const char* name) {
  const double value = reader.numbers(kSessionGroup, name, 1)[0];
  if (value >= 0 && std::isfinite(value)) return value;
  throw settings::InputError("its " + std::string(kSessionGroup) + " has a " + name + " of " +
                             std::to_string(value) + " Pa, but it must be finite and not negative");
}

}  // namespace

void writeSessionZero(const SessionZero& zero, hdf5::Writer& writer) {
  if (!zero.expected()) return;
  writer.group(kSessionGroup);
  writer.attribute(kSessionGroup, "tare", zero.tare == SessionTare::kTrained ? kTrained : kTablesAlone);
  writer.attribute(
      kSessionGroup, "meaning",
      "a tare is due at rest at the start of a session (one surface and mount); RMSE on sessions "
      "that were left out, without and with it");
  writer.attribute(kSessionGroup, "rmse_without", std::vector<double>{zero.rmse_without});
  writer.attribute(kSessionGroup, "rmse", std::vector<double>{zero.rmse});
  writer.attribute(kSessionGroup, "unit", "Pa");
}

SessionZero readSessionZero(const hdf5::Reader& reader) {
  SessionZero zero;
  if (!reader.has(kSessionGroup)) return zero;
  const std::string tare = reader.text(kSessionGroup, "tare");
  if (tare != kTablesAlone && tare != kTrained) {
    throw settings::InputError("its " + std::string(kSessionGroup) + " has a tare of \"" + tare +
                               "\", but it must be " + kTablesAlone + " or " + kTrained);
  }
  zero.tare = tare == kTrained ? SessionTare::kTrained : SessionTare::kTablesAlone;
  zero.rmse_without = readError(reader, "rmse_without");
  zero.rmse = readError(reader, "rmse");
  return zero;
}

void writeSessionScores(const SessionScore& score, hdf5::Writer& writer) {
  if (score.choice.empty()) return;
  const std::string group = kSessionScores;
  writer.group(group);
  writer.attribute(group, "choice", score.choice);
  if (score.sessions.empty()) return;
  std::vector<std::string> names;
  std::vector<std::uint64_t> readings;
  std::vector<double> rmse;
  for (const SessionScore::Session& session : score.sessions) {
    names.push_back(session.name);
    readings.push_back(session.readings);
    rmse.insert(rmse.end(), session.rmse.begin(), session.rmse.end());
  }
  writer.texts(group + "/sessions", names, "each was left out in turn");
  writer.dataset(group + "/readings", readings, {names.size()}, "",
                 "scans x taxels after the rest at the start");
  writer.dataset(group + "/rmse", rmse, {names.size(), 3}, "Pa",
                 "static tables; the same after a tare; tables trained with the zeros, after a tare");
}

SessionScore readSessionScores(const hdf5::Reader& reader) {
  SessionScore score;
  if (!reader.has(kSessionScores)) return score;
  const std::string group = kSessionScores;
  score.choice = reader.text(group, "choice");
  if (!reader.has(group + "/sessions")) return score;
  const std::vector<std::string> names = reader.texts(group + "/sessions");
  const auto readings = reader.dataset<std::uint64_t>(group + "/readings", {names.size()});
  const auto rmse = reader.dataset<double>(group + "/rmse", {names.size(), 3});
  for (std::size_t s = 0; s < names.size(); ++s)
    score.sessions.push_back({names[s], readings[s], {rmse[3 * s], rmse[3 * s + 1], rmse[3 * s + 2]}});
  return score;
}

}  // namespace fsr::calibration
