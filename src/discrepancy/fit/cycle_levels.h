#pragma once

#include <Eigen/Dense>
#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy {

// Gain and zero of every cycle used for fitting, relative to the mean of similar cycles (same surface, same
// protocol). They show what changes from cycle to cycle, slowly or by chance.
class CycleLevels {
 public:
  // A covariate, expressed as functions of the cycle.
  struct Course {
    simulation::Covariate covariate;
    Eigen::MatrixXd terms;  // [cycles x terms], orthonormal, with the means over similar cycles subtracted
  };

  CycleLevels(const Measured& measured, const StaticFit& fit, const Trace& residual);

  const std::vector<Course>& courses() const { return courses_; }  // none if there are too few cycles
  const Eigen::MatrixXd& measured() const { return levels_; }      // [cycles x 2]
  // Random levels for the null hypothesis that nothing changes slowly [cycles x 2]; `draw` is the number of
  // the draw.
  Eigen::MatrixXd drawn(const statistics::RandomStream& stream, std::uint64_t draw) const;
  // What the course explains of the levels, in units of the scatter from each cycle to the next.
  double statistic(const Eigen::MatrixXd& levels, const Course& course) const;
  // Mean square of the common trace that the course explains [share of full scale, squared].
  double explained(const Course& course) const;

 private:
  void judge(const Measured& measured, const StaticFit& fit, const Trace& residual);
  void group(const Measured& measured);
  void plan(const Measured& measured);
  void add(simulation::Covariate covariate, Eigen::MatrixXd terms);
  void centre(Eigen::MatrixXd& rows) const;

  std::vector<std::size_t> cycles_;
  std::vector<std::size_t> visit_, group_;  // of each cycle in cycles_
  std::size_t groups_ = 0;
  Eigen::MatrixXd levels_;
  Eigen::Matrix2d gram_;  // Gram matrix of the rise and the constant 1, summed over all samples
  double samples_ = 0;
  std::vector<Course> courses_;
};

}  // namespace fsr::discrepancy
