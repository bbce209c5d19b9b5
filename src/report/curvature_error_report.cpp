#include "report/curvature_error_report.h"

#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "settings/number_text.h"

namespace fsr::report {

namespace {

constexpr int kSchemeWidth = 20;
constexpr int kErrorCellWidth = 9;

// "right", "-40 %", "+2 1/m".
std::string errorText(const study::CurvatureError& error) {
  const bool share = error.absolute == 0;
  const double size = share ? 100 * error.relative : error.absolute;
  if (size == 0) return "right";
  return (size > 0 ? "+" : "") + settings::roundedText(size) + (share ? " %" : " 1/m");
}

template <typename Cell>
void table(std::ostream& out, const std::string& title, const std::vector<study::CurvatureErrorCurve>& curves,
           Cell cell) {
  out << title << '\n' << std::left << std::setw(2 + kSchemeWidth) << "  curvature is" << std::right;
  for (const study::CurvatureErrorScore& score : curves.front().scores)
    out << std::setw(kErrorCellWidth) << errorText(score.error);
  out << '\n';
  for (const study::CurvatureErrorCurve& curve : curves) {
    out << "  " << std::left << std::setw(kSchemeWidth) << curve.id << std::right;
    for (const study::CurvatureErrorScore& score : curve.scores)
      out << std::setw(kErrorCellWidth) << cell(score);
    out << '\n';
  }
}

// Share of the change of the answers that the stated deviation accounts for [%].
double statedShare(const study::CurvatureErrorScore& score) {
  return score.moved > 0 ? 100 * score.stated / score.moved : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::string curvatureErrorText(const std::vector<study::CurvatureErrorCurve>& curves) {
  if (curves.empty()) return "";
  std::ostringstream out;
  out << "\nError of the map against error of the curvature: five_sections, trained with the right "
         "curvatures, told wrong ones\n";
  table(out, "RMSE [kPa]", curves,
        [](const study::CurvatureErrorScore& score) { return settings::fixedText(score.rmse / 1e3, 1); });
  table(out, "RMSE [% of range]", curves,
        [](const study::CurvatureErrorScore& score) { return settings::fixedText(score.rmse_percent, 2); });
  table(out,
        "Stated: what the map's deviation takes up where the message states the error as its deviation [% of "
        "the change of the pressures]",
        curves,
        [](const study::CurvatureErrorScore& score) { return settings::fixedText(statedShare(score), 0); });
  return out.str();
}

}  // namespace fsr::report
