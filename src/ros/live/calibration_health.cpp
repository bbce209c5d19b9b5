#include "ros/live/calibration_health.h"

#include <algorithm>
#include <cmath>

#include "settings/number_text.h"

namespace fsr_ros {

namespace {

using Status = diagnostic_updater::DiagnosticStatusWrapper;
using Level = diagnostic_msgs::DiagnosticStatus;
using fsr::map::MapState;
namespace flag = fsr::map::taxel_flag;

constexpr std::size_t kListedTaxels = 10;
constexpr double kWorthATare = 0.98;  // of the error without it

std::size_t flagged(const fsr::map::PressureMap& map, std::uint16_t flags) {
  const auto has = [flags](std::uint16_t f) { return (f & flags) != 0; };
  return std::size_t(std::count_if(map.flags.begin(), map.flags.end(), has));
}

// "(0, 3), (2, 9)": row and column of the first taxels that carry a flag.
std::string places(const fsr::map::PressureMap& map, std::uint16_t flags) {
  std::string text;
  std::size_t listed = 0;
  for (std::size_t taxel = 0; taxel < map.flags.size(); ++taxel) {
    if ((map.flags[taxel] & flags) == 0) continue;
    if (listed++ == kListedTaxels) return text + ", ...";
    text += (text.empty() ? "(" : ", (") + std::to_string(map.layout.row({taxel})) + ", " +
            std::to_string(map.layout.column({taxel})) + ")";
  }
  return text;
}

void addPressures(const fsr::map::PressureMap& map, double contact_threshold, Status& status) {
  float peak = 0;
  int contact = 0;
  for (const float pressure : map.pressure) {
    if (!(pressure >= contact_threshold)) continue;  // false for NaN
    ++contact;
    peak = std::max(peak, pressure);
  }
  status.add("taxels in contact", contact);
  status.add("peak in contact, gauge [kPa]", fsr::settings::roundedText(peak / 1000, 4));
}

void addFlags(const fsr::map::PressureMap& map, Status& status) {
  status.add("dead taxels (row, column)", places(map, flag::kDead));
  status.add("stuck taxels (row, column)", places(map, flag::kStuck));
  status.add("taxels of a broken or shorted line (row, column)", places(map, flag::kLineFault));
  status.add("masked taxels", flagged(map, flag::kMasked));
  status.add("saturated taxels", flagged(map, flag::kSaturated));
  status.add("taxels below range", flagged(map, flag::kBelowRange));
  status.add("taxels with a reading beyond training", flagged(map, flag::kReadingExtrapolated));
  status.add("taxels with a curvature beyond training", flagged(map, flag::kCurvatureExtrapolated));
  status.add("taxels with a temperature beyond training", flagged(map, flag::kTemperatureExtrapolated));
  status.add("taxels between curvature classes", flagged(map, flag::kBetweenClasses));
  status.add("share of taxels whose history is not settled [%]",
             fsr::settings::roundedText(100 * fsr::map::unsettledShare(map.pressure, map.flags), 3));
}

std::string temperatureSentence(const CalibrationHealth& health) {
  if (health.corrects_temperature && std::isnan(health.temperature)) {
    return "the temperature is unknown, so the maps are not corrected for it and their deviation is larger: "
           "does "
           "the board publish temperature?";
  }
  if (flagged(health.map, flag::kTemperatureExtrapolated) == 0) return "";
  return "the temperature is beyond that of training, " +
         fsr::settings::roundedText(health.info.temperature_low, 3) + " to " +
         fsr::settings::roundedText(health.info.temperature_high, 3) + " degrees Celsius";
}

// The comparison of the surface with the sheet at rest: what is known of it and its sentence.
void addShape(const CalibrationHealth& health, Status& status) {
  using fsr::calibration::ShapeVerdict;
  const bool compared = !health.shape.sentence.empty();
  std::string verdict = compared || !health.no_shape.empty() ? kRestUnknown : kRestOpen;
  if (compared && health.shape.verdict == ShapeVerdict::kAgrees) verdict = kRestAgrees;
  if (compared && health.shape.verdict == ShapeVerdict::kDisagrees) verdict = kRestDisagrees;
  std::string sentence = health.shape.sentence;
  if (!compared)
    sentence = health.no_shape.empty() ? kRestOpen : "how the sheet lies cannot be told: " + health.no_shape;
  status.add(kRestVerdictKey, verdict);
  status.add(kRestKey, sentence);
  status.add(kMarkedRestKey, health.marked.empty() ? kNoMarkedRest : health.marked);
  status.add(kCurvatureSourceKey, health.estimates_curvature ? kCurvatureEstimated : kCurvaturePublished);
}

bool isError(MapState state) {
  return state == MapState::kUncalibrated || state == MapState::kSizeMismatch ||
         state == MapState::kWrongSensor;
}

}  // namespace

std::string stateSentence(const CalibrationHealth& health) {
  switch (health.map.state) {
    case MapState::kOk:
      return temperatureSentence(health);
    case MapState::kUncalibrated:
      return "maps are empty because no calibration is loaded: " + health.complaint;
    case MapState::kCurvatureUnknown:
      return "the curvature is unknown, so every taxel uses the flattest trained surface: " +
             (health.surface_complaint.empty() ? "no curvature has been received" : health.surface_complaint);
    case MapState::kCurvatureStale:
      return "the last curvature is older than ~curvature_timeout, but still in use: is the curvature node "
             "running?";
    case MapState::kSizeMismatch:
      return "maps are empty because the board sends " + sizeText(health.map.layout.size) +
             " taxels, and this size or the full scale is not that of the calibration " + health.info.path;
    case MapState::kWrongSensor:
      return "the board has the serial number " + health.board +
             ", but the calibration was trained with board " + health.info.sensor_serial;
  }
  return "";
}

std::string tareSentence(const CalibrationHealth& health) {
  if (health.tare) return "";
  const fsr::calibration::SessionZero& zero = health.session_zero;
  if (!zero.expected()) return "not tared, because the calibration expects no tare";
  std::string text = "not tared, because ";
  text += health.tare_refusal.empty() ? "no tare was taken on this surface and mount" : health.tare_refusal;
  if (!std::isnan(zero.rmse)) {
    text += "; a tare at rest made the error of sessions that training left out " +
            fsr::settings::roundedPressure(zero.rmse, 3) + " instead of " +
            fsr::settings::roundedPressure(zero.rmse_without, 3);
  }
  return text + "; unload the sheet and call ~tare";
}

std::string shapeSentence(const CalibrationHealth& health) {
  if (health.shape.verdict != fsr::calibration::ShapeVerdict::kDisagrees) return "";
  return health.shape.sentence + ": correct the surface, or lay the sheet on it again";
}

void judgeCalibration(const CalibrationHealth& health, Status& status) {
  if (health.info.id.empty()) {
    status.summary(Level::ERROR, "waiting for a calibration: " + health.complaint);
  } else {
    status.summary(Level::OK, health.info.scheme + " from " + health.info.path);
    const fsr::calibration::SessionZero& zero = health.session_zero;
    // Where training could not tell what a tare is worth, the value says it, without a warning.
    if (zero.rmse < kWorthATare * zero.rmse_without && !health.tare)
      status.summary(Level::WARN, tareSentence(health));
    const std::string misplaced = shapeSentence(health);
    if (!misplaced.empty()) status.summary(Level::WARN, misplaced);
  }
  status.add("id", health.info.id);
  status.add("file", health.info.path);
  status.add("correction", health.info.parent.empty() ? "none" : correctionText(health.info));
  status.add("deviation of the map", health.deviation);
  status.add("scheme", health.info.scheme);
  status.add("sensor serial number", health.info.sensor_serial);
  status.add("board serial number", health.board);
  status.add("surface", health.surface.name);
  status.add("mount", health.surface.mount);
  addShape(health, status);
  status.add("tare", health.tare ? health.tare->date : tareSentence(health));
}

void judgeMaps(const CalibrationHealth& before, const CalibrationHealth& now, double seconds,
               const std::string& scan_topic, double contact_threshold, Status& status) {
  const std::uint64_t scans = now.scans - before.scans;
  const std::string complaint = stateSentence(now);
  const std::size_t bad = flagged(now.map, flag::kDead | flag::kStuck);
  if (scans == 0) {
    status.summary(Level::ERROR, "waiting for scans: none has come on " + scan_topic);
  } else if (!complaint.empty()) {
    status.summary(isError(now.map.state) ? Level::ERROR : Level::WARN, complaint);
  } else if (bad > 0) {
    status.summary(Level::WARN, std::to_string(bad) + " taxels are dead or stuck");
  } else {
    status.summary(Level::OK, "maps are calibrated");
  }
  status.add("maps a second of wall time", fsr::settings::roundedText(double(scans) / seconds, 4));
  status.add("maps", now.scans);
  status.add("dead taxels that recovered", now.revivals);
  status.add("temperature [degree Celsius]", fsr::settings::roundedText(now.temperature, 4));
  addFlags(now.map, status);
  addPressures(now.map, contact_threshold, status);
}

}  // namespace fsr_ros
