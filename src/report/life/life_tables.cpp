#include <cmath>
#include <sstream>

#include "report/life/life_report.h"
#include "report/result_json.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

using Source = life::SheetState::Source;

std::string name(Source source) {
  return source == Source::kRecording ? "recordings" : "calibrations";
}

// [[row, column], ...]
Json places(const std::vector<std::size_t>& taxels, const matrix::Layout& layout) {
  Json list = Json::array();
  for (const std::size_t taxel : taxels) list.push_back({layout.row({taxel}), layout.column({taxel})});
  return list;
}

std::string untestedText(life::Untested reason) {
  switch (reason) {
    case life::Untested::kNo:
      return "";
    case life::Untested::kNoValue:
      return "no value";
    case life::Untested::kTooFew:
      return "too few dates";
    case life::Untested::kNoScatter:
      return "no scatter";
  }
  return "";
}

Json json(const life::Row& row, const matrix::Layout& layout) {
  return {{"date", life::dayText(row.date_ns)},
          {"source", name(row.source)},
          {"files", row.files},
          {"gain", row.gain},
          {"gain_scatter", row.gain_scatter},
          {"zero", row.zero},
          {"noise", row.noise},
          {"dead", places(row.dead, layout)},
          {"stuck", places(row.stuck, layout)},
          {"held_out_error", row.error},
          {"sheet_temperature", row.temperature}};
}

Json json(const life::Column& column, const life::SheetLife& life) {
  Json dates = Json::array();
  for (std::size_t i = 0; i < column.rows.size(); ++i) {
    const life::Step& step = column.tests.steps[i];
    dates.push_back({{"date", life::dayText(life.rows[column.rows[i]].date_ns)},
                     {"value", column.values[i]},
                     {"predicted", step.predicted},
                     {"half_width", step.half_width},
                     {"p", step.p},
                     {"changed", step.changed},
                     {"untested", untestedText(step.untested)}});
  }
  return {{"column", column.name},
          {"unit", column.unit},
          {"source", name(column.source)},
          {"dates", dates},
          {"next_half_width", column.tests.next.half_width}};
}

Json json(const life::SheetLife& life) {
  Json rows = Json::array(), columns = Json::array(), lost = Json::array();
  for (const life::Row& row : life.rows) rows.push_back(json(row, life.layout));
  for (const life::Column& column : life.columns) columns.push_back(json(column, life));
  for (const life::LostTaxel& taxel : life.lost) {
    lost.push_back({{"date", life::dayText(life.rows[taxel.row].date_ns)},
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
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string cell(double value) {
  return std::isnan(value) ? "" : settings::roundedText(value, 9);
}

}  // namespace

std::string lifeJson(const std::vector<life::SheetLife>& lives, const std::vector<SkippedFile>& skipped) {
  Json sheets = Json::array(), left = Json::array();
  for (const life::SheetLife& life : lives) sheets.push_back(json(life));
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

std::string lifeCsv(const std::vector<life::SheetLife>& lives) {
  std::ostringstream out;
  out << "sheet,date,source,files,gain [1],gain scatter [1],zero [counts],noise [counts],dead taxels,stuck "
         "taxels,held-out error [Pa],temperature [degree Celsius],changed\n";
  for (const life::SheetLife& life : lives) {
    for (std::size_t r = 0; r < life.rows.size(); ++r) {
      const life::Row& row = life.rows[r];
      std::string changed;
      const auto add = [&](const std::string& what) { changed += (changed.empty() ? "" : "; ") + what; };
      for (const life::Column& column : life.columns) {
        for (std::size_t i = 0; i < column.rows.size(); ++i)
          if (column.rows[i] == r && column.tests.steps[i].changed) add(column.name);
      }
      for (const life::LostTaxel& lost : life.lost) {
        if (lost.row == r) add(std::string(lost.stuck ? "stuck" : "dead") + " taxel");
      }
      out << cell(life.sheet) << ',' << life::dayText(row.date_ns) << ',' << name(row.source) << ','
          << row.files.size() << ',' << cell(row.gain) << ',' << cell(row.gain_scatter) << ','
          << cell(row.zero) << ',' << cell(row.noise) << ',' << row.dead.size() << ',' << row.stuck.size()
          << ',' << cell(row.error) << ',' << cell(row.temperature) << ',' << cell(changed) << '\n';
    }
  }
  return out.str();
}

}  // namespace fsr::report
