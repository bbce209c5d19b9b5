#include "discrepancy/decide/cycle_gains.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "statistics/random_stream.h"

namespace fsr::discrepancy {

namespace {

using Index = Eigen::Index;

constexpr Index kFewestFree = 4;  // cycles beyond the constants of the mounts
constexpr std::array<double, 7> kCorrelations = {0,   0.2, 0.4, 0.6,
                                                 0.8, 0.9, 0.95};  // of one cycle to the next

// Slope of a course of the cycle against the static readings, both with an offset.
double gainOf(const CycleBins& bins, const Eigen::VectorXd& course) {
  const Eigen::ArrayXd weight = bins.white.array().max(1e-300).inverse();
  const Eigen::ArrayXd net = bins.net.array() - (weight * bins.net.array()).sum() / weight.sum();
  const double square = (weight * net.square()).sum();
  return square > 0 ? (weight * net * course.array()).sum() / square : 0;
}

// A signature of a slow effect.
struct SlowColumn {
  std::size_t explanation;
  Index column;
  bool free, bent_only;
};

std::vector<SlowColumn> slowColumns(const std::vector<Explaining>& explanations) {
  std::vector<SlowColumn> all;
  for (std::size_t e = 0; e < explanations.size(); ++e) {
    if (!explanations[e].slow || !explanations[e].single()) continue;
    for (const Form& form : explanations[e].forms) {
      for (std::size_t k = 0; k < form.columns.size() && !form.fitted; ++k)
        all.push_back({e, form.columns[k], form.free[k], form.bent_only});
    }
  }
  return all;
}

// The test at one correlation of the noise: what is left of the gains beside the constants of the mounts.
class Correlated {
 public:
  Correlated(const CycleDesign& design, double correlation, const Eigen::MatrixXd& columns)
      : correlation_(correlation), constants_(columns.rows()) {
    for (const CycleBins& bins : design.cycles) {
      firsts_.push_back(visits_.empty() || visits_.back() != bins.visit);
      visits_.push_back(bins.visit);
    }
    constants_.setOnes();
    constants_ = decorrelated(constants_);
    Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(static_cast<Index>(design.visits));
    for (std::size_t c = 0; c < visits_.size(); ++c)
      squares[static_cast<Index>(visits_[c])] += std::pow(constants_[static_cast<Index>(c)], 2);
    for (std::size_t c = 0; c < visits_.size(); ++c) {
      constants_[static_cast<Index>(c)] /= std::sqrt(squares[static_cast<Index>(visits_[c])]);
      if (firsts_[c]) constant_ += std::log(1 - correlation * correlation) / 2;
    }
    for (Index v = 0; v < squares.size(); ++v) {
      if (!(squares[v] > 0)) continue;  // none of its cycles may be fitted
      constant_ -= std::log(squares[v]) / 2;
      ++mounts_;
    }
    columns_ = whitened(columns);
    for (Index k = 0; k < columns_.cols(); ++k) {
      const double norm = columns_.col(k).norm();
      columns_.col(k) *= norm > 1e-9 * columns.col(k).norm() ? 1 / norm : 0;
    }
  }

  // Restricted log likelihood of the gains without an effect [1 x draws], and with one column [columns x
  // draws].
  Eigen::ArrayXXd without(const Eigen::MatrixXd& gains) const {
    return logLikelihood(whitened(gains).colwise().squaredNorm().array());
  }
  Eigen::ArrayXXd with(const Eigen::MatrixXd& gains, const std::vector<SlowColumn>& slow) const {
    const Eigen::MatrixXd left = whitened(gains);
    Eigen::ArrayXXd explained = (columns_.transpose() * left).array();
    for (Index k = 0; k < explained.rows(); ++k) {
      if (!slow[static_cast<std::size_t>(k)].free) explained.row(k) = explained.row(k).max(0.0);
    }
    return logLikelihood(left.colwise().squaredNorm().array().replicate(explained.rows(), 1) -
                         explained.square());
  }

 private:
  Eigen::ArrayXXd logLikelihood(const Eigen::ArrayXXd& squares) const {
    const auto free = static_cast<double>(columns_.rows() - mounts_);
    return constant_ - free / 2 * squares.max(1e-300).log();
  }

  Eigen::MatrixXd decorrelated(const Eigen::MatrixXd& courses) const {
    Eigen::MatrixXd result = courses;
    for (Index c = 0; c < courses.rows(); ++c) {
      if (firsts_[static_cast<std::size_t>(c)])
        result.row(c) *= std::sqrt(1 - correlation_ * correlation_);
      else
        result.row(c) -= correlation_ * courses.row(c - 1);
    }
    return result;
  }
  // Without the constants of the mounts.
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& courses) const {
    Eigen::MatrixXd result = decorrelated(courses);
    std::map<std::size_t, Eigen::RowVectorXd> sums;  // of each visit
    for (Index c = 0; c < result.rows(); ++c) {
      Eigen::RowVectorXd& sum = sums[visits_[static_cast<std::size_t>(c)]];
      if (sum.size() == 0) sum.setZero(result.cols());
      sum += constants_[c] * result.row(c);
    }
    for (Index c = 0; c < result.rows(); ++c)
      result.row(c) -= constants_[c] * sums[visits_[static_cast<std::size_t>(c)]];
    return result;
  }

  double correlation_;               // of one cycle to the next of the same visit
  std::vector<std::size_t> visits_;  // of each cycle
  std::vector<bool> firsts_;         // the cycle before it is of another visit
  Eigen::VectorXd constants_;        // a constant of each visit, decorrelated, of length 1
  Eigen::MatrixXd columns_;          // whitened, of length 1
  double constant_ = 0;              // of the restricted likelihood
  Index mounts_ = 0;
};

class GainTest {
 public:
  GainTest(const CycleDesign& design, std::vector<SlowColumn> slow)
      : design_(design), slow_(std::move(slow)) {
    const auto n = static_cast<Index>(design.cycles.size());
    gains_.resize(n, 1);
    columns_.resize(n, static_cast<Index>(slow_.size()));
    for (Index c = 0; c < n; ++c) {
      const CycleBins& bins = design.cycles[static_cast<std::size_t>(c)];
      gains_(c, 0) = gainOf(bins, bins.reading);
      for (std::size_t k = 0; k < slow_.size(); ++k) {
        const bool off = slow_[k].bent_only && design.flat[bins.curvature_class];
        columns_(c, static_cast<Index>(k)) = off ? 0 : gainOf(bins, bins.columns.col(slow_[k].column));
      }
    }
    for (const double correlation : kCorrelations) noises_.emplace_back(design, correlation, columns_);
  }

  // Of the gains as they were measured [columns].
  Eigen::ArrayXd ratios() const { return ratios(gains_).col(0); }
  // The largest one of each draw of the noise that was fitted without an effect.
  std::vector<double> largestByChance(std::size_t draws, std::uint64_t seed) const {
    std::size_t best = 0;
    for (std::size_t r = 1; r < noises_.size(); ++r) {
      if (noises_[r].without(gains_)(0, 0) > noises_[best].without(gains_)(0, 0)) best = r;
    }
    const Eigen::ArrayXXd drawn = ratios(noise(kCorrelations[best], static_cast<Index>(draws), seed));
    std::vector<double> largest;
    for (Index d = 0; d < drawn.cols(); ++d) largest.push_back(drawn.col(d).maxCoeff());
    return largest;
  }

 private:
  // [columns x draws]
  Eigen::ArrayXXd ratios(const Eigen::MatrixXd& gains) const {
    Eigen::ArrayXXd with = noises_.front().with(gains, slow_), without = noises_.front().without(gains);
    for (const Correlated& noise : noises_) {
      with = with.max(noise.with(gains, slow_));
      without = without.max(noise.without(gains));
    }
    return with - without.replicate(with.rows(), 1);
  }
  // Gains that are noise alone; its size does not matter [cycles x draws].
  Eigen::MatrixXd noise(double correlation, Index draws, std::uint64_t seed) const {
    Eigen::MatrixXd drawn(gains_.rows(), draws);
    for (Index d = 0; d < draws; ++d) {
      const auto stream = statistics::randomStream(seed, "discrepancy.gains", static_cast<std::uint64_t>(d));
      for (Index c = 0; c < drawn.rows(); ++c) {
        const double fresh = stream.normal(static_cast<std::uint64_t>(c));
        const auto at = static_cast<std::size_t>(c);
        const bool first = c == 0 || design_.cycles[at - 1].visit != design_.cycles[at].visit;
        drawn(c, d) =
            first ? fresh : correlation * drawn(c - 1, d) + std::sqrt(1 - correlation * correlation) * fresh;
      }
    }
    return drawn;
  }

  const CycleDesign& design_;
  const std::vector<SlowColumn> slow_;
  Eigen::MatrixXd gains_;    // [cycles x 1]
  Eigen::MatrixXd columns_;  // [cycles x columns]
  std::vector<Correlated> noises_;
};

}  // namespace

std::vector<double> chanceByGains(const CycleDesign& design, const std::vector<Explaining>& explanations,
                                  std::size_t draws, std::uint64_t seed) {
  std::vector<double> p(explanations.size(), 1);
  const std::vector<SlowColumn> slow = slowColumns(explanations);
  if (slow.empty() || design.cycles.size() < design.visits + kFewestFree) return p;
  const GainTest test(design, slow);
  const std::vector<double> largest = test.largestByChance(draws, seed);
  const Eigen::ArrayXd ratios = test.ratios();
  for (std::size_t k = 0; k < slow.size(); ++k) {
    const auto above = std::count_if(largest.begin(), largest.end(), [&](double by_chance) {
      return by_chance >= ratios[static_cast<Index>(k)];
    });
    p[slow[k].explanation] =
        std::min(p[slow[k].explanation], (1 + static_cast<double>(above)) / (1 + static_cast<double>(draws)));
  }
  return p;
}

}  // namespace fsr::discrepancy
