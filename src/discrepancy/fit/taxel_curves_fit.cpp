#include "discrepancy/fit/taxel_curves_fit.h"

#include <algorithm>
#include <cmath>

#include "dataset/count_readers.h"
#include "discrepancy/fit/signatures.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

// Each degree of freedom counts so often, which guards against too little smoothing (Kim and Gu 2004).
constexpr double kInflated = 1.4;
constexpr double kStep = 2;          // factor between the weights that are tried
constexpr double kForbidden = 1e6;   // weight of a slope that is too low, relative to the mean normal
constexpr double kTolerated = 1e-9;  // slope below the least
constexpr int kMostPenaltyRounds = 40;
constexpr int kReleases = 20;  // rounds in which a slope that was forbidden may rise again

}  // namespace

SplineSums::SplineSums(std::size_t knots)
    : normal_(
          Eigen::MatrixXd::Zero(2 * static_cast<Eigen::Index>(knots), 2 * static_cast<Eigen::Index>(knots))),
      right_(Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(knots))) {}

void SplineSums::add(const simulation::SplineWeights& weights, double slope, double value) {
  const Eigen::Index knots = right_.size() / 2, k = static_cast<Eigen::Index>(weights.knot);
  const Eigen::Index at[] = {k, k + 1, knots + k, knots + k + 1};
  const double x[] = {slope * weights.below, slope * weights.above, slope * weights.below_bend,
                      slope * weights.above_bend};
  for (int a = 0; a < 4; ++a) {
    right_[at[a]] += x[a] * value;
    for (int b = 0; b < 4; ++b) normal_(at[a], at[b]) += x[a] * x[b];
  }
  square_ += value * value;
  ++number_;
}

Eigen::MatrixXd SplineSums::normal(const Eigen::MatrixXd& bends) const {
  const Eigen::Index n = right_.size() / 2;
  const Eigen::MatrixXd cross = normal_.topRightCorner(n, n) * bends;
  return normal_.topLeftCorner(n, n) + cross + cross.transpose() +
         bends.transpose() * normal_.bottomRightCorner(n, n) * bends;
}

Eigen::VectorXd SplineSums::right(const Eigen::MatrixXd& bends) const {
  const Eigen::Index n = right_.size() / 2;
  return right_.head(n) + bends.transpose() * right_.tail(n);
}

Eigen::MatrixXd secondDifferences(Eigen::Index knots) {
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(knots, knots);
  for (Eigen::Index k = 1; k + 1 < knots; ++k) {
    const Eigen::Vector3d bend(1, -2, 1);
    squares.block<3, 3>(k - 1, k - 1) += bend * bend.transpose();
  }
  return squares;
}

PenalisedSpline::PenalisedSpline(Eigen::MatrixXd normal, Eigen::VectorXd right, double square, double number)
    : normal_(std::move(normal)), right_(std::move(right)), square_(square), number_(number) {
  const Eigen::MatrixXd rough = secondDifferences(normal_.rows());
  unit_ = std::max(normal_.diagonal().mean(), 1e-12);
  normal_ += kLeastWeight * unit_ * rough;
  normal_.diagonal().array() += 1e-12 * unit_;  // where fewer than two loads occur
  const Eigen::LLT<Eigen::MatrixXd> factor(normal_);
  const Eigen::MatrixXd half = factor.matrixL().solve(rough);
  const Eigen::MatrixXd both = factor.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (both + both.transpose()));
  roughness_ = eigen.eigenvalues().cwiseMax(0);
  back_ = factor.matrixU().solve(eigen.eigenvectors());
}

PenalisedSpline::PenalisedSpline(const PenalisedSpline& like, Eigen::VectorXd right, double square,
                                 double number)
    : PenalisedSpline(like) {
  right_ = std::move(right);
  square_ = square;
  number_ = number;
}

Eigen::VectorXd PenalisedSpline::values(double weight) const {
  const Eigen::ArrayXd shrunk = 1 / (1 + penalty(weight) * roughness_.array());
  return back_ * (shrunk * (back_.transpose() * right_).array()).matrix();
}

double PenalisedSpline::crossValidated(double weight) const {
  const Eigen::ArrayXd shrunk = 1 / (1 + penalty(weight) * roughness_.array());
  const Eigen::ArrayXd own = 1 - kLeastWeight * unit_ * roughness_.array();  // of the data alone
  const Eigen::ArrayXd squared = (back_.transpose() * right_).array().square();
  const double error = square_ - 2 * (shrunk * squared).sum() + (shrunk.square() * squared * own).sum();
  const double freedom = number_ - kInflated * (shrunk * own).sum();
  if (freedom < 1) return INFINITY;
  return number_ * std::max(0.0, error) / (freedom * freedom);
}

// Forbidden slopes are drawn to the least slope by a large weight, until the set of them stays the same.
// Where the data draw such a slope upwards, it is set free again.
Eigen::VectorXd PenalisedSpline::valuesRising(double weight, const Eigen::MatrixXd& slopes,
                                              const Eigen::VectorXd& least) const {
  Eigen::VectorXd values = this->values(weight);
  const Eigen::MatrixXd plain = normal_ + penalty(weight) * secondDifferences(normal_.rows());
  std::vector<bool> active(static_cast<std::size_t>(least.size()), false);
  for (int round = 0; round < kMostPenaltyRounds; ++round) {
    const Eigen::VectorXd slope = slopes * values;
    bool changed = false;
    for (Eigen::Index k = 0; k < least.size(); ++k) {
      const bool now = active[static_cast<std::size_t>(k)];
      const bool release = now && round < kReleases && slope[k] > least[k];
      if (now ? !release : slope[k] >= least[k] - kTolerated) continue;
      active[static_cast<std::size_t>(k)] = !now;
      changed = true;
    }
    if (!changed) break;
    Eigen::MatrixXd normal = plain;
    Eigen::VectorXd right = right_;
    for (Eigen::Index k = 0; k < least.size(); ++k) {
      if (!active[static_cast<std::size_t>(k)]) continue;
      const double heavy = kForbidden * unit_ / std::max(1e-300, slopes.row(k).squaredNorm());
      normal += heavy * slopes.row(k).transpose() * slopes.row(k);
      right += heavy * least[k] * slopes.row(k).transpose();
    }
    values = normal.ldlt().solve(right);
  }
  return values;
}

double chooseWeight(const std::vector<PenalisedSpline>& splines) {
  double best = PenalisedSpline::kLeastWeight, least = INFINITY;
  for (double weight = PenalisedSpline::kLeastWeight; weight <= PenalisedSpline::kMostWeight;
       weight *= kStep) {
    double sum = 0;
    for (const PenalisedSpline& spline : splines)
      sum += spline.number() > 0 ? spline.crossValidated(weight) : 0;
    if (sum >= least) continue;
    least = sum;
    best = weight;
  }
  return best;
}

namespace {

constexpr std::size_t kMostCurveKnots = 40, kFewestCurveKnots = 4;
constexpr std::size_t kScansPerKnot = 5;
constexpr double kDenser = 0.35;  // spacing of the first knots, relative to even spacing
constexpr double kProbe =
    1e-3;  // change of the curves with which the slope is measured [share of full scale]
constexpr double kSameSlope = 1e-6;
constexpr int kMostNewtonRounds = 4;  // of Gauss and Newton, where the read-out is not linear
constexpr double kSettled = 1e-5;     // change of a curve after which they end [share of full scale]
constexpr double kWithin = 0.5;       // between two knots: where the curve must not fall either
constexpr double kLeastSlope = 1e-3;  // relative to a linear read-out; below it a reading tells nothing

using Curves = simulation::TaxelCurves;

// The knots lie closer at low load, where the static law bends most.
std::vector<double> knotsOver(double low, double high, std::size_t scans) {
  const std::size_t knots = std::clamp(scans / kScansPerKnot, kFewestCurveKnots, kMostCurveKnots);
  std::vector<double> result;
  for (std::size_t k = 0; k < knots; ++k) {
    const double even = static_cast<double>(k) / static_cast<double>(knots - 1);
    result.push_back(low + (high - low) * even * (kDenser + (1 - kDenser) * even));
  }
  return result;
}

// Curves that are 0 everywhere, with their knots over the loads that occur.
Curves emptyCurves(const FitView& fit, const simulation::SimulationSettings& simulation) {
  Curves curves;
  curves.taxels = fit.taxels();
  for (std::size_t c = 0; c < fit.classes(); ++c) {
    if (fit.covered(c).low > fit.covered(c).high) continue;
    curves.surfaces.push_back({fit.curvatureOf(c), {0, 1}, std::vector<double>(2 * curves.taxels, 0.0)});
  }
  simulation::SimulationSettings flat = simulation;
  flat.taxel_curves = std::make_shared<const Curves>(curves);
  struct Range {
    double low = INFINITY, high = -INFINITY;
    std::size_t scans = 0;
  };
  std::vector<Range> ranges(curves.surfaces.size());
  driveRecordings(fit.recordings(), flat,
                  [&](std::size_t r, std::size_t i, const simulation::SensorChain& chain) {
                    if (fit.sampleOf(r, i) == FitView::kNotInView) return;
                    Range& range = ranges[chain.curvesSurface()];
                    const std::vector<double>& load = chain.signals().load;
                    const auto [low, high] = std::minmax_element(load.begin(), load.end());
                    range.low = std::min(range.low, *low);
                    range.high = std::max(range.high, *high);
                    ++range.scans;
                  });
  for (std::size_t s = curves.surfaces.size(); s-- > 0;) {
    if (ranges[s].scans == 0) {
      curves.surfaces.erase(curves.surfaces.begin() + static_cast<std::ptrdiff_t>(s));
      continue;
    }
    curves.surfaces[s].load =
        knotsOver(ranges[s].low, std::max(ranges[s].high, ranges[s].low + 1), ranges[s].scans);
    curves.surfaces[s].added.assign(curves.surfaces[s].load.size() * curves.taxels, 0.0);
  }
  return curves;
}

// Static readings of every taxel at loads, by the simulation alone, [loads x taxels] [share of full scale].
Eigen::MatrixXd staticReadings(const simulation::SimulationSettings& simulation,
                               const std::vector<double>& loads) {
  simulation::SimulationSettings plain = simulation;
  plain.taxel_curves.reset();
  auto& effects = plain.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(),
                               [&](const simulation::EnabledEffect& effect) {
                                 return !simulation::libraryOf(simulation).info(effect.id).required;
                               }),
                effects.end());
  simulation::SensorChain chain(plain);
  Eigen::MatrixXd readings(static_cast<Eigen::Index>(loads.size()),
                           static_cast<Eigen::Index>(plain.layout.size.taxels()));
  simulation::RigSample sample;
  for (std::size_t k = 0; k < loads.size(); ++k) {
    sample.pressure = loads[k];
    sample.time = static_cast<double>(k);
    chain.read(sample);
    for (Eigen::Index t = 0; t < readings.cols(); ++t) {
      readings(static_cast<Eigen::Index>(k), t) =
          chain.reading()[static_cast<std::size_t>(t)] / chain.fullScale();
    }
  }
  return readings;
}

// Fits the curves of one surface.
class SurfaceFit {
 public:
  SurfaceFit(const Curves::OnSurface& surface, std::size_t taxels,
             const simulation::SimulationSettings& simulation);

  void add(std::size_t taxel, double load, double slope, double wanted) {
    sums_[taxel].add(simulation::splineWeights(knots_, load), slope, wanted);
  }
  // Returns the values at the knots, [knots x taxels].
  std::vector<double> solved() const;

 private:
  std::vector<double> knots_;
  Eigen::MatrixXd bends_;
  std::vector<SplineSums> sums_;  // of each taxel
  Eigen::MatrixXd steps_;         // from values at the knots to rises from place to place
  Eigen::MatrixXd static_steps_;  // rises of the static law, [places x taxels]
};

SurfaceFit::SurfaceFit(const Curves::OnSurface& surface, std::size_t taxels,
                       const simulation::SimulationSettings& simulation)
    : knots_(surface.load), sums_(taxels, SplineSums(knots_.size())) {
  const auto n = static_cast<Eigen::Index>(knots_.size());
  const std::vector<double> bends = simulation::splineBends(knots_);
  bends_ = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      bends.data(), n, n);
  std::vector<double> places;
  for (std::size_t k = 0; k + 1 < knots_.size(); ++k) {
    places.push_back(knots_[k]);
    places.push_back(knots_[k] + kWithin * (knots_[k + 1] - knots_[k]));
  }
  places.push_back(knots_.back());
  Eigen::MatrixXd at = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(places.size()), n);
  for (std::size_t p = 0; p < places.size(); ++p) {
    const simulation::SplineWeights w = simulation::splineWeights(knots_, places[p]);
    const auto row = static_cast<Eigen::Index>(p), k = static_cast<Eigen::Index>(w.knot);
    at(row, k) += w.below;
    at(row, k + 1) += w.above;
    at.row(row) += w.below_bend * bends_.row(k) + w.above_bend * bends_.row(k + 1);
  }
  const Eigen::Index rises = at.rows() - 1;
  steps_ = at.bottomRows(rises) - at.topRows(rises);
  const Eigen::MatrixXd readings = staticReadings(simulation, places);
  static_steps_ = readings.bottomRows(rises) - readings.topRows(rises);
}

std::vector<double> SurfaceFit::solved() const {
  std::vector<PenalisedSpline> splines;
  for (std::size_t t = 0; t < sums_.size(); ++t) {
    const SplineSums& sums = sums_[t];
    if (t > 0 && sums.sameDesign(sums_[t - 1])) {
      splines.emplace_back(splines.back(), sums.right(bends_), sums.square(), sums.number());
    } else {
      splines.emplace_back(sums.normal(bends_), sums.right(bends_), sums.square(), sums.number());
    }
  }
  const double weight = chooseWeight(splines);
  std::vector<double> values(knots_.size() * sums_.size());
  for (std::size_t t = 0; t < sums_.size(); ++t) {
    const Eigen::VectorXd own =
        splines[t].valuesRising(weight, steps_, -static_steps_.col(static_cast<Eigen::Index>(t)));
    for (std::size_t k = 0; k < knots_.size(); ++k)
      values[k * sums_.size() + t] = own[static_cast<Eigen::Index>(k)];
  }
  return values;
}

// Fits the curves by the method of Gauss and Newton: the readings as linear functions of the curves.
class CurvesFit {
 public:
  CurvesFit(const FitView& fit, const simulation::SimulationSettings& simulation)
      : fit_(fit), simulation_(simulation) {
    simulation_.taxel_curves.reset();
    simulation_ = simulation::fitted(simulation_, *fit.recordings().front());
    curves_ = emptyCurves(fit, simulation_);
  }

  Curves run();

 private:
  double step();
  void prepare();
  void takeIn(std::size_t recording, const std::uint16_t* counts, const double* plain,
              const simulation::SensorChain& moved);
  simulation::SimulationSettings with(double added) const;

  const FitView& fit_;
  simulation::SimulationSettings simulation_;
  Curves curves_;
  std::vector<simulation::LoadCurves> now_;  // of each surface
  std::vector<SurfaceFit> fits_;             // likewise
  bool linear_ = true;                       // the readings are linear in the curves
  bool first_ = true;                        // step
};

// The simulation with the present curves and `added` at every load [share of full scale].
simulation::SimulationSettings CurvesFit::with(double added) const {
  Curves moved = curves_;
  for (Curves::OnSurface& surface : moved.surfaces) {
    for (double& value : surface.added) value += added;
  }
  simulation::SimulationSettings result = simulation_;
  result.taxel_curves = std::make_shared<const Curves>(std::move(moved));
  return result;
}

void CurvesFit::prepare() {
  fits_.clear();
  now_.clear();
  for (const Curves::OnSurface& surface : curves_.surfaces) {
    fits_.emplace_back(surface, curves_.taxels, simulation_);
    now_.emplace_back(surface, curves_.taxels);
  }
}

// Adds one scan to the sums. `plain`: readings with the present curves [counts].
void CurvesFit::takeIn(std::size_t recording, const std::uint16_t* counts, const double* plain,
                       const simulation::SensorChain& moved) {
  const std::size_t surface = moved.curvesSurface();
  const double full_scale = fit_.fullScale();
  const std::vector<std::uint8_t>& unmasked = fit_.unmasked(recording);
  for (std::size_t t = 0; t < curves_.taxels; ++t) {
    if (!unmasked[t]) continue;
    const double load = moved.signals().load[t], reading = plain[t] / full_scale;
    const double slope = (moved.reading()[t] / full_scale - reading) / kProbe;
    const bool full = counts[t] >= full_scale;
    // Gains are linear, too, but they do not stay.
    linear_ = linear_ && !full && std::abs(slope - moved.signals().gain[t]) < kSameSlope * std::abs(slope);
    if (std::abs(slope) < kLeastSlope || (full && !first_ && reading >= 1)) continue;
    fits_[surface].add(t, load, slope, counts[t] / full_scale - reading + slope * now_[surface].at(t, load));
  }
}

// Returns the largest change of a curve [share of full scale].
double CurvesFit::step() {
  prepare();
  std::vector<dataset::ScanCounts> counts;
  for (const dataset::Recording* recording : fit_.recordings()) counts.emplace_back(*recording);
  driveRecordingsTwice(
      fit_.recordings(), with(0), with(kProbe),
      [&](std::size_t r, std::size_t i, const double* plain, const simulation::SensorChain& moved) {
        if (fit_.sampleOf(r, i) != FitView::kNotInView) takeIn(r, counts[r][i], plain, moved);
      });
  double largest = 0;
  for (std::size_t s = 0; s < fits_.size(); ++s) {
    const std::vector<double> values = fits_[s].solved();
    std::vector<double>& before = curves_.surfaces[s].added;
    for (std::size_t k = 0; k < values.size(); ++k)
      largest = std::max(largest, std::abs(values[k] - before[k]));
    before = values;
  }
  first_ = false;
  return largest;
}

Curves CurvesFit::run() {
  for (int round = 0; round < kMostNewtonRounds; ++round) {
    if (step() < kSettled || linear_) break;
  }
  return curves_;
}

}  // namespace

simulation::SimulationSettings withTaxelCurves(const FitView& fit,
                                               const simulation::SimulationSettings& simulation,
                                               const std::string& file) {
  simulation::SimulationSettings result = simulation;
  result.taxel_curves = std::make_shared<const Curves>(CurvesFit(fit, simulation).run());
  result.taxel_curves_file = file;
  return result;
}

}  // namespace fsr::discrepancy
