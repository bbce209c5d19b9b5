#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <string>

#include "ros/live/live_calibration.h"

namespace fsr_ros {

// Values of the diagnostics of the calibration that the panel reads, by their keys.
constexpr char kRestKey[] = "sheet at rest";           ///< the sentence of the last comparison
constexpr char kRestVerdictKey[] = "surface at rest";  ///< one of the following
constexpr char kRestAgrees[] = "agrees";               ///< the sheet rests as the surface says
constexpr char kRestDisagrees[] = "disagrees";         ///< it rests as on another surface
constexpr char kRestUnknown[] = "cannot be told";      ///< compared, or never possible
constexpr char kRestOpen[] = "not compared yet";       ///< since the surface changed
constexpr char kMarkedRestKey[] = "marked rest";  ///< what was done at the last event doff, or the following
constexpr char kNoMarkedRest[] = "none";
constexpr char kCurvatureSourceKey[] = "curvature";  ///< one of the following
constexpr char kCurvatureEstimated[] = "estimated";  ///< this node publishes it
constexpr char kCurvaturePublished[] = "published";  ///< another node publishes it

/// Diagnostics of the calibration in use, its tare and the comparison of its surface with the sheet.
void judgeCalibration(const CalibrationHealth& health, diagnostic_updater::DiagnosticStatusWrapper& status);

/// Diagnostics of the maps between two samples `seconds` apart: rate, state, and taxels by flag. `scan_topic`
/// is named in the message when no scan has come.
void judgeMaps(const CalibrationHealth& before, const CalibrationHealth& now, double seconds,
               const std::string& scan_topic, double contact_threshold,
               diagnostic_updater::DiagnosticStatusWrapper& status);

/// What a map's state means and what to do about it, or that the temperature is beyond training, or unknown
/// and needed; else empty.
std::string stateSentence(const CalibrationHealth& health);

/// That the surface is not the one that the sheet rests on; else empty.
std::string shapeSentence(const CalibrationHealth& health);

/// Why the maps are not tared, and what a tare is worth if the calibration expects one; empty = they are.
std::string tareSentence(const CalibrationHealth& health);

}  // namespace fsr_ros
