#pragma once

#include <memory>
#include <string>

#include "simulation/effects/effect_library.h"
#include "simulation/rig.h"
#include "simulation/sensor_chain.h"

namespace fsr::simulation {

/// Derivative of the unrounded, noise-free reading with respect to one strength of one effect.
///
/// It is a finite difference between two chains without noise that differ in the strength only. The
/// difference is central, or forward where the strength may not go below its value (one-sided effects have a
/// kink at neutral). Effects are linear in their strength where they act, so that the difference is exact
/// there. The following stages, above all the static curve, leave a relative error below 1e-5. Where a taxel
/// has no load at all, a static curve with an exponent below 1 has an infinite slope; there the difference
/// depends on the step.
class Sensitivity {
 public:
  /// Where `effect` is enabled in `settings`, the derivative is taken at those values; else with all its
  /// strengths and scatters at neutral and its shapes at their usual values, both overruled by `values`.
  /// `step`: as a share of the usual strength; 0 = 1e-4 for central differences, 1e-6 for forward ones.
  /// Throws InputError, also where the effect has no such strength.
  Sensitivity(const SimulationSettings& settings, const std::string& effect, const std::string& strength,
              const EffectValues& values = {}, double step = 0);

  /// As SensorChain::mount().
  void mount(const matrix::Surface& surface, const LoadPattern& pattern = {});

  /// Derivatives of all signals of one scan [per unit of the strength], valid until the next call. The
  /// pressure of `sample` and its course are what the reference channel shows: an error of the reference
  /// is an error of the readings at the pressure that was recorded.
  const TaxelSignals& read(const RigSample& sample);

 private:
  struct Side {
    SensorChain chain;
    ReferenceChannel reference;
    const PressureCourse* recorded = nullptr;
    PressureCourse course;  // of the true pressure behind the recorded one

    explicit Side(const SimulationSettings& settings);
    const TaxelSignals& read(const RigSample& sample);
  };
  std::unique_ptr<Side> lower_, upper_;
  double step_ = 0;  // of the strength, from the lower to the upper
  TaxelSignals derivative_;
};

}  // namespace fsr::simulation
