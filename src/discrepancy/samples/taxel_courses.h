#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "dataset/count_readers.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// A robust function of the median reading, given by points and linear between them.
struct ReadingCurve {
  std::vector<double> at;     ///< median reading, ascending [share of full scale]
  std::vector<double> value;  ///< reading of the taxel at each point [share of full scale]
  bool borrowed = true;       ///< its points are not those of the visit
};

/// Readings of all taxels in one visit at every scan, relative to those of the other taxels. What all taxels
/// share (pressure, loops, creep, drift, a late clock) is in the median reading and in no deviation.
///
/// Unit of all readings: range of the taxel's reading in this visit, but at least half the median range of
/// all taxels. 0 = the taxel's lowest expected reading. Readings are computed from the counts of the
/// recording when they are asked for, because stored ones would take four times the memory of the counts.
struct VisitCourses {
  std::size_t visit = 0;
  std::vector<double> common;  ///< median reading of the used taxels at each scan [share of full scale]
  std::vector<double> unit;    ///< unit of each taxel [share of full scale]
  std::vector<double> lowest;  ///< lowest expected reading of each taxel [share of full scale]
  std::vector<bool> borrowed;  ///< taxels that have no curve in this visit: another one stands for it

  const dataset::Recording* recording = nullptr;
  std::size_t first_scan = 0;  ///< of the visit in the recording
  double offset = 0;           ///< of the recording's times [s]
  double full_scale = 0;       ///< [counts]
  /// Where the median reading of a scan lies between the points of this visit's curves.
  struct Between {
    std::uint32_t point = 0;  ///< the upper one; 0: the curves have one point
    double share = 0;         ///< of the way from the lower one; NaN: both are at one place
  };
  std::vector<Between> between;  ///< of each scan
  /// Curve of each taxel; without points: the median reading itself is expected.
  std::vector<ReadingCurve> curve;

  std::size_t scans() const { return common.size(); }
  /// Since the first scan of the first recording [s].
  double time(std::size_t scan) const { return recording->time[first_scan + scan] + offset; }
  /// From the median reading and the taxel's own curve.
  float expected(std::size_t taxel, std::size_t scan) const {
    return inUnits(taxel, expectedShare(taxel, scan));
  }
  /// The same without the taxel's unit [share of full scale].
  double expectedShare(std::size_t taxel, std::size_t scan) const {
    const ReadingCurve& own = curve[taxel];
    const Between& at = between[scan];
    if (own.borrowed || at.point == 0) return elsewhere(own, common[scan]);
    return interpolated(own, at);
  }
  /// reading() - expected() of a TaxelCourse for the scans first .. last - 1, faster.
  void deviations(std::size_t taxel, std::size_t first, std::size_t last, double* result) const;

 private:
  friend class TaxelCourse;
  static double interpolated(const ReadingCurve& curve, const Between& at) {
    const double low = curve.value[at.point - 1], high = curve.value[at.point];
    return std::isnan(at.share) ? high : low + at.share * (high - low);
  }
  static double elsewhere(const ReadingCurve& curve, double common);
  float inUnits(std::size_t taxel, double share) const {
    return static_cast<float>((share - lowest[taxel]) / unit[taxel]);
  }
};

/// Readings of one taxel in a visit. The courses must outlive it; it belongs to one thread.
class TaxelCourse {
 public:
  TaxelCourse(const VisitCourses& visit, std::size_t taxel)
      : visit_(&visit), taxel_(taxel), counts_(*visit.recording, taxel) {}

  /// As the board sent it [share of full scale].
  float recorded(std::size_t scan) {
    return static_cast<float>(counts_[visit_->first_scan + scan] / visit_->full_scale);
  }
  float reading(std::size_t scan) { return visit_->inUnits(taxel_, static_cast<double>(recorded(scan))); }
  float expected(std::size_t scan) const { return visit_->expected(taxel_, scan); }
  double deviation(std::size_t scan) {
    return static_cast<double>(reading(scan)) - static_cast<double>(expected(scan));
  }

 private:
  const VisitCourses* visit_;
  std::size_t taxel_;
  dataset::TaxelCounts counts_;
};

/// Courses of all visits. The expected reading of a taxel is a robust function of the median reading in the
/// same visit, so a change of mount is no deviation. Where a taxel responds in one visit to less than
/// `kResponds` of the change that its readings show in the others, the curve of another visit stands for its
/// own: the fault lasts longer there than the sound part.
std::vector<VisitCourses> taxelCourses(const Measured& measured);

/// A row or column that fails in spells.
struct LineFault {
  bool found = false;
  std::size_t line = 0;
  std::vector<std::size_t> taxels;         ///< row-major
  double p = 1;                            ///< corrected for all lines
  std::vector<std::vector<bool>> failing;  ///< [visits][scans]
};

/// Searches rows (or columns) for steps from one scan to the next in which their taxels leave the
/// neighbouring lines together. `sound`: for each taxel; others are left out.
LineFault findLineFault(const Measured& measured, const std::vector<VisitCourses>& courses, bool rows,
                        const std::vector<bool>& sound, const DiscrepancyOptions& options);

/// A taxel that leaves the others.
struct TaxelFault {
  /// What its readings do in the spells. kOther: they still follow the others, or do neither of the two.
  enum class Kind { kOther, kDead, kStuck };
  std::size_t taxel = 0;
  Kind kind = Kind::kOther;
  double p = 1;                            ///< corrected for all taxels and lengths of spells
  std::vector<std::vector<bool>> failing;  ///< [visits][scans]
};

/// Searches single taxels for spells in which they leave the others. `sound`: for each taxel; others are left
/// out. Returns those that are outliers by `level`.
std::vector<TaxelFault> findTaxelFaults(const Measured& measured, const std::vector<VisitCourses>& courses,
                                        const std::vector<bool>& sound, const DiscrepancyOptions& options);

}  // namespace fsr::discrepancy
