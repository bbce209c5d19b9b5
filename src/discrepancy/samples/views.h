#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// Scans of one use, at full rate. FitView and HoldOutView are types of their own, so that a fit cannot be
/// given the scans that are held out. The recordings must outlive the view.
class ScanView {
 public:
  static constexpr std::uint32_t kNotInView = std::numeric_limits<std::uint32_t>::max();

  /// All recordings, in order of time. Their pressure, surfaces and temperature drive simulations; a sheet
  /// remembers all of them. Only counts of scans in the view may be used.
  const std::vector<const dataset::Recording*>& recordings() const { return order_; }
  /// Number of the sample that contains the scan, kNotInView where the scan is not in the view. `recording`:
  /// place in recordings().
  std::uint32_t sampleOf(std::size_t recording, std::size_t scan) const { return sample_[recording][scan]; }
  std::uint32_t cycleOf(std::uint32_t sample) const { return measured_.cycle[sample]; }
  std::size_t cycles() const { return measured_.cycles.size(); }
  std::int8_t directionOf(std::uint32_t sample) const { return measured_.direction[sample]; }
  std::size_t classOf(std::uint32_t sample) const { return measured_.classOf(sample); }
  std::size_t classes() const { return measured_.classes.size(); }
  /// Principal curvature of taxel 0 on a class of curvature [1/m].
  double curvatureOf(std::size_t curvature_class) const { return measured_.classes[curvature_class].at(0); }
  const std::string& surfaceOf(std::size_t curvature_class) const {
    return measured_.classes[curvature_class].surface;
  }
  /// Name of the surface on which a cycle was recorded.
  const std::string& surfaceOfCycle(std::size_t cycle) const {
    return measured_.visits[measured_.cycles[cycle].visit].surface.name;
  }

  std::size_t taxels() const { return measured_.taxels(); }
  double fullScale() const { return measured_.full_scale; }
  /// For each taxel: whether a recording does not mask it. Taxels with a fault are in the view.
  const std::vector<std::uint8_t>& unmasked(std::size_t recording) const { return unmasked_[recording]; }
  /// Number of scans in the view.
  std::size_t scans() const;

 protected:
  ScanView(const Measured& measured, CycleUse use);

  const Measured& measured_;
  std::vector<const dataset::Recording*> order_;
  std::vector<std::vector<std::uint32_t>> sample_;   // [recordings][scans]
  std::vector<std::vector<std::uint8_t>> unmasked_;  // [recordings][taxels]
};

/// The scans that may be fitted. Pressures that hardly ever occur (one scan in two thousand on their surface:
/// spikes of the reference) do not count as covered, and their scans are not in the view.
class FitView : public ScanView {
 public:
  explicit FitView(const Measured& measured);

  /// Range of the pressures on a surface [Pa]; low > high where no cycle on it is fitted.
  const Interval& covered(std::size_t curvature_class) const { return covered_[curvature_class]; }

 private:
  std::vector<Interval> covered_;  // of each class of curvature
};

/// The scans of the hold-out cycles. Only the proof takes them. Scans beyond the pressures that FIT covered
/// on their surface are counted and left out.
class HoldOutView : public ScanView {
 public:
  HoldOutView(const Measured& measured, const FitView& fit);

  /// Number of scans of hold-out cycles that are left out.
  std::size_t leftOut() const { return left_out_; }
  /// The scans of the view as spans of stamps, bag by bag in order of time. A cycle is several spans where
  /// parts of it are left out.
  std::vector<HoldOutCycles> spans() const;

 private:
  std::size_t left_out_ = 0;
};

/// Cycles on one surface, or cycles of one protocol of filling and venting.
struct Part {
  std::string name;                 ///< name of the surface, or the common feature of the cycles
  std::vector<std::size_t> cycles;  ///< ascending
};

/// Divides the cycles by surface: one part for each class of curvature that has hold-out cycles. None if
/// there are fewer than two.
std::vector<Part> partsByCondition(const Measured& measured);

/// Divides the cycles by protocol. The parts differ clearly in the speed of the ramps. If no speeds differ,
/// the parts differ in the dwell time under load, and otherwise in the peak. None if all cycles are alike.
std::vector<Part> partsByProtocol(const Measured& measured);

/// The recordings with all cycles of a part held out. A fit to them does not use the part.
Measured withoutPart(const Measured& measured, const Part& part);

}  // namespace fsr::discrepancy
