#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "health/faults.h"

namespace fsr::health {

/// A robust function of the median reading, given by points and linear between and beyond them. Without
/// points it is the median reading itself [share of full scale].
struct ReadingCurve {
  std::vector<double> at, value;

  double operator()(double median) const;
  double range() const;
};

/// Readings of all taxels in one stay, relative to those of the other taxels. What all taxels share
/// (pressure, loops, creep, drift, a late clock) is in the median reading and in no deviation.
///
/// Unit of expected readings and deviations: range of the taxel's reading in this stay, but at least half the
/// median range of all taxels. 0 = the taxel's lowest expected reading.
struct StayCourses {
  std::vector<double> median;        ///< reading of the used taxels at each scan [share of full scale]
  std::vector<double> unit, lowest;  ///< of each taxel [share of full scale]
  std::vector<ReadingCurve> curve;   ///< of each taxel
  Eigen::MatrixXf deviation;         ///< reading less the expected one [scans x taxels]

  std::size_t scans() const { return median.size(); }
  double expected(std::size_t taxel, std::size_t scan) const {
    return (curve[taxel](median[scan]) - lowest[taxel]) / unit[taxel];
  }
  double deviates(std::size_t taxel, std::size_t scan) const { return double(deviation(scan, taxel)); }
  /// As the board sent it [share of full scale].
  double reading(std::size_t taxel, std::size_t scan) const {
    return curve[taxel](median[scan]) + unit[taxel] * deviates(taxel, scan);
  }
};

/// Courses of all stays. The expected reading of a taxel is a robust function of the median reading in the
/// same stay, so a change of mount is no deviation. Where a taxel responds in one stay to less than
/// `kResponds` of the change that its readings show in the others, the curve of another stay stands for its
/// own: the fault lasts longer there than the sound part.
std::vector<StayCourses> taxelCourses(const Sheet& sheet);

}  // namespace fsr::health
