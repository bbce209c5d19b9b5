#include <algorithm>
#include <cmath>
#include <sstream>

#include "calibration/sources.h"
#include "compensation/fit_scheme.h"
#include "dataset/count_readers.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

constexpr std::size_t kFewestFolds = 2;
constexpr std::size_t kMostFolds = 20;
// A smaller range is noise of the transducer, not a change of the chamber pressure [Pa].
constexpr double kLeastPressureRange = 2e3;

std::string scansOf(std::uint64_t number, const std::string& what) {
  return number == 0 ? "" : ", " + std::to_string(number) + " " + what;
}

std::string whyNoScan(const dataset::RecordingLosses& losses) {
  const std::string why = scansOf(losses.near_change, "were made within 1 s of a change of surface") +
                          scansOf(losses.no_reference, "lie in a gap of chamber_pressure") +
                          scansOf(losses.unknown_surface, "on a surface of unknown curvature");
  return why.empty() ? "" : ":" + why.substr(1);
}

void requireWhole(const dataset::Recording& recording) {
  const auto refuse = [&](const std::string& what) {
    throw settings::InputError(recording.name + ": " + what);
  };
  if (recording.scans() == 0) refuse("no scan is left to train on" + whyNoScan(recording.losses));
  if (recording.pressure.empty()) {
    refuse("no chamber pressure is recorded, but training needs the topic chamber_pressure");
  }
  const bool whole = dataset::countsAreWhole(recording) && recording.pressure.size() == recording.scans() &&
                     recording.condition.size() == recording.scans() &&
                     (recording.mask.empty() || recording.mask.size() == recording.layout.size.taxels()) &&
                     (recording.temperature.empty() || recording.temperature.size() == recording.scans());
  if (!whole) refuse("counts, pressure, temperature, condition and mask do not fit each other");
}

void requirePressures(const dataset::Recording& recording) {
  std::vector<std::size_t> usable(recording.conditions.size());
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (!std::isfinite(recording.pressure[i])) continue;
    if (std::abs(recording.pressure[i]) > regression::kLargestPressure) {
      throw settings::InputError(recording.name + ": chamber pressure is " +
                                 std::to_string(recording.pressure[i]) +
                                 " Pa, but must lie within +-8000000 Pa gauge");
    }
    ++usable.at(recording.condition[i]);
  }
  for (std::size_t c = 0; c < usable.size(); ++c) {
    if (usable[c] == 0) {
      throw settings::InputError(recording.name + ": no scan on \"" + recording.conditions[c].name +
                                 "\" has a chamber pressure");
    }
  }
}

void requireSameMatrix(const dataset::Recording& first, const dataset::Recording& other) {
  const auto refuse = [&](const std::string& what, const std::string& own, const std::string& that) {
    throw settings::InputError(other.name + ": " + what + " is " + own + ", but that of " + first.name +
                               " is " + that + "; a calibration is of one matrix");
  };
  if (other.layout.size != first.layout.size) {
    refuse("the matrix", matrix::sizeText(other.layout.size), matrix::sizeText(first.layout.size));
  }
  if (other.full_scale != first.full_scale) {
    refuse("full_scale", std::to_string(other.full_scale), std::to_string(first.full_scale));
  }
  const std::string& serial = other.sensor.serial;
  if (!serial.empty() && !first.sensor.serial.empty() && serial != first.sensor.serial) {
    refuse("the serial number", '"' + serial + '"', '"' + first.sensor.serial + '"');
  }
}

// Tables say how their readings became counts, e.g. "65535 counts = 0.2 S" (dataset/table_recording.h).
void requireSameScale(const dataset::Recording& first, const dataset::Recording& other) {
  const std::string &scale = first.sensor.model, &own = other.sensor.model;
  const bool tables =
      scale.find("counts =") != std::string::npos || own.find("counts =") != std::string::npos;
  if (!tables || scale == own || scale.empty() || own.empty()) return;
  throw settings::InputError(other.name + ": the scale of the readings is \"" + own + "\", but that of " +
                             first.name + " is \"" + scale + "\"; convert both with the same --range");
}

// The same readings given twice would count as independent.
void requireDifferentBags(const std::vector<dataset::Recording>& recordings) {
  for (auto later = recordings.begin(); later != recordings.end(); ++later) {
    const auto same = [&](const dataset::Recording& earlier) { return earlier.sha256 == later->sha256; };
    const auto twin = std::find_if(recordings.begin(), later, same);
    if (twin == later || later->sha256.empty()) continue;
    throw settings::InputError(later->name + ": has the same bytes as " + twin->name +
                               "; give each bag once");
  }
}

void requireChange(const std::vector<dataset::Recording>& recordings) {
  TrainedInterval pressure;
  for (const dataset::Recording& recording : recordings) {
    for (const double value : recording.pressure) {
      if (std::isfinite(value)) pressure.include(value);
    }
  }
  if (pressure.high - pressure.low >= kLeastPressureRange) return;
  std::ostringstream text;
  text << recordings.front().name << ": the chamber pressure never changes (" << pressure.low << " to "
       << pressure.high << " Pa gauge), but training needs cycles";
  throw settings::InputError(text.str());
}

}  // namespace

void validate(const CalibrationProblem& problem) {
  validate(problem.recordings, problem.options);
}

void validate(const std::vector<dataset::Recording>& recordings, const CalibrationOptions& options) {
  compensation::requireSchemeFor(options.scheme, options.regressor);
  if (options.folds < kFewestFolds || options.folds > kMostFolds) {
    throw settings::InputError("folds is " + std::to_string(options.folds) + ", but must be 2 to 20");
  }
  if (options.reference_deviation < 0 || std::isinf(options.reference_deviation)) {
    throw settings::InputError("the uncertainty of the transducer is " +
                               std::to_string(options.reference_deviation) +
                               " Pa, but must be finite and not negative");
  }
  if (recordings.empty())
    throw settings::InputError("there is no recording to train on; give one bag or more");
  for (const dataset::Recording& recording : recordings) requireWhole(recording);
  for (const dataset::Recording& recording : recordings) requireSameMatrix(recordings.front(), recording);
  for (const dataset::Recording& recording : recordings) requireSameScale(recordings.front(), recording);
  for (const dataset::Recording& recording : recordings) requirePressures(recording);
  requireChange(recordings);
  compensation::planScheme(
      options.scheme, dataset::poolConditions(recordings, compensation::poolingOf(options.scheme)).classes);
  requireDifferentBags(recordings);
}

}  // namespace fsr::calibration
