#pragma once

#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/Instruction.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/PressureStatisticsArray.h>

#include <QString>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "fsr_pressure_map/view/colour_map.h"

namespace fsr_rviz {

/// Values of a status of /diagnostics, by their keys.
using DiagnosticValues = std::map<std::string, std::string>;

/// The text, or "-" if it is empty.
QString text(const std::string& words);

/// `value` (SI) in the unit `name`, which is `unit` in SI, e.g. (0.0026, 1e-4, "cm²", 1) = "26.0 cm²". NaN
/// gives "-".
QString number(double value, double unit, const char* name, int decimals);

/// The mask of ~set_mask after the user pressed "Mask selected": the taxels that `flags` call masked, without
/// those of `selected` that were masked, and with those that were not.
std::vector<std::uint8_t> maskAfter(const std::vector<std::uint16_t>& flags,
                                    const std::vector<std::size_t>& selected);

/// Peak of the whole matrix with its place, e.g. "402 kPa ± 12 kPa, row 3, column 4", or ">= 500 kPa, ..."
/// where a reading is a lower limit. The deviation is that of the taxel in `map`, which may be null.
QString peakText(const fsr_pressure_map::PressureStatistics& whole,
                 const fsr_pressure_map::PressureMapConstPtr& map, fsr::view::PressureUnit unit);

/// What the line "Calibration" says about the map: ", tared" if a tare is subtracted from any taxel, and
/// ", history not settled" while that is so. Empty without a map.
QString mapRemark(const fsr_pressure_map::PressureMapConstPtr& map);

/// What the line "Calibration" says about its origin: ", corrected on 2026-11-23 from 3f2a01c4d5e6". Empty if
/// it was trained.
QString correctionRemark(const fsr_pressure_map::CalibrationInfo& info);

/// A line of the panel that may catch the eye.
struct PanelLine {
  QString text;
  QString style;  ///< Qt style sheet
};

/// The line "Alarms": the alarms of all regions. A message is null if none has come recently: without
/// statistics the alarm is UNKNOWN, and without a map the reason is not known.
PanelLine alarmLine(const fsr_pressure_map::PressureStatisticsArrayConstPtr& statistics,
                    const fsr_pressure_map::PressureMapConstPtr& map);

/// One of several sheets round a limb. A message is null if none has come recently.
struct SheetOfLimb {
  std::string name;  ///< its namespace
  fsr_pressure_map::PressureStatisticsArrayConstPtr statistics;
  fsr_pressure_map::PressureMapConstPtr map;
};

/// The lines "Sheets": highest peak and sum of forces, then state, peak and force of each sheet. The sum says
/// which sheets it is without.
QString sheetsText(const std::vector<SheetOfLimb>& sheets, fsr::view::PressureUnit unit);

/// The line "Sheet at rest": whether the sheet rests as the surface says, as the diagnostics of the
/// calibration node do, and what was done at the last doff if that is something else. "-" without values.
PanelLine restLine(const DiagnosticValues& values);

/// What the conductor says, e.g. "Step 3 of 40: Cycle 1 of 10: fill to 620 kPa ...".
QString instructionText(const fsr_pressure_map::Instruction& instruction);

/// Why the last attempt was rejected, and what hinders; at the end, where the report of the day is. Empty =
/// nothing.
PanelLine remarkLine(const fsr_pressure_map::Instruction& instruction);

}  // namespace fsr_rviz
