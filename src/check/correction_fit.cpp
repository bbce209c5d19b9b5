#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "check/correction.h"

namespace fsr::check {

namespace {

constexpr int kSteps = 5;             // of Gauss and Newton; the second is already smaller than a count
constexpr double kDetermined = 1e-9;  // of a determinant, relative
constexpr double kLargestStretch = 0.9;

// An error, or the mean of errors, with its derivatives by shift and stretch.
struct Error {
  double value = 0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
};

Error errorOf(const Reading& reading, const AnswerTable& answer, const ReadingChange& change, double pivot) {
  const double before = change.before(reading.code);
  const double slope = answer.slopeAt(before) / change.gain;
  return {AnswerTable::at(answer.pressure, before) - double(reading.pressure),
          {-slope, -slope * (before - pivot)}};
}

// What a tare subtracts: the mean over the readings at rest.
Error zeroOf(const CycleReadings::Stay& stay, std::size_t taxel, const ReadingChange& change, double pivot) {
  Error zero;
  if (stay.rest.empty() || stay.rest[taxel].empty()) return zero;
  for (const Reading& reading : stay.rest[taxel]) {
    const Error error = errorOf(reading, stay.answers[taxel], change, pivot);
    zero.value += error.value;
    zero.slope += error.slope;
  }
  const double n = double(stay.rest[taxel].size());
  return {zero.value / n, zero.slope / n};
}

}  // namespace

void CorrectionFit::Sums::add(const Sums& more, double sign) {
  matrix += sign * more.matrix;
  right += sign * more.right;
}

CorrectionFit::Sums CorrectionFit::Solution::total(const Cycles& cycles) const {
  Sums total;
  for (std::size_t cycle = 0; cycle < cycles.size(); ++cycle) {
    if (cycles[cycle]) total.add(sums[cycle]);
  }
  return total;
}

std::optional<CorrectionFit::Change> CorrectionFit::Solution::solve(const Sums& of) const {
  if (!(of.matrix.determinant() > kDetermined * of.matrix(0, 0) * of.matrix(1, 1))) return std::nullopt;
  Change change = centre + of.matrix.inverse() * of.right;
  change[1] = std::min(std::max(change[1], -kLargestStretch), 1 / (1 - kLargestStretch));
  return change;
}

CorrectionFit::CorrectionFit(const CycleReadings& readings)
    : readings_(readings), all_(readings.cycles(), true) {
  double sum = 0;
  for (const TaxelReadings& cycle : readings.cycle) {
    for (const auto& taxel : cycle) {
      for (const Reading& reading : taxel) sum += reading.code;
      number_ += double(taxel.size());
    }
  }
  if (number_ > 0) pivot_ = sum / number_;
  fitSheet();
  taxels_ = around_sheet_;
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) fitTaxel(taxel);
}

ReadingChange CorrectionFit::toReading(const Change& change) const {
  return {1 + change[1], change[0] - change[1] * pivot_};
}

void CorrectionFit::fitSheet() {
  for (int step = 0; step <= kSteps; ++step) {
    if (step > 0) sheet_.centre = sheet_.solve(sheet_.total(all_)).value_or(sheet_.centre);
    sheet_.sums.assign(all_.size(), {});
    around_sheet_.assign(readings_.stays.front().answers.size(), {sheet_.centre, sheet_.sums});
    for (std::size_t taxel = 0; taxel < around_sheet_.size(); ++taxel) {
      addTaxel(taxel, around_sheet_[taxel]);
      for (std::size_t cycle = 0; cycle < all_.size(); ++cycle)
        sheet_.sums[cycle].add(around_sheet_[taxel].sums[cycle]);
    }
  }
}

// Starts from the sheet's change. A step that makes the error larger is not taken.
void CorrectionFit::fitTaxel(std::size_t taxel) {
  const std::vector<Sums> none(all_.size());
  Solution start{sheet_.centre, none};
  double best = addTaxel(taxel, start);
  for (int step = 0; step < kSteps; ++step) {
    const std::optional<Change> centre = taxels_[taxel].solve(taxels_[taxel].total(all_));
    if (!centre) return;
    Solution next{*centre, none};
    const double error = addTaxel(taxel, next);
    if (!(error < best)) return;
    best = error;
    taxels_[taxel] = std::move(next);
  }
}

double CorrectionFit::addTaxel(std::size_t taxel, Solution& around) const {
  const ReadingChange change = toReading(around.centre);
  double error = 0;
  for (std::size_t cycle = 0; cycle < readings_.cycles(); ++cycle) {
    const CycleReadings::Stay& stay = readings_.stayOf(cycle);
    const Error zero = zeroOf(stay, taxel, change, pivot_);
    for (const Reading& reading : readings_.cycle[cycle][taxel]) {
      const Error one = errorOf(reading, stay.answers[taxel], change, pivot_);
      const double value = one.value - zero.value;
      const Eigen::Vector2d slope = one.slope - zero.slope;
      around.sums[cycle].matrix += slope * slope.transpose();
      around.sums[cycle].right -= slope * value;
      error += value * value;
    }
  }
  return error;
}

// s^2 of a taxel; negative where it is not known.
CorrectionFit::Change CorrectionFit::jackknifeVariance(const Solution& taxel, const Cycles& cycles,
                                                       const Change& whole) const {
  const Sums all = taxel.total(cycles);
  Change square = Change::Zero();
  double number = 0;
  for (std::size_t cycle = 0; cycle < cycles.size(); ++cycle) {
    if (!cycles[cycle]) continue;
    Sums rest = all;
    rest.add(taxel.sums[cycle], -1);
    const std::optional<Change> change = taxel.solve(rest);
    if (!change) return {-1, -1};
    square += (*change - whole).cwiseAbs2();
    number += 1;
  }
  if (number < 2) return {-1, -1};
  return square * (number - 1) / number;
}

// The change of each taxel, drawn towards that of the sheet.
std::vector<CorrectionFit::Change> CorrectionFit::shrunk(const Cycles& cycles, const Change& sheet) const {
  std::vector<Change> own(taxels_.size(), sheet), variance(taxels_.size(), Change{-1, -1});
  Change between = Change::Zero(), within = Change::Zero();
  double number = 0;
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) {
    const std::optional<Change> solved = taxels_[taxel].solve(taxels_[taxel].total(cycles));
    if (!solved) continue;
    own[taxel] = *solved;
    variance[taxel] = jackknifeVariance(taxels_[taxel], cycles, own[taxel]);
    if (variance[taxel][0] < 0) continue;
    between += (own[taxel] - sheet).cwiseAbs2();
    within += variance[taxel];
    number += 1;
  }
  if (number == 0) return std::vector<Change>(taxels_.size(), sheet);
  const Change tau = ((between - within) / number).cwiseMax(0);
  for (std::size_t taxel = 0; taxel < own.size(); ++taxel) {
    for (const int i : {0, 1}) {
      const bool known = variance[taxel][i] >= 0 && tau[i] > 0;
      const double share = known ? tau[i] / (tau[i] + variance[taxel][i]) : 0;
      own[taxel][i] = sheet[i] + (own[taxel][i] - sheet[i]) * share;
    }
  }
  return own;
}

// The mean square of a x^2 + 2 b x y + d y^2 as the sum of two squares.
void CorrectionFit::addEffect(const Sums& sums, const Change& change, std::vector<double>& effects) const {
  const double a = sums.matrix(0, 0), b = sums.matrix(0, 1), root = std::sqrt(a);
  const double rest = a > 0 ? std::max(0.0, sums.matrix(1, 1) - b * b / a) : 0.0;
  effects.push_back((root > 0 ? root * change[0] + b / root * change[1] : 0.0) / std::sqrt(number_));
  effects.push_back(std::sqrt(rest) * change[1] / std::sqrt(number_));
}

std::vector<double> CorrectionFit::sheetEffect(const Cycles& cycles) const {
  std::vector<double> effect;
  addEffect(sheet_.total(all_), sheet_.solve(sheet_.total(cycles)).value_or(sheet_.centre), effect);
  return effect;
}

std::vector<double> CorrectionFit::taxelEffects(const Cycles& cycles) const {
  const Change sheet = sheet_.solve(sheet_.total(cycles)).value_or(sheet_.centre);
  std::vector<double> effects;
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) {
    const Change own = taxels_[taxel].solve(taxels_[taxel].total(cycles)).value_or(sheet);
    addEffect(around_sheet_[taxel].total(all_), own - sheet, effects);
  }
  return effects;
}

std::vector<ReadingChange> CorrectionFit::fit(ChangeModel model, const Cycles& cycles) const {
  std::vector<ReadingChange> result(taxels_.size());
  const std::optional<Change> sheet = sheet_.solve(sheet_.total(cycles));
  if (model == ChangeModel::kNone || !sheet) return result;
  std::vector<Change> changes(taxels_.size(), *sheet);
  if (model == ChangeModel::kTaxels) changes = shrunk(cycles, *sheet);
  for (std::size_t taxel = 0; taxel < result.size(); ++taxel) result[taxel] = toReading(changes[taxel]);
  return result;
}

CheckedReadings CorrectionFit::errors(const std::vector<ReadingChange>& changes, std::size_t cycle) const {
  CheckedReadings errors;
  const CycleReadings::Stay& stay = readings_.stayOf(cycle);
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) {
    const std::vector<Reading>& readings = readings_.cycle[cycle][taxel];
    if (readings.empty()) continue;
    const AnswerTable& answer = stay.answers[taxel];
    const double zero = zeroOf(stay, taxel, changes[taxel], pivot_).value;
    for (const Reading& reading : readings) {
      const double before = changes[taxel].before(reading.code);
      errors.add(AnswerTable::at(answer.pressure, before) - zero - double(reading.pressure),
                 AnswerTable::at(answer.deviation, before));
    }
  }
  return errors;
}

}  // namespace fsr::check
