#include "report/calibration_check_report.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "report/good_for.h"
#include "report/history_report.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

void addRow(const calibration::CheckedClass& row, std::size_t width, std::ostringstream& out) {
  const auto cell = [&](int cell_width, double value) {
    out << std::setw(cell_width) << settings::fixedText(value, 1);
  };
  out << std::left << std::setw(static_cast<int>(width)) << (row.name.empty() ? "all" : row.name)
      << std::right << std::setw(12) << row.readings;
  cell(14, row.expected_rmse / 1000);
  cell(11, row.rmse / 1000);
  cell(11, row.bias / 1000);
  cell(14, 100 * row.within_one_deviation);
  cell(12, 100 * row.beyond_training);
  out << '\n';
}

}  // namespace

std::string checkText(const calibration::CalibrationCheck& check) {
  std::size_t width = 8;
  for (const calibration::CheckedClass& row : check.classes) width = std::max(width, row.name.size() + 2);
  std::ostringstream out;
  out << std::left << std::setw(static_cast<int>(width)) << "surface" << std::right << std::setw(12)
      << "readings" << std::setw(14) << "expected" << std::setw(11) << "RMSE" << std::setw(11) << "bias"
      << std::setw(14) << "within" << std::setw(12) << "outside" << '\n'
      << std::setw(static_cast<int>(width) + 26) << "RMSE [kPa]" << std::setw(11) << "[kPa]" << std::setw(11)
      << "[kPa]" << std::setw(14) << "1 deviation %" << std::setw(12) << "training %" << '\n';
  for (const calibration::CheckedClass& row : check.classes) addRow(row, width, out);
  addRow(check.whole, width, out);
  out << historyTable(check.history);
  for (const std::string& remark : check.remarks) out << "Note: " << remark << '\n';
  for (const std::string& sentence : check.not_shown) out << "Not shown: " << sentence << '\n';
  out << goodForText(check) << '\n';
  if (check.still_good) {
    out << (check.not_shown.empty() ? "Still good.\n" : "Still good as far as these bags show.\n");
    return out.str();
  }
  out << "Recalibrate, because";
  for (std::size_t i = 0; i < check.reasons.size(); ++i) {
    out << (check.reasons.size() == 1 ? " " : "\n  - ") << check.reasons[i];
  }
  out << '\n';
  return out.str();
}

}  // namespace fsr::report
