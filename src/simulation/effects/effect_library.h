#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/simulation/effect_info.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::simulation {

/// What the constructor of an effect gets to know about the rig.
struct EffectContext {
  matrix::Layout layout;
  std::uint64_t seed = 0;  ///< of the whole simulation; see randomStream()
  std::vector<FaultSpell> spells = {};
};

/// Gauge pressure of the chamber [Pa] at any rig time [s].
using PressureCourse = std::function<double(double)>;

/// Default temperature and reference temperature of sensitivities [degree Celsius].
constexpr double kRoomTemperature = 23;

/// The state of the rig at the time of one scan.
struct RigSample {
  double time = 0;                        ///< rig time, middle of the scan [s]
  double pressure = 0;                    ///< chamber, gauge [Pa]
  std::uint64_t scan = 0;                 ///< number of the scan; selects its noise
  double temperature = kRoomTemperature;  ///< of the chamber [degree Celsius]
  /// The pressure before and after this scan, which effects of timing need. nullptr = not known.
  const PressureCourse* course = nullptr;
  // The chain fills in:
  bool first = false;  ///< first scan since the matrix was reset
  double elapsed = 0;  ///< since the scan before, 0 at the first [s]
};

/// Curvature and load share of each taxel after mounting. One value for each taxel, row-major.
struct Mounting {
  std::uint32_t number = 0;       ///< increases at each remounting; 0 = unknown
  std::vector<double> curvature;  ///< principal curvature [1/m]
  std::vector<double> share;      ///< of the chamber's pressure that reaches the taxel, 0 to 1
};

/// The signals of the chain. Effects change them in place. Vectors have one value for each taxel, row-major.
struct TaxelSignals {
  double skew = 0;                  ///< the scan was taken this long before its stamp [s]
  std::vector<double> offset;       ///< each taxel was read this long after the scan's middle [s]
  std::vector<double> load;         ///< [Pa]
  std::vector<double> gain;         ///< factor of the conductance
  std::vector<double> conductance;  ///< [S]
  std::vector<double> reading;      ///< not yet rounded [counts]
};

/// One physical effect, with its parameters, for all taxels of one matrix.
class Effect {
 public:
  virtual ~Effect() = default;

  /// Called before mounting. May change curvatures and load shares. Runs for all effects before any mount().
  virtual void place(Mounting& mounting) { static_cast<void>(mounting); }

  /// Called after mounting.
  virtual void mount(const Mounting& mounting) { static_cast<void>(mounting); }

  /// Acts on the signals of its stage. Called once for each scan, in time order. Must not allocate. From the
  /// second stage on, time and pressure of `sample` are those at which the scan was really taken.
  virtual void apply(const RigSample& sample, TaxelSignals& signals) {
    static_cast<void>(sample);
    static_cast<void>(signals);
  }

  /// Reading of the chamber's transducer at a gauge pressure [Pa].
  virtual double transduce(double pressure) const { return pressure; }

  /// The whole state of the effect, for saving and restoring. All zeros in a matrix that was never loaded.
  /// Empty where the effect has no memory.
  std::vector<double>& state() { return state_; }

 protected:
  std::vector<double> state_;
};

/// One entry of the library.
struct EffectEntry {
  EffectInfo info;
  /// `values` contains every parameter, each within its permitted range. Throws InputError where they
  /// contradict each other. nullptr where the effect is only listed.
  std::unique_ptr<Effect> (*make)(const EffectValues& values, const EffectContext& context) = nullptr;
};

/// EffectEntry::make for a class whose constructor takes values and context.
template <typename Type>
std::unique_ptr<Effect> makeEffect(const EffectValues& values, const EffectContext& context) {
  return std::make_unique<Type>(values, context);
}

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
  /// These effects, with pressures in proportion to the range of a chamber [Pa].
  std::shared_ptr<const EffectLibrary> forRange(double range) const;

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

/// The converter, without which no chain runs.
const EnabledEffect& converterOf(const SimulationSettings& settings);

/// The settings without the effects that draw new random numbers at each scan.
SimulationSettings withoutNoise(SimulationSettings settings);

/// Whether the course of the effect is random with these values: always, unless its spells are known, or
/// because it walks.
bool isByChance(const EffectInfo& info, const EnabledEffect& effect);

/// The settings without noise, without effects whose course in a recording no simulation repeats, and without
/// the random walks of the others.
SimulationSettings withoutChance(SimulationSettings settings);

}  // namespace fsr::simulation
