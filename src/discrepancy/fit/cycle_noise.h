#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "discrepancy/fit/cycle_design.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::discrepancy {

/// Noise of the common trace within one cycle: a sum of independent Gaussian parts. Cycles are independent.
/// Source of the estimate: H. Zhou, L. Hu, J. Zhou, K. Lange, MM algorithms for variance components models,
/// Journal of Computational and Graphical Statistics 28 (2019) 350-361.
struct CycleNoise {
  enum Part : std::size_t {
    kWhite,          ///< factor of CycleBins::white
    kReference,      ///< variance of one reading of the reference [Pa^2], seen through the slope
    kCorners,        ///< the same where the rate of the pressure changes, for a slow reference [s^4]
    kFast,           ///< Ornstein-Uhlenbeck, a twentieth of a cycle [share of full scale, squared]
    kSlow,           ///< Ornstein-Uhlenbeck, a third of a cycle [share of full scale, squared]
    kCycleOffset,    ///< offset of each cycle [share of full scale, squared]
    kCycleGain,      ///< relative gain of each cycle, squared
    kWanderingGain,  ///< relative gain, Ornstein-Uhlenbeck, a third of a cycle, squared
    kParts
  };
  std::array<double, kParts> variance{1, 0, 0, 0, 0, 0, 0, 0};

  Eigen::MatrixXd covariance(const CycleBins& bins, double cycle_time) const;
  /// The covariance of each part at variance 1.
  static std::array<Eigen::MatrixXd, kParts> parts(const CycleBins& bins, double cycle_time);
};

/// The noise of a design, for cycles of another protocol.
struct NoiseOfCycles {
  CycleNoise noise;
  double cycle_time = 0;  ///< [s]
  double white = 0;       ///< mean variance of the white noise of one scan [share of full scale, squared]
};
NoiseOfCycles noiseOf(const CycleDesign& design, const CycleNoise& noise);

/// Static curves and what is fitted together with them, as one linear model with Gaussian priors.
///
/// The coefficients are, in this order: for each class its splines, then gain and offset of each of its
/// visits; at the end the chosen columns. Neighbouring splines are tied by second differences; the other
/// coefficients have a variance each. Classes share nothing but the chosen columns.
class StaticModel {
 public:
  /// `chosen`: indices of columns that belong to the model, with their prior variances.
  StaticModel(const CycleDesign& design, std::vector<Eigen::Index> chosen = {},
              std::vector<double> variances = {}, std::vector<bool> bent_only = {});

  Eigen::Index size() const { return size_; }
  std::size_t classes() const { return starts_.size() - 1; }
  /// Number of coefficients of one class, and the first of them.
  Eigen::Index sizeOf(std::size_t curvature_class) const;
  Eigen::Index startOf(std::size_t curvature_class) const { return starts_[curvature_class]; }
  /// Number of chosen columns. They are the last coefficients.
  Eigen::Index chosen() const { return static_cast<Eigen::Index>(chosen_.size()); }
  /// Coefficient of a visit's gain; that of its offset follows.
  Eigen::Index visitAt(std::size_t visit) const { return visits_[visit]; }
  /// The model's columns in one cycle [bins x local], and the coefficients that they belong to.
  Eigen::MatrixXd columns(const CycleBins& bins) const;
  std::vector<Eigen::Index> places(const CycleBins& bins) const;
  /// Precision of the prior.
  Eigen::MatrixXd prior() const;

  double stiffness = 1e4;                   ///< of second differences of neighbouring splines
  double visit_gain = 1, visit_offset = 1;  ///< prior variances
 private:
  const CycleDesign& design_;
  std::vector<Eigen::Index> chosen_;
  std::vector<double> variances_;
  std::vector<bool> bent_only_;
  std::vector<Eigen::Index> starts_;  // of each class; the last is that of the chosen columns
  std::vector<Eigen::Index> visits_;  // of each visit
  Eigen::Index size_ = 0;
};

/// The normal equations of a StaticModel, solved class by class: only the chosen columns join the classes.
class StaticSolution {
 public:
  /// `gram`, `right`: normal equations without the prior [size x size], [size].
  StaticSolution(const StaticModel& model, const Eigen::MatrixXd& gram, const Eigen::VectorXd& right);

  const Eigen::VectorXd& coefficients() const { return coefficients_; }
  /// Logarithm of the determinant of the posterior precision.
  double logDeterminant() const { return log_determinant_; }
  /// Posterior variance of a coefficient of a class.
  double variance(std::size_t curvature_class, Eigen::Index coefficient) const;
  /// Effective number of coefficients.
  double degrees() const;

 private:
  struct Block {
    Eigen::LLT<Eigen::MatrixXd> root;  // of the class's own precision
    Eigen::MatrixXd border;            // its solution for the chosen columns
  };
  const StaticModel& model_;
  const Eigen::MatrixXd& gram_;
  std::vector<Block> blocks_;
  Eigen::MatrixXd chosen_;  // covariance of the chosen columns' coefficients
  Eigen::VectorXd coefficients_;
  double log_determinant_ = 0;
};

/// Fits the noise by maximum likelihood. Without `start` the stiffness of the static curves and the scatter
/// of the visits are fitted, too. With it they stay, and the search begins at these variances.
CycleNoise fitNoise(const CycleDesign& design, StaticModel& model, const CycleNoise* start = nullptr);

/// The slow parts of a fitted noise, as sizes with intervals: cycle_gain, cycle_offset and wandering.
///
/// The intervals are of the likelihood: the inverse of the expected information on all variances gives the
/// standard error of each. The logarithm of a variance is taken as normal where the variance exceeds two
/// standard errors; else the interval begins at 0. Source: S. Searle, G. Casella, C. McCulloch, Variance
/// Components, Wiley 1992, chapter 6. Empty for fewer than three cycles.
std::vector<Scatter> scatterOf(const CycleDesign& design, const CycleNoise& noise);

}  // namespace fsr::discrepancy
