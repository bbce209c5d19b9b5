#include "report/history_report.h"

#include "report/text_table.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

constexpr int kDecimals = 2;  // of an error [kPa]
constexpr const char* kFamilyNames[] = {"static", "plays", "memories", "both"};

std::string protocolTable(const std::vector<calibration::HistoryScore::Protocol>& protocols) {
  TextTable table({"protocol", "static", "plays", "memories", "both", "c alone"});
  for (const auto& protocol : protocols) {
    std::vector<std::string> cells = {protocol.name};
    for (const double rmse : protocol.rmse) cells.push_back(inKilopascals(rmse, kDecimals));
    cells.push_back(inKilopascals(protocol.corrected_rmse, kDecimals));
    table.row(cells);
  }
  return "RMSE [kPa] of means over half a second; each protocol was predicted without it\n" + table.text();
}

}  // namespace

std::string historyTable(const std::vector<calibration::HistoryScore::Part>& parts) {
  if (parts.empty()) return "";
  TextTable table({"readings", "static", "history", "within 1 dev", "number"});
  for (const auto& part : parts)
    table.row({part.name, inKilopascals(part.static_rmse, kDecimals), inKilopascals(part.rmse, kDecimals),
               settings::percentText(part.within_one_deviation), std::to_string(part.readings)});
  return "RMSE [kPa] of the static answer and with the history, by part of the readings\n" + table.text();
}

std::string historyChoiceText(const calibration::HistoryScore& score) {
  return score.choice + '\n' + (score.protocols.empty() ? "" : protocolTable(score.protocols));
}

std::string historyText(const calibration::Calibration& calibration) {
  const calibration::HistoryScore& score = calibration.scores.history;
  if (score.choice.empty()) return "";
  return historyChoiceText(score) +
         (score.parts.empty() ? "" : "Protocols that were left out. " + historyTable(score.parts));
}

std::string temperatureText(const calibration::Calibration& calibration) {
  const calibration::TemperatureScore& score = calibration.scores.temperature;
  if (score.choice.empty()) return "";
  std::string text = score.choice + '\n';
  if (calibration.temperature.present())
    text += "Tables, scores and history are those of " +
            settings::roundedText(calibration.temperature.reference, 3) + " degrees Celsius.\n";
  if (score.groups.empty()) return text;
  TextTable table({"left out", "without temperature", "with"});
  for (const auto& group : score.groups)
    table.row({group.name, inKilopascals(group.without, kDecimals), inKilopascals(group.with, kDecimals)});
  return text +
         "RMSE [kPa] of means over half a second; each protocol and recording was predicted without it\n" +
         table.text();
}

std::string sessionText(const calibration::SessionScore& score) {
  if (score.choice.empty()) return "";
  if (score.sessions.empty()) return score.choice + '\n';
  TextTable table({"session", "static", "tared", "trained and tared", "number"});
  for (const auto& session : score.sessions)
    table.row({session.name, inKilopascals(session.rmse[0], kDecimals),
               inKilopascals(session.rmse[1], kDecimals), inKilopascals(session.rmse[2], kDecimals),
               std::to_string(session.readings)});
  return score.choice + "\nRMSE [kPa] after the rest at the start; each session was predicted without it\n" +
         table.text();
}

Json sessionJson(const calibration::Calibration& calibration) {
  const calibration::SessionScore& score = calibration.scores.session;
  if (score.choice.empty()) return nullptr;
  Json sessions = Json::array();
  for (const auto& session : score.sessions) {
    sessions.push_back({{"session", session.name},
                        {"count", session.readings},
                        {"static_rmse", session.rmse[0]},
                        {"tared_rmse", session.rmse[1]},
                        {"trained_and_tared_rmse", session.rmse[2]}});
  }
  const calibration::SessionZero& zero = calibration.session_zero;
  return {{"choice", score.choice},
          {"tare_expected", zero.expected()},
          {"tables_trained_with_zeros", zero.tare == calibration::SessionTare::kTrained},
          {"rmse_without", zero.expected() ? Json(zero.rmse_without) : Json(nullptr)},
          {"rmse", zero.expected() ? Json(zero.rmse) : Json(nullptr)},
          {"sessions", sessions}};
}

Json temperatureJson(const calibration::Calibration& calibration) {
  const calibration::TemperatureScore& score = calibration.scores.temperature;
  if (score.choice.empty()) return nullptr;
  Json groups = Json::array();
  for (const auto& group : score.groups)
    groups.push_back({{"left_out", group.name}, {"rmse_without", group.without}, {"rmse_with", group.with}});
  const calibration::TemperatureModel& model = calibration.temperature;
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
  const calibration::HistoryModel& model = calibration.history;
  return {{"choice", score.choice},
          {"family", calibration::historyName(model.family)},
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
