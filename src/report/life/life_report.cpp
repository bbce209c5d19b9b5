#include "report/life/life_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "report/result_json.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

using check::Column;
using check::Row;
using check::SheetLife;
using check::Step;
using settings::fixedText;
using settings::roundedText;

// The numbers of a row, in the order of every table; dead and stuck taxels stand before the error.
struct Figure {
  const char *key, *csv, *head, *unit;  // in JSON, in CSV, and two lines of the terminal
  int decimals;
  double scale;  // from SI to the unit of the terminal
  double Row::*value;
};
constexpr Figure kFigures[] = {
    {"gain", "gain [1]", "gain", "[1]", 3, 1, &Row::gain},
    {"gain_scatter", "gain scatter [1]", "scatter", "[1]", 3, 1, &Row::gain_scatter},
    {"zero", "zero [counts]", "zero", "[counts]", 1, 1, &Row::zero},
    {"noise", "noise [counts]", "noise", "[counts]", 2, 1, &Row::noise},
    {"held_out_error", "held-out error [Pa]", "error", "[kPa]", 2, 1e-3, &Row::error},
    {"sheet_temperature", "temperature [degree Celsius]", "temp.", "[deg C]", 1, 1, &Row::temperature},
};
constexpr std::size_t kBeforeTaxels = 4;

std::string sourceName(bool calibration) {
  return calibration ? "calibrations" : "recordings";
}

std::string counted(std::size_t number, const std::string& what) {
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

std::string sourceText(const Row& row) {
  if (!row.calibration) return counted(row.files.size(), "recording");
  return row.files.size() == 1 ? row.files.front() : counted(row.files.size(), "calibration");
}

std::string columnText(const Column& column) {
  return column.name + " of the " + sourceName(column.calibration);
}

// "12.1 counts", "6.3 kPa", "0.913".
std::string valueText(const Column& column, double value) {
  if (column.unit == "Pa") return fixedText(value / 1e3, 2) + " kPa";
  if (column.unit.empty()) return fixedText(value, 3);
  return fixedText(value, 2) + " " + column.unit;
}

void addHead(const SheetLife& life, std::ostringstream& out) {
  std::size_t recordings = 0, calibrations = 0;
  for (const Row& row : life.rows) (row.calibration ? calibrations : recordings) += row.files.size();
  out << "Sheet " << (life.sheet.empty() ? "without a serial number" : life.sheet) << ": "
      << check::dayText(life.rows.front().date_ns) << " to " << check::dayText(life.rows.back().date_ns)
      << ", " << counted(recordings, "recording") << ", " << counted(calibrations, "calibration") << '\n';
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
  for (const Row& row : life.rows) width = std::max(width, sourceText(row).size() + 2);
  const auto line = [&](const std::string& date, const std::string& source, const std::string& dead,
                        const std::string& stuck, const auto& cellOf) {
    out << std::left << std::setw(12) << date << std::setw(static_cast<int>(width)) << source << std::right;
    for (std::size_t i = 0; i < std::size(kFigures); ++i) {
      if (i == kBeforeTaxels) out << std::setw(9) << dead << std::setw(9) << stuck;
      out << std::setw(9) << cellOf(kFigures[i]);
    }
    out << '\n';
  };
  line("", "", "dead", "stuck", [](const Figure& figure) { return figure.head; });
  line("date", "source", "taxels", "taxels", [](const Figure& figure) { return figure.unit; });
  for (const Row& row : life.rows) {
    line(check::dayText(row.date_ns), sourceText(row), std::to_string(row.dead.size()),
         row.calibration ? "-" : std::to_string(row.stuck.size()), [&](const Figure& figure) {
           return fixedText(figure.scale * (row.*figure.value), figure.decimals);
         });
  }
}

void addChanges(const SheetLife& life, std::ostringstream& out) {
  out << (life.changed() ? "Changed suddenly:\n" : "Changed suddenly: nothing that was tested.\n");
  for (const Column& column : life.columns) {
    for (std::size_t i = 0; i < column.rows.size(); ++i) {
      const Step& step = column.tests.steps[i];
      if (!step.changed) continue;
      out << "  " << check::dayText(life.rows[column.rows[i]].date_ns) << ": " << columnText(column) << " is "
          << valueText(column, column.values[i]) << "; the dates before let expect "
          << valueText(column, step.predicted) << " +- " << valueText(column, step.half_width)
          << " (p = " << roundedText(step.p, 2) << ")\n";
    }
  }
  for (const check::LostTaxel& lost : life.lost) {
    out << "  " << check::dayText(life.rows[lost.row].date_ns) << ": taxel (row, column) ("
        << life.layout.row({lost.taxel}) << ", " << life.layout.column({lost.taxel}) << ") is "
        << (lost.stuck ? "stuck" : "dead") << "; before it was not\n";
  }
}

void addRule(const SheetLife& life, std::ostringstream& out) {
  std::size_t dates = 0;
  out << "What was tested:\n";
  for (const Column& column : life.columns) {
    dates = std::max(dates, column.tested());
    out << "  " << columnText(column) << ": " << counted(column.tested(), "date") << " tested; ";
    const Step& next = column.tests.next;
    if (next.untested.empty()) {
      out << "at the next one a change beyond +-" << valueText(column, next.half_width)
          << " would be found\n";
    } else if (next.untested == check::kNoScatter) {
      out << "the values have no scatter to compare with\n";
    } else {
      out << "too few dates to tell more: three make the scatter known\n";
    }
  }
  out << "Rule: a value is compared with the prediction interval of a line through the values before it "
         "(slow wear is no change).\n"
      << "Of the dates at which nothing changed, " << roundedText(100 * life.level)
      << " % show a change by chance, over all columns of a source";
  if (dates > 1) {
    out << "; of " << dates << " dates together at most "
        << roundedText(100 * (1 - std::pow(1 - life.level, static_cast<double>(dates))), 2) << " %";
  }
  out << ".\n";
}

// [[row, column], ...]
Json placesJson(const std::vector<std::size_t>& taxels, const matrix::Layout& layout) {
  Json list = Json::array();
  for (const std::size_t taxel : taxels) list.push_back({layout.row({taxel}), layout.column({taxel})});
  return list;
}

Json rowJson(const Row& row, const matrix::Layout& layout) {
  Json json = {
      {"date", check::dayText(row.date_ns)}, {"source", sourceName(row.calibration)}, {"files", row.files}};
  for (std::size_t i = 0; i < std::size(kFigures); ++i) {
    if (i == kBeforeTaxels) {
      json["dead"] = placesJson(row.dead, layout);
      json["stuck"] = placesJson(row.stuck, layout);
    }
    json[kFigures[i].key] = row.*kFigures[i].value;
  }
  return json;
}

Json columnJson(const Column& column, const SheetLife& life) {
  Json dates = Json::array();
  for (std::size_t i = 0; i < column.rows.size(); ++i) {
    const Step& step = column.tests.steps[i];
    dates.push_back({{"date", check::dayText(life.rows[column.rows[i]].date_ns)},
                     {"value", column.values[i]},
                     {"predicted", step.predicted},
                     {"half_width", step.half_width},
                     {"p", step.p},
                     {"changed", step.changed},
                     {"untested", step.untested}});
  }
  return {{"column", column.name},
          {"unit", column.unit},
          {"source", sourceName(column.calibration)},
          {"dates", dates},
          {"next_half_width", column.tests.next.half_width}};
}

Json sheetJson(const SheetLife& life) {
  Json rows = Json::array(), columns = Json::array(), lost = Json::array();
  for (const Row& row : life.rows) rows.push_back(rowJson(row, life.layout));
  for (const Column& column : life.columns) columns.push_back(columnJson(column, life));
  for (const check::LostTaxel& taxel : life.lost) {
    lost.push_back({{"date", check::dayText(life.rows[taxel.row].date_ns)},
                    {"row", life.layout.row({taxel.taxel})},
                    {"column", life.layout.column({taxel.taxel})},
                    {"fault", taxel.stuck ? "stuck" : "dead"}});
  }
  return {{"sheet", life.sheet},       {"first_calibration", life.first},
          {"surface", life.surface},   {"level", life.level},
          {"changed", life.changed()}, {"rows", rows},
          {"tests", columns},          {"lost_taxels", lost}};
}

// A cell of CSV: quoted where it must be.
std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

// "gain; dead taxel".
std::string changesOf(std::size_t row, const SheetLife& life) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  for (const Column& column : life.columns) {
    for (std::size_t i = 0; i < column.rows.size(); ++i) {
      if (column.rows[i] == row && column.tests.steps[i].changed) add(column.name);
    }
  }
  for (const check::LostTaxel& lost : life.lost) {
    if (lost.row == row) add(std::string(lost.stuck ? "stuck" : "dead") + " taxel");
  }
  return text;
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

std::string lifeJson(const std::vector<SheetLife>& lives, const std::vector<SkippedFile>& skipped) {
  Json sheets = Json::array(), left = Json::array();
  for (const SheetLife& life : lives) sheets.push_back(sheetJson(life));
  for (const SkippedFile& file : skipped) left.push_back({{"file", file.file}, {"reason", file.reason}});
  return dump({{"version", FSR_VERSION},
               {"units",
                {{"zero", "counts"},
                 {"noise", "counts"},
                 {"held_out_error", "Pa"},
                 {"sheet_temperature", "degree Celsius"},
                 {"gain", "1"}}},
               {"sheets", sheets},
               {"skipped", left}});
}

std::string lifeCsv(const std::vector<SheetLife>& lives) {
  std::ostringstream out;
  out << "sheet,date,source,files";
  for (std::size_t i = 0; i < std::size(kFigures); ++i)
    out << (i == kBeforeTaxels ? ",dead taxels,stuck taxels," : ",") << kFigures[i].csv;
  out << ",changed\n";
  for (const SheetLife& life : lives) {
    for (std::size_t r = 0; r < life.rows.size(); ++r) {
      const Row& row = life.rows[r];
      out << csvCell(life.sheet) << ',' << check::dayText(row.date_ns) << ',' << sourceName(row.calibration)
          << ',' << row.files.size();
      for (std::size_t i = 0; i < std::size(kFigures); ++i) {
        if (i == kBeforeTaxels) out << ',' << row.dead.size() << ',' << row.stuck.size();
        const double value = row.*kFigures[i].value;
        out << ',' << (std::isnan(value) ? "" : roundedText(value, 9));
      }
      out << ',' << csvCell(changesOf(r, life)) << '\n';
    }
  }
  return out.str();
}

}  // namespace fsr::report
