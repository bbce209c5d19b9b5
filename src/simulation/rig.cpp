#include "simulation/rig.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "settings/yaml_text.h"

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

}  // namespace fsr::simulation
