#include "simulation/effects/effect_library.h"

#include <algorithm>
#include <stdexcept>

namespace fsr::simulation {

const std::vector<EffectEntry>& effectLibrary() {
  static const std::vector<EffectEntry> library = {
      timeSkew(),       scanSkew(),    sealLeak(),        trappedGas(), edgeStiffness(), repositioning(),
      bendingPreload(), turnOn(),      hysteresis(),      creep(),      bendingGain(),   temperature(),
      breakIn(),        wear(),        staticCurve(),     deadTaxel(),  rowFault(),      columnFault(),
      crosstalk(),      supplyDroop(), converter(),       drift(),      mainsPickup(),   whiteNoise(),
      saturation(),     stuckTaxel(),  transducerError(), compliance(), shear(),         wrinkle(),
      humidity(),
  };
  return library;
}

const EffectEntry* findEffect(const std::string& id) {
  const auto& library = effectLibrary();
  const auto found = std::find_if(library.begin(), library.end(),
                                  [&](const EffectEntry& entry) { return entry.info.id == id; });
  return found == library.end() ? nullptr : &*found;
}

const EffectInfo& foundBy(Detector detector) {
  for (const EffectEntry& entry : effectLibrary()) {
    if (entry.info.detector == detector) return entry.info;
  }
  throw std::out_of_range("no effect of the library is found by that detector");
}

std::vector<std::string> effectIds() {
  std::vector<std::string> ids;
  for (const EffectEntry& entry : effectLibrary()) ids.push_back(entry.info.id);
  return ids;
}

}  // namespace fsr::simulation
