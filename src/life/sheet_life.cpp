#include "life/sheet_life.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::life {

namespace {

constexpr double kDay = 86400;  // [s]
using Source = SheetState::Source;

std::int64_t dayOf(std::int64_t date_ns) {
  return date_ns / static_cast<std::int64_t>(kDay * 1e9);
}

void requireOneSheet(const std::vector<SheetState>& states) {
  for (const SheetState& state : states) {
    const SheetState& other = states.front();
    if (state.sheet != other.sheet) {
      throw settings::InputError(state.file + " is of sheet \"" + state.sheet + "\", but " + other.file +
                                 " is of \"" + other.sheet + "\"; two sheets have two lives");
    }
    if (state.layout.size == other.layout.size && state.full_scale == other.full_scale) continue;
    throw settings::InputError(state.file + " and " + other.file +
                               " have the same sheet, but not the same matrix and converter");
  }
}

// The surface that was recorded on most dates.
std::string usualSurface(const std::vector<SheetState>& states) {
  std::map<std::string, std::set<std::int64_t>> days;
  std::vector<std::string> order;
  for (const SheetState& state : states) {
    if (state.source != Source::kRecording) continue;
    for (const SurfaceState& surface : state.surfaces) {
      if (days.count(surface.surface) == 0) order.push_back(surface.surface);
      days[surface.surface].insert(dayOf(state.date_ns));
    }
  }
  std::string usual;
  for (const std::string& name : order) {
    if (usual.empty() || days[name].size() > days[usual].size()) usual = name;
  }
  return usual;
}

bool hasSurface(const std::vector<SheetState>& states, const std::string& name) {
  return std::any_of(states.begin(), states.end(), [&](const SheetState& state) {
    return std::any_of(state.surfaces.begin(), state.surfaces.end(),
                       [&](const SurfaceState& surface) { return surface.surface == name; });
  });
}

std::vector<std::size_t> sorted(const std::set<std::size_t>& taxels) {
  return {taxels.begin(), taxels.end()};
}

// The states of one day and source as a row.
Row rowOf(const std::vector<const SheetState*>& states, const std::string& surface) {
  Row row;
  row.source = states.front()->source;
  row.date_ns = states.front()->date_ns;
  std::vector<double> gain, scatter, zero, noise, temperature, error;
  std::set<std::size_t> dead, stuck;
  for (const SheetState* const state : states) {
    row.files.push_back(state->file);
    temperature.push_back(state->temperature);
    error.push_back(state->error);
    dead.insert(state->dead.begin(), state->dead.end());
    stuck.insert(state->stuck.begin(), state->stuck.end());
    for (const SurfaceState& on : state->surfaces) {
      // Without recordings there is no usual surface: the mean of the surfaces of each calibration.
      if (!surface.empty() && on.surface != surface) continue;
      gain.push_back(on.gain);
      scatter.push_back(on.gain_scatter);
      zero.push_back(on.zero);
      noise.push_back(on.noise);
    }
  }
  row.gain = meanOfKnown(gain);
  row.gain_scatter = meanOfKnown(scatter);
  row.zero = meanOfKnown(zero);
  row.noise = meanOfKnown(noise);
  row.temperature = meanOfKnown(temperature);
  row.error = meanOfKnown(error);
  row.dead = sorted(dead);
  row.stuck = sorted(stuck);
  return row;
}

std::vector<Row> rowsOf(const std::vector<SheetState>& states, const std::string& surface) {
  std::map<std::pair<std::int64_t, Source>, std::vector<const SheetState*>> groups;
  for (const SheetState& state : states) groups[{dayOf(state.date_ns), state.source}].push_back(&state);
  std::vector<Row> rows;
  for (const auto& [day, group] : groups) rows.push_back(rowOf(group, surface));
  return rows;
}

struct ColumnKind {
  const char* name;
  const char* unit;
  Source source;
  double Row::*value;
};
constexpr std::array<ColumnKind, 5> kColumns = {
    {{"gain", "", Source::kRecording, &Row::gain},
     {"zero", "counts", Source::kRecording, &Row::zero},
     {"noise", "counts", Source::kRecording, &Row::noise},
     {"gain", "", Source::kCalibration, &Row::gain},
     {"held-out error", "Pa", Source::kCalibration, &Row::error}}};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

void testColumn(const std::vector<Row>& rows, double level, Column& column) {
  std::vector<double> days, pauses;
  for (const std::size_t row : column.rows) {
    days.push_back(1e-9 * static_cast<double>(rows[row].date_ns - rows.front().date_ns) / kDay);
    if (days.size() > 1) pauses.push_back(days.back() - days[days.size() - 2]);
  }
  column.tests = testSteps(days, column.values, level, median(pauses));
}

std::vector<Column> columnsOf(const std::vector<Row>& rows, double level) {
  std::vector<Column> columns;
  std::map<Source, double> family;  // columns of each source
  for (const ColumnKind& kind : kColumns) {
    Column column;
    column.name = kind.name;
    column.unit = kind.unit;
    column.source = kind.source;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (rows[r].source != kind.source) continue;
      column.rows.push_back(r);
      column.values.push_back(rows[r].*kind.value);
    }
    if (column.known() == 0) continue;
    family[kind.source] += 1;
    columns.push_back(column);
  }
  for (Column& column : columns) testColumn(rows, level / family[column.source], column);
  return columns;
}

// Taxels that are dead or stuck on a date, and were recorded before as neither.
std::vector<LostTaxel> lostTaxels(const std::vector<Row>& rows) {
  std::vector<LostTaxel> lost;
  std::set<std::size_t> known;  // lost so far
  bool first = true;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (rows[r].source != Source::kRecording) continue;
    for (const bool stuck : {false, true}) {
      for (const std::size_t taxel : stuck ? rows[r].stuck : rows[r].dead) {
        if (known.insert(taxel).second && !first) lost.push_back({r, taxel, stuck});
      }
    }
    first = false;
  }
  return lost;
}

}  // namespace

std::size_t Column::known() const {
  return static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(), [](double value) { return !std::isnan(value); }));
}

std::size_t Column::tested() const {
  return static_cast<std::size_t>(std::count_if(tests.steps.begin(), tests.steps.end(), [](const Step& step) {
    return step.untested == Untested::kNo;
  }));
}

bool SheetLife::changed() const {
  return !lost.empty() || std::any_of(columns.begin(), columns.end(), [](const Column& column) {
    return std::any_of(column.tests.steps.begin(), column.tests.steps.end(),
                       [](const Step& step) { return step.changed; });
  });
}

SheetLife lifeOf(std::vector<SheetState> states, const std::string& first, const LifeOptions& options) {
  SheetLife life;
  life.first = first;
  life.level = options.level;
  if (states.empty()) return life;
  requireOneSheet(states);
  std::stable_sort(states.begin(), states.end(), [](const SheetState& a, const SheetState& b) {
    return std::tie(a.date_ns, a.file) < std::tie(b.date_ns, b.file);
  });
  life.sheet = states.front().sheet;
  life.layout = states.front().layout;
  life.surface = options.surface.empty() ? usualSurface(states) : options.surface;
  if (!options.surface.empty() && !hasSurface(states, options.surface)) {
    throw settings::InputError("sheet \"" + life.sheet + "\": no file has the surface \"" + options.surface +
                               "\"; the usual one is \"" + usualSurface(states) + "\"");
  }
  life.rows = rowsOf(states, life.surface);
  life.columns = columnsOf(life.rows, options.level);
  life.lost = lostTaxels(life.rows);
  return life;
}

}  // namespace fsr::life
