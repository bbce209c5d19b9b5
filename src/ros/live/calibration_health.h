#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <string>

#include "ros/live/live_calibration.h"

namespace fsr_ros {

/// Diagnostics of the calibration in use and its tare.
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

/// That a tare is due and what it is worth, if the calibration expects one and none is set; else empty.
std::string tareSentence(const CalibrationHealth& health);

}  // namespace fsr_ros
