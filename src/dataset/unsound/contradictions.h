#pragma once

#include <vector>

#include "dataset/unsound/unsound_spans.h"

namespace fsr::dataset {

/// Spans in which sheet and transducer contradict each other: "pressure without reading" (the sheet was taken
/// off or its plug pulled, the transducer jumped), "reading without pressure" (the transducer was unplugged,
/// whatever it reads then) or "pressure below rest". Nothing needs to be known of the sheet. On each surface,
/// the pressure whose rank among all pressures is the rank of the reading among all readings is what the
/// sheet says. It differs from the transducer's by loops, creep, drift and noise all the time. Contradicted
/// is a scan where it differs far beyond this, in pressure and in reading, for longer than clocks may differ.
/// Nothing is found where a sheet does not follow the pressure anyway, or where more than a quarter of the
/// scans contradicts the rest.
std::vector<UnsoundSpan> contradictions(const ScanCourse& course);

/// Rejected attempts, and contradictions that are not within one, in the order of time.
std::vector<UnsoundSpan> unsoundSpans(const ScanCourse& course, const std::vector<AttemptEnd>& ends);

}  // namespace fsr::dataset
