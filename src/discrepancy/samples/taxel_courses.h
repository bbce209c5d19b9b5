#pragma once

#include <vector>

#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// Readings of all taxels in one visit at every scan, relative to those of the other taxels. What all taxels
/// share (pressure, loops, creep, drift, a late clock) is in the median reading and in no deviation.
///
/// Unit of all readings: range of the taxel's reading in this visit, but at least half the median range of
/// all taxels. 0 = the taxel's lowest expected reading.
struct VisitCourses {
  std::size_t visit = 0;
  std::vector<double> time;    ///< of each scan, since the first scan of the first recording [s]
  std::vector<double> common;  ///< median reading of the used taxels at each scan [share of full scale]
  std::vector<std::vector<float>> reading;   ///< [taxels][scans]
  std::vector<std::vector<float>> expected;  ///< from the median reading and the taxel's own curve
  std::vector<double> unit;                  ///< unit of each taxel [share of full scale]
  std::vector<double> lowest;                ///< lowest expected reading of each taxel [share of full scale]
  std::vector<bool> borrowed;  ///< taxels that have no curve in this visit: another one stands for it

  std::size_t scans() const { return time.size(); }
  double deviation(std::size_t taxel, std::size_t scan) const {
    return static_cast<double>(reading[taxel][scan]) - static_cast<double>(expected[taxel][scan]);
  }
};

/// Courses of all visits. The expected reading of a taxel is a robust function of the median reading in the
/// same visit, so a change of mount is no deviation. Where a taxel responds in one visit to less than
/// `kResponds` of the change that its readings show in the others, the curve of another visit stands for its
/// own: the fault lasts longer there than the sound part.
std::vector<VisitCourses> taxelCourses(const Measured& measured);

}  // namespace fsr::discrepancy
