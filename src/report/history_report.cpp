#include "report/history_report.h"

#include <iomanip>
#include <sstream>

#include "settings/number_text.h"

namespace fsr::report {

namespace {

constexpr int kPartWidth = 52;
constexpr const char* kFamilyNames[] = {"static", "plays", "memories", "both"};

std::string partKilopascal(double pressure) {
  return settings::fixedText(pressure / 1e3, 2);
}

void head(std::ostream& out, const std::string& name) {
  out << std::left << std::setw(kPartWidth) << name << std::right;
}

void protocolTable(std::ostream& out, const std::vector<calibration::HistoryScore::Protocol>& protocols) {
  out << "RMSE [kPa] of means over half a second; each protocol was predicted without it\n";
  head(out, "protocol");
  for (const char* name : kFamilyNames) out << std::setw(10) << name;
  out << std::setw(10) << "c alone" << '\n';
  for (const auto& protocol : protocols) {
    head(out, protocol.name);
    for (const double rmse : protocol.rmse) out << std::setw(10) << partKilopascal(rmse);
    out << std::setw(10) << partKilopascal(protocol.corrected_rmse) << '\n';
  }
}

}  // namespace

std::string historyTable(const std::vector<calibration::HistoryScore::Part>& parts) {
  if (parts.empty()) return "";
  std::ostringstream out;
  out << "RMSE [kPa] of the static answer and with the history, by part of the readings\n";
  head(out, "readings");
  out << std::setw(10) << "static" << std::setw(10) << "history" << std::setw(14) << "within 1 dev"
      << std::setw(12) << "number" << '\n';
  for (const auto& part : parts) {
    head(out, part.name);
    out << std::setw(10) << partKilopascal(part.static_rmse) << std::setw(10) << partKilopascal(part.rmse)
        << std::setw(12) << settings::percentText(part.within_one_deviation) << std::setw(12) << part.readings
        << '\n';
  }
  return out.str();
}

std::string historyChoiceText(const calibration::HistoryScore& score) {
  std::ostringstream out;
  out << score.choice << '\n';
  if (!score.protocols.empty()) protocolTable(out, score.protocols);
  return out.str();
}

std::string historyText(const calibration::Calibration& calibration) {
  const calibration::HistoryScore& score = calibration.scores.history;
  if (score.choice.empty()) return "";
  std::ostringstream out;
  out << historyChoiceText(score);
  if (!score.parts.empty()) out << "Protocols that were left out. " << historyTable(score.parts);
  return out.str();
}

std::string temperatureText(const calibration::Calibration& calibration) {
  const calibration::TemperatureScore& score = calibration.scores.temperature;
  if (score.choice.empty()) return "";
  std::ostringstream out;
  out << score.choice << '\n';
  if (calibration.temperature.present()) {
    out << "Tables, scores and history are those of "
        << settings::roundedText(calibration.temperature.reference, 3) << " degrees Celsius.\n";
  }
  if (score.groups.empty()) return out.str();
  out << "RMSE [kPa] of means over half a second; each protocol and recording was predicted without it\n";
  head(out, "left out");
  out << std::setw(20) << "without temperature" << std::setw(10) << "with" << '\n';
  for (const auto& group : score.groups) {
    head(out, group.name);
    out << std::setw(20) << partKilopascal(group.without) << std::setw(10) << partKilopascal(group.with)
        << '\n';
  }
  return out.str();
}

Json temperatureJson(const calibration::Calibration& calibration) {
  const calibration::TemperatureScore& score = calibration.scores.temperature;
  if (score.choice.empty()) return nullptr;
  Json groups = Json::array();
  for (const auto& group : score.groups)
    groups.push_back({{"left_out", group.name}, {"rmse_without", group.without}, {"rmse_with", group.with}});
  const compensation::TemperatureModel& model = calibration.temperature;
  return {{"choice", score.choice},
          {"sensitivity", model.sensitivity},
          {"reference", model.reference},
          {"lag", model.lag},
          {"low", model.low},
          {"high", model.high},
          {"spread", model.spread},
          {"groups", groups}};
}

Json historyProtocolsJson(const calibration::HistoryScore& score) {
  Json protocols = Json::array();
  for (const auto& protocol : score.protocols) {
    Json rmse = Json::object();
    for (std::size_t f = 0; f < protocol.rmse.size(); ++f) rmse[kFamilyNames[f]] = protocol.rmse[f];
    rmse["correction_alone"] = protocol.corrected_rmse;
    protocols.push_back({{"protocol", protocol.name}, {"rmse", rmse}});
  }
  return protocols;
}

Json historyJson(const calibration::Calibration& calibration) {
  const calibration::HistoryScore& score = calibration.scores.history;
  if (score.choice.empty()) return nullptr;
  Json parts = Json::array();
  for (const auto& part : score.parts) {
    parts.push_back({{"readings", part.name},
                     {"count", part.readings},
                     {"static_rmse", part.static_rmse},
                     {"rmse", part.rmse},
                     {"within_one_deviation", part.within_one_deviation}});
  }
  const compensation::HistoryModel& model = calibration.history;
  return {{"choice", score.choice},
          {"family", compensation::historyName(model.family)},
          {"radius", model.radius},
          {"play_weight", model.play_weight},
          {"time_constant", model.time_constant},
          {"memory_weight", model.memory_weight},
          {"knot", model.knot},
          {"correction", model.correction},
          {"deviation_knot", model.deviation_knot},
          {"loading_deviation", model.loading_deviation},
          {"unloading_deviation", model.unloading_deviation},
          {"protocols", historyProtocolsJson(score)},
          {"parts", parts}};
}

}  // namespace fsr::report
