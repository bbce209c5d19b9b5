#include <cmath>
#include <limits>

#include "calibration/file/calibration_hdf5.h"

// Coverage, scores and error budget: a row for each class, bin, line or left-out part.
namespace fsr::calibration {

namespace {

constexpr std::size_t kBins = statistics::kPressureBins;

std::vector<Score*> rowsOf(CalibrationScores& scores) {
  std::vector<Score*> rows;
  for (ConditionScore& condition : scores.conditions) rows.push_back(&condition.score);
  rows.push_back(&scores.whole);
  return rows;
}

// Of all pressures, then of each bin; both directions, loading, unloading.
std::vector<statistics::ErrorSummary*> errorsOf(const std::vector<Score*>& rows) {
  std::vector<statistics::ErrorSummary*> errors;
  for (Score* score : rows) {
    const auto add = [&](statistics::BinnedErrors::Directions& of) {
      errors.insert(errors.end(), {&of.all, &of.loading, &of.unloading});
    };
    add(score->errors.whole);
    for (auto& bin : score->errors.bins) add(bin);
  }
  return errors;
}

// Errors of readings that took no part: UnseenScore or RemountScore. Earlier files have not both groups.
template <typename LeftOut>
void leftOutMembers(hdf5::Members& file, const char* group, const char* meaning, LeftOut& score) {
  if (!file.group(group)) return;
  file.note("meaning", meaning);
  file.attribute("readings", score.readings);
  file.numbers("rmse_percent", std::tie(score.rmse_percent.mean, score.rmse_percent.deviation));
  file.attribute("rmse", score.rmse);
  file.note("unit", "Pa");
}

void historyScoresMembers(hdf5::Members& file, HistoryScore& score) {
  if (!file.group("/scores/history", !score.choice.empty())) return;
  file.attribute("choice", score.choice);
  if (file.reads() ? file.has("protocols") : !score.protocols.empty()) {
    file.texts("protocols", score.protocols, &HistoryScore::Protocol::name, "each was left out in turn");
    file.rows<double>(
        "protocol_rmse", score.protocols,
        [](HistoryScore::Protocol& one) {
          return std::tuple_cat(std::tie(one.rmse[0], one.rmse[1], one.rmse[2], one.rmse[3]),
                                std::tie(one.corrected_rmse));
        },
        {score.protocols.size(), 5}, "Pa",
        "of means over half a second: static, plays, memories, both, correction c alone");
  }
  if (!(file.reads() ? file.has("parts") : !score.parts.empty())) return;
  file.texts("parts", score.parts, &HistoryScore::Part::name, "readings of all protocols that were left out");
  file.rows<std::uint64_t>("part_readings", score.parts, &HistoryScore::Part::readings, {score.parts.size()},
                           "", "scans x taxels");
  file.rows<double>(
      "part_errors", score.parts,
      [](HistoryScore::Part& one) { return std::tie(one.static_rmse, one.rmse, one.within_one_deviation); },
      {score.parts.size(), 3}, "",
      "RMSE of the static answer [Pa], RMSE with the model [Pa], share within one deviation");
}

void sessionScoresMembers(hdf5::Members& file, SessionScore& score) {
  if (!file.group("/scores/session", !score.choice.empty())) return;
  file.attribute("choice", score.choice);
  if (!(file.reads() ? file.has("sessions") : !score.sessions.empty())) return;
  file.texts("sessions", score.sessions, &SessionScore::Session::name, "each was left out in turn");
  const std::size_t rows = score.sessions.size();
  file.rows<std::uint64_t>("readings", score.sessions, &SessionScore::Session::readings, {rows}, "",
                           "scans x taxels after the rest at the start");
  file.rows<double>("rmse", score.sessions, &SessionScore::Session::rmse, {rows, 3}, "Pa",
                    "static tables; the same after a tare; tables trained with the zeros, after a tare");
}

}  // namespace

void temperatureScoresMembers(hdf5::Members& file, TemperatureScore& score) {
  if (!file.group("/scores/temperature", !score.choice.empty())) return;
  file.attribute("choice", score.choice);
  if (!(file.reads() ? file.has("groups") : !score.groups.empty())) return;
  file.texts("groups", score.groups, &TemperatureScore::Group::name,
             "protocols and recordings; each was left out in turn");
  file.rows<double>(
      "group_rmse", score.groups,
      [](TemperatureScore::Group& one) { return std::tie(one.without, one.with); }, {score.groups.size(), 2},
      "Pa", "of readings on a linear map: without and with the model of the temperature");
}

void scoresMembers(hdf5::Members& file, CalibrationScores& scores,
                   const std::vector<dataset::CurvatureClass>& classes) {
  if (file.reads()) {
    for (const dataset::CurvatureClass& one : classes) scores.conditions.push_back({one, true, {}});
  }
  std::vector<Score*> all = rowsOf(scores);
  std::vector<statistics::ErrorSummary*> errors = errorsOf(all);
  const std::size_t rows = all.size();
  file.group("/scores");
  file.note("meaning",
            "held-out readings; rows are the classes of /statistics, the last row all of them together");
  file.rows<std::uint8_t>("trained", scores.conditions, &ConditionScore::trained, {rows - 1}, "",
                          "1 = the model that answers has seen this class");
  file.rows<std::uint64_t>("readings", all, &Score::readings, {rows}, "", "scans x taxels");
  file.rows<double>(
      "over_taxels", all,
      [](Score* one) {
        return std::tie(one->r2.mean, one->r2.deviation, one->rmse_percent.mean, one->rmse_percent.deviation);
      },
      {rows, 4}, "",
      "R2 mean, R2 deviation, RMSE% mean, RMSE% deviation over taxels; of a taxel the mean of its sections");
  file.rows<double>("worst_rmse_percent", all, &Score::worst_rmse_percent, {rows}, "%", "of the worst taxel");
  file.rows<std::uint64_t>("worst_taxel", all, &Score::worst_taxel, {rows}, "", "row * columns + column");
  file.rows<double>("within_one_deviation", all, &Score::within_one_deviation, {rows}, "",
                    "share of the readings");
  file.rows<double>(
      "errors", errors,
      [](statistics::ErrorSummary* e) {
        return std::tie(e->count, e->bias, e->rmse, e->limit_low, e->limit_high, e->p95_absolute);
      },
      {rows, 1 + kBins, 3, 6}, "Pa",
      "[class][whole, then bins of 0, 50, 100, 200, 400 kPa and more][both, loading, unloading]"
      "[count, bias, RMSE, lower and upper 95 % limit, 95th percentile of the absolute error]");
  leftOutMembers(file, "/scores/unseen", "inner surfaces, each in turn answered from the others",
                 scores.unseen);
  leftOutMembers(file, "/scores/remount", "each mount of a surface in turn answered from the others",
                 scores.remount);
  historyScoresMembers(file, scores.history);
  sessionScoresMembers(file, scores.session);
}

void coverageMembers(hdf5::Members& file, dataset::Coverage& coverage,
                     const std::vector<dataset::CurvatureClass>& classes) {
  if (file.reads()) {
    for (const dataset::CurvatureClass& one : classes)
      coverage.conditions.push_back({one, 0, 0, 0, 0, {}, {}});
  }
  std::vector<dataset::CoverageCell*> cells;
  for (dataset::ConditionCoverage& condition : coverage.conditions) {
    for (std::size_t bin = 0; bin < kBins; ++bin)
      cells.insert(cells.end(), {&condition.loading[bin], &condition.unloading[bin]});
  }
  const std::size_t rows = coverage.conditions.size();
  using Condition = dataset::ConditionCoverage;
  file.group("/coverage");
  file.note("meaning", "what the bags held; rows are the classes of /statistics");
  file.rows<std::uint64_t>("scans", cells, &dataset::CoverageCell::scans, {rows, kBins, 2}, "",
                           "[class][bin of 0, 50, 100, 200, 400 kPa and more][loading, unloading]");
  file.rows<std::uint64_t>("cycles", cells, &dataset::CoverageCell::cycles, {rows, kBins, 2}, "", "likewise");
  file.rows<std::uint64_t>(
      "totals", coverage.conditions, [](Condition& one) { return std::tie(one.scans, one.cycles); },
      {rows, 2}, "", "scans, cycles");
  file.rows<double>(
      "pressure", coverage.conditions,
      [](Condition& one) { return std::tie(one.pressure_low, one.pressure_high); }, {rows, 2}, "Pa",
      "lowest and highest, gauge");
  file.texts("thin", coverage.thin, "where there is little data");
}

namespace {

constexpr std::size_t kPoints = kBudgetShares.size();
constexpr std::size_t kLevels = kIntervalLevels.size();
constexpr double kSmallestFactor = 1e-12;
constexpr double kLargestFactor = 32;  // that of training: the edge of the last cell of IntervalTally

const hdf5::Names<IntervalUnit> kUnits = {{IntervalUnit::kCycles, "cycles"},
                                          {IntervalUnit::kMounts, "mounts"}};

template <typename Value>
hdf5::Names<Value> namesOf(std::string (*name)(Value), std::initializer_list<Value> values) {
  hdf5::Names<Value> names;
  for (const Value value : values) names.emplace_back(value, name(value));
  return names;
}

void requireScale(const hdf5::Members& file, const DeviationScale& scale) {
  double before = -std::numeric_limits<double>::infinity();
  for (const BinScale& bin : scale.bins) {
    if (!std::isnan(bin.factor)) file.within("scale_factor", {bin.factor}, kSmallestFactor, kLargestFactor);
    if (std::isnan(bin.pressure)) continue;
    file.require(bin.pressure > before && !std::isinf(bin.pressure), "scale_pressure",
                 "must rise from bin to bin");
    before = bin.pressure;
  }
}

// The group is /budget/intervals. Earlier files have no scale.
void scaleMembers(hdf5::Members& file, DeviationScale& scale) {
  if (file.reads() && !file.has("scale_factor")) return;
  std::vector<BinScale*> rows;
  for (BinScale& bin : scale.bins) rows.push_back(&bin);
  file.rows<double>("scale_pressure", rows, &BinScale::pressure, {kBins}, "Pa",
                    "middle of each bin; NaN = no readings");
  file.rows<double>("scale_factor", rows, &BinScale::factor, {kBins}, "",
                    "the deviation of the map is that of /tables times this, linear between the middles of "
                    "the bins; NaN = too few units: 1");
  rows.push_back(&scale.whole);
  file.rows<double>(
      "scale_covered", rows, [](BinScale* bin) { return std::tie(bin->within_tables, bin->within_map); },
      {kBins + 1, 2}, "",
      "share of the readings of a unit within one deviation [row][of /tables, of the map with the factors of "
      "the other units]");
  if (file.reads()) requireScale(file, scale);
}

void intervalsMembers(hdf5::Members& file, ErrorIntervals& intervals, std::size_t taxels) {
  if (!file.group("/budget/intervals", intervals.present())) return;
  file.note("meaning",
            "pressure +- factor x deviation; rows are bins of 0, 50, 100, 200, 400 kPa and more, then all "
            "pressures; columns are 68.27 % and 95 %; NaN = too few units");
  file.attribute("unit_left_out", intervals.unit, kUnits);
  std::vector<BinIntervals*> rows;
  for (BinIntervals& bin : intervals.bins) rows.push_back(&bin);
  rows.push_back(&intervals.whole);
  file.rows<std::uint64_t>("units", rows, &BinIntervals::units, {kBins + 1}, "", "units with readings");
  file.rows<double>("factor", rows, &BinIntervals::factor, {kBins + 1, kLevels}, "", "of the deviation");
  file.rows<double>("covered", rows, &BinIntervals::covered, {kBins + 1, kLevels}, "",
                    "share of the readings of a unit, with the factor of the others");
  const auto itself = [](auto& values) -> auto& {
    return values;
  };
  file.rows<double>("by_direction", intervals.by_direction, itself, {kLevels, 2}, "",
                    "share of the readings, [level][loading, unloading]");
  std::vector<double*> of_taxels;
  for (std::vector<double>& level : intervals.by_taxel) {
    level.resize(taxels);
    for (double& value : level) of_taxels.push_back(&value);
  }
  file.rows<double>(
      "by_taxel", of_taxels, [](double* value) { return std::tie(*value); }, {kLevels, taxels}, "",
      "share of the readings, [level][taxel]");
  scaleMembers(file, intervals.scale);
}

}  // namespace

void budgetMembers(hdf5::Members& file, ErrorBudget& budget, std::size_t taxels) {
  if (!file.group("/budget", budget.present())) return;
  file.note("meaning",
            "error budget: standard uncertainties, source by source, at 10, 50 and 90 % of the trained "
            "pressures; combined = held_out and what is added, in quadrature");
  std::vector<ErrorBudget*> all = {&budget};
  file.rows<double>("pressure", all, &ErrorBudget::pressure, {kPoints}, "Pa", "gauge");
  file.rows<double>("held_out", all, &ErrorBudget::held_out, {kPoints}, "Pa",
                    "root mean square of the errors of held-out readings");
  file.rows<double>("combined", all, &ErrorBudget::combined, {kPoints}, "Pa", "k = 1");
  std::vector<BudgetLine>& lines = budget.lines;
  file.texts("names", lines, &BudgetLine::name, "of the lines");
  file.texts("sources", lines, &BudgetLine::source,
             namesOf(budgetSourceName, {BudgetSource::kMeasured, BudgetSource::kSession,
                                        BudgetSource::kDeclared, BudgetSource::kNotAssessed}),
             "where each number comes from");
  file.texts("parts", lines, &BudgetLine::part,
             namesOf(budgetPartName,
                     {BudgetPart::kHeldOut, BudgetPart::kPartly, BudgetPart::kAdded, BudgetPart::kAside}),
             "inside the held-out error, partly, added to it, or aside");
  file.texts("notes", lines, &BudgetLine::note, "how it was found, or what is missing");
  file.rows<double>("standard", lines, &BudgetLine::standard, {lines.size(), kPoints}, "Pa",
                    "standard uncertainty [line][pressure]; NaN = not known");
  file.rows<double>("added", lines, &BudgetLine::added, {lines.size(), kPoints}, "Pa",
                    "beyond the held-out error [line][pressure]");
  intervalsMembers(file, budget.intervals, taxels);
}

}  // namespace fsr::calibration
