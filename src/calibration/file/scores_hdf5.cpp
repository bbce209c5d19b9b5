#include "calibration/file/calibration_hdf5.h"

namespace fsr::calibration {

namespace {

// Every dataset has one row for each class and a last row for all together.
constexpr std::size_t kMeasures = 6;
constexpr std::size_t kDirections = 3;
constexpr std::size_t kErrors = (1 + statistics::kPressureBins) * kDirections * kMeasures;

void appendErrors(const statistics::ErrorSummary& errors, std::vector<double>& values) {
  values.insert(values.end(), {static_cast<double>(errors.count), errors.bias, errors.rmse, errors.limit_low,
                               errors.limit_high, errors.p95_absolute});
}

void appendErrors(const statistics::BinnedErrors::Directions& errors, std::vector<double>& values) {
  appendErrors(errors.all, values);
  appendErrors(errors.loading, values);
  appendErrors(errors.unloading, values);
}

const double* takeErrors(const double* values, statistics::ErrorSummary& errors) {
  errors = {static_cast<std::size_t>(values[0]), values[1], values[2], values[3], values[4], values[5]};
  return values + kMeasures;
}

const double* takeErrors(const double* values, statistics::BinnedErrors::Directions& errors) {
  values = takeErrors(values, errors.all);
  values = takeErrors(values, errors.loading);
  return takeErrors(values, errors.unloading);
}

struct Columns {
  std::vector<std::uint64_t> readings, worst_taxel;
  std::vector<double> over_taxels, worst, within, errors;

  void append(const Score& score) {
    readings.push_back(score.readings);
    worst_taxel.push_back(score.worst_taxel);
    over_taxels.insert(over_taxels.end(), {score.r2.mean, score.r2.deviation, score.rmse_percent.mean,
                                           score.rmse_percent.deviation});
    worst.push_back(score.worst_rmse_percent);
    within.push_back(score.within_one_deviation);
    appendErrors(score.errors.whole, errors);
    for (const auto& bin : score.errors.bins) appendErrors(bin, errors);
  }
  Score row(std::size_t i) const {
    Score score;
    score.readings = readings[i];
    score.worst_taxel = worst_taxel[i];
    score.r2 = {over_taxels[4 * i], over_taxels[4 * i + 1]};
    score.rmse_percent = {over_taxels[4 * i + 2], over_taxels[4 * i + 3]};
    score.worst_rmse_percent = worst[i];
    score.within_one_deviation = within[i];
    const double* values = takeErrors(&errors[i * kErrors], score.errors.whole);
    for (auto& bin : score.errors.bins) values = takeErrors(values, bin);
    return score;
  }
};

constexpr const char* kUnseen = "/scores/unseen";
constexpr const char* kRemount = "/scores/remount";

// Errors of readings that took no part: UnseenScore or RemountScore.
template <typename LeftOut>
void writeLeftOut(const LeftOut& score, const char* group, const char* meaning, hdf5::Writer& writer) {
  writer.group(group);
  writer.attribute(group, "meaning", meaning);
  writer.attribute(group, "readings", score.readings);
  writer.attribute(group, "rmse_percent",
                   std::vector<double>{score.rmse_percent.mean, score.rmse_percent.deviation});
  writer.attribute(group, "rmse", std::vector<double>{score.rmse});
  writer.attribute(group, "unit", "Pa");
}

// Files of schema 1 have neither group, and those before the error of another mount have no kRemount.
template <typename LeftOut>
LeftOut readLeftOut(const hdf5::Reader& reader, const char* group) {
  if (!reader.has(group)) return {};
  const std::vector<double> percent = reader.numbers(group, "rmse_percent", 2);
  return {reader.integer(group, "readings"), {percent[0], percent[1]}, reader.numbers(group, "rmse", 1)[0]};
}

}  // namespace

void writeScores(const CalibrationScores& scores, hdf5::Writer& writer) {
  Columns columns;
  std::vector<std::uint8_t> trained;
  for (const ConditionScore& condition : scores.conditions) {
    columns.append(condition.score);
    trained.push_back(condition.trained);
  }
  columns.append(scores.whole);
  const std::size_t rows = scores.conditions.size() + 1;
  writer.group("/scores");
  writer.attribute(
      "/scores", "meaning",
      "held-out readings; rows are the classes of /statistics, the last row all of them together");
  writer.dataset("/scores/trained", trained, {rows - 1}, "",
                 "1 = the model that answers has seen this class");
  writer.dataset("/scores/readings", columns.readings, {rows}, "", "scans x taxels");
  writer.dataset("/scores/over_taxels", columns.over_taxels, {rows, 4}, "",
                 "R2 mean, R2 deviation, RMSE% mean, RMSE% deviation over taxels; of a taxel the mean of its "
                 "sections");
  writer.dataset("/scores/worst_rmse_percent", columns.worst, {rows}, "%", "of the worst taxel");
  writer.dataset("/scores/worst_taxel", columns.worst_taxel, {rows}, "", "row * columns + column");
  writer.dataset("/scores/within_one_deviation", columns.within, {rows}, "", "share of the readings");
  writer.dataset("/scores/errors", columns.errors,
                 {rows, 1 + statistics::kPressureBins, kDirections, kMeasures}, "Pa",
                 "[class][whole, then bins of 0, 50, 100, 200, 400 kPa and more][both, loading, unloading]"
                 "[count, bias, RMSE, lower and upper 95 % limit, 95th percentile of the absolute error]");
  writeLeftOut(scores.unseen, kUnseen, "inner surfaces, each in turn answered from the others", writer);
  writeLeftOut(scores.remount, kRemount, "each mount of a surface in turn answered from the others", writer);
}

CalibrationScores readScores(const hdf5::Reader& reader,
                             const std::vector<dataset::CurvatureClass>& classes) {
  const std::size_t rows = classes.size() + 1;
  Columns columns;
  columns.readings = reader.dataset<std::uint64_t>("/scores/readings", {rows});
  columns.over_taxels = reader.dataset<double>("/scores/over_taxels", {rows, 4});
  columns.worst = reader.dataset<double>("/scores/worst_rmse_percent", {rows});
  columns.worst_taxel = reader.dataset<std::uint64_t>("/scores/worst_taxel", {rows});
  columns.within = reader.dataset<double>("/scores/within_one_deviation", {rows});
  columns.errors =
      reader.dataset<double>("/scores/errors", {rows, 1 + statistics::kPressureBins, kDirections, kMeasures});
  const auto trained = reader.dataset<std::uint8_t>("/scores/trained", {classes.size()});
  CalibrationScores scores;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    scores.conditions.push_back({classes[c], trained[c] != 0, columns.row(c)});
  }
  scores.whole = columns.row(classes.size());
  scores.unseen = readLeftOut<UnseenScore>(reader, kUnseen);
  scores.remount = readLeftOut<RemountScore>(reader, kRemount);
  return scores;
}

void writeCoverage(const dataset::Coverage& coverage, hdf5::Writer& writer) {
  std::vector<std::uint64_t> scans, cycles, totals;
  std::vector<double> pressure;
  for (const dataset::ConditionCoverage& condition : coverage.conditions) {
    for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin) {
      scans.insert(scans.end(), {condition.loading[bin].scans, condition.unloading[bin].scans});
      cycles.insert(cycles.end(), {condition.loading[bin].cycles, condition.unloading[bin].cycles});
    }
    totals.insert(totals.end(), {condition.scans, condition.cycles});
    pressure.insert(pressure.end(), {condition.pressure_low, condition.pressure_high});
  }
  const std::size_t rows = coverage.conditions.size();
  writer.group("/coverage");
  writer.attribute("/coverage", "meaning", "what the bags held; rows are the classes of /statistics");
  writer.dataset("/coverage/scans", scans, {rows, statistics::kPressureBins, 2}, "",
                 "[class][bin of 0, 50, 100, 200, 400 kPa and more][loading, unloading]");
  writer.dataset("/coverage/cycles", cycles, {rows, statistics::kPressureBins, 2}, "", "likewise");
  writer.dataset("/coverage/totals", totals, {rows, 2}, "", "scans, cycles");
  writer.dataset("/coverage/pressure", pressure, {rows, 2}, "Pa", "lowest and highest, gauge");
  writer.texts("/coverage/thin", coverage.thin, "where there is little data");
}

dataset::Coverage readCoverage(const hdf5::Reader& reader,
                               const std::vector<dataset::CurvatureClass>& classes) {
  const std::size_t rows = classes.size();
  const auto scans = reader.dataset<std::uint64_t>("/coverage/scans", {rows, statistics::kPressureBins, 2});
  const auto cycles = reader.dataset<std::uint64_t>("/coverage/cycles", {rows, statistics::kPressureBins, 2});
  const auto totals = reader.dataset<std::uint64_t>("/coverage/totals", {rows, 2});
  const auto pressure = reader.dataset<double>("/coverage/pressure", {rows, 2});
  dataset::Coverage coverage;
  for (std::size_t c = 0; c < rows; ++c) {
    dataset::ConditionCoverage condition{
        classes[c], totals[2 * c], totals[2 * c + 1], pressure[2 * c], pressure[2 * c + 1], {}, {}};
    for (std::size_t bin = 0; bin < statistics::kPressureBins; ++bin) {
      const std::size_t at = 2 * (c * statistics::kPressureBins + bin);
      condition.loading[bin] = {scans[at], cycles[at]};
      condition.unloading[bin] = {scans[at + 1], cycles[at + 1]};
    }
    coverage.conditions.push_back(condition);
  }
  coverage.thin = reader.texts("/coverage/thin");
  return coverage;
}

}  // namespace fsr::calibration
