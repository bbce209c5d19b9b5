#include "discrepancy/fit/mains.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "discrepancy/thresholds.h"
#include "simulation/effects/effect_library.h"
#include "statistics/median.h"

namespace fsr::discrepancy {

namespace {

constexpr double kLeastTurns = 0.4;  // least turns of the phase over the whole scan
constexpr double kLeastZ = 8;        // least z score of the peak among the patterns
constexpr double kRound = 0.5;       // largest |sum z^2| / sum |z|^2 of a course through all phases
constexpr std::size_t kFewestTaxels = 8;
constexpr double kMainsFrequency = 50;  // assumed [Hz]

// Readings of the used taxels, minus their static curves and minus the mean residual of these taxels.
class Residuals {
 public:
  Residuals(const Measured& measured, const TaxelFit& taxels) : measured_(measured), taxels_(taxels) {
    for (std::size_t t = 0; t < measured.taxels(); ++t) {
      if (measured.used[t]) place_.push_back(t);
    }
  }
  std::size_t size() const { return place_.size(); }
  double place(std::size_t k) const { return static_cast<double>(place_[k]); }
  void at(std::size_t sample, Eigen::VectorXd& result) {
    taxels_.residuals(sample, all_);
    for (std::size_t k = 0; k < place_.size(); ++k) result[static_cast<Eigen::Index>(k)] = all_[place_[k]];
    result.array() -= result.mean();
  }

 private:
  const Measured& measured_;
  const TaxelFit& taxels_;
  std::vector<std::size_t> place_;
  std::vector<double> all_;
};

Eigen::MatrixXd covarianceOf(const Measured& measured, Residuals& residuals) {
  const auto n = static_cast<Eigen::Index>(residuals.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd now(n);
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    residuals.at(i, now);
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(now);
  }
  covariance /= static_cast<double>(measured.samples());
  return covariance.selfadjointView<Eigen::Lower>();
}

Eigen::VectorXcd patternOf(const Residuals& residuals, double turn) {
  Eigen::VectorXcd pattern(static_cast<Eigen::Index>(residuals.size()));
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    pattern[static_cast<Eigen::Index>(k)] =
        std::polar(1 / std::sqrt(static_cast<double>(residuals.size())), turn * residuals.place(k));
  }
  return pattern;
}

}  // namespace

Mains findMains(const Measured& measured, const TaxelFit& taxels) {
  Mains mains;
  Residuals residuals(measured, taxels);
  if (residuals.size() < kFewestTaxels) return mains;
  const Eigen::MatrixXd covariance = covarianceOf(measured, residuals);
  const auto n = static_cast<double>(measured.taxels());
  std::vector<double> powers, turns;
  for (double turn = kLeastTurns * 2 * M_PI / n; turn < M_PI; turn += M_PI / (2 * n)) {
    const Eigen::VectorXcd w = patternOf(residuals, turn);
    powers.push_back((w.adjoint() * covariance * w).value().real());
    turns.push_back(turn);
  }
  const double usual = statistics::upperMedian(powers);
  std::vector<double> deviations;
  for (const double power : powers) deviations.push_back(std::abs(power - usual));
  const auto peak = static_cast<std::size_t>(std::max_element(powers.begin(), powers.end()) - powers.begin());
  const double excess = powers[peak] - usual;
  const double total = covariance.trace() / static_cast<double>(residuals.size()) + taxels.within();
  mains.turn = turns[peak];
  mains.z = excess / std::max(1e-300, statistics::kDeviationPerMedian * statistics::upperMedian(deviations));
  mains.share = total > 0 ? 2 * excess / static_cast<double>(residuals.size()) / total : 0;
  mains.amplitude = 2 * std::sqrt(excess / static_cast<double>(residuals.size()));
  if (mains.z < kLeastZ || mains.share < thresholds::kLeastShareOfError) return mains;
  const Eigen::VectorXcd pattern = patternOf(residuals, mains.turn);
  const auto samples = static_cast<Eigen::Index>(measured.samples());
  mains.cosine.resize(samples);
  mains.sine.resize(samples);
  Eigen::VectorXd now(static_cast<Eigen::Index>(residuals.size()));
  std::vector<std::complex<double>> square(measured.visits.size());
  std::complex<double> turned = 0, before = 0;
  double size = 0, seconds = 0, steps = 0;
  for (Eigen::Index i = 0; i < samples; ++i) {
    const auto sample = static_cast<std::size_t>(i);
    residuals.at(sample, now);
    const std::complex<double> z = pattern.dot(now.cast<std::complex<double>>());
    mains.cosine[i] = z.real();
    mains.sine[i] = z.imag();
    square[measured.visit[sample]] += z * z;
    size += std::norm(z);
    if (i > 0 && measured.visit[sample] == measured.visit[sample - 1]) {
      turned += std::conj(before) * z;
      seconds += measured.time[sample] - measured.time[sample - 1];
      ++steps;
    }
    before = z;
  }
  mains.beat = steps > 0 ? std::arg(turned) / (2 * M_PI) / (seconds / steps) : 0;
  double one_phase = 0;  // a pattern that changes only between visits is not hum either
  for (const std::complex<double>& sum : square) one_phase += std::abs(sum);
  mains.found = one_phase < kRound * (size - static_cast<double>(samples) * usual);
  return mains;
}

void takeOut(const Mains& mains, const StaticFit& fit, CommonTraces& common) {
  Eigen::MatrixXd course(mains.cosine.size(), 2);
  course << mains.cosine, mains.sine;
  const Eigen::MatrixXd normal = course.transpose() * course;
  for (Trace* trace : {&common.all, &common.halves[0], &common.halves[1]}) {
    const Eigen::Vector2d weights = normal.ldlt().solve(course.transpose() * fit.residual(*trace));
    *trace -= course * weights;
  }
}

simulation::EnabledEffect asEffect(const Mains& mains, double full_scale) {
  simulation::EnabledEffect effect{simulation::foundBy(simulation::Detector::kMains).id, {}};
  for (const simulation::EffectParameter& parameter : simulation::findEffect(effect.id)->info.parameters) {
    effect.values[parameter.name] = parameter.usual;
  }
  effect.values["amplitude"] = mains.amplitude * full_scale;
  effect.values["frequency"] = kMainsFrequency + mains.beat;
  effect.values["taxel_time"] = std::abs(mains.turn) / (2 * M_PI * kMainsFrequency);
  return effect;
}

}  // namespace fsr::discrepancy
