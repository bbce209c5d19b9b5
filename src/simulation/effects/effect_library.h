#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulation/effect.h"

namespace fsr::simulation {

// The effects, one file each in src/simulation/effects. A new effect: its file, a line here and one in
// effectLibrary().
EffectEntry timeSkew();
EffectEntry scanSkew();
EffectEntry sealLeak();
EffectEntry trappedGas();
EffectEntry edgeStiffness();
EffectEntry repositioning();
EffectEntry bendingPreload();
EffectEntry turnOn();
EffectEntry hysteresis();
EffectEntry creep();
EffectEntry relaxation();
EffectEntry bendingGain();
EffectEntry temperature();
EffectEntry breakIn();
EffectEntry wear();
EffectEntry staticCurve();
EffectEntry deadTaxel();
EffectEntry rowFault();
EffectEntry columnFault();
EffectEntry crosstalk();
EffectEntry supplyDroop();
EffectEntry converter();
EffectEntry drift();
EffectEntry mainsPickup();
EffectEntry sessionOffset();
EffectEntry whiteNoise();
EffectEntry saturation();
EffectEntry stuckTaxel();
EffectEntry transducerError();
// Listed only: a gas chamber cannot show them.
EffectEntry compliance();
EffectEntry shear();
EffectEntry wrinkle();
EffectEntry humidity();

struct SimulationSettings;

/// The effects that a simulation can enable. They are in the order in which they act; those that are only
/// listed come last. The order of the stages has precedence, see ChainStage.
class EffectLibrary {
 public:
  explicit EffectLibrary(std::vector<EffectEntry> entries) : entries_(std::move(entries)) {}
  /// The effects of this package.
  static const EffectLibrary& shipped();
  /// These effects and one more, which acts after the others of its stage. Throws InputError where there is
  /// one of its id already.
  std::shared_ptr<const EffectLibrary> with(EffectEntry entry) const;

  const std::vector<EffectEntry>& entries() const { return entries_; }
  const EffectEntry* find(const std::string& id) const;  ///< nullptr where there is none
  const EffectInfo& info(const std::string& id) const;   ///< throws std::out_of_range where there is none
  /// The effect that a detector finds. Throws std::out_of_range where none is.
  const EffectInfo& foundBy(Detector detector) const;
  std::vector<std::string> ids() const;

 private:
  std::vector<EffectEntry> entries_;
};

/// The library of a simulation.
const EffectLibrary& libraryOf(const SimulationSettings& settings);

// The same of the library of this package.
const std::vector<EffectEntry>& effectLibrary();
const EffectEntry* findEffect(const std::string& id);
const EffectInfo& foundBy(Detector detector);
std::vector<std::string> effectIds();

}  // namespace fsr::simulation
