#include "discrepancy/decide/take_out.h"

#include "discrepancy/decide/candidates.h"
#include "discrepancy/decide/changes.h"
#include "discrepancy/decide/refine.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

void takeOut(Measured& measured, const StaticFit& fit, const simulation::SimulationSettings& without,
             const simulation::SimulationSettings& with) {
  const Changes changes = changesBy(measured, without, with, driven(measured, without, true), true);
  const Trace load = loadOf(measured, changes);
  if (measured.gain.empty()) {
    measured.unloaded = fit.unloaded();
    measured.gain.assign(measured.samples(), 1.0);
    measured.added.assign(measured.samples(), 0.0);
  }
  measured.load.assign(load.data(), load.data() + load.size());
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    measured.gain[i] *= changes.gain[static_cast<Eigen::Index>(i)];
    measured.added[i] += changes.reading[static_cast<Eigen::Index>(i)];
  }
}

bool hasTimeCourse(const simulation::EffectInfo& info) {
  return (info.kind == simulation::EffectKind::kAdditive || info.kind == simulation::EffectKind::kGrid) &&
         !isStatic(info) && info.detector == simulation::Detector::kNone;
}

simulation::SimulationSettings takeOutEnabled(Measured& measured, const CommonTraces& common,
                                              const StaticFit& fit,
                                              const simulation::SimulationSettings& base, bool fit_sizes,
                                              const std::vector<simulation::EnabledEffect>& beside) {
  simulation::SimulationSettings still = base, with = base;
  std::vector<simulation::EnabledEffect> moving;
  still.effects.clear();
  for (const simulation::EnabledEffect& effect : base.effects) {
    const bool moves = hasTimeCourse(measured.info(effect.id));
    (moves ? moving : still.effects).push_back(effect);
  }
  if (moving.empty()) return base;
  const std::size_t enabled = moving.size();
  moving.insert(moving.end(), beside.begin(), beside.end());
  if (fit_sizes) {
    const Refined refined = refine(measured, common, fit, still, moving, true, {});
    for (std::size_t e = 0; refined.share > 0 && e < enabled; ++e)
      with = withEffect(with, refined.effects[e]);
  }
  takeOut(measured, fit, still, with);
  return with;
}

}  // namespace fsr::discrepancy
