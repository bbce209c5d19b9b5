#include <algorithm>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <optional>
#include <sstream>

#include "calibration/stages/session/session_rests.h"
#include "check/sheet_life.h"
#include "dataset/count_readers.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/statistics/metrics.h"
#include "health/recording_health.h"

namespace fsr::check {

namespace {

using calibration::Calibration;

// The share of the first calibration's range of pressure over which the slope is taken: up to 1 / 0.7 = 1.4
// times its first gain a sheet still reads codes that the first calibration knows.
constexpr double kLowShare = 0.1;
constexpr double kHighShare = 0.7;

struct PressureRange {
  explicit PressureRange(const calibration::TrainedInterval& trained)
      : low(trained.low + kLowShare * (trained.high - trained.low)),
        high(trained.low + kHighShare * (trained.high - trained.low)) {}
  double low, high;  // [Pa]
};

// Sums of a straight line y over x.
struct LineSums {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;

  void add(double at, double value) {
    n += 1;
    x += at;
    y += value;
    xx += at * at;
    xy += at * value;
  }
  double slope() const {
    const double spread = n * xx - x * x;
    return n >= 3 && spread > 0 ? (n * xy - x * y) / spread : kUnknown;
  }
};

void setGain(const std::vector<LineSums>& lines, SurfaceState& state) {
  std::vector<double> slopes;
  for (const LineSums& line : lines) slopes.push_back(line.slope());
  const statistics::Spread spread = statistics::spreadOf(slopes);
  state.gain = spread.mean;
  state.gain_scatter = spread.deviation;
}

// The class of the calibration that a surface belongs to, by its curvatures.
std::optional<std::size_t> classOf(const Calibration& calibration, const dataset::CurvatureClass& surface) {
  const compensation::CurvatureTables& tables = calibration.tables;
  if (tables.classes.size() == 1 && !compensation::usesCurvature(tables.scheme)) return 0;
  std::optional<std::size_t> nearest;
  double distance = tables.class_tolerance;
  for (std::size_t c = 0; c < tables.classes.size(); ++c) {
    double farthest = 0;
    for (std::size_t t = 0; t < tables.size.taxels(); ++t)
      farthest = std::max(farthest, std::abs(tables.classes[c].at(t) - surface.at(t)));
    if (farthest > distance) continue;
    distance = farthest;
    nearest = c;
  }
  return nearest;
}

void requireSame(const Calibration* first, const matrix::Layout& layout, std::uint16_t full_scale) {
  if (first == nullptr || (layout.size == first->layout.size && full_scale == first->tables.full_scale))
    return;
  const auto text = [](const matrix::MatrixSize& size, std::uint16_t counts) {
    return matrix::sizeText(size) + " taxels and " + std::to_string(counts) + " counts";
  };
  throw settings::InputError("it has " + text(layout.size, full_scale) +
                             ", but the first calibration of the same sheet has " +
                             text(first->layout.size, first->tables.full_scale));
}

// Zero and noise in the rest at the start. `ignored`: [taxels].
void addRest(const dataset::Recording& recording, std::size_t condition,
             const std::vector<std::uint8_t>& ignored, SurfaceState& state) {
  double sum = 0, squares = 0, readings = 0, steps = 0;
  dataset::ScanCounts scans(recording);
  std::vector<std::uint16_t> before;  // counts of the scan before
  for (const std::size_t at : calibration::restAtStart(recording, condition)) {
    const std::uint16_t* const scan = scans[at];
    for (std::size_t t = 0; t < ignored.size(); ++t) {
      if (ignored[t] != 0) continue;
      sum += scan[t];
      readings += 1;
      if (before.empty()) continue;
      const double step = double(scan[t]) - double(before[t]);
      squares += step * step;
      steps += 1;
    }
    before.assign(scan, scan + ignored.size());
  }
  if (readings == 0) return;
  state.zero = sum / readings;
  state.noise = std::sqrt(squares / steps / 2);  // a step has the noise of two readings
}

// Slope of what the first calibration answers to the readings over their pressures.
void addGain(const dataset::Recording& recording, std::size_t condition, const Calibration& first,
             const std::vector<std::uint8_t>& ignored, SurfaceState& state) {
  const matrix::Surface& surface = recording.conditions[condition];
  if (!surface.known()) return;
  dataset::CurvatureClass bent{surface.name, {}};
  for (const matrix::Curvature& curvature : surface.curvature)
    bent.curvature.push_back(matrix::principalCurvature(curvature));
  const std::optional<std::size_t> known = classOf(first, bent);
  if (!known) return;
  const PressureRange range(first.trained.pressure);
  std::vector<LineSums> lines(ignored.size());
  dataset::ScanCounts scans(recording);
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    const double pressure = recording.pressure[i];
    if (recording.condition[i] != condition || !(pressure >= range.low && pressure <= range.high)) continue;
    const std::uint16_t* const scan = scans[i];
    for (std::size_t t = 0; t < lines.size(); ++t) {
      const double answer = first.tables.table(t, *known).pressure[scan[t]];
      if (ignored[t] == 0 && !std::isnan(answer)) lines[t].add(pressure, answer);
    }
  }
  setGain(lines, state);
}

// The line of what the first calibration answers over what this one answers, at evenly spaced pressures: a
// mean over codes would weigh the steep part of the curve least.
LineSums lineBetween(const regression::CodeTable& first, const regression::CodeTable& now,
                     const PressureRange& range) {
  constexpr int kPoints = 50;
  LineSums line;
  std::size_t code = now.lowest;
  for (int i = 0; i <= kPoints; ++i) {
    const double pressure = range.low + (range.high - range.low) * i / kPoints;
    while (code < now.highest && now.pressure[code] < pressure) ++code;
    if (now.pressure[code] < pressure || code == now.lowest) continue;  // outside the table
    const double below = now.pressure[code - 1], share = (pressure - below) / (now.pressure[code] - below);
    const double answer = (1 - share) * first.pressure[code - 1] + share * first.pressure[code];
    if (std::isfinite(answer)) line.add(pressure, answer);
  }
  return line;
}

SurfaceState stateOnClass(const Calibration& calibration, std::size_t now, const Calibration* first) {
  SurfaceState state;
  state.surface = calibration.tables.classes[now].surface;
  if (first == nullptr) return state;
  const std::optional<std::size_t> then = classOf(*first, calibration.tables.classes[now]);
  if (!then) return state;
  const PressureRange range(first->trained.pressure);
  std::vector<LineSums> lines;
  for (std::size_t t = 0; t < calibration.layout.size.taxels(); ++t) {
    if (calibration.no_model[t] != 0 || first->no_model[t] != 0) continue;
    lines.push_back(lineBetween(first->tables.table(t, *then), calibration.tables.table(t, now), range));
  }
  setGain(lines, state);
  return state;
}

// A taxel without contact reads the noise of the board, and that is known from the rest: five deviations of
// it are exceeded once in 3.5 million readings. The readings of loaded taxels are far above.
health::TaxelWatchOptions watchOptions(const SheetState& state) {
  constexpr double kDeviations = 5;
  health::TaxelWatchOptions options;
  for (const SurfaceState& surface : state.surfaces) {
    if (std::isnan(surface.noise)) continue;
    options.floor_share = std::max(options.floor_share, kDeviations * surface.noise / state.full_scale);
  }
  options.floor_share = std::min(options.floor_share, options.travel_share);
  return options;
}

}  // namespace

std::string sheetOf(const dataset::SensorIdentity& sensor) {
  return sensor.serial.empty() ? sensor.sensor_id : sensor.serial;
}

SheetState stateOf(const dataset::Recording& recording, const Calibration* first) {
  requireSame(first, recording.layout, recording.full_scale);
  SheetState state;
  state.file = recording.name;
  state.sheet = sheetOf(recording.sensor);
  state.date_ns = recording.start_ns;
  state.layout = recording.layout;
  state.full_scale = recording.full_scale;
  state.temperature = statistics::spreadOf(recording.temperature).mean;
  std::vector<std::uint8_t> ignored = recording.mask;
  ignored.resize(recording.layout.size.taxels(), 0);
  for (std::size_t c = 0; c < recording.conditions.size() && !recording.pressure.empty(); ++c) {
    state.surfaces.emplace_back();
    state.surfaces.back().surface = recording.conditions[c].name;
    addRest(recording, c, ignored, state.surfaces.back());
  }
  const health::RecordingHealth health = health::recordingHealth(recording, watchOptions(state));
  state.dead = health.dead;
  state.stuck = health.stuck;
  for (const auto& failed : {state.dead, state.stuck}) {
    for (const std::size_t taxel : failed) ignored[taxel] = 1;
  }
  for (std::size_t c = 0; first != nullptr && c < state.surfaces.size(); ++c)
    addGain(recording, c, *first, ignored, state.surfaces[c]);
  return state;
}

SheetState stateOf(const Calibration& calibration, const Calibration* first) {
  requireSame(first, calibration.layout, calibration.tables.full_scale);
  SheetState state;
  state.calibration = true;
  state.file = calibration.id;
  state.sheet = sheetOf(calibration.sensor);
  state.date_ns = dateOf(calibration.provenance.date);
  state.layout = calibration.layout;
  state.full_scale = calibration.tables.full_scale;
  for (std::size_t t = 0; t < calibration.no_model.size(); ++t) {
    if (calibration.no_model[t] != 0 && calibration.masked[t] == 0) state.dead.push_back(t);
  }
  const calibration::TrainedInterval& temperature = calibration.trained.temperature;
  if (temperature.known()) state.temperature = (temperature.low + temperature.high) / 2;
  state.error = calibration.scores.whole.errors.whole.all.rmse;
  for (std::size_t c = 0; c < calibration.tables.classes.size(); ++c)
    state.surfaces.push_back(stateOnClass(calibration, c, first));
  return state;
}

std::int64_t dateOf(const std::string& iso) {
  std::tm parts{};
  std::istringstream text(iso);
  text >> std::get_time(&parts, "%Y-%m-%dT%H:%M:%S");
  if (text.fail()) {
    throw settings::InputError("its date is \"" + iso + "\", but must be one such as 2026-03-01T12:00:00Z");
  }
  return 1'000'000'000 * static_cast<std::int64_t>(timegm(&parts));
}

std::string dayText(std::int64_t date_ns) {
  const std::time_t seconds = date_ns / 1'000'000'000;
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[16];
  std::strftime(text, sizeof(text), "%Y-%m-%d", &parts);
  return text;
}

}  // namespace fsr::check
