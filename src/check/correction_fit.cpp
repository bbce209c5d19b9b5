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

bool CorrectionFit::Sums::solve(Change& step) const {
  if (!(matrix.determinant() > kDetermined * matrix(0, 0) * matrix(1, 1))) return false;
  step = matrix.inverse() * right;
  return true;
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
  sheet_sums_.resize(readings.stays.front().answers.size());
  fitSheet();
  taxels_.assign(sheet_sums_.size(), sheet_);
  taxel_sums_ = sheet_sums_;
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) fitTaxel(taxel);
}

ReadingChange CorrectionFit::toReading(const Change& change) const {
  return {1 + change[1], change[0] - change[1] * pivot_};
}

CorrectionFit::Change CorrectionFit::moved(Change from, const Change& step) {
  from += step;
  from[1] = std::min(std::max(from[1], -kLargestStretch), 1 / (1 - kLargestStretch));
  return from;
}

void CorrectionFit::fitSheet() {
  for (int step = 0; step <= kSteps; ++step) {
    double error = 0;
    for (std::size_t taxel = 0; taxel < sheet_sums_.size(); ++taxel)
      sheet_sums_[taxel] = sumsAround(sheet_, taxel, error);
    if (step < kSteps) sheet_ = sheetOf(all_);
  }
}

// Starts from the sheet's change. A step that makes the error larger is not taken.
void CorrectionFit::fitTaxel(std::size_t taxel) {
  double best = 0;
  sumsAround(sheet_, taxel, best);
  for (int step = 0; step < kSteps; ++step) {
    Change next;
    if (!alone(taxel, totalOf(taxel_sums_[taxel], all_), next)) return;
    double error = 0;
    CycleSums sums = sumsAround(next, taxel, error);
    if (!(error < best)) return;
    best = error;
    taxels_[taxel] = next;
    taxel_sums_[taxel] = std::move(sums);
  }
}

CorrectionFit::CycleSums CorrectionFit::sumsAround(const Change& centre, std::size_t taxel,
                                                   double& error) const {
  const ReadingChange change = toReading(centre);
  CycleSums result(readings_.cycles());
  for (std::size_t cycle = 0; cycle < readings_.cycles(); ++cycle) {
    const CycleReadings::Stay& stay = readings_.stayOf(cycle);
    const Error zero = zeroOf(stay, taxel, change, pivot_);
    for (const Reading& reading : readings_.cycle[cycle][taxel]) {
      const Error one = errorOf(reading, stay.answers[taxel], change, pivot_);
      const double value = one.value - zero.value;
      const Eigen::Vector2d slope = one.slope - zero.slope;
      result[cycle].matrix += slope * slope.transpose();
      result[cycle].right -= slope * value;
      error += value * value;
    }
  }
  return result;
}

CorrectionFit::Sums CorrectionFit::totalOf(const CycleSums& sums, const Cycles& cycles) {
  Sums total;
  for (std::size_t cycle = 0; cycle < cycles.size(); ++cycle) {
    if (!cycles[cycle]) continue;
    total.matrix += sums[cycle].matrix;
    total.right += sums[cycle].right;
  }
  return total;
}

CorrectionFit::Sums CorrectionFit::sheetTotal(const Cycles& cycles) const {
  Sums whole;
  for (const CycleSums& taxel : sheet_sums_) {
    const Sums total = totalOf(taxel, cycles);
    whole.matrix += total.matrix;
    whole.right += total.right;
  }
  return whole;
}

CorrectionFit::Change CorrectionFit::sheetOf(const Cycles& cycles) const {
  Change step;
  return sheetTotal(cycles).solve(step) ? moved(sheet_, step) : sheet_;
}

bool CorrectionFit::alone(std::size_t taxel, const Sums& sums, Change& change) const {
  Change step;
  if (!sums.solve(step)) return false;
  change = moved(taxels_[taxel], step);
  return true;
}

// s^2 of a taxel; negative where it is not known.
CorrectionFit::Change CorrectionFit::jackknifeVariance(std::size_t taxel, const Cycles& cycles,
                                                       const Change& whole) const {
  const CycleSums& own = taxel_sums_[taxel];
  const Sums all = totalOf(own, cycles);
  Change square = Change::Zero();
  double number = 0;
  for (std::size_t cycle = 0; cycle < cycles.size(); ++cycle) {
    if (!cycles[cycle]) continue;
    Change change;
    if (!alone(taxel, {all.matrix - own[cycle].matrix, all.right - own[cycle].right}, change))
      return {-1, -1};
    square += (change - whole).cwiseAbs2();
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
    if (!alone(taxel, totalOf(taxel_sums_[taxel], cycles), own[taxel])) continue;
    variance[taxel] = jackknifeVariance(taxel, cycles, own[taxel]);
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
  addEffect(sheetTotal(all_), sheetOf(cycles), effect);
  return effect;
}

std::vector<double> CorrectionFit::taxelEffects(const Cycles& cycles) const {
  const Change sheet = sheetOf(cycles);
  std::vector<double> effects;
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) {
    Change own = sheet;
    alone(taxel, totalOf(taxel_sums_[taxel], cycles), own);
    addEffect(totalOf(sheet_sums_[taxel], all_), own - sheet, effects);
  }
  return effects;
}

std::vector<ReadingChange> CorrectionFit::fit(ChangeModel model, const Cycles& cycles) const {
  std::vector<ReadingChange> result(taxels_.size());
  Change step;
  if (model == ChangeModel::kNone || !sheetTotal(cycles).solve(step)) return result;
  const Change sheet = moved(sheet_, step);
  std::vector<Change> changes(taxels_.size(), sheet);
  if (model == ChangeModel::kTaxels) changes = shrunk(cycles, sheet);
  for (std::size_t taxel = 0; taxel < result.size(); ++taxel) result[taxel] = toReading(changes[taxel]);
  return result;
}

SquaredErrors CorrectionFit::errors(const std::vector<ReadingChange>& changes, std::size_t cycle) const {
  SquaredErrors errors;
  const CycleReadings::Stay& stay = readings_.stayOf(cycle);
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) {
    const std::vector<Reading>& readings = readings_.cycle[cycle][taxel];
    if (readings.empty()) continue;
    const AnswerTable& answer = stay.answers[taxel];
    const double zero = zeroOf(stay, taxel, changes[taxel], pivot_).value;
    for (const Reading& reading : readings) {
      const double before = changes[taxel].before(reading.code);
      const double error = AnswerTable::at(answer.pressure, before) - zero - double(reading.pressure);
      const double deviation = AnswerTable::at(answer.deviation, before);
      errors.sum += error * error;
      errors.expected += deviation * deviation;
    }
    errors.readings += readings.size();
  }
  return errors;
}

}  // namespace fsr::check
