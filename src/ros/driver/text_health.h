#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <string>

#include "ros/driver/driver_health.h"
#include "ros/messages/driver_settings.h"

/// Diagnostics of a board that sends lines of text. Such lines say neither the matrix nor the full scale nor
/// the unit of their times, so parameters say them, and these may be wrong.
namespace fsr_ros {

bool speaksText(const DriverSettings& settings);

/// Why lines of whole numbers between two samples gave no scan, and which parameter to set.
std::string lineSentence(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings);

/// Adds to `status` what is wrong with a board whose scans come: times of another unit than the parameter
/// says, and scans that are not published because counts are above the full scale.
void judgeLines(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings,
                diagnostic_updater::DiagnosticStatusWrapper& status);

/// Lists the lines that gave no scan, by cause.
void addLineCounts(const fsr::protocol::LineCounts& lines,
                   diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace fsr_ros
