#include "report/budget_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

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

constexpr int kSourceWidth = 28;
constexpr int kValueWidth = 9;
constexpr std::size_t kLevels = calibration::kIntervalLevels.size();
constexpr const char* kLevelNames[kLevels] = {"68 %", "95 %"};
/// A direction or taxel whose share is lower than the level by more than this is named.
constexpr double kUneven = 0.10;

void row(std::ostream& out, const std::string& name, const BudgetValues& values, double factor,
         const std::string& more) {
  out << std::left << std::setw(kSourceWidth) << name << std::right;
  for (const double value : values)
    out << std::setw(kValueWidth) << settings::fixedText(factor * value / 1e3, 2);
  out << (more.empty() ? "" : "  ") << more << '\n';
}

std::string wordsOf(const BudgetLine& line) {
  if (line.source == BudgetSource::kNotAssessed) return "not assessed: " + line.note;
  const std::string part = line.part == BudgetPart::kHeldOut  ? "inside"
                           : line.part == BudgetPart::kPartly ? "partly inside"
                           : line.part == BudgetPart::kAdded  ? "added"
                                                              : "aside";
  return calibration::budgetSourceName(line.source) + ", " + part + ": " + line.note;
}

void budgetTable(std::ostream& out, const ErrorBudget& budget) {
  out << "Error budget [kPa], standard uncertainties. Lines \"inside\" are parts of the held-out error and "
         "are "
         "not added again.\n";
  out << std::left << std::setw(kSourceWidth) << "at % of the trained range" << std::right;
  for (const double share : calibration::kBudgetShares)
    out << std::setw(kValueWidth) << settings::percentText(share, 0);
  out << '\n';
  row(out, "pressure", budget.pressure, 1, "");
  for (const BudgetLine& line : budget.lines) row(out, line.name, line.standard, 1, wordsOf(line));
  row(out, "held-out error", budget.held_out, 1, "root mean square");
  for (const BudgetLine& line : budget.lines) {
    const bool adds = std::any_of(line.added.begin(), line.added.end(), [](double more) { return more > 0; });
    if (adds) row(out, "+ " + line.name, line.added, 1, "");
  }
  row(out, "combined, k = 1", budget.combined, 1, "");
  row(out, "combined, k = 2", budget.combined, 2, "");
}

const char* unitsOf(const ErrorIntervals& intervals) {
  return intervals.unit == calibration::IntervalUnit::kMounts ? "mounts" : "cycles";
}

void intervalRow(std::ostream& out, const std::string& name, const calibration::BinIntervals& bin) {
  out << std::left << std::setw(kSourceWidth) << name << std::right << std::setw(8) << bin.units;
  for (std::size_t level = 0; level < kLevels; ++level) {
    out << std::setw(10) << settings::fixedText(bin.factor[level], 2) << std::setw(10)
        << settings::percentText(bin.covered[level]);
  }
  out << '\n';
}

// Where the units are too few for 95 %, in words.
void refusal(std::ostream& out, const ErrorIntervals& intervals) {
  const std::uint64_t units = intervals.whole.units;
  std::uint64_t fewest = units;
  for (const calibration::BinIntervals& bin : intervals.bins)
    if (bin.units > 0) fewest = std::min(fewest, bin.units);
  const std::size_t needed = statistics::conformalUnits(calibration::kIntervalLevels[1]);
  if (fewest >= needed) return;
  const double allowed = 1 - 1 / (static_cast<double>(fewest) + 1);
  out << "No 95 % interval " << (fewest == units ? "" : "in some bins ") << "from " << fewest << ' '
      << unitsOf(intervals) << ": they allow at most " << settings::percentText(allowed)
      << ", and 95 % needs " << needed << ".\n";
}

void coverage(std::ostream& out, const ErrorIntervals& intervals, const matrix::Layout& layout) {
  for (std::size_t level = 0; level < kLevels; ++level) {
    const double wanted = calibration::kIntervalLevels[level];
    std::vector<double> taxels;
    std::size_t lowest = 0, uneven = 0;
    const std::vector<double>& all = intervals.by_taxel[level];
    for (std::size_t taxel = 0; taxel < all.size(); ++taxel) {
      if (std::isnan(all[taxel])) continue;
      if (taxels.empty() || all[taxel] < all[lowest]) lowest = taxel;
      taxels.push_back(all[taxel]);
      uneven += all[taxel] < wanted - kUneven;
    }
    if (taxels.empty()) continue;
    const auto& direction = intervals.by_direction[level];
    out << kLevelNames[level] << " intervals cover " << settings::percentText(direction[0])
        << " of the readings of loading, " << settings::percentText(direction[1]) << " of unloading, and "
        << settings::percentText(all[lowest]) << " to "
        << settings::percentText(*std::max_element(taxels.begin(), taxels.end())) << " by taxel (lowest: row "
        << layout.row({lowest}) << ", column " << layout.column({lowest}) << ").\n";
    if (uneven > 0) {
      out << "Warning: they cover less than " << settings::percentText(wanted - kUneven) << " on " << uneven
          << " of " << taxels.size() << " taxels.\n";
    }
    for (std::size_t d = 0; d < direction.size(); ++d) {
      if (direction[d] < wanted - kUneven)
        out << "Warning: they cover too little during " << (d == 0 ? "loading" : "unloading") << ".\n";
    }
  }
}

// How many readings of new units the intervals contain, by the number of units alone.
void expectation(std::ostream& out, const ErrorIntervals& intervals) {
  for (std::size_t level = 0; level < kLevels; ++level) {
    const auto cover = statistics::conformalCover(intervals.whole.units, calibration::kIntervalLevels[level]);
    if (!cover) continue;
    out << "From " << intervals.whole.units << ' ' << unitsOf(intervals) << " a " << kLevelNames[level]
        << " interval contains " << settings::percentText(cover->mean) << " of new readings on average, "
        << settings::percentText(cover->low) << " to " << settings::percentText(cover->high)
        << " in nine of ten trainings, and " << settings::percentText(cover->median) << " where all "
        << unitsOf(intervals) << " are alike.\n";
  }
}

void intervalTable(std::ostream& out, const ErrorIntervals& intervals, const matrix::Layout& layout) {
  if (!intervals.present()) return;
  const bool mounts = intervals.unit == calibration::IntervalUnit::kMounts;
  out << "Intervals: pressure +- factor x deviation, of whole " << unitsOf(intervals)
      << " that were left out. \"covers\": share of a unit's readings, with the factor of the others.\n"
      << (mounts ? "" : "They hold for new cycles. For another mount they are not assessed.\n");
  out << std::left << std::setw(kSourceWidth) << "pressure of the map [kPa]" << std::right << std::setw(8)
      << unitsOf(intervals);
  for (const char* const level : kLevelNames) out << std::setw(10) << level << std::setw(10) << "covers";
  out << '\n';
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin)
    intervalRow(out, statistics::pressureBinName(bin), intervals.bins[bin]);
  intervalRow(out, "all", intervals.whole);
  refusal(out, intervals);
  expectation(out, intervals);
  coverage(out, intervals, layout);
}

void scaleRow(std::ostream& out, const std::string& name, const calibration::BinScale& bin, double factor) {
  out << std::left << std::setw(kSourceWidth) << name << std::right << std::setw(10)
      << settings::fixedText(factor, 2) << std::setw(10) << settings::percentText(bin.within_tables)
      << std::setw(10) << settings::percentText(bin.within_map) << '\n';
}

void scaleTable(std::ostream& out, const ErrorIntervals& intervals) {
  if (!intervals.present()) return;
  const calibration::DeviationScale& scale = intervals.scale;
  if (!scale.present()) {
    const bool mounts = intervals.unit == calibration::IntervalUnit::kMounts;
    out << "Deviation of the map: that of the tables, "
        << (mounts ? "from too few mounts for a factor" : "which was found on left-out cycles") << "; "
        << settings::percentText(scale.whole.within_tables) << " of the readings of left-out "
        << unitsOf(intervals) << " lie within it.\n";
    return;
  }
  out << "Deviation of the map: that of the tables x factor, so that 68 % of the readings of new "
      << unitsOf(intervals) << " lie within it. Shares: of left-out " << unitsOf(intervals)
      << ", with the factors of the others.\n";
  out << std::left << std::setw(kSourceWidth) << "pressure of the map [kPa]" << std::right << std::setw(10)
      << "factor" << std::setw(10) << "tables" << std::setw(10) << "map" << '\n';
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin)
    scaleRow(out, statistics::pressureBinName(bin), scale.bins[bin], scale.bins[bin].factor);
  scaleRow(out, "all", scale.whole, std::nan(""));
}

Json json(const calibration::BinScale& bin) {
  return {{"pressure_pa", bin.pressure},
          {"factor", bin.factor},
          {"within_tables", bin.within_tables},
          {"within_map", bin.within_map}};
}

Json scaleJson(const calibration::DeviationScale& scale) {
  if (!scale.present()) return nullptr;
  Json bins = Json::object();
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin)
    bins[statistics::pressureBinName(bin) + " kPa"] = json(scale.bins[bin]);
  return {{"bins", bins},
          {"whole", {{"within_tables", scale.whole.within_tables}, {"within_map", scale.whole.within_map}}}};
}

Json json(const calibration::BinIntervals& bin) {
  return {{"units", bin.units},
          {"factor_68", bin.factor[0]},
          {"covered_68", bin.covered[0]},
          {"factor_95", bin.factor[1]},
          {"covered_95", bin.covered[1]}};
}

Json intervalsJson(const ErrorIntervals& intervals) {
  if (!intervals.present()) return nullptr;
  Json bins = Json::object();
  for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin)
    bins[statistics::pressureBinName(bin) + " kPa"] = json(intervals.bins[bin]);
  return {{"unit", unitsOf(intervals)},
          {"bins", bins},
          {"whole", json(intervals.whole)},
          {"loading",
           {{"covered_68", intervals.by_direction[0][0]}, {"covered_95", intervals.by_direction[1][0]}}},
          {"unloading",
           {{"covered_68", intervals.by_direction[0][1]}, {"covered_95", intervals.by_direction[1][1]}}},
          {"deviation_of_the_map", scaleJson(intervals.scale)},
          {"taxels", {{"covered_68", intervals.by_taxel[0]}, {"covered_95", intervals.by_taxel[1]}}}};
}

}  // namespace

std::string budgetText(const ErrorBudget& budget, const matrix::Layout& layout) {
  if (!budget.present()) return "Error budget: none, since scores were not computed.\n";
  std::ostringstream out;
  budgetTable(out, budget);
  intervalTable(out, budget.intervals, layout);
  scaleTable(out, budget.intervals);
  return out.str();
}

Json budgetJson(const ErrorBudget& budget) {
  if (!budget.present()) return nullptr;
  Json lines = Json::array();
  for (const BudgetLine& line : budget.lines) {
    lines.push_back({{"name", line.name},
                     {"source", calibration::budgetSourceName(line.source)},
                     {"part", calibration::budgetPartName(line.part)},
                     {"standard_pa", line.standard},
                     {"added_pa", line.added},
                     {"note", line.note}});
  }
  return {{"share_of_range", calibration::kBudgetShares},
          {"pressure_pa", budget.pressure},
          {"lines", lines},
          {"held_out_pa", budget.held_out},
          {"combined_pa", budget.combined},
          {"coverage_factor", 2},
          {"intervals", intervalsJson(budget.intervals)}};
}

}  // namespace fsr::report
