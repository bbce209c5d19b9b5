#include "fsr_pressure_map/simulation/sensor_chain.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/simulation/effects/effect_library.h"

namespace fsr {

namespace {

std::vector<double> principalCurvatures(const Surface& surface, std::size_t taxels) {
  if (surface.curvature.size() != 1 && surface.curvature.size() != taxels) {
    throw InputError("surface " + surface.name + " has " + std::to_string(surface.curvature.size()) +
                     " curvatures, but one, or one for each of the " + std::to_string(taxels) +
                     " taxels, is needed");
  }
  std::vector<double> curvatures(taxels);
  for (std::size_t i = 0; i < taxels; ++i) curvatures[i] = principalCurvature(surface.at({i}));
  return curvatures;
}

bool earlier(const EffectEntry& a, const EffectEntry& b) {
  return a.info.stage < b.info.stage;
}

}  // namespace

SensorChain::SensorChain(const SimulationSettings& settings)
    : size_(settings.layout.size), full_scale_(settings.fullScale()) {
  std::vector<EffectEntry> order = effectLibrary();
  std::stable_sort(order.begin(), order.end(), earlier);
  for (const EffectEntry& entry : order) {
    const EnabledEffect* enabled = settings.effect(entry.info.id);
    if (enabled)
      links_.push_back({enabled->id, entry.make(enabled->values, {settings.layout, settings.seed})});
  }
  const std::size_t taxels = size_.taxels();
  signals_ = {std::vector<double>(taxels), std::vector<double>(taxels), std::vector<double>(taxels),
              std::vector<double>(taxels)};
  counts_.resize(taxels);
  mount(Surface{"flat", 0, {Curvature{}}, {}});
}

void SensorChain::mount(const Surface& surface) {
  const std::vector<double> curvatures = principalCurvatures(surface, size_.taxels());
  for (Link& link : links_) link.effect->mount(curvatures);
}

const std::vector<std::uint16_t>& SensorChain::read(const RigMoment& moment) {
  std::fill(signals_.load.begin(), signals_.load.end(), moment.pressure);
  std::fill(signals_.gain.begin(), signals_.gain.end(), 1.0);
  for (Link& link : links_) link.effect->apply(moment, signals_);
  const double full_scale = full_scale_;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    counts_[i] = static_cast<std::uint16_t>(std::lround(std::clamp(signals_.reading[i], 0.0, full_scale)));
  }
  return counts_;
}

ChainState SensorChain::state() const {
  ChainState state;
  for (const Link& link : links_) {
    if (!link.effect->state().empty()) state[link.id] = link.effect->state();
  }
  return state;
}

void SensorChain::restore(const ChainState& state) {
  const ChainState mine = this->state();
  const auto fits = [](const auto& a, const auto& b) {
    return a.first == b.first && a.second.size() == b.second.size();
  };
  if (mine.size() != state.size() || !std::equal(mine.begin(), mine.end(), state.begin(), fits)) {
    throw InputError("the state of a simulated matrix does not fit: it has other effects or another size");
  }
  for (Link& link : links_) {
    const auto saved = state.find(link.id);
    if (saved != state.end()) link.effect->state() = saved->second;
  }
}

void SensorChain::reset() {
  for (Link& link : links_) std::fill(link.effect->state().begin(), link.effect->state().end(), 0.0);
}

}  // namespace fsr
