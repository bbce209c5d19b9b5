#include "simulation/rig.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "settings/text.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

// State: whether there was a call before, its time [s], its pressure [Pa], and the slow mean of the pressure
// [Pa].
enum { kGasStarted, kGasTime, kGasPressure, kGasSlow, kGasState };

}  // namespace

ChamberGas::ChamberGas(const ChamberClimate& climate)
    : climate_(climate), cooling_(climate.cooling), state_(kGasState) {}

double ChamberGas::room(double time) const {
  const auto& points = climate_.room;
  if (points.empty()) return kRoomTemperature;
  const auto next = std::find_if(points.begin(), points.end(),
                                 [time](const TemperaturePoint& point) { return point.time > time; });
  if (next == points.begin()) return points.front().temperature;
  if (next == points.end()) return points.back().temperature;
  const auto from = next - 1;
  const double share = (time - from->time) / (next->time - from->time);
  return from->temperature + share * (next->temperature - from->temperature);
}

double ChamberGas::temperature(double time, double pressure) {
  // dT/dt = c dP/dt - T / tau, T above the room. The solution is c times the pressure less its exponential
  // mean.
  const double slow = state_[kGasStarted] == 0 ? 0
                                               : cooling_.step(state_[kGasPressure], pressure,
                                                               time - state_[kGasTime], state_[kGasSlow]);
  state_ = {1, time, pressure, slow};
  return room(time) + climate_.heating * (pressure - slow);
}

ReferenceChannel::ReferenceChannel(const SimulationSettings& settings) : transducer_(settings.transducer) {
  for (const EnabledEffect& enabled : settings.effects) {
    const EffectEntry* entry = libraryOf(settings).find(enabled.id);
    if (entry->info.stage != ChainStage::kReference) continue;
    effects_.push_back(entry->make(enabled.values, {settings.layout, settings.seed}));
  }
}

double ReferenceChannel::indicated(double pressure) const {
  for (const auto& effect : effects_) pressure = effect->transduce(pressure);
  return pressure;
}

double ReferenceChannel::truePressure(double indicated) const {
  // Errors are a fraction of the pressure, so that each round leaves a fraction of the rest.
  constexpr int kMostRounds = 40;
  double pressure = indicated;
  for (int round = 0; round < kMostRounds; ++round) {
    const double rest = indicated - this->indicated(pressure);
    if (rest == 0) break;
    pressure += rest;
  }
  return pressure;
}

namespace {

const settings::Range kAny{-std::numeric_limits<double>::max(), std::numeric_limits<double>::max(), ""};
constexpr std::int64_t kFormat = 1;

std::string list(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + settings::numberText(value);
  return "[" + text + "]\n";
}

}  // namespace

std::string stateText(const RigState& state) {
  std::string text = "# What a simulated rig remembers; simulate --state goes on from it.\nrig_state: " +
                     std::to_string(kFormat) + "\norigin_ns: " + std::to_string(state.origin_ns) +
                     "\ntime: " + settings::numberText(state.time) +
                     "\nscans: " + std::to_string(state.scans) + "\nmount: " + std::to_string(state.mount) +
                     "\nsurface: " + settings::quotedText(state.surface) + "\ngas: " + list(state.gas) +
                     "sheet:\n";
  for (const auto& [id, values] : state.sheet) text += "  " + id + ": " + list(values);
  return text;
}

RigState readRigState(const settings::Settings& settings) {
  settings.integer("rig_state", {kFormat, kFormat, ""});
  RigState state;
  state.origin_ns = settings.integer("origin_ns", {0, 9e18, "ns"});
  state.time = settings.number("time", {0, 1e12, "s"});
  state.scans = static_cast<std::uint64_t>(settings.integer("scans", {0, 9e15, ""}));
  state.mount = static_cast<std::uint32_t>(settings.integer("mount", {0, 4294967295.0, ""}));
  state.surface = settings.text("surface");
  state.gas = settings.numbers("gas", kAny);
  const settings::Settings sheet = settings.section("sheet");
  for (const std::string& id : sheet.keys()) state.sheet[id] = sheet.numbers(id, kAny);
  settings.refuseUnknown();
  return state;
}

Rig::Rig(const SimulationSettings& settings)
    : chain_(settings), reference_(settings), gas_(settings.climate) {}

const std::vector<std::uint16_t>& Rig::scan(double time, const PressureCourse& pressure) {
  RigSample sample;
  sample.time = time;
  sample.pressure = pressure(time);
  sample.scan = scans_++;
  sample.temperature = gas_.temperature(time, sample.pressure);
  sample.course = &pressure;
  return chain_.read(sample);
}

std::int32_t Rig::transducer(double time, const PressureCourse& pressure) const {
  return reference_.counts(pressure(time));
}

double Rig::temperature(double time, const PressureCourse& pressure) {
  return gas_.temperature(time, pressure(time));
}

void Rig::save(RigState& state) const {
  state.scans = scans_;
  state.gas = gas_.state();
  state.sheet = chain_.state();
}

void Rig::restore(const RigState& state) {
  chain_.restore(state.sheet);
  if (state.gas.size() == gas_.state().size()) gas_.state() = state.gas;
  scans_ = state.scans;
}

namespace {

/// The pressure of a recording, linear between its scans and constant outside. The search starts at the last
/// time.
class RecordedCourse {
 public:
  RecordedCourse(const dataset::Recording& recording, double start) : recording_(recording), start_(start) {}

  double operator()(double rig_time) {
    const auto& time = recording_.time;
    const auto& pressure = recording_.pressure;
    const double wanted = rig_time - start_;
    while (next_ > 0 && time[next_ - 1] > wanted) --next_;
    while (next_ < time.size() && time[next_] <= wanted) ++next_;
    if (next_ == 0) return pressure.front();
    if (next_ == time.size()) return pressure.back();
    const double share = (wanted - time[next_ - 1]) / (time[next_] - time[next_ - 1]);
    return pressure[next_ - 1] + share * (pressure[next_] - pressure[next_ - 1]);
  }

 private:
  const dataset::Recording& recording_;
  double start_;          // rig time of the recording's time 0 [s]
  std::size_t next_ = 0;  // first scan after the time asked about
};

}  // namespace

SimulationSettings fitted(const SimulationSettings& settings, const dataset::Recording& recording) {
  SimulationSettings result = settings;
  result.layout = recording.layout;
  for (EnabledEffect& effect : result.effects) {
    if (effect.id == converterOf(settings).id) effect.values["full_scale"] = recording.full_scale;
  }
  return result;
}

DrivenRig::DrivenRig(const SimulationSettings& settings)
    : settings_(settings), chain_(settings), reference_(settings) {}

void DrivenRig::require(const dataset::Recording& recording) const {
  if (recording.pressure.empty() || recording.scans() == 0) {
    throw settings::InputError(recording.name + ": contains no chamber pressure, which the simulation needs");
  }
  if (recording.layout.size != settings_.layout.size) {
    throw settings::InputError(recording.name + ": is of a matrix of " +
                               matrix::sizeText(recording.layout.size) + ", but the simulated one has " +
                               matrix::sizeText(settings_.layout.size));
  }
  const bool early =
      origin_ns_ &&
      1e-9 * static_cast<double>(recording.start_ns - *origin_ns_) + recording.time.front() < end_;
  if (early) {
    throw settings::InputError(
        recording.name + ": begins before the recording before it has ended; give recordings in time order");
  }
}

void DrivenRig::lie(const matrix::Surface& surface) {
  if (surface_ && matrix::sameCondition(*surface_, surface)) return;
  chain_.mount(surface.known() ? surface
                               : matrix::Surface{surface.name, surface.mount, {matrix::Curvature{}}, {}});
  surface_ = surface;
  // The sheet lay there already and was not mounted again.
  if (resumed_ && surface.mount == resumed_->mount && surface.name == resumed_->surface) {
    chain_.restore(resumed_->sheet);
  }
  resumed_.reset();
}

void DrivenRig::resume(const RigState& state) {
  chain_.restore(state.sheet);
  origin_ns_ = state.origin_ns;
  end_ = state.time;
  scans_ = state.scans;
  surface_.reset();
  resumed_ = state;
}

RigState DrivenRig::state() const {
  RigState state;
  state.origin_ns = origin_ns_.value_or(0);
  state.time = end_;
  state.scans = scans_;
  if (surface_) {
    state.mount = surface_->mount;
    state.surface = surface_->name;
  }
  state.sheet = chain_.state();
  return state;
}

void DrivenRig::run(const dataset::Recording& recording,
                    const std::function<void(std::size_t, const SensorChain&)>& listener) {
  require(recording);
  if (!origin_ns_) origin_ns_ = recording.start_ns;
  const double start = 1e-9 * static_cast<double>(recording.start_ns - *origin_ns_);
  RecordedCourse recorded(recording, start);
  const PressureCourse course = [&](double time) { return reference_.truePressure(recorded(time)); };
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    const matrix::Surface& surface = recording.conditions.at(recording.condition[i]);
    lie(surface);
    RigSample sample;
    sample.time = start + recording.time[i];
    sample.pressure = reference_.truePressure(recording.pressure[i]);
    sample.scan = scans_++;
    if (!recording.temperature.empty()) sample.temperature = recording.temperature[i];
    sample.course = &course;
    chain_.read(sample);
    listener(i, chain_);
  }
  end_ = start + recording.time.back();
}

}  // namespace fsr::simulation
