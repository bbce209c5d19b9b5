#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dataset/count_readers.h"
#include "health/faults.h"

namespace fsr::health {

/// Response, relative to that of the same taxel elsewhere, below which a taxel fails. Loops, creep, heat and
/// wear change how much a taxel reads by a share of it; only what breaks its contact takes most of it away.
constexpr double kResponds = 0.3;

/// Readings of all taxels in one stay, relative to those of the other taxels. What all taxels share
/// (pressure, loops, creep, drift, a late clock) is in the median reading and in no deviation.
///
/// Unit of expected readings and deviations: range of the taxel's reading in this stay, but at least half the
/// median range of all taxels. 0 = the taxel's lowest expected reading. Deviations are computed from the
/// counts when they are asked for: stored ones would take twice the memory of the counts.
struct StayCourses {
  const Stay* stay = nullptr;
  double full_scale = 0;  ///< [counts]
  /// Of the median reading of the used taxels at each scan among the points of `curve`; linear beyond them.
  std::vector<float> place;
  /// Reading of each taxel where the median reading has certain values: a robust function of it
  /// [taxels x points] [share of full scale].
  Eigen::ArrayXXd curve;
  Eigen::ArrayXd unit, lowest;  ///< [taxels] [share of full scale]
  std::vector<bool> foreign;    ///< of each taxel: its curve is that of another surface

  std::size_t scans() const { return place.size(); }
  double expected(std::size_t taxel, std::size_t scan) const {
    return (expectedReading(taxel, scan) - lowest[taxel]) / unit[taxel];
  }
  /// [share of full scale]
  double expectedReading(std::size_t taxel, std::size_t scan) const {
    const Eigen::Index k = pointBefore(scan);
    return curve(taxel, k) + (double(place[scan]) - double(k)) * (curve(taxel, k + 1) - curve(taxel, k));
  }
  /// Reading less the expected one of all taxels, from the counts of the scan [taxels].
  void deviations(std::size_t scan, const std::uint16_t* counts, Eigen::Ref<Eigen::ArrayXd> result) const {
    const Eigen::Index k = pointBefore(scan);
    const Eigen::Map<const Eigen::Array<std::uint16_t, Eigen::Dynamic, 1>> all(counts, unit.size());
    result = (all.cast<double>() / full_scale - curve.col(k) -
              (double(place[scan]) - double(k)) * (curve.col(k + 1) - curve.col(k))) /
             unit;
  }

 private:
  Eigen::Index pointBefore(std::size_t scan) const {
    return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(place[scan]), 0, curve.cols() - 2);
  }
};

/// Readings of one taxel in a stay. The courses must outlive it; it belongs to one thread.
class TaxelCourse {
 public:
  TaxelCourse(const StayCourses& courses, std::size_t taxel)
      : courses_(courses), taxel_(taxel), counts_(*courses.stay->recording, taxel) {}

  /// As the board sent it [share of full scale].
  double reading(std::size_t scan) { return counts_[courses_.stay->first + scan] / courses_.full_scale; }
  /// Whether a scan, not the first, has the code of the one before.
  bool repeats(std::size_t scan) {
    const std::size_t at = courses_.stay->first + scan;
    return counts_[at] == counts_[at - 1];
  }
  /// Less the expected reading [unit of the courses].
  double deviates(std::size_t scan) {
    return (reading(scan) - courses_.expectedReading(taxel_, scan)) / courses_.unit[taxel_];
  }

 private:
  const StayCourses& courses_;
  std::size_t taxel_;
  dataset::TaxelCounts counts_;
};

/// Courses of all stays. The expected reading of a taxel is a robust function of the median reading in the
/// same stay, so a change of mount is no deviation. Where a taxel responds in one stay to less than
/// kResponds of the change that its readings show in the others, the curve of another stay stands for its
/// own: the fault lasts longer there than the sound part. That of another surface does where there is none of
/// the same one: the chamber loads all taxels alike on each, so a bend that silences one of them and not its
/// neighbours has broken its contact.
std::vector<StayCourses> taxelCourses(const Sheet& sheet);

}  // namespace fsr::health
