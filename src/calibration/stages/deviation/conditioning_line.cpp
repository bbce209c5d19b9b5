#include "calibration/stages/deviation/conditioning_line.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

constexpr const char* kName = "conditioning";
constexpr const char* kThen = "; ";  // between what is known of the conditioning and what was measured

// Contains no kThen.
std::string wordsOf(const std::vector<dataset::Conditioning>& sessions) {
  const auto number = static_cast<std::size_t>(
      std::count_if(sessions.begin(), sessions.end(), [](const auto& session) { return session.present(); }));
  if (number == 0) {
    const bool known = std::any_of(sessions.begin(), sessions.end(), [](const auto& s) { return s.known; });
    return known ? "sheet was not conditioned" : "not known whether the sheet was conditioned";
  }
  if (sessions.size() > 1) {
    return "conditioned before " + std::to_string(number) + " of " + std::to_string(sessions.size()) +
           " sessions";
  }
  const dataset::Conditioning& only = sessions.front();
  if (!only.enough)
    return "conditioned before the first recording, as the bags say: first loadings left out of the figure";
  return "conditioned: " + std::to_string(only.cycles) + " cycles to " +
         settings::fixedPressure(only.peak, 0) + " at the start of the bags";
}

}  // namespace

BudgetLine conditioningLine(const BudgetSums& sums, const std::vector<dataset::Conditioning>& sessions) {
  BudgetLine line;
  line.name = kName;
  line.note = wordsOf(sessions);
  std::string mean;
  for (std::size_t p = 0; p < sums.size(); ++p) {
    const BudgetPoint& point = sums[p];
    if (point.firsts > 0) line.standard[p] = std::sqrt(std::max(0.0, point.first / point.firsts));
    mean += " " + settings::inShownUnit(point.first_change / point.firsts, 2);
  }
  if (std::all_of(line.standard.begin(), line.standard.end(),
                  [](double value) { return std::isnan(value); })) {
    line.note += std::string(kThen) + "no mount has three cycles that reach these pressures";
    return line;
  }
  line.source = BudgetSource::kMeasured;
  line.note += std::string(kThen) +
               "change from the first cycle of a mount to the later ones, root mean square; mean" + mean +
               ' ' + settings::shownUnitName();
  return line;
}

void restateConditioning(const std::vector<dataset::Conditioning>& sessions, ErrorBudget& budget) {
  for (BudgetLine& line : budget.lines) {
    if (line.name == kName) line.note = wordsOf(sessions) + line.note.substr(line.note.find(kThen));
  }
}

}  // namespace fsr::calibration
