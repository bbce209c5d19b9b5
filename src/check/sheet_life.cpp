#include "check/sheet_life.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/statistics/metrics.h"
#include "statistics/samples.h"

namespace fsr::check {

namespace {

constexpr std::int64_t kDay = 86'400'000'000'000;  // [ns]
constexpr double kRounding = 1e-12;                // residuals up to this share of the values are rounding

// A line in time with scatter, fitted to the values since the last change.
struct Course {
  std::vector<double> time, y;

  // Compares a value (NaN = none yet) with the prediction at its time.
  Step compare(double at, double value, double level) const {
    Step step;
    const auto n = static_cast<double>(y.size());
    if (y.size() < 3) return step;
    const double middle = statistics::meanOf(time), mean = statistics::meanOf(y);
    double tt = 0, ty = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      tt += (time[i] - middle) * (time[i] - middle);
      ty += (time[i] - middle) * (y[i] - mean);
    }
    const double slope = ty / tt;
    double squares = 0, largest = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double residual = y[i] - mean - slope * (time[i] - middle);
      squares += residual * residual;
      largest = std::max(largest, std::abs(y[i]));
    }
    if (std::sqrt(squares / n) <= kRounding * largest) {
      step.untested = kNoScatter;
      return step;
    }
    const double error = std::sqrt(squares / (n - 2) * (1 + 1 / n + (at - middle) * (at - middle) / tt));
    const boost::math::students_t t(n - 2);
    step.untested.clear();
    step.predicted = mean + slope * (at - middle);
    step.half_width = error * boost::math::quantile(boost::math::complement(t, level / 2));
    if (!std::isnan(value))
      step.p = 2 * boost::math::cdf(boost::math::complement(t, std::abs(value - step.predicted) / error));
    step.changed = step.p < level;  // false for NaN
    return step;
  }
};

// The surface that was recorded on most dates; of several, the one that was recorded first.
std::string usualSurface(const std::vector<SheetState>& states) {
  std::map<std::string, std::set<std::int64_t>> days;
  std::string usual;
  for (const SheetState& state : states) {
    for (const SurfaceState& on : state.surfaces) {
      if (!state.calibration) days[on.surface].insert(state.date_ns / kDay);
    }
  }
  for (const SheetState& state : states) {
    for (const SurfaceState& on : state.surfaces) {
      if (!state.calibration && (usual.empty() || days[on.surface].size() > days[usual].size()))
        usual = on.surface;
    }
  }
  return usual;
}

void requireSurface(const std::vector<SheetState>& states, const std::string& name) {
  for (const SheetState& state : states) {
    for (const SurfaceState& on : state.surfaces) {
      if (on.surface == name) return;
    }
  }
  throw settings::InputError("sheet \"" + states.front().sheet + "\": no file has the surface \"" + name +
                             "\"; the usual one is \"" + usualSurface(states) + "\"");
}

// The states of one day and source as a row.
Row rowOf(const std::vector<const SheetState*>& states, const std::string& surface) {
  Row row;
  row.calibration = states.front()->calibration;
  row.date_ns = states.front()->date_ns;
  std::vector<double> temperature, error;
  std::set<std::size_t> dead, stuck;
  for (const SheetState* const state : states) {
    row.files.push_back(state->file);
    temperature.push_back(state->temperature);
    error.push_back(state->error);
    dead.insert(state->dead.begin(), state->dead.end());
    stuck.insert(state->stuck.begin(), state->stuck.end());
  }
  row.temperature = statistics::spreadOf(temperature).mean;
  row.error = statistics::spreadOf(error).mean;
  row.dead = {dead.begin(), dead.end()};
  row.stuck = {stuck.begin(), stuck.end()};
  for (double SurfaceState::*const member :
       {&SurfaceState::gain, &SurfaceState::gain_scatter, &SurfaceState::zero, &SurfaceState::noise}) {
    std::vector<double> values;
    for (const SheetState* const state : states) {
      for (const SurfaceState& on : state->surfaces) {
        // Without recordings there is no usual surface: the mean of the surfaces of each calibration.
        if (surface.empty() || on.surface == surface) values.push_back(on.*member);
      }
    }
    row.*member = statistics::spreadOf(values).mean;
  }
  return row;
}

struct ColumnKind {
  const char* name;
  const char* unit;
  bool calibration;
  double Row::*value;
};
constexpr ColumnKind kColumns[] = {{"gain", "", false, &Row::gain},
                                   {"zero", "counts", false, &Row::zero},
                                   {"noise", "counts", false, &Row::noise},
                                   {"gain", "", true, &Row::gain},
                                   {"held-out error", "Pa", true, &Row::error}};

void testColumn(const std::vector<Row>& rows, double level, Column& column) {
  std::vector<double> days, pauses;
  for (const std::size_t row : column.rows) {
    days.push_back(static_cast<double>(rows[row].date_ns - rows.front().date_ns) / kDay);
    if (days.size() > 1) pauses.push_back(days.back() - days[days.size() - 2]);
  }
  column.tests = testSteps(days, column.values, level, statistics::upperMedian(pauses, 0));
}

std::vector<Column> columnsOf(const std::vector<Row>& rows, double level) {
  std::vector<Column> columns;
  double family[2] = {0, 0};  // columns of recordings, of calibrations
  for (const ColumnKind& kind : kColumns) {
    Column column{kind.name, kind.unit, kind.calibration, {}, {}, {}};
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (rows[r].calibration != kind.calibration) continue;
      column.rows.push_back(r);
      column.values.push_back(rows[r].*kind.value);
    }
    if (std::isnan(statistics::spreadOf(column.values).mean)) continue;
    family[kind.calibration] += 1;
    columns.push_back(column);
  }
  for (Column& column : columns) testColumn(rows, level / family[column.calibration], column);
  return columns;
}

// Taxels that are dead or stuck on a date, and were recorded before as neither.
std::vector<LostTaxel> lostTaxels(const std::vector<Row>& rows) {
  std::vector<LostTaxel> lost;
  std::set<std::size_t> known;  // lost so far
  bool first = true;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (rows[r].calibration) continue;
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

StepTests testSteps(const std::vector<double>& time, const std::vector<double>& y, double level,
                    double next) {
  StepTests tests;
  Course course;
  for (std::size_t i = 0; i < y.size(); ++i) {
    Step step;
    step.untested = kNoValue;
    if (!std::isnan(y[i])) {
      step = course.compare(time[i], y[i], level);
      if (step.changed) course = {};
      course.time.push_back(time[i]);
      course.y.push_back(y[i]);
    }
    tests.steps.push_back(step);
  }
  tests.next = course.compare((course.time.empty() ? 0 : course.time.back()) + next, kUnknown, level);
  return tests;
}

std::size_t Column::tested() const {
  return static_cast<std::size_t>(std::count_if(tests.steps.begin(), tests.steps.end(),
                                                [](const Step& step) { return step.untested.empty(); }));
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
  std::stable_sort(states.begin(), states.end(), [](const SheetState& a, const SheetState& b) {
    return std::tie(a.date_ns, a.file) < std::tie(b.date_ns, b.file);
  });
  if (!options.surface.empty()) requireSurface(states, options.surface);
  life.sheet = states.front().sheet;
  life.layout = states.front().layout;
  life.surface = options.surface.empty() ? usualSurface(states) : options.surface;
  std::map<std::pair<std::int64_t, bool>, std::vector<const SheetState*>> days;
  for (const SheetState& state : states) days[{state.date_ns / kDay, state.calibration}].push_back(&state);
  for (const auto& [day, of_day] : days) life.rows.push_back(rowOf(of_day, life.surface));
  life.columns = columnsOf(life.rows, options.level);
  life.lost = lostTaxels(life.rows);
  return life;
}

}  // namespace fsr::check
