#include "report/calibration_report.h"

#include <algorithm>
#include <cmath>

#include "report/text_table.h"
#include "settings/number_text.h"
#include "statistics/conformal.h"

namespace fsr::report {

namespace {

using calibration::BudgetLine;
using calibration::BudgetPart;
using calibration::BudgetSource;
using calibration::BudgetValues;
using calibration::ErrorBudget;
using calibration::ErrorIntervals;

constexpr std::size_t kLevels = calibration::kIntervalLevels.size();
constexpr const char* kLevelNames[kLevels] = {"68 %", "95 %"};
/// A direction or taxel whose share is lower than the level by more than this is named.
constexpr double kUneven = 0.10;

void addRow(TextTable& table, const std::string& name, const BudgetValues& values, double factor,
            const std::string& more) {
  std::vector<std::string> cells = {name};
  for (const double value : values) cells.push_back(inShownUnit(factor * value, 2));
  cells.push_back(more);
  table.row(cells);
}

std::string wordsOf(const BudgetLine& line) {
  if (line.source == BudgetSource::kNotAssessed) return "not assessed: " + line.note;
  const std::string part = line.part == BudgetPart::kHeldOut  ? "inside"
                           : line.part == BudgetPart::kPartly ? "partly inside"
                           : line.part == BudgetPart::kAdded  ? "added"
                                                              : "aside";
  return calibration::budgetSourceName(line.source) + ", " + part + ": " + line.note;
}

std::string budgetTable(const ErrorBudget& budget) {
  std::vector<std::string> headings = {"at % of the trained range"};
  for (const double share : calibration::kBudgetShares) headings.push_back(settings::percentText(share, 0));
  headings.emplace_back();
  TextTable table(headings, {headings.size() - 1});
  addRow(table, "pressure", budget.pressure, 1, "");
  for (const BudgetLine& line : budget.lines) addRow(table, line.name, line.standard, 1, wordsOf(line));
  addRow(table, "held-out error", budget.held_out, 1, "root mean square");
  for (const BudgetLine& line : budget.lines) {
    const bool adds = std::any_of(line.added.begin(), line.added.end(), [](double more) { return more > 0; });
    if (adds) addRow(table, "+ " + line.name, line.added, 1, "");
  }
  addRow(table, "combined, k = 1", budget.combined, 1, "");
  addRow(table, "combined, k = 2", budget.combined, 2, "");
  return "Error budget [" + settings::shownUnitName() +
         "], standard uncertainties. Lines \"inside\" are parts of the held-out error and "
         "are "
         "not added again.\n" +
         table.text();
}

const char* unitsOf(const ErrorIntervals& intervals) {
  return intervals.unit == calibration::IntervalUnit::kMounts ? "mounts" : "cycles";
}

void intervalRow(TextTable& table, const std::string& name, const calibration::BinIntervals& bin) {
  std::vector<std::string> cells = {name, std::to_string(bin.units)};
  for (std::size_t level = 0; level < kLevels; ++level) {
    cells.push_back(settings::fixedText(bin.factor[level], 2));
    cells.push_back(settings::percentText(bin.covered[level]));
  }
  table.row(cells);
}

// Where the units are too few for 95 %, in words.
std::string refusal(const ErrorIntervals& intervals) {
  const std::uint64_t units = intervals.whole.units;
  std::uint64_t fewest = units;
  for (const calibration::BinIntervals& bin : intervals.bins)
    if (bin.units > 0) fewest = std::min(fewest, bin.units);
  const std::size_t needed = statistics::conformalUnits(calibration::kIntervalLevels[1]);
  if (fewest >= needed) return "";
  const double allowed = 1 - 1 / (static_cast<double>(fewest) + 1);
  return std::string("No 95 % interval ") + (fewest == units ? "" : "in some bins ") + "from " +
         std::to_string(fewest) + " " + unitsOf(intervals) + ": they allow at most " +
         settings::percentText(allowed) + ", and 95 % needs " + std::to_string(needed) + ".\n";
}

std::string coverage(const ErrorIntervals& intervals, const matrix::Layout& layout) {
  std::string text;
  for (std::size_t level = 0; level < kLevels; ++level) {
    const double least = calibration::kIntervalLevels[level] - kUneven;
    const std::vector<double>& all = intervals.by_taxel[level];
    std::vector<std::pair<double, std::size_t>> taxels;  // share, taxel
    for (std::size_t taxel = 0; taxel < all.size(); ++taxel) {
      if (!std::isnan(all[taxel])) taxels.emplace_back(all[taxel], taxel);
    }
    if (taxels.empty()) continue;
    const auto [lowest, highest] = std::minmax_element(taxels.begin(), taxels.end());
    const auto uneven =
        std::count_if(taxels.begin(), taxels.end(), [&](const auto& one) { return one.first < least; });
    const auto& direction = intervals.by_direction[level];
    text += std::string(kLevelNames[level]) + " intervals cover " + settings::percentText(direction[0]) +
            " of the readings of loading, " + settings::percentText(direction[1]) + " of unloading, and " +
            settings::percentText(lowest->first) + " to " + settings::percentText(highest->first) +
            " by taxel (lowest: row " + std::to_string(layout.row({lowest->second})) + ", column " +
            std::to_string(layout.column({lowest->second})) + ").\n";
    if (uneven > 0)
      text += "Warning: they cover less than " + settings::percentText(least) + " on " +
              std::to_string(uneven) + " of " + std::to_string(taxels.size()) + " taxels.\n";
    if (direction[0] < least) text += "Warning: they cover too little during loading.\n";
    if (direction[1] < least) text += "Warning: they cover too little during unloading.\n";
  }
  return text;
}

// How many readings of new units the intervals contain, by the number of units alone.
std::string expectation(const ErrorIntervals& intervals) {
  std::string text;
  for (std::size_t level = 0; level < kLevels; ++level) {
    const auto cover = statistics::conformalCover(intervals.whole.units, calibration::kIntervalLevels[level]);
    if (!cover) continue;
    text += "From " + std::to_string(intervals.whole.units) + " " + unitsOf(intervals) + " a " +
            kLevelNames[level] + " interval contains " + settings::percentText(cover->mean) +
            " of new readings on average, " + settings::percentText(cover->low) + " to " +
            settings::percentText(cover->high) + " in nine of ten trainings, and " +
            settings::percentText(cover->median) + " where all " + unitsOf(intervals) + " are alike.\n";
  }
  return text;
}

std::string intervalTable(const ErrorIntervals& intervals, const matrix::Layout& layout) {
  if (!intervals.present()) return "";
  const std::string units = unitsOf(intervals);
  TextTable table({"pressure of the map [" + settings::shownUnitName() + "]", units, kLevelNames[0], "covers",
                   kLevelNames[1], "covers"});
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin)
    intervalRow(table, binText(bin), intervals.bins[bin]);
  intervalRow(table, "all", intervals.whole);
  const bool mounts = intervals.unit == calibration::IntervalUnit::kMounts;
  return "Intervals: pressure +- factor x deviation, of whole " + units +
         " that were left out. \"covers\": share of a unit's readings, with the factor of the others.\n" +
         (mounts ? "" : "They hold for new cycles. For another mount they are not assessed.\n") +
         table.text() + refusal(intervals) + expectation(intervals) + coverage(intervals, layout);
}

std::string scaleTable(const ErrorIntervals& intervals) {
  if (!intervals.present()) return "";
  const calibration::DeviationScale& scale = intervals.scale;
  const std::string units = unitsOf(intervals);
  if (!scale.present()) {
    const bool mounts = intervals.unit == calibration::IntervalUnit::kMounts;
    return std::string("Deviation of the map: that of the tables, ") +
           (mounts ? "from too few mounts for a factor" : "which was found on left-out cycles") + "; " +
           settings::percentText(scale.whole.within_tables) + " of the readings of left-out " + units +
           " lie within it.\n";
  }
  TextTable table({"pressure of the map [" + settings::shownUnitName() + "]", "factor", "tables", "map"});
  const auto row = [&](const std::string& name, const calibration::BinScale& bin, double factor) {
    table.row({name, settings::fixedText(factor, 2), settings::percentText(bin.within_tables),
               settings::percentText(bin.within_map)});
  };
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin)
    row(binText(bin), scale.bins[bin], scale.bins[bin].factor);
  row("all", scale.whole, std::nan(""));
  return "Deviation of the map: that of the tables x factor, so that 68 % of the readings of new " + units +
         " lie within it. Shares: of left-out " + units + ", with the factors of the others.\n" +
         table.text();
}

}  // namespace

std::string budgetText(const ErrorBudget& budget, const matrix::Layout& layout) {
  if (!budget.present()) return "Error budget: none, since scores were not computed.\n";
  return budgetTable(budget) + intervalTable(budget.intervals, layout) + scaleTable(budget.intervals);
}

}  // namespace fsr::report
