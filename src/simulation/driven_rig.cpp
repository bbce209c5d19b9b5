#include "simulation/driven_rig.h"

#include <algorithm>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

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
