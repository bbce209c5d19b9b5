#pragma once

#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/PressureStatisticsArray.h>

#include <QString>
#include <string>

namespace fsr_rviz {

/// The words, or "-" for none.
QString text(const std::string& words);

/// `value` in a unit that is worth `unit` in SI, e.g. (0.0026, 1e-4, "cm²", 1) = "26.0 cm²"; NaN is "-".
QString number(double value, double unit, const char* name, int decimals);

/// What stands beside "Alarms": in words first, in colour second.
struct AlarmLine {
  QString text;
  QString style;  ///< Qt style sheet
};

/// Of all regions. Null for what did not come of late: without statistics the alarm is UNKNOWN, and without
/// a map nobody can say why.
AlarmLine alarmLine(const fsr_pressure_map::PressureStatisticsArrayConstPtr& statistics,
                    const fsr_pressure_map::PressureMapConstPtr& map);

}  // namespace fsr_rviz
