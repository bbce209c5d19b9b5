#include "calibration/correction/correction_fit.h"

#include <cmath>

namespace fsr::calibration {

namespace {

constexpr int kSteps = 5;             // of Gauss and Newton; the second is already smaller than a count
constexpr double kDetermined = 1e-9;  // of a determinant, relative
constexpr double kLargestStretch = 0.9;

// What a tare subtracts and how it changes with shift and stretch, mean over the readings at rest.
struct Zero {
  double pressure = 0, by_shift = 0, by_stretch = 0;
};

double limited(double stretch) {
  return std::min(std::max(stretch, -kLargestStretch), 1 / (1 - kLargestStretch));
}

// The error of a reading and its derivatives.
struct Error {
  double value, by_shift, by_stretch;
};

Error errorOf(const RecheckReading& reading, const AnswerTable& answer, const ReadingChange& change,
              double pivot) {
  const double before = change.before(reading.code);
  const double slope = answer.slopeAt(before) / change.gain;
  return {answer.pressureAt(before) - double(reading.pressure), -slope, -slope * (before - pivot)};
}

Zero zeroOf(const RecheckReadings::Stay& stay, std::size_t taxel, const ReadingChange& change, double pivot) {
  Zero zero;
  if (stay.rest.empty() || stay.rest[taxel].empty()) return zero;
  for (const RecheckReading& reading : stay.rest[taxel]) {
    const Error error = errorOf(reading, stay.answers[taxel], change, pivot);
    zero.pressure += error.value;
    zero.by_shift += error.by_shift;
    zero.by_stretch += error.by_stretch;
  }
  const double n = double(stay.rest[taxel].size());
  return {zero.pressure / n, zero.by_shift / n, zero.by_stretch / n};
}

}  // namespace

void CorrectionFit::Sums::add(const Sums& other) {
  a += other.a;
  b += other.b;
  d += other.d;
  shift += other.shift;
  stretch += other.stretch;
}

bool CorrectionFit::Sums::solve(double& shift_out, double& stretch_out) const {
  const double determinant = a * d - b * b;
  if (!(determinant > kDetermined * a * d)) return false;
  shift_out = (d * shift - b * stretch) / determinant;
  stretch_out = (a * stretch - b * shift) / determinant;
  return true;
}

CorrectionFit::CorrectionFit(const RecheckReadings& readings) : readings_(readings) {
  double sum = 0;
  for (const auto& taxel : readings.readings) {
    for (const RecheckReading& reading : taxel) sum += reading.code;
    number_ += double(taxel.size());
  }
  if (number_ > 0) pivot_ = sum / number_;
  fitSheet();
  taxels_.assign(sheet_sums_.size(), sheet_);
  taxel_sums_ = sheet_sums_;
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) fitTaxel(taxel);
}

ReadingChange CorrectionFit::toReading(Change change) const {
  return {1 + change.stretch, change.shift - change.stretch * pivot_};
}

void CorrectionFit::fitSheet() {
  sheet_sums_.resize(readings_.readings.size());
  for (int step = 0; step <= kSteps; ++step) {
    Sums whole;
    for (std::size_t taxel = 0; taxel < sheet_sums_.size(); ++taxel) {
      double error = 0;
      sheet_sums_[taxel] = sumsAround(sheet_, taxel, error);
      for (const Sums& cycle : sheet_sums_[taxel]) whole.add(cycle);
    }
    Change change;
    if (step == kSteps || !whole.solve(change.shift, change.stretch)) return;
    sheet_.shift += change.shift;
    sheet_.stretch = limited(sheet_.stretch + change.stretch);
  }
}

// Starts from the sheet's change. A step that makes the error larger is not taken.
void CorrectionFit::fitTaxel(std::size_t taxel) {
  double best = 0;
  sumsAround(sheet_, taxel, best);
  for (int step = 0; step < kSteps; ++step) {
    Change next;
    if (!alone(taxel, totalOf(taxel_sums_[taxel], Cycles(readings_.cycles(), true)), next)) return;
    double error = 0;
    CycleSums sums = sumsAround(next, taxel, error);
    if (!(error < best)) return;
    best = error;
    taxels_[taxel] = next;
    taxel_sums_[taxel] = std::move(sums);
  }
}

CorrectionFit::CycleSums CorrectionFit::sumsAround(Change centre, std::size_t taxel, double& error) const {
  const ReadingChange change = toReading(centre);
  CycleSums result(readings_.cycles());
  for (std::size_t cycle = 0; cycle < readings_.cycles(); ++cycle) {
    const RecheckReadings::Stay& stay = readings_.stayOf(cycle);
    const Zero zero = zeroOf(stay, taxel, change, pivot_);
    Sums& sums = result[cycle];
    for (std::size_t i = readings_.first[taxel][cycle]; i < readings_.first[taxel][cycle + 1]; ++i) {
      const Error one = errorOf(readings_.readings[taxel][i], stay.answers[taxel], change, pivot_);
      const double by_shift = one.by_shift - zero.by_shift;
      const double by_stretch = one.by_stretch - zero.by_stretch;
      const double value = one.value - zero.pressure;
      sums.a += by_shift * by_shift;
      sums.b += by_shift * by_stretch;
      sums.d += by_stretch * by_stretch;
      sums.shift -= by_shift * value;
      sums.stretch -= by_stretch * value;
      error += value * value;
    }
  }
  return result;
}

CorrectionFit::Sums CorrectionFit::totalOf(const CycleSums& sums, const Cycles& cycles) {
  Sums total;
  for (std::size_t cycle = 0; cycle < cycles.size(); ++cycle) {
    if (cycles[cycle]) total.add(sums[cycle]);
  }
  return total;
}

bool CorrectionFit::alone(std::size_t taxel, const Sums& sums, Change& change) const {
  Change step;
  if (!sums.solve(step.shift, step.stretch)) return false;
  change = {taxels_[taxel].shift + step.shift, limited(taxels_[taxel].stretch + step.stretch)};
  return true;
}

// s^2 of a taxel; negative where it is not known.
CorrectionFit::Change CorrectionFit::jackknifeVariance(std::size_t taxel, const Cycles& cycles,
                                                       Change whole) const {
  const CycleSums& own = taxel_sums_[taxel];
  const Sums all = totalOf(own, cycles);
  Change square;
  double number = 0;
  for (std::size_t cycle = 0; cycle < cycles.size(); ++cycle) {
    if (!cycles[cycle]) continue;
    const Sums& out = own[cycle];
    const Sums rest{all.a - out.a, all.b - out.b, all.d - out.d, all.shift - out.shift,
                    all.stretch - out.stretch};
    Change change;
    if (!alone(taxel, rest, change)) return {-1, -1};
    square.shift += (change.shift - whole.shift) * (change.shift - whole.shift);
    square.stretch += (change.stretch - whole.stretch) * (change.stretch - whole.stretch);
    number += 1;
  }
  if (number < 2) return {-1, -1};
  return {square.shift * (number - 1) / number, square.stretch * (number - 1) / number};
}

// The change of each taxel, drawn towards that of the sheet.
std::vector<CorrectionFit::Change> CorrectionFit::shrunk(const Cycles& cycles, Change sheet) const {
  std::vector<Change> own(taxels_.size(), sheet), variance(taxels_.size(), Change{-1, -1});
  Change between, within;
  double number = 0;
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) {
    Change change;
    if (!alone(taxel, totalOf(taxel_sums_[taxel], cycles), change)) continue;
    own[taxel] = change;
    variance[taxel] = jackknifeVariance(taxel, cycles, change);
    if (variance[taxel].shift < 0) continue;
    between.shift += (change.shift - sheet.shift) * (change.shift - sheet.shift);
    between.stretch += (change.stretch - sheet.stretch) * (change.stretch - sheet.stretch);
    within.shift += variance[taxel].shift;
    within.stretch += variance[taxel].stretch;
    number += 1;
  }
  if (number == 0) return std::vector<Change>(taxels_.size(), sheet);
  const Change tau{std::max(0.0, (between.shift - within.shift) / number),
                   std::max(0.0, (between.stretch - within.stretch) / number)};
  const auto draw = [](double mean, double value, double spread, double error) {
    return error < 0 || spread == 0 ? mean : mean + (value - mean) * spread / (spread + error);
  };
  for (std::size_t taxel = 0; taxel < own.size(); ++taxel) {
    own[taxel] = {draw(sheet.shift, own[taxel].shift, tau.shift, variance[taxel].shift),
                  draw(sheet.stretch, own[taxel].stretch, tau.stretch, variance[taxel].stretch)};
  }
  return own;
}

CorrectionFit::Sums CorrectionFit::sheetTotal(const Cycles& cycles) const {
  Sums whole;
  for (const CycleSums& taxel : sheet_sums_) whole.add(totalOf(taxel, cycles));
  return whole;
}

CorrectionFit::Change CorrectionFit::sheetOf(const Cycles& cycles) const {
  Change step;
  if (!sheetTotal(cycles).solve(step.shift, step.stretch)) return sheet_;
  return {sheet_.shift + step.shift, limited(sheet_.stretch + step.stretch)};
}

// The mean square of a x^2 + 2 b x y + d y^2 as the sum of two squares.
void CorrectionFit::addEffect(const Sums& sums, Change change, std::vector<double>& effects) const {
  const double root = std::sqrt(sums.a);
  const double rest = sums.a > 0 ? std::max(0.0, sums.d - sums.b * sums.b / sums.a) : 0.0;
  const double first = root > 0 ? root * change.shift + sums.b / root * change.stretch : 0.0;
  effects.push_back(first / std::sqrt(number_));
  effects.push_back(std::sqrt(rest) * change.stretch / std::sqrt(number_));
}

std::vector<double> CorrectionFit::sheetEffect(const Cycles& cycles) const {
  std::vector<double> effect;
  addEffect(sheetTotal(Cycles(readings_.cycles(), true)), sheetOf(cycles), effect);
  return effect;
}

std::vector<double> CorrectionFit::taxelEffects(const Cycles& cycles) const {
  const Change sheet = sheetOf(cycles);
  std::vector<double> effects;
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) {
    Change own = sheet;
    alone(taxel, totalOf(taxel_sums_[taxel], cycles), own);
    const Change beside{own.shift - sheet.shift, own.stretch - sheet.stretch};
    addEffect(totalOf(sheet_sums_[taxel], Cycles(readings_.cycles(), true)), beside, effects);
  }
  return effects;
}

std::vector<ReadingChange> CorrectionFit::fit(ChangeModel model, const Cycles& cycles) const {
  std::vector<ReadingChange> result(taxels_.size());
  if (model == ChangeModel::kNone) return result;
  Change step;
  if (!sheetTotal(cycles).solve(step.shift, step.stretch)) return result;
  const Change sheet{sheet_.shift + step.shift, limited(sheet_.stretch + step.stretch)};
  std::vector<Change> changes(taxels_.size(), sheet);
  if (model == ChangeModel::kTaxels) changes = shrunk(cycles, sheet);
  for (std::size_t taxel = 0; taxel < result.size(); ++taxel) result[taxel] = toReading(changes[taxel]);
  return result;
}

SquaredErrors CorrectionFit::errors(const std::vector<ReadingChange>& changes, std::size_t cycle) const {
  SquaredErrors errors;
  const RecheckReadings::Stay& stay = readings_.stayOf(cycle);
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) {
    const auto& first = readings_.first[taxel];
    if (first[cycle] == first[cycle + 1]) continue;
    const AnswerTable& answer = stay.answers[taxel];
    const ReadingChange& change = changes[taxel];
    const double zero = zeroOf(stay, taxel, change, pivot_).pressure;
    for (std::size_t i = first[cycle]; i < first[cycle + 1]; ++i) {
      const RecheckReading& reading = readings_.readings[taxel][i];
      const double before = change.before(reading.code);
      const double error = answer.pressureAt(before) - zero - double(reading.pressure);
      const double deviation = answer.deviationAt(before);
      errors.sum += error * error;
      errors.expected += deviation * deviation;
    }
    errors.readings += first[cycle + 1] - first[cycle];
  }
  return errors;
}

}  // namespace fsr::calibration
