#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// The common trace and all columns of one cycle, averaged over bins of consecutive samples.
struct CycleBins {
  std::size_t cycle = 0;            ///< index into Measured::cycles
  std::size_t curvature_class = 0;  ///< whose static curve holds
  std::size_t visit = 0;
  Eigen::VectorXd reading;   ///< common trace [share of full scale]
  Eigen::VectorXd net;       ///< static reading above the unloaded one [share of full scale]
  Eigen::VectorXd slope;     ///< of the static curve [share of full scale / Pa]
  Eigen::VectorXd pressure;  ///< as recorded, not smoothed [Pa]
  Eigen::VectorXd time;      ///< since the first scan [s]
  Eigen::VectorXd white;     ///< variance of the white noise of the mean [share of full scale, squared]
  Eigen::VectorXd corner;    ///< mean square of slope times second derivative of the pressure [1 / s^4]
  Eigen::VectorXd scans;     ///< number of scans
  Eigen::MatrixXd splines;   ///< values of the static splines [bins x splines]
  Eigen::MatrixXd columns;   ///< signatures, generic terms and the corners [bins x columns]

  Eigen::Index bins() const { return reading.size(); }
};

/// The cycles that may be fitted, reduced to bins. Splines and columns are computed at every sample and then
/// averaged, so that the bins are exact for everything that is linear.
struct CycleDesign {
  std::vector<CycleBins> cycles;  ///< in order of time; no hold-out cycle
  std::size_t classes = 0;
  std::size_t visits = 0;
  Eigen::Index splines = 0;  ///< of the static curve of one class
  Eigen::Index columns = 0;  ///< signatures, generic terms and the corners
  /// Column of slope times second derivative of the pressure: what a reference that averages, or is read too
  /// rarely, adds where the rate of the pressure changes.
  Eigen::Index corners = 0;
  std::vector<Eigen::Index> always;  ///< columns that belong to every model: the corners, and those asked for
  std::vector<bool> flat;            ///< of each class
  std::vector<std::size_t> class_of;  ///< curvature class of each visit
  std::vector<bool> visited_again;    ///< of each visit: its class was visited more than once
  double range = 0;                   ///< highest less lowest pressure [Pa]
  double cycle_time = 0;              ///< median duration of a cycle [s]
};

/// `columns`: [samples x columns], not projected. `always`: those of them that belong to every model.
CycleDesign cycleDesign(const Measured& measured, const StaticFit& fit, const Trace& common,
                        const Eigen::MatrixXd& columns, const std::vector<Eigen::Index>& always = {});

}  // namespace fsr::discrepancy
