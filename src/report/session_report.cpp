#include "report/session_report.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "settings/number_text.h"

namespace fsr::report {

std::string sessionText(const calibration::SessionScore& score) {
  if (score.choice.empty()) return "";
  std::ostringstream out;
  out << score.choice << '\n';
  if (score.sessions.empty()) return out.str();
  std::size_t width = 10;
  for (const auto& session : score.sessions) width = std::max(width, session.name.size() + 2);
  out << "RMSE [kPa] after the rest at the start; each session was predicted without it\n"
      << std::left << std::setw(static_cast<int>(width)) << "session" << std::right << std::setw(10)
      << "static" << std::setw(10) << "tared" << std::setw(20) << "trained and tared" << std::setw(12)
      << "number" << '\n';
  for (const auto& session : score.sessions) {
    out << std::left << std::setw(static_cast<int>(width)) << session.name << std::right;
    const int columns[] = {10, 10, 20};
    for (std::size_t a = 0; a < session.rmse.size(); ++a)
      out << std::setw(columns[a]) << settings::fixedText(session.rmse[a] / 1000, 2);
    out << std::setw(12) << session.readings << '\n';
  }
  return out.str();
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

}  // namespace fsr::report
