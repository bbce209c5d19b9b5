#include "report/calibration_report.h"

#include "report/text_table.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

constexpr int kDecimals = 2;  // of an error [kPa]

std::string protocolTable(const std::vector<calibration::HistoryScore::Protocol>& protocols) {
  TextTable table({"protocol", "static", "plays", "memories", "both", "c alone"});
  for (const auto& protocol : protocols) {
    std::vector<std::string> cells = {protocol.name};
    for (const double rmse : protocol.rmse) cells.push_back(inShownUnit(rmse, kDecimals));
    cells.push_back(inShownUnit(protocol.corrected_rmse, kDecimals));
    table.row(cells);
  }
  return "RMSE [" + settings::shownUnitName() +
         "] of means over half a second; each protocol was predicted without it\n" + table.text();
}

}  // namespace

std::string historyTable(const std::vector<calibration::HistoryScore::Part>& parts) {
  if (parts.empty()) return "";
  TextTable table({"readings", "static", "history", "within 1 dev", "number"});
  for (const auto& part : parts)
    table.row({part.name, inShownUnit(part.static_rmse, kDecimals), inShownUnit(part.rmse, kDecimals),
               settings::percentText(part.within_one_deviation), std::to_string(part.readings)});
  return "RMSE [" + settings::shownUnitName() +
         "] of the static answer and with the history, by part of the readings\n" + table.text();
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
    table.row({group.name, inShownUnit(group.without, kDecimals), inShownUnit(group.with, kDecimals)});
  return text + "RMSE of readings [" + settings::shownUnitName() +
         " on a straight line up to the highest pressure]; each protocol and recording "
         "was "
         "predicted without it\n" +
         table.text();
}

std::string sessionText(const calibration::SessionScore& score) {
  if (score.choice.empty()) return "";
  if (score.sessions.empty()) return score.choice + '\n';
  TextTable table({"session", "static", "tared", "trained and tared", "number"});
  for (const auto& session : score.sessions)
    table.row({session.name, inShownUnit(session.rmse[0], kDecimals), inShownUnit(session.rmse[1], kDecimals),
               inShownUnit(session.rmse[2], kDecimals), std::to_string(session.readings)});
  return score.choice + "\nRMSE [" + settings::shownUnitName() +
         "] after the rest at the start; each session was predicted without it\n" + table.text();
}

}  // namespace fsr::report
