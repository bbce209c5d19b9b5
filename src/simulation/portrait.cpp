#include "simulation/portrait.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/chamber.h"
#include "simulation/effects/effect_library.h"
#include "simulation/pressure_profile.h"
#include "simulation/rig.h"
#include "simulation/sensor_chain.h"

namespace fsr::simulation {

namespace {

const matrix::Surface kFlat{"flat", 1, {matrix::Curvature{}}, {}};
const matrix::Surface kBent{"cylinder of 5 cm", 2, {matrix::Curvature{20, 0, 0}}, {}};
constexpr double kSlow = 17e3, kFast = 60e3;             // [Pa/s]
constexpr double kPortraitPeak = 620e3, kLevel = 300e3;  // [Pa]
constexpr double kHold = 900;                            // [s]
constexpr double kWarming = 5;                           // of the room while it is held and at rest [K]
constexpr double kPeriod = 0.2, kLongPeriod = 0.5;       // from scan to scan [s]

/// One experiment.
struct Trial {
  PressureProfile profile;  // what the transducer shows
  double period = kPeriod;  // from scan to scan [s]
  matrix::Surface surface = kBent;
  LoadPattern load;
  double warming = 0;  // of the room from begin to end [K]
};

/// Readings of all scans in shares of full scale, [scans x taxels].
std::vector<double> run(const SimulationSettings& noisy, const Trial& trial) {
  const SimulationSettings settings = withoutNoise(noisy);
  SensorChain chain(settings);
  const ReferenceChannel reference(settings);
  const PressureCourse course = [&](double time) { return reference.truePressure(trial.profile.at(time)); };
  chain.mount(trial.surface, trial.load);
  std::vector<double> readings;
  const double duration = trial.profile.duration();
  for (std::uint64_t scan = 0; static_cast<double>(scan) * trial.period <= duration; ++scan) {
    const double time = static_cast<double>(scan) * trial.period;
    chain.read({time, course(time), scan, kRoomTemperature + trial.warming * time / duration, &course});
    for (const double reading : chain.reading()) readings.push_back(reading / settings.fullScale());
  }
  return readings;
}

std::vector<double> difference(const SimulationSettings& with, const SimulationSettings& without,
                               const Trial& trial) {
  std::vector<double> change = run(with, trial);
  const std::vector<double> before = run(without, trial);
  for (std::size_t i = 0; i < change.size(); ++i) change[i] -= before[i];
  return change;
}

enum class Axis { kTime, kPressure };

/// One taxel of a run's readings.
PortraitLine line(const std::string& label, const Trial& trial, const std::vector<double>& readings,
                  std::size_t taxels, std::size_t taxel, Axis axis) {
  PortraitLine result{label, {}, {}};
  for (std::size_t scan = 0; scan * taxels < readings.size(); ++scan) {
    const double time = static_cast<double>(scan) * trial.period;
    result.x.push_back(axis == Axis::kTime ? time : trial.profile.at(time));
    result.y.push_back(readings[scan * taxels + taxel]);
  }
  return result;
}

std::size_t mostChanged(const std::vector<double>& change, std::size_t taxels) {
  std::vector<double> sums(taxels);
  for (std::size_t i = 0; i < change.size(); ++i) sums[i % taxels] += std::abs(change[i]);
  return static_cast<std::size_t>(std::max_element(sums.begin(), sums.end()) - sums.begin());
}

std::vector<PortraitLine> changes(const SimulationSettings& with, const SimulationSettings& without,
                                  const Trial& trial, Axis axis) {
  const std::size_t taxels = with.layout.size.taxels();
  const std::vector<double> change = difference(with, without, trial);
  return {line("most changed taxel", trial, change, taxels, mostChanged(change, taxels), axis),
          line("first taxel", trial, change, taxels, 0, axis),
          line("last taxel", trial, change, taxels, taxels - 1, axis)};
}

std::vector<PortraitLine> responses(const SimulationSettings& with, const SimulationSettings& without) {
  const std::size_t taxels = with.layout.size.taxels();
  std::vector<PortraitLine> lines;
  for (const matrix::Surface& surface : {kFlat, kBent}) {
    Trial trial{pressureProfile(ChamberProgram{HoldPart{kPortraitPeak, kSlow, 0}}), kPeriod, surface, {}, 0};
    lines.push_back(
        line(surface.name + ", without", trial, run(without, trial), taxels, taxels / 2, Axis::kPressure));
    lines.push_back(line(surface.name, trial, run(with, trial), taxels, taxels / 2, Axis::kPressure));
  }
  return lines;
}

Trial cycles() {
  const ChamberProtocol slow{kPortraitPeak, kSlow, kSlow, 1, 1, 3},
      fast{kPortraitPeak, kFast, kFast, 1, 1, 1};
  return {pressureProfile(ChamberProgram{slow, fast}), kPeriod, kBent, {}, 0};
}

Trial stepAndHold() {
  const ChamberProgram program{HoldPart{0, kFast, 30}, HoldPart{kLevel, 2 * kFast, kHold},
                               RestPart{2 * kFast, kHold}};
  return {pressureProfile(program), kLongPeriod, kBent, {}, kWarming};
}

Trial pressed(const LoadPattern& pattern) {
  return {pressureProfile(ChamberProgram{HoldPart{kLevel, kSlow, 2}}), kPeriod, kBent, pattern, 0};
}

LoadPattern discOn(const matrix::Layout& layout) {
  const double side = std::min(layout.size.columns * layout.pitch_x, layout.size.rows * layout.pitch_y);
  return {LoadPattern::Kind::kDisc, {0, 0}, 0.35 * side, 0};
}

std::vector<double> scanAt(const std::vector<double>& readings, std::size_t scan, std::size_t taxels) {
  const auto first = readings.begin() + static_cast<std::ptrdiff_t>(scan * taxels);
  return {first, first + static_cast<std::ptrdiff_t>(taxels)};
}

/// The scan of the largest change over all taxels.
std::vector<double> largest(const std::vector<double>& change, std::size_t taxels) {
  std::size_t best = 0;
  double best_sum = -1;
  for (std::size_t scan = 0; scan < change.size() / taxels; ++scan) {
    double sum = 0;
    for (const double value : scanAt(change, scan, taxels)) sum += std::abs(value);
    if (sum > best_sum) best = scan;
    best_sum = std::max(best_sum, sum);
  }
  return scanAt(change, best, taxels);
}

bool isCore(const EffectInfo& info) {
  return info.kind == EffectKind::kBase || info.with_bending;
}

template <typename Unwanted>
SimulationSettings withoutThose(SimulationSettings settings, Unwanted unwanted) {
  auto& effects = settings.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(), unwanted), effects.end());
  return settings;
}

}  // namespace

SimulationSettings withEffect(const SimulationSettings& settings, const std::string& id) {
  const EffectEntry* entry = libraryOf(settings).find(id);
  if (!entry || !entry->make)
    throw settings::InputError(id + ": no effect that can be simulated has that name");
  SimulationSettings result = settings;
  if (result.effect(id)) return result;
  EnabledEffect effect{id, {}};
  for (const EffectParameter& parameter : entry->info.parameters) {
    effect.values[parameter.name] = parameter.usual;
  }
  result.effects.push_back(effect);
  return result;
}

SimulationSettings withoutEffect(const SimulationSettings& settings, const std::string& id) {
  return withoutThose(settings, [&](const EnabledEffect& effect) { return effect.id == id; });
}

SimulationSettings coreOf(const SimulationSettings& settings) {
  return withoutThose(
      settings, [&](const EnabledEffect& effect) { return !isCore(libraryOf(settings).info(effect.id)); });
}

Portrait portray(const SimulationSettings& with, const SimulationSettings& without) {
  Portrait portrait;
  portrait.title = with.name;
  portrait.response = responses(with, without);
  portrait.loop = changes(with, without, cycles(), Axis::kPressure);
  const Trial hold = stepAndHold();
  portrait.hold = changes(with, without, hold, Axis::kTime);
  portrait.hold_pressure = {"chamber", portrait.hold[0].x, {}};
  for (const double time : portrait.hold[0].x) portrait.hold_pressure.y.push_back(hold.profile.at(time));
  portrait.size = with.layout.size;
  const std::size_t taxels = portrait.size.taxels();
  const Trial disc = pressed(discOn(with.layout));
  const std::vector<double> readings = run(with, disc);
  portrait.disc = scanAt(readings, readings.size() / taxels - 1, taxels);
  portrait.disc_change = largest(difference(with, without, disc), taxels);
  portrait.gas_change = largest(difference(with, without, pressed({})), taxels);
  return portrait;
}

}  // namespace fsr::simulation
