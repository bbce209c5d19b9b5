#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dataset/reject_reason.h"

namespace fsr::dataset {

/// The chamber is at rest up to this gauge pressure [Pa]: twice the accuracy of the transducer of Ahmadizadeh
/// and Menon 2019 (Omega PX309, 0.25 % of 1.1 MPa).
constexpr double kRestLevel = 5e3;

/// The scans of a recording in the order of time, without their single taxels.
struct ScanCourse {
  std::vector<std::int64_t> stamp_ns;
  std::vector<double> pressure;          ///< of the chamber, gauge [Pa]
  std::vector<double> reading;           ///< mean of all taxels [counts]
  std::vector<std::uint32_t> condition;  ///< number of the surface and mount

  std::size_t scans() const { return stamp_ns.size(); }
};

/// The end of an attempt at a step, told by an event of the conductor.
struct AttemptEnd {
  std::int64_t stamp_ns = 0;
  RejectReason reason = RejectReason::kNone;  ///< kNone = accepted, or rejected by a person
};

/// Scans that are not readings of the sheet under the pressure recorded with them.
struct UnsoundSpan {
  std::size_t first = 0, end = 0;  ///< indices of scans; `end` is the first one behind the span
  std::string why;                 ///< "attempt rejected: sheet_off"
};

/// The attempts that were rejected for a reason by which readings mislead. A span begins at the last rest
/// before the attempt and ends at the first one after it; rest is that of the chamber and of the sheet. It
/// stays between the ends of the attempts before and after. `ends` ascend.
std::vector<UnsoundSpan> rejectedSpans(const ScanCourse& course, const std::vector<AttemptEnd>& ends);

/// "left out 353 scans that are not the sheet under the recorded pressure: 120.0 to 135.0 s (attempt
/// rejected: sheet_off)", with times since the first scan; empty without spans.
std::string unsoundText(const ScanCourse& course, const std::vector<UnsoundSpan>& spans);

}  // namespace fsr::dataset
