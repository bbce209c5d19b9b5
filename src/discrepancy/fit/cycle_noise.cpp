#include "discrepancy/fit/cycle_noise.h"

#include <algorithm>
#include <cmath>

#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

using Index = Eigen::Index;

constexpr double kFastShare = 1.0 / 20, kSlowShare = 1.0 / 3;  // of a cycle
constexpr int kRounds = 8;                                     // of curves and noise in turn
constexpr int kMoreRounds = 3;                                 // the same, from a start that is near
constexpr int kSteps = 25;                                     // of the variances in each round
constexpr double kTinyRidge = 1e-9;  // keeps splines without data from being singular

Eigen::MatrixXd wandering(const CycleBins& bins, double time) {
  const Index n = bins.bins();
  Eigen::MatrixXd k(n, n);
  for (Index a = 0; a < n; ++a) {
    for (Index b = 0; b < n; ++b) k(a, b) = std::exp(-std::abs(bins.time[a] - bins.time[b]) / time);
  }
  return k;
}

class NoiseFitter {
 public:
  NoiseFitter(const CycleDesign& design, StaticModel& model) : design_(design), model_(model) {
    for (const CycleBins& bins : design.cycles) {
      parts_.push_back(CycleNoise::parts(bins, design.cycle_time));
      columns_.push_back(model.columns(bins));
      places_.push_back(model.places(bins));
      rows_ += static_cast<double>(bins.bins());
    }
  }

  CycleNoise run(const CycleNoise* start) {
    begin();
    if (start) startFrom(*start);
    const int rounds = start ? kMoreRounds : kRounds;
    for (int round = 0; round < rounds; ++round) {
      gather();
      if (!start && round < rounds - 1) choosePriors();
      stepVariances(StaticSolution(model_, gram_, right_));
    }
    return noise_;
  }

 private:
  Eigen::MatrixXd covariance(std::size_t c) const {
    Eigen::MatrixXd sum = noise_.variance[0] * parts_[c][0];
    for (std::size_t k = 1; k < CycleNoise::kParts; ++k) sum += noise_.variance[k] * parts_[c][k];
    return sum;
  }
  void begin() {
    double square = 0;
    for (const CycleBins& bins : design_.cycles) square += bins.white.mean();
    square /= static_cast<double>(design_.cycles.size());
    noise_.variance = {1, 1e2, 1e-6, square, square, square, 1e-6, 1e-6};
  }

  // A step multiplies each variance, so a part that is nearly 0 would never come back.
  void startFrom(const CycleNoise& start) {
    constexpr double kLeast = 1e-2;  // of the value that a fit without a start begins with
    for (std::size_t k = 0; k < CycleNoise::kParts; ++k)
      noise_.variance[k] = std::max(start.variance[k], kLeast * noise_.variance[k]);
  }

  void gather() {
    gram_.setZero(model_.size(), model_.size());
    right_.setZero(model_.size());
    for (std::size_t c = 0; c < design_.cycles.size(); ++c) {
      const Eigen::LLT<Eigen::MatrixXd> root(covariance(c));
      const Eigen::MatrixXd x = root.matrixL().solve(columns_[c]);
      const Eigen::VectorXd y = root.matrixL().solve(design_.cycles[c].reading);
      const Eigen::MatrixXd g = x.transpose() * x;
      const Eigen::VectorXd r = x.transpose() * y;
      for (std::size_t a = 0; a < places_[c].size(); ++a) {
        right_[places_[c][a]] += r[static_cast<Index>(a)];
        for (std::size_t b = 0; b < places_[c].size(); ++b)
          gram_(places_[c][a], places_[c][b]) += g(static_cast<Index>(a), static_cast<Index>(b));
      }
    }
  }

  // Twice the logarithm of the marginal likelihood, without constants. The determinant of the prior depends
  // on the stiffness through the second differences alone.
  double likelihood() const {
    const StaticSolution solution(model_, gram_, right_);
    const double log_prior = static_cast<double>(design_.classes) * static_cast<double>(design_.splines - 2) *
                             std::log(model_.stiffness);
    return right_.dot(solution.coefficients()) - solution.logDeterminant() + log_prior;
  }

  void choosePriors() {
    double best = -INFINITY, chosen = model_.stiffness;
    for (double e = 1; e <= 10; e += 0.5) {
      model_.stiffness = std::pow(10, e);
      const double now = likelihood();
      if (now > best) best = now, chosen = model_.stiffness;
    }
    model_.stiffness = chosen;
    updateVisits(StaticSolution(model_, gram_, right_));
  }

  // One step of the EM algorithm for the variances of the visits' gains and offsets.
  void updateVisits(const StaticSolution& solution) {
    double gain = 0, offset = 0, number = 0;
    for (std::size_t v = 0; v < design_.visits; ++v) {
      if (!design_.visited_again[v]) continue;
      const Index at = model_.visitAt(v);
      const std::size_t c = design_.class_of[v];
      gain += std::pow(solution.coefficients()[at], 2) + solution.variance(c, at);
      offset += std::pow(solution.coefficients()[at + 1], 2) + solution.variance(c, at + 1);
      ++number;
    }
    if (number == 0) return;
    model_.visit_gain = std::max(1e-10, gain / number);
    model_.visit_offset = std::max(1e-12, offset / number);
  }

  void stepVariances(const StaticSolution& fit) {
    const double freed = rows_ / std::max(rows_ / 2, rows_ - fit.degrees());
    std::vector<Eigen::VectorXd> left;
    for (std::size_t c = 0; c < design_.cycles.size(); ++c) {
      Eigen::VectorXd residual = design_.cycles[c].reading;
      for (std::size_t a = 0; a < places_[c].size(); ++a)
        residual -= fit.coefficients()[places_[c][a]] * columns_[c].col(static_cast<Index>(a));
      left.push_back(residual * std::sqrt(freed));
    }
    for (int step = 0; step < kSteps; ++step) {
      std::array<double, CycleNoise::kParts> pull{}, expected{};
      for (std::size_t c = 0; c < design_.cycles.size(); ++c) {
        const Eigen::LLT<Eigen::MatrixXd> root(covariance(c));
        const Index n = design_.cycles[c].bins();
        const Eigen::MatrixXd inverse = root.solve(Eigen::MatrixXd::Identity(n, n));
        const Eigen::VectorXd weighted = inverse * left[c];
        for (std::size_t k = 0; k < CycleNoise::kParts; ++k) {
          pull[k] += weighted.dot(parts_[c][k] * weighted);
          expected[k] += inverse.cwiseProduct(parts_[c][k]).sum();
        }
      }
      for (std::size_t k = 0; k < CycleNoise::kParts; ++k)
        noise_.variance[k] *= std::sqrt(pull[k] / std::max(expected[k], 1e-300));
      noise_.variance[CycleNoise::kWhite] = std::max(noise_.variance[CycleNoise::kWhite], 1e-3);
    }
  }

  const CycleDesign& design_;
  StaticModel& model_;
  CycleNoise noise_;
  std::vector<std::array<Eigen::MatrixXd, CycleNoise::kParts>> parts_;
  std::vector<Eigen::MatrixXd> columns_;
  std::vector<std::vector<Index>> places_;
  double rows_ = 0;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_;
};

}  // namespace

std::array<Eigen::MatrixXd, CycleNoise::kParts> CycleNoise::parts(const CycleBins& bins, double cycle_time) {
  std::array<Eigen::MatrixXd, kParts> parts;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(bins.bins());
  parts[kWhite] = bins.white.asDiagonal();
  parts[kReference] = Eigen::VectorXd(bins.slope.cwiseAbs2().cwiseQuotient(bins.scans)).asDiagonal();
  parts[kCorners] = Eigen::VectorXd(bins.corner).asDiagonal();
  parts[kFast] = wandering(bins, kFastShare * cycle_time);
  parts[kSlow] = wandering(bins, kSlowShare * cycle_time);
  parts[kCycleOffset] = ones * ones.transpose();
  parts[kCycleGain] = bins.net * bins.net.transpose();
  parts[kWanderingGain] = parts[kSlow].cwiseProduct(parts[kCycleGain]);
  return parts;
}

Eigen::MatrixXd CycleNoise::covariance(const CycleBins& bins, double cycle_time) const {
  const auto all = parts(bins, cycle_time);
  Eigen::MatrixXd sum = variance[0] * all[0];
  for (std::size_t k = 1; k < kParts; ++k) sum += variance[k] * all[k];
  return sum;
}

NoiseOfCycles noiseOf(const CycleDesign& design, const CycleNoise& noise) {
  double white = 0, scans = 0;
  for (const CycleBins& bins : design.cycles) {
    white += (bins.white.array() * bins.scans.array() * bins.scans.array()).sum();
    scans += bins.scans.sum();
  }
  return {noise, design.cycle_time, scans > 0 ? white / scans : 0};
}

StaticModel::StaticModel(const CycleDesign& design, std::vector<Index> chosen, std::vector<double> variances,
                         std::vector<bool> bent_only)
    : design_(design),
      chosen_(std::move(chosen)),
      variances_(std::move(variances)),
      bent_only_(std::move(bent_only)) {
  bent_only_.resize(chosen_.size(), false);
  visits_.resize(design.visits);
  for (std::size_t c = 0; c < design.classes; ++c) {
    starts_.push_back(size_);
    size_ += design.splines;
    for (std::size_t v = 0; v < design.visits; ++v) {
      if (design.class_of[v] != c) continue;
      visits_[v] = size_;
      size_ += 2;
    }
  }
  starts_.push_back(size_);
  size_ += static_cast<Index>(chosen_.size());
}

Index StaticModel::sizeOf(std::size_t curvature_class) const {
  return starts_[curvature_class + 1] - starts_[curvature_class];
}

Eigen::MatrixXd StaticModel::columns(const CycleBins& bins) const {
  const auto more = static_cast<Index>(chosen_.size());
  Eigen::MatrixXd columns(bins.bins(), design_.splines + 2 + more);
  columns.leftCols(design_.splines) = bins.splines;
  columns.col(design_.splines) = bins.net;
  columns.col(design_.splines + 1).setOnes();
  for (Index k = 0; k < more; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const bool off = bent_only_[at] && design_.flat[bins.curvature_class];
    columns.col(design_.splines + 2 + k) = bins.columns.col(chosen_[at]);
    if (off) columns.col(design_.splines + 2 + k).setZero();
  }
  return columns;
}

std::vector<Index> StaticModel::places(const CycleBins& bins) const {
  std::vector<Index> places;
  for (Index k = 0; k < design_.splines; ++k) places.push_back(startOf(bins.curvature_class) + k);
  places.push_back(visitAt(bins.visit));
  places.push_back(visitAt(bins.visit) + 1);
  for (Index k = 0; k < chosen(); ++k) places.push_back(starts_.back() + k);
  return places;
}

Eigen::MatrixXd StaticModel::prior() const {
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(size_, size_);
  const Index n = design_.splines;
  const Eigen::Vector3d difference(1, -2, 1);
  for (std::size_t c = 0; c < design_.classes; ++c) {
    for (Index k = startOf(c); k + 2 < startOf(c) + n; ++k)
      prior.block<3, 3>(k, k) += stiffness * difference * difference.transpose();
    prior.block(startOf(c), startOf(c), n, n).diagonal().array() += kTinyRidge;
  }
  for (std::size_t v = 0; v < design_.visits; ++v) {
    const Index at = visitAt(v);
    prior(at, at) = design_.visited_again[v] ? 1 / visit_gain : 1e12;
    prior(at + 1, at + 1) = design_.visited_again[v] ? 1 / visit_offset : 1e14;
  }
  for (std::size_t k = 0; k < chosen_.size(); ++k) {
    const Index at = starts_.back() + static_cast<Index>(k);
    prior(at, at) = 1 / variances_[k];
  }
  return prior;
}

StaticSolution::StaticSolution(const StaticModel& model, const Eigen::MatrixXd& gram,
                               const Eigen::VectorXd& right)
    : model_(model), gram_(gram), coefficients_(right.size()) {
  const Eigen::MatrixXd precision = gram + model.prior();
  const Index chosen = model.chosen(), last = model.size() - chosen;
  Eigen::MatrixXd left = precision.bottomRightCorner(chosen, chosen);
  Eigen::VectorXd pull = right.tail(chosen);
  const std::size_t classes = model.classes();
  for (std::size_t c = 0; c < classes; ++c) {
    const Index start = model.startOf(c), size = model.sizeOf(c);
    blocks_.push_back({Eigen::LLT<Eigen::MatrixXd>(precision.block(start, start, size, size)), {}});
    Block& block = blocks_.back();
    coefficients_.segment(start, size) = block.root.solve(right.segment(start, size));
    log_determinant_ += 2 * block.root.matrixLLT().diagonal().array().log().sum();
    if (chosen == 0) continue;
    const Eigen::MatrixXd across = precision.block(start, last, size, chosen);
    block.border = block.root.solve(across);
    left -= across.transpose() * block.border;
    pull -= across.transpose() * coefficients_.segment(start, size);
  }
  if (chosen == 0) return;
  const Eigen::LLT<Eigen::MatrixXd> root(left);
  log_determinant_ += 2 * root.matrixLLT().diagonal().array().log().sum();
  chosen_ = root.solve(Eigen::MatrixXd::Identity(chosen, chosen));
  coefficients_.tail(chosen) = chosen_ * pull;
  for (std::size_t c = 0; c < classes; ++c)
    coefficients_.segment(model.startOf(c), model.sizeOf(c)) -=
        blocks_[c].border * coefficients_.tail(chosen);
}

double StaticSolution::variance(std::size_t curvature_class, Index coefficient) const {
  const Block& block = blocks_[curvature_class];
  const Index at = coefficient - model_.startOf(curvature_class);
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(model_.sizeOf(curvature_class));
  unit[at] = 1;
  double variance = block.root.matrixL().solve(unit).squaredNorm();
  if (chosen_.size() > 0) variance += block.border.row(at) * chosen_ * block.border.row(at).transpose();
  return variance;
}

double StaticSolution::degrees() const {
  const Index chosen = model_.chosen(), last = model_.size() - chosen;
  double sum = chosen > 0 ? chosen_.cwiseProduct(gram_.bottomRightCorner(chosen, chosen)).sum() : 0;
  for (std::size_t c = 0; c < blocks_.size(); ++c) {
    const Index start = model_.startOf(c), size = model_.sizeOf(c);
    const Eigen::MatrixXd own = gram_.block(start, start, size, size);
    sum += blocks_[c].root.solve(own).trace();
    if (chosen == 0) continue;
    const Eigen::MatrixXd across = -blocks_[c].border * chosen_;
    sum += 2 * across.cwiseProduct(gram_.block(start, last, size, chosen)).sum();
    sum -= (across * blocks_[c].border.transpose()).cwiseProduct(own).sum();
  }
  return sum;
}

CycleNoise fitNoise(const CycleDesign& design, StaticModel& model, const CycleNoise* start) {
  return NoiseFitter(design, model).run(start);
}

namespace {

constexpr std::size_t kFewestCycles = 3;
constexpr double kNormal95 = 1.96;      // of a normal distribution: 95 % lie within
constexpr double kSeen = 0.5;           // relative standard error of a variance that can be told from 0
constexpr double kTellingSlope = 0.05;  // of the usual one: below it a reading tells nothing of the pressure

constexpr std::size_t kAll = CycleNoise::kParts;
using Parts = Eigen::Matrix<double, static_cast<int>(kAll), 1>;
using Square = Eigen::Matrix<double, static_cast<int>(kAll), static_cast<int>(kAll)>;

// ScatterSums over all bins of the variance that each part has at variance 1.
struct ScatterSums {
  Square information = Square::Zero();
  Parts reading = Parts::Zero();   // [share of full scale, squared]
  Parts pressure = Parts::Zero();  // [Pa^2]
  double scans = 0, scans_with_slope = 0;
};

double leastSlope(const CycleDesign& design) {
  std::vector<double> slopes;
  for (const CycleBins& bins : design.cycles) {
    for (Eigen::Index b = 0; b < bins.bins(); ++b) slopes.push_back(bins.slope[b]);
  }
  return kTellingSlope * statistics::upperMedian(slopes, 0);
}

void add(const CycleBins& bins, const std::array<Eigen::MatrixXd, kAll>& parts, double least,
         ScatterSums& sums) {
  for (Eigen::Index b = 0; b < bins.bins(); ++b) {
    const bool slope = bins.slope[b] >= least && bins.slope[b] > 0;
    sums.scans += bins.scans[b];
    if (slope) sums.scans_with_slope += bins.scans[b];
    for (std::size_t k = 0; k < kAll; ++k) {
      const double variance = bins.scans[b] * parts[k](b, b);
      const auto at = static_cast<Eigen::Index>(k);
      sums.reading[at] += variance;
      if (slope) sums.pressure[at] += variance / (bins.slope[b] * bins.slope[b]);
    }
  }
}

// I_kl = tr(S^-1 V_k S^-1 V_l) / 2, added up over the cycles.
ScatterSums sumsOf(const CycleDesign& design, const CycleNoise& noise) {
  ScatterSums sums;
  const double least = leastSlope(design);
  for (const CycleBins& bins : design.cycles) {
    const auto parts = CycleNoise::parts(bins, design.cycle_time);
    const Eigen::LLT<Eigen::MatrixXd> root(noise.covariance(bins, design.cycle_time));
    std::array<Eigen::MatrixXd, kAll> solved;
    for (std::size_t k = 0; k < kAll; ++k) solved[k] = root.solve(parts[k]);
    for (std::size_t k = 0; k < kAll; ++k) {
      for (std::size_t l = 0; l < kAll; ++l)
        sums.information(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)) +=
            0.5 * solved[k].cwiseProduct(solved[l].transpose()).sum();
    }
    add(bins, parts, least, sums);
  }
  return sums;
}

// Covariance of the variances. Their units differ by many orders, so the information is scaled first. A part
// that these cycles do not have (no corners, say) has no information and is left out.
Square covarianceOf(const Square& information) {
  Parts scale = Parts::Zero();
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    if (information(k, k) > 0) scale[k] = 1 / std::sqrt(information(k, k));
  }
  Square scaled = scale.asDiagonal() * information * scale.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  return scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
}

Interval intervalOf(double variance, double error) {
  if (!(variance > 0) || error > kSeen * variance) return {0, std::sqrt(variance + kNormal95 * error)};
  const double factor = std::exp(0.5 * kNormal95 * error / variance);
  return {std::sqrt(variance) / factor, std::sqrt(variance) * factor};
}

}  // namespace

std::vector<Scatter> scatterOf(const CycleDesign& design, const CycleNoise& noise) {
  if (design.cycles.size() < kFewestCycles) return {};
  const ScatterSums sums = sumsOf(design, noise);
  const Square covariance = covarianceOf(sums.information);
  Parts variance;
  for (std::size_t k = 0; k < kAll; ++k) variance[static_cast<Eigen::Index>(k)] = noise.variance[k];
  const double total = sums.reading.dot(variance);
  // `weight`: of each part's variance in the square of the size.
  const auto scatter = [&](const std::string& name, const std::string& unit, const Parts& weight) {
    Scatter one{name, unit, 0, {}, 0, 0};
    const double square = weight.dot(variance);
    one.size = std::sqrt(square);
    one.interval = intervalOf(square, std::sqrt(std::max(0.0, weight.dot(covariance * weight))));
    const Parts taken = (weight.array() != 0).select(variance, Parts::Zero());
    one.at_map = std::sqrt(sums.pressure.dot(taken) / std::max(1.0, sums.scans_with_slope));
    one.of_noise = total > 0 ? sums.reading.dot(taken) / total : 0;
    return one;
  };
  Parts wandering = Parts::Zero();
  for (const CycleNoise::Part part : {CycleNoise::kSlow, CycleNoise::kWanderingGain})
    wandering[part] = sums.reading[part] / sums.scans;
  return {scatter("cycle_gain", "share", Parts::Unit(CycleNoise::kCycleGain)),
          scatter("cycle_offset", "share of full scale", Parts::Unit(CycleNoise::kCycleOffset)),
          scatter("wandering", "share of full scale", wandering)};
}

}  // namespace fsr::discrepancy
