#include "ros/rviz/panel_text.h"

#include <QStringList>
#include <algorithm>
#include <cmath>
#include <vector>

#include "fsr_pressure_map/map/region.h"
#include "fsr_pressure_map/ros/pressure_map_message.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/loaded_calibration.h"
#include "ros/live/calibration_health.h"
#include "ros/messages/view_messages.h"
#include "ros/rviz/display_status.h"

namespace fsr_rviz {

namespace {

using fsr_pressure_map::PressureStatistics;

constexpr auto kNotSet = static_cast<std::uint8_t>(fsr::map::AlarmState::kNotSet);

// Why the alarm of the whole matrix is unknown; empty if the map gives no reason.
QString reasonOfUnknown(const fsr_pressure_map::PressureMapConstPtr& message) {
  if (!message) return "no maps";
  try {
    const fsr::map::PressureMap map = fsr_ros::toPressureMap(*message);
    const std::string state = fsr_ros::stateText(map.state);
    if (!state.empty()) return text(state);
    std::vector<fsr::view::TaxelLook> looks;
    for (std::size_t i = 0; i < map.flags.size(); ++i) {
      looks.push_back(fsr::view::lookOf(map.pressure[i], map.flags[i]));
    }
    const StatusLine taxels = taxelStatus(looks, map.flags);
    return taxels.level == rviz::StatusProperty::Ok ? "" : text(taxels.text);
  } catch (const fsr::settings::InputError&) {
    return "";  // the display shows what is wrong with the message
  }
}

}  // namespace

QString text(const std::string& words) {
  return words.empty() ? QString("-") : QString::fromStdString(words);
}

QString number(double value, double unit, const char* name, int decimals) {
  if (!std::isfinite(value)) return "-";
  return QString::number(value / unit, 'f', decimals) + " " + name;
}

std::vector<std::uint8_t> maskAfter(const std::vector<std::uint16_t>& flags,
                                    const std::vector<std::size_t>& selected) {
  std::vector<std::uint8_t> mask;
  for (const std::uint16_t flag : flags)
    mask.push_back((flag & fsr_pressure_map::PressureMap::FLAG_MASKED) != 0 ? 1 : 0);
  for (const std::size_t taxel : selected) {
    if (taxel < mask.size()) mask[taxel] = mask[taxel] == 0 ? 1 : 0;
  }
  return mask;
}

QString peakText(const PressureStatistics& whole, const fsr_pressure_map::PressureMapConstPtr& map,
                 fsr::view::PressureUnit unit) {
  QString peak = text(fsr::view::limitText(whole.peak, unit, whole.saturated > 0));
  if (!std::isfinite(whole.peak)) return peak;
  const std::size_t taxel = map ? std::size_t{whole.peak_row} * map->columns + whole.peak_column : 0;
  const bool known = map && taxel < map->deviation.size() && std::isfinite(map->deviation[taxel]);
  if (whole.saturated == 0 && known) {
    peak += " \u00b1 " + text(fsr::view::pressureText(double(map->deviation[taxel]), unit));
  }
  return peak + QString(", row %1, column %2").arg(whole.peak_row).arg(whole.peak_column);
}

QString mapRemark(const fsr_pressure_map::PressureMapConstPtr& map) {
  if (!map) return "";
  const bool tared = std::any_of(map->flags.begin(), map->flags.end(), [](std::uint16_t flags) {
    return (flags & fsr_pressure_map::PressureMap::FLAG_TARED) != 0;
  });
  const std::string settling = fsr::view::settlingText(fsr::map::unsettledShare(map->pressure, map->flags));
  return (tared ? QString(", tared") : QString()) + (settling.empty() ? QString() : ", " + text(settling));
}

QString correctionRemark(const fsr_pressure_map::CalibrationInfo& info) {
  return info.parent.empty() ? QString() : ", " + text(fsr_ros::correctionText(info));
}

PanelLine alarmLine(const fsr_pressure_map::PressureStatisticsArrayConstPtr& statistics,
                    const fsr_pressure_map::PressureMapConstPtr& map) {
  QStringList alarm, unknown, unset;
  if (!statistics) {
    unknown << "no statistics";
  } else {
    for (const PressureStatistics& region : statistics->regions) {
      const bool whole = region.region.empty();
      const QString name = whole ? QString("whole matrix") : text(region.region);
      if (region.alarm == PressureStatistics::ALARM) alarm << name;
      if (region.alarm == PressureStatistics::UNKNOWN) {
        const QString reason = whole ? reasonOfUnknown(map) : "";
        unknown << (reason.isEmpty() ? name : name + " (" + reason + ")");
      }
      if (region.alarm == kNotSet) unset << name;
    }
  }
  QStringList lines;
  if (!alarm.empty()) lines << "ALARM: " + alarm.join(", ");
  if (!unknown.empty()) lines << "UNKNOWN: " + unknown.join(", ");
  if (!alarm.empty()) return {lines.join("\n"), "background: #b00020; color: white; font-weight: bold"};
  if (!unknown.empty()) return {lines.join("\n"), "background: #606060; color: white"};
  if (unset.size() == static_cast<int>(statistics->regions.size())) return {"no alarm set", ""};
  return {unset.empty() ? QString("OK") : "OK (no alarm set: " + unset.join(", ") + ")", ""};
}

QString sheetsText(const std::vector<SheetOfLimb>& sheets, fsr::view::PressureUnit unit) {
  const auto numbers = [&](const fsr::map::RegionStatistics& of) {
    const bool at_least = of.at_least > 0;
    return QString("peak ") + text(fsr::view::limitText(of.peak, unit, at_least)) + ", force " +
           (at_least ? ">= " : "") + number(of.force, 1, "N", 1);
  };
  std::vector<fsr::map::RegionStatistics> all;
  QStringList lines, without;
  for (const SheetOfLimb& sheet : sheets) {
    fsr::map::RegionStatistics whole;
    QStringList alarm;
    if (sheet.statistics && !sheet.statistics->regions.empty())
      whole = fsr_ros::toStatistics(sheet.statistics->regions.front());
    for (std::size_t r = 0; sheet.statistics && r < sheet.statistics->regions.size(); ++r) {
      const PressureStatistics& region = sheet.statistics->regions[r];
      if (region.alarm == PressureStatistics::ALARM) alarm << (r == 0 ? "whole matrix" : text(region.region));
    }
    const QString name = text(sheet.name.substr(sheet.name.find_first_not_of('/')));
    if (!std::isfinite(whole.force)) without << name;
    all.push_back(whole);
    QString state = sheet.statistics ? reasonOfUnknown(sheet.map) : "no statistics";
    if (!alarm.empty()) state = "ALARM (" + alarm.join(", ") + ")" + (state.isEmpty() ? "" : ", " + state);
    lines << name + ": " + (state.isEmpty() ? "OK" : state) + ", " + numbers(whole);
  }
  const QString total = "all: " + numbers(fsr::map::sumOfSheets("", all));
  lines.push_front(without.empty() ? total : total + " (without " + without.join(", ") + ")");
  return lines.join("\n");
}

PanelLine restLine(const DiagnosticValues& values) {
  const auto sentence = values.find(fsr_ros::kRestKey);
  const auto verdict = values.find(fsr_ros::kRestVerdictKey);
  if (sentence == values.end() || verdict == values.end()) return {"-", ""};
  const bool disagrees = verdict->second == fsr_ros::kRestDisagrees;
  PanelLine line{(disagrees ? "DISAGREES: " : "") + text(sentence->second),
                 disagrees ? "background: #8a5200; color: white; font-weight: bold" : ""};
  const auto marked = values.find(fsr_ros::kMarkedRestKey);
  const bool told = marked == values.end() || marked->second == fsr_ros::kNoMarkedRest ||
                    marked->second.find(sentence->second) != std::string::npos;
  if (!told) line.text += "\n" + text(marked->second);
  return line;
}

QString instructionText(const fsr_pressure_map::Instruction& instruction) {
  // A session that cannot begin has no steps.
  if (instruction.kind == fsr_pressure_map::Instruction::DONE || instruction.steps == 0)
    return text(instruction.text);
  return QString("Step %1 of %2: ").arg(instruction.step).arg(instruction.steps) + text(instruction.text);
}

PanelLine remarkLine(const fsr_pressure_map::Instruction& instruction) {
  if (instruction.remark.empty()) return {};
  QString remark = text(instruction.remark);
  remark[0] = remark[0].toUpper();
  // At the end it says where the report of the day is.
  const bool done = instruction.kind == fsr_pressure_map::Instruction::DONE;
  return {remark, done ? "" : "color: #b00020"};
}

}  // namespace fsr_rviz
