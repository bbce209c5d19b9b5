#include "discrepancy/fit/taxel_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "dataset/count_readers.h"
#include "discrepancy/samples/measured.h"
#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

constexpr double kRidge = 1e-10;
constexpr double kMostLocal = 8;

}  // namespace

TaxelFit::TaxelFit(const Measured& measured, const StaticFit& fit) : measured_(measured), fit_(fit) {
  const auto size = static_cast<Eigen::Index>(fit.coefficients());
  const auto taxels = static_cast<Eigen::Index>(measured.taxels());
  std::vector<Eigen::MatrixXd> normal(fit.groups(), Eigen::MatrixXd::Zero(size, size));
  coefficients_.assign(fit.groups(), Eigen::MatrixXd::Zero(size, taxels));
  std::vector<double> readings;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (measured.cycles[measured.cycle[i]].use == CycleUse::kHoldOut) continue;
    measured.readings(i, readings);
    const Eigen::Map<const Eigen::RowVectorXd> row(readings.data(), taxels);
    const SplineBasis::Values& at = fit.splines(i);
    for (std::size_t j = 0; j < SplineBasis::kAtOnce; ++j) {
      const auto a = static_cast<Eigen::Index>(at.first + j);
      coefficients_[fit.groupOf(i)].row(a) += at.value[j] * row;
      for (std::size_t k = 0; k < SplineBasis::kAtOnce; ++k) {
        normal[fit.groupOf(i)](a, static_cast<Eigen::Index>(at.first + k)) += at.value[j] * at.value[k];
      }
    }
  }
  for (std::size_t g = 0; g < normal.size(); ++g) {
    normal[g].diagonal().array() += kRidge * normal[g].diagonal().maxCoeff() + 1e-300;
    coefficients_[g] = normal[g].ldlt().solve(coefficients_[g]).eval();
  }
  judgeWithin();
}

void TaxelFit::residuals(std::size_t sample, std::vector<double>& result) const {
  measured_.readings(sample, result);
  const SplineBasis::Values& at = fit_.splines(sample);
  const Eigen::MatrixXd& coefficients = coefficients_[fit_.groupOf(sample)];
  for (std::size_t t = 0; t < result.size(); ++t) {
    for (std::size_t j = 0; j < SplineBasis::kAtOnce; ++j) {
      result[t] -=
          at.value[j] * coefficients(static_cast<Eigen::Index>(at.first + j), static_cast<Eigen::Index>(t));
    }
    if (!measured_.used[t]) result[t] = 0;
  }
}

// The pressure changes within a sample. The common slope is used to subtract the resulting change.
void TaxelFit::judgeWithin() {
  double squares = 0, number = 0;
  std::vector<double> mean;
  std::vector<dataset::ScanCounts> scans(measured_.recordings->begin(), measured_.recordings->end());
  for (std::size_t m = 0; m < measured_.samples(); ++m) {
    if (measured_.scans[m] < 2) continue;
    measured_.recorded(m, mean);
    const Visit& visit = measured_.visits[measured_.visit[m]];
    const dataset::Recording& recording = (*measured_.recordings)[visit.recording];
    const double slope = fit_.slope()[static_cast<Eigen::Index>(m)];
    const double middle = static_cast<double>(measured_.first_scan[m]) + (measured_.scans[m] - 1) / 2.0;
    for (std::size_t s = measured_.first_scan[m]; s < measured_.first_scan[m] + measured_.scans[m]; ++s) {
      const double period =
          recording.time[measured_.first_scan[m] + 1] - recording.time[measured_.first_scan[m]];
      const double moved = slope * measured_.rate[m] * (static_cast<double>(s) - middle) * period;
      const std::uint16_t* counts = scans[visit.recording][s];
      for (std::size_t t = 0; t < mean.size(); ++t) {
        if (!measured_.used[t]) continue;
        squares += std::pow(counts[t] / measured_.full_scale - mean[t] - moved, 2);
        ++number;
      }
    }
  }
  within_ = number > 0 ? squares / number : 0;
}

Spread spreadOf(const Measured& measured, const TaxelFit& taxels, const Trace& trace) {
  const auto rows = static_cast<Eigen::Index>(measured.taxels());
  const auto classes = static_cast<Eigen::Index>(measured.classes.size());
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(rows, classes), square = product;
  Eigen::VectorXd norm = Eigen::VectorXd::Zero(classes), samples = norm;
  std::vector<double> residual;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (measured.cycles[measured.cycle[i]].use == CycleUse::kHoldOut) continue;
    taxels.residuals(i, residual);
    const auto c = static_cast<Eigen::Index>(measured.classOf(i));
    const double x = trace[static_cast<Eigen::Index>(i)];
    const Eigen::Map<const Eigen::VectorXd> r(residual.data(), rows);
    product.col(c) += x * r;
    square.col(c) += r.cwiseAbs2();
    norm[c] += x * x;
    samples[c] += 1;
  }
  Spread spread;
  spread.amplitude = spread.error =
      Eigen::MatrixXd::Constant(rows, classes, std::numeric_limits<double>::quiet_NaN());
  double sum = 0, squares = 0, number = 0;
  for (Eigen::Index c = 0; c < classes; ++c) {
    for (Eigen::Index t = 0; t < rows; ++t) {
      if (!measured.used[static_cast<std::size_t>(t)] || norm[c] <= 0) continue;
      const double a = product(t, c) / norm[c];
      const double left = std::max(0.0, square(t, c) - a * a * norm[c]);
      spread.amplitude(t, c) = a;
      spread.error(t, c) = std::sqrt(left / std::max(1.0, samples[c] - 1) / norm[c]);
      const double weight = norm[c];  // an amplitude counts by the mean square it causes
      sum += weight * a;
      squares += weight * (a * a - std::pow(spread.error(t, c), 2));
      number += weight;
    }
  }
  const double scans = samples.sum() * static_cast<double>(measured.usedTaxels());
  spread.square = square.sum() / std::max(1.0, scans) + taxels.within();
  if (sum != 0) spread.local = std::clamp(squares * number / (sum * sum), 1.0, kMostLocal);
  return spread;
}

namespace {

constexpr double kOdd = 6;           // times the usual squared residual; noise differs by less
constexpr double kDeaf = 0.02;       // share of the usual variance of the readings within a visit
constexpr double kChanceFactor = 2;  // times the square that the mean of a line has by chance
constexpr double kMostOfLine = 0.6;  // share of a line's taxels; from it on the line is odd

// LineSums over the samples outside the hold-out cycles. The residuals of taxels and lines are relative to
// the mean residual of all used taxels.
struct LineSums {
  Eigen::VectorXd squares;                  // [taxels]
  Eigen::VectorXd lines[2];                 // squares of the means of rows, of columns
  Eigen::MatrixXd reading, reading_square;  // [taxels x visits]
  Eigen::VectorXd in_visit;                 // number of samples [visits]
  double common = 0;                        // squares of the mean residual
  double samples = 0;
};

class Judge {
 public:
  Judge(const Measured& measured, const TaxelFit& fit) : measured_(measured), fit_(fit) {
    for (std::size_t t = 0; t < measured.taxels(); ++t) {
      if (measured.used[t]) used_.push_back(t);
    }
    addUp();
  }
  OddTaxels run() const;

 private:
  std::size_t lineOf(std::size_t taxel, bool column) const {
    return column ? measured_.layout.column({taxel}) : measured_.layout.row({taxel});
  }
  std::vector<double> linesOf(const std::vector<double>& own, bool column) const;
  void addUp();
  bool isDeaf(std::size_t taxel) const;
  void judgeLines(bool column, OddTaxels& odd) const;
  double total() const {
    return sums_.squares.sum() +
           static_cast<double>(used_.size()) * (sums_.common + fit_.within() * sums_.samples);
  }

  const Measured& measured_;
  const TaxelFit& fit_;
  std::vector<std::size_t> used_;
  std::vector<double> members_[2];  // used taxels of each row, of each column
  LineSums sums_;
};

std::vector<double> Judge::linesOf(const std::vector<double>& own, bool column) const {
  std::vector<double> lines(column ? measured_.layout.size.columns : measured_.layout.size.rows, 0.0);
  for (const std::size_t t : used_) lines[lineOf(t, column)] += own[t];
  return lines;
}

void Judge::addUp() {
  const auto taxels = static_cast<Eigen::Index>(measured_.taxels());
  const auto visits = static_cast<Eigen::Index>(measured_.visits.size());
  sums_.squares = Eigen::VectorXd::Zero(taxels);
  sums_.reading = sums_.reading_square = Eigen::MatrixXd::Zero(taxels, visits);
  sums_.in_visit = Eigen::VectorXd::Zero(visits);
  for (const bool column : {false, true}) {
    members_[column] = linesOf(std::vector<double>(measured_.taxels(), 1.0), column);
    sums_.lines[column] = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(members_[column].size()));
  }
  std::vector<double> own, readings;
  for (std::size_t i = 0; i < measured_.samples(); ++i) {
    if (measured_.cycles[measured_.cycle[i]].use == CycleUse::kHoldOut) continue;
    fit_.residuals(i, own);
    measured_.readings(i, readings);
    double mean = 0;
    for (const std::size_t t : used_) mean += own[t] / static_cast<double>(used_.size());
    for (const std::size_t t : used_) own[t] -= mean;
    const auto v = static_cast<Eigen::Index>(measured_.visit[i]);
    const Eigen::Map<const Eigen::VectorXd> left(own.data(), taxels), read(readings.data(), taxels);
    sums_.squares += left.cwiseAbs2();
    sums_.reading.col(v) += read;
    sums_.reading_square.col(v) += read.cwiseAbs2();
    sums_.in_visit[v] += 1;
    for (const bool column : {false, true}) {
      const std::vector<double> lines = linesOf(own, column);
      for (std::size_t l = 0; l < lines.size(); ++l) {
        if (members_[column][l] > 0)
          sums_.lines[column][static_cast<Eigen::Index>(l)] += std::pow(lines[l] / members_[column][l], 2);
      }
    }
    sums_.common += mean * mean;
    sums_.samples += 1;
  }
}

bool Judge::isDeaf(std::size_t taxel) const {
  for (Eigen::Index v = 0; v < sums_.in_visit.size(); ++v) {
    const double n = std::max(1.0, sums_.in_visit[v]);
    const auto variance = [&](std::size_t t) {
      const auto at = static_cast<Eigen::Index>(t);
      return sums_.reading_square(at, v) / n - std::pow(sums_.reading(at, v) / n, 2);
    };
    std::vector<double> all;
    for (const std::size_t t : used_) all.push_back(variance(t));
    if (variance(taxel) < kDeaf * statistics::upperMedian(all)) return true;
  }
  return false;
}

// Finds lines whose taxels deviate together although no single taxel stands out.
void Judge::judgeLines(bool column, OddTaxels& odd) const {
  const double usual = sums_.squares.sum() / static_cast<double>(used_.size());
  std::vector<std::size_t> lines;
  double more = 0;
  for (Eigen::Index l = 0; l < sums_.lines[column].size(); ++l) {
    const double n = members_[column][static_cast<std::size_t>(l)];
    const double by_chance = n > 0 ? usual / n : 0;
    if (n < 3 || sums_.lines[column][l] < kChanceFactor * by_chance) continue;
    lines.push_back(static_cast<std::size_t>(l));
    more += n * (sums_.lines[column][l] - by_chance);
  }
  const double share = more / std::max(1e-300, total());
  if (share < thresholds::kLeastShareOfError || share <= odd.share) return;
  odd = {{}, column ? simulation::Covariate::kColumn : simulation::Covariate::kRow, share};
  for (const std::size_t t : used_) {
    if (std::count(lines.begin(), lines.end(), lineOf(t, column))) odd.taxels.push_back(t);
  }
}

OddTaxels Judge::run() const {
  OddTaxels odd;
  if (used_.size() < 4) return odd;
  std::vector<double> squares;
  for (const std::size_t t : used_) squares.push_back(sums_.squares[static_cast<Eigen::Index>(t)]);
  const double usual = statistics::upperMedian(squares);
  double more = 0;
  bool deaf = false;
  for (const std::size_t t : used_) {
    const double square = sums_.squares[static_cast<Eigen::Index>(t)];
    const bool is_deaf = isDeaf(t);
    if (!is_deaf && square < kOdd * usual) continue;
    odd.taxels.push_back(t);
    more += std::max(0.0, square - usual);
    deaf = deaf || is_deaf;
  }
  odd.share = more / std::max(1e-300, total());
  if (odd.share < thresholds::kLeastShareOfError && !deaf) odd = OddTaxels();
  for (const bool column : {false, true}) judgeLines(column, odd);
  if (odd.by != simulation::Covariate::kTaxel) return odd;
  for (const bool column : {false, true}) {
    std::map<std::size_t, double> in_line;
    for (const std::size_t t : odd.taxels) ++in_line[lineOf(t, column)];
    const bool whole = !in_line.empty() && std::all_of(in_line.begin(), in_line.end(), [&](const auto& line) {
      return line.second >= std::max(3.0, kMostOfLine * members_[column][line.first]);
    });
    if (whole) odd.by = column ? simulation::Covariate::kColumn : simulation::Covariate::kRow;
  }
  return odd;
}

}  // namespace

OddTaxels findOddTaxels(const Measured& measured, const TaxelFit& taxels) {
  return Judge(measured, taxels).run();
}

}  // namespace fsr::discrepancy
