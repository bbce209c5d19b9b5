#include "report/shape_report.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "settings/number_text.h"

namespace fsr::report {

namespace {

using calibration::ShapeVerdict;

const char* verdictName(ShapeVerdict verdict) {
  if (verdict == ShapeVerdict::kAgrees) return "agrees";
  return verdict == ShapeVerdict::kDisagrees ? "disagrees" : "unknown";
}

std::string namesText(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + (name.empty() ? "?" : name);
  return text.empty() ? "-" : text;
}

std::string declaredCurvature(const matrix::Surface& surface) {
  if (surface.curvature.size() > 1) return "varies";
  return settings::fixedText(matrix::principalCurvature(surface.curvature.front()), 2);
}

// "8.0 +- 0.8", or "-" if the readings do not bound it.
std::string changeText(const compensation::ShapeModel& model, const compensation::BendChange& change) {
  if (!calibration::isKnown(model, change)) return "-";
  return settings::fixedText(change.change, 2) + " +- " + settings::fixedText(change.deviation, 2);
}

std::string changeTable(const compensation::ShapeModel& model,
                        const std::vector<calibration::CheckedMount>& mounts, int left) {
  std::ostringstream out;
  out << "\nChange of the bend along the sheet, from the first to the last column and row [1/m]; - = not "
         "known\n"
      << std::left << std::setw(left) << "mount" << std::setw(18) << "along a row" << std::setw(18)
      << "along a column"
      << "changes\n";
  for (const auto& [mount, check] : mounts) {
    if (check.estimate.taxels == 0) continue;  // no estimate was made
    out << std::setw(left) << mount.name << std::setw(18) << changeText(model, check.change.along_x)
        << std::setw(18) << changeText(model, check.change.along_y) << (check.changes ? "yes" : "no") << '\n';
  }
  out << calibration::fixedText(model) << "\n\n";
  return out.str();
}

}  // namespace

std::string shapeText(const compensation::ShapeModel& model,
                      const std::vector<calibration::CheckedMount>& mounts) {
  std::ostringstream out;
  if (mounts.empty()) {
    return "How the sheet lies cannot be told: no bag starts with a rest before the first load\n";
  }
  std::size_t width = 6;
  for (const auto& mount : mounts) width = std::max(width, mount.mount.name.size() + 2);
  const auto left = static_cast<int>(width);
  out << "How the sheet rests before the first load: principal curvature [1/m]\n"
      << std::left << std::setw(left) << "mount" << std::right << std::setw(9) << "declared" << std::setw(9)
      << "rests as" << std::setw(9) << "low" << std::setw(9) << "high"
      << "  " << std::left << std::setw(10) << "verdict"
      << "surfaces of training that agree\n";
  for (const auto& [mount, check] : mounts) {
    const bool told = check.estimated;
    const auto number = [&](double value) {
      out << std::setw(9) << (told ? settings::fixedText(value, 2) : "-");
    };
    out << std::left << std::setw(left) << mount.name << std::right << std::setw(9)
        << declaredCurvature(mount.surface);
    number(check.estimate.curvature);
    number(check.estimate.low);
    number(check.estimate.high);
    out << "  " << std::left << std::setw(10) << verdictName(check.verdict) << namesText(check.possible)
        << '\n';
  }
  out << changeTable(model, mounts, left);
  for (const auto& [mount, check] : mounts) {
    if (check.verdict != ShapeVerdict::kAgrees) out << mount.name << ": " << check.sentence << '\n';
  }
  return out.str();
}

}  // namespace fsr::report
