#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "report/life/life_report.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

using life::Column;
using life::SheetLife;
using life::Step;
using settings::cellText;
using settings::fixedText;
using settings::roundedText;
using Source = life::SheetState::Source;

std::string counted(std::size_t number, const std::string& what) {
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

std::string sourceText(const life::Row& row) {
  if (row.source == Source::kRecording) return counted(row.files.size(), "recording");
  return row.files.size() == 1 ? row.files.front() : counted(row.files.size(), "calibration");
}

std::string columnText(const Column& column) {
  return column.name + (column.source == Source::kRecording ? " of the recordings" : " of the calibrations");
}

// "12.1 counts", "6.3 kPa", "0.913".
std::string valueText(const Column& column, double value) {
  if (column.unit == "Pa") return fixedText(value / 1e3, 2) + " kPa";
  if (column.unit.empty()) return fixedText(value, 3);
  return fixedText(value, 2) + " " + column.unit;
}

void addHead(const SheetLife& life, std::ostringstream& out) {
  std::map<Source, std::size_t> files;
  for (const life::Row& row : life.rows) files[row.source] += row.files.size();
  out << "Sheet " << (life.sheet.empty() ? "without a serial number" : life.sheet) << ": "
      << life::dayText(life.rows.front().date_ns) << " to " << life::dayText(life.rows.back().date_ns) << ", "
      << counted(files[Source::kRecording], "recording") << ", "
      << counted(files[Source::kCalibration], "calibration") << '\n';
  if (life.first.empty()) {
    out << "Gain: not known, because there is no calibration of this sheet (--first FILE, or one in the "
           "folder).\n";
  } else {
    out << "Gain: slope against " << life.first << ", the first calibration.\n";
  }
  if (!life.surface.empty()) out << "Gain, zero and noise: on " << life.surface << ".\n";
}

void addTable(const SheetLife& life, std::ostringstream& out) {
  std::size_t width = 16;
  for (const life::Row& row : life.rows) width = std::max(width, sourceText(row).size() + 2);
  const auto line = [&](const std::string& date, const std::string& source,
                        const std::vector<std::string>& cells) {
    out << std::left << std::setw(12) << date << std::setw(static_cast<int>(width)) << source << std::right;
    for (const std::string& cell : cells) out << std::setw(9) << cell;
    out << '\n';
  };
  line("", "", {"gain", "scatter", "zero", "noise", "dead", "stuck", "error", "temp."});
  line("date", "source", {"[1]", "[1]", "[counts]", "[counts]", "taxels", "taxels", "[kPa]", "[deg C]"});
  for (const life::Row& row : life.rows) {
    line(life::dayText(row.date_ns), sourceText(row),
         {cellText(row.gain, 3), cellText(row.gain_scatter, 3), cellText(row.zero, 1), cellText(row.noise, 2),
          std::to_string(row.dead.size()),
          row.source == Source::kRecording ? std::to_string(row.stuck.size()) : "-",
          cellText(row.error / 1e3, 2), cellText(row.temperature, 1)});
  }
}

void addChanges(const SheetLife& life, std::ostringstream& out) {
  out << (life.changed() ? "Changed suddenly:\n" : "Changed suddenly: nothing that was tested.\n");
  for (const Column& column : life.columns) {
    for (std::size_t i = 0; i < column.rows.size(); ++i) {
      const Step& step = column.tests.steps[i];
      if (!step.changed) continue;
      out << "  " << life::dayText(life.rows[column.rows[i]].date_ns) << ": " << columnText(column) << " is "
          << valueText(column, column.values[i]) << "; the dates before let expect "
          << valueText(column, step.predicted) << " +- " << valueText(column, step.half_width)
          << " (p = " << roundedText(step.p, 2) << ")\n";
    }
  }
  for (const life::LostTaxel& lost : life.lost) {
    out << "  " << life::dayText(life.rows[lost.row].date_ns) << ": taxel (row, column) ("
        << life.layout.row({lost.taxel}) << ", " << life.layout.column({lost.taxel}) << ") is "
        << (lost.stuck ? "stuck" : "dead") << "; before it was not\n";
  }
}

// What a test could find next, or why there was none.
std::string outlook(const Column& column) {
  const Step& next = column.tests.next;
  const std::string start = "  " + columnText(column) + ": " + counted(column.tested(), "date") + " tested; ";
  if (next.untested == life::Untested::kNo)
    return start + "at the next one a change beyond +-" + valueText(column, next.half_width) +
           " would be found\n";
  if (next.untested == life::Untested::kNoScatter)
    return start + "the values have no scatter to compare with\n";
  return start + "too few dates to tell more: three make the scatter known\n";
}

void addRule(const SheetLife& life, std::ostringstream& out) {
  std::size_t dates = 0;
  for (const Column& column : life.columns) dates = std::max(dates, column.tested());
  out << "What was tested:\n";
  for (const Column& column : life.columns) out << outlook(column);
  out << "Rule: a value is compared with the prediction interval of a line through the values before it "
         "(slow wear is no change).\n";
  out << "Of the dates at which nothing changed, " << roundedText(100 * life.level)
      << " % show a change by chance, over all columns of a source";
  if (dates > 1) {
    out << "; of " << dates << " dates together at most "
        << roundedText(100 * (1 - std::pow(1 - life.level, static_cast<double>(dates))), 2) << " %";
  }
  out << ".\n";
}

}  // namespace

std::string lifeText(const SheetLife& life) {
  std::ostringstream out;
  if (life.rows.empty()) return "";
  addHead(life, out);
  out << '\n';
  addTable(life, out);
  out << '\n';
  addChanges(life, out);
  addRule(life, out);
  return out.str();
}

}  // namespace fsr::report
