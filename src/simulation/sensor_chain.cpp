#include "simulation/sensor_chain.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

const char* const kClock = "clock";  // of the chain itself, in its state
enum { kClockStarted, kLastTime, kClockState };

std::vector<double> principalCurvatures(const matrix::Surface& surface, std::size_t taxels) {
  if (surface.curvature.size() != 1 && surface.curvature.size() != taxels) {
    throw settings::InputError(
        "surface " + surface.name + " has " + std::to_string(surface.curvature.size()) +
        " curvatures, but one, or one for each of the " + std::to_string(taxels) + " taxels, is needed");
  }
  std::vector<double> curvatures(taxels);
  for (std::size_t i = 0; i < taxels; ++i) curvatures[i] = matrix::principalCurvature(surface.at({i}));
  return curvatures;
}

bool earlier(const EffectEntry& a, const EffectEntry& b) {
  return a.info.stage < b.info.stage;
}

std::vector<std::uint8_t> actingOn(const EnabledEffect& effect, std::size_t taxels) {
  if (effect.only_taxels.empty()) return {};
  std::vector<std::uint8_t> acts(taxels, 0);
  for (const std::size_t taxel : effect.only_taxels) {
    if (taxel >= taxels) {
      throw settings::InputError("effects." + effect.id + ": only_taxels names " + std::to_string(taxel) +
                                 ", but the matrix has " + std::to_string(taxels) + " taxels");
    }
    acts[taxel] = 1;
  }
  return acts;
}

// Restores the signals of the taxels on which the effect does not act.
void keepOthers(const std::vector<std::uint8_t>& acts, const std::vector<double>& before,
                std::vector<double>& now) {
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (acts[i] == 0) now[i] = before[i];
  }
}

double pressureAt(const RigSample& sample, double time) {
  if (sample.course == nullptr) {
    throw std::invalid_argument("effects of timing need the course of the pressure");
  }
  return (*sample.course)(time);
}

}  // namespace

SensorChain::SensorChain(const SimulationSettings& settings)
    : layout_(settings.layout),
      full_scale_(settings.fullScale()),
      curves_(settings.taxel_curves),
      clock_(kClockState, 0.0) {
  if (curves_ && curves_->taxels != layout_.size.taxels()) {
    throw settings::InputError(settings.taxel_curves_file + ": is of " + std::to_string(curves_->taxels) +
                               " taxels, but the matrix has " + std::to_string(layout_.size.taxels()));
  }
  std::vector<EffectEntry> order = libraryOf(settings).entries();
  std::stable_sort(order.begin(), order.end(), earlier);
  for (const EffectEntry& entry : order) {
    const EnabledEffect* enabled = settings.effect(entry.info.id);
    if (!enabled || entry.info.stage == ChainStage::kReference) continue;
    links_.push_back({enabled->id, entry.info.stage,
                      entry.make(enabled->values, {settings.layout, settings.seed, enabled->spells}),
                      actingOn(*enabled, layout_.size.taxels()), enabled->only_surfaces,
                      enabled->carried_over,
                      entry.info.required && entry.info.stage == ChainStage::kConductance});
  }
  if (curves_) {
    for (const TaxelCurves::OnSurface& surface : curves_->surfaces)
      load_curves_.emplace_back(surface, curves_->taxels);
    siemens_ = 1 / converterOf(settings).values.at("feedback_resistance");
  }
  const std::vector<double> zeros(layout_.size.taxels());
  before_ = signals_ = {0, zeros, zeros, zeros, zeros, zeros};
  counts_.resize(zeros.size());
  mount(matrix::Surface{"flat", 0, {matrix::Curvature{}}, {}});
}

void SensorChain::mount(const matrix::Surface& surface, const LoadPattern& pattern) {
  Mounting mounting{surface.mount, principalCurvatures(surface, layout_.size.taxels()),
                    loadShares(pattern, layout_)};
  for (Link& link : links_) link.effect->place(mounting);
  for (Link& link : links_) {
    std::vector<double>& state = link.effect->state();
    if (!link.carried_over) std::fill(state.begin(), state.end(), 0.0);
    link.effect->mount(mounting);
  }
  for (Link& link : links_) {
    link.here = link.surfaces.empty() || std::count(link.surfaces.begin(), link.surfaces.end(), surface.name);
  }
  share_ = mounting.share;
  if (curves_) on_surface_ = curves_->nearestIndex(mounting.curvature.front());
}

RigSample SensorChain::clocked(const RigSample& sample) {
  RigSample with_clock = sample;
  with_clock.first = clock_[kClockStarted] == 0;
  with_clock.elapsed = with_clock.first ? 0 : std::max(sample.time - clock_[kLastTime], 0.0);
  clock_ = {1, sample.time};
  return with_clock;
}

void SensorChain::load(const RigSample& sample) {
  for (std::size_t i = 0; i < share_.size(); ++i) {
    const double offset = signals_.offset[i];
    const double pressure = offset == 0 ? sample.pressure : pressureAt(sample, sample.time + offset);
    signals_.load[i] = share_[i] * pressure;
  }
}

// The deviations belong to the static curve: gain, faults and read-out act on both.
void SensorChain::addToConductance() {
  const LoadCurves& curves = load_curves_[on_surface_];
  for (std::size_t i = 0; i < share_.size(); ++i) {
    signals_.conductance[i] += siemens_ * signals_.gain[i] * curves.at(i, signals_.load[i]);
  }
}

// An effect updates its state also where it does not act.
void SensorChain::apply(Link& link, const RigSample& sample) {
  if (!link.confined()) return link.effect->apply(sample, signals_);
  before_ = signals_;
  link.effect->apply(sample, signals_);
  if (!link.here) {
    signals_ = before_;
    return;
  }
  keepOthers(link.acts, before_.offset, signals_.offset);
  keepOthers(link.acts, before_.load, signals_.load);
  keepOthers(link.acts, before_.gain, signals_.gain);
  keepOthers(link.acts, before_.conductance, signals_.conductance);
  keepOthers(link.acts, before_.reading, signals_.reading);
}

const std::vector<std::uint16_t>& SensorChain::read(const RigSample& stamped) {
  RigSample sample = clocked(stamped);
  signals_.skew = 0;
  std::fill(signals_.offset.begin(), signals_.offset.end(), 0.0);
  std::fill(signals_.gain.begin(), signals_.gain.end(), 1.0);
  auto link = links_.begin();
  for (; link->stage == ChainStage::kTiming; ++link) apply(*link, sample);
  if (signals_.skew != 0) {
    sample.time -= signals_.skew;
    sample.pressure = pressureAt(sample, sample.time);
  }
  load(sample);
  for (; link != links_.end(); ++link) {
    apply(*link, sample);
    if (link->is_static_curve && curves_) addToConductance();
  }
  const double full_scale = full_scale_;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    counts_[i] = static_cast<std::uint16_t>(std::lround(std::clamp(signals_.reading[i], 0.0, full_scale)));
  }
  return counts_;
}

ChainState SensorChain::state() const {
  ChainState state{{kClock, clock_}};
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
    throw settings::InputError(
        "the state of a simulated matrix does not fit: it has other effects or another size");
  }
  clock_ = state.at(kClock);
  for (Link& link : links_) {
    const auto saved = state.find(link.id);
    if (saved != state.end()) link.effect->state() = saved->second;
  }
}

void SensorChain::reset() {
  std::fill(clock_.begin(), clock_.end(), 0.0);
  for (Link& link : links_) std::fill(link.effect->state().begin(), link.effect->state().end(), 0.0);
}

}  // namespace fsr::simulation
