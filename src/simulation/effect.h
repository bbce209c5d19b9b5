#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::simulation {

/// What the constructor of an effect gets to know about the rig.
struct EffectContext {
  matrix::Layout layout;
  std::uint64_t seed = 0;  ///< of the whole simulation; see randomStream()
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

}  // namespace fsr::simulation
