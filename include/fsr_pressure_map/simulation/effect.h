#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/settings/range.h"

namespace fsr {

/// Where in the forward chain an effect acts; effects run in this order, within a stage in the order
/// of the library.
///
///     chamber P -> load P_e -> memory u -> gain g -> G = curve(u, g) -> read-out -> sample y -> reading
enum class ChainStage {
  kLoad,         ///< what presses on a taxel: TaxelSignals::load
  kMemory,       ///< history of the load: TaxelSignals::load
  kGain,         ///< factors of the conductance: TaxelSignals::gain
  kConductance,  ///< static curve: load and gain -> TaxelSignals::conductance
  kReadOut,      ///< wires and supply: TaxelSignals::conductance
  kSample,       ///< conductance -> TaxelSignals::reading
  kReading,      ///< what disturbs the reading before it is rounded: TaxelSignals::reading
};

/// What one set of an effect's parameters belongs to.
enum class EffectLevel { kRig, kRow, kColumn, kTaxel, kMount };

/// One parameter of an effect. Values outside `permitted` are refused.
struct EffectParameter {
  std::string name;
  std::string meaning;
  Range permitted;   ///< with the unit
  double usual = 0;  ///< where the settings do not give it
  /// At this value the parameter changes nothing, bit for bit; NaN where it only gives the shape of
  /// what another parameter scales.
  double neutral = std::numeric_limits<double>::quiet_NaN();
};

/// What an effect says about itself.
struct EffectInfo {
  std::string id;
  std::string summary;
  std::string equation;
  std::string source;
  ChainStage stage = ChainStage::kLoad;
  EffectLevel level = EffectLevel::kRig;
  bool required = false;  ///< no chain runs without it
  std::vector<EffectParameter> parameters;
};

/// Values of all parameters of one effect, by name, in SI units.
using EffectValues = std::map<std::string, double>;

/// What an effect may know about the rig when it is made.
struct EffectContext {
  Layout layout;
  std::uint64_t seed = 0;  ///< of the whole simulation; see randomStream()
};

/// What the rig does at the time of one scan.
struct RigMoment {
  double time = 0;         ///< rig time, middle of the scan [s]
  double pressure = 0;     ///< chamber, gauge [Pa]
  std::uint64_t scan = 0;  ///< number of the scan: picks its noise
};

/// The chain's signals, one value for each taxel, row-major. Effects change them in place.
struct TaxelSignals {
  std::vector<double> load;         ///< [Pa]
  std::vector<double> gain;         ///< factor of the conductance
  std::vector<double> conductance;  ///< [S]
  std::vector<double> reading;      ///< not yet rounded [counts]
};

/// One physical effect, with its parameters, for all taxels of one matrix.
class Effect {
 public:
  virtual ~Effect() = default;

  /// The matrix was laid on a surface of these principal curvatures, one for each taxel [1/m].
  virtual void mount(const std::vector<double>& curvature) { static_cast<void>(curvature); }

  /// Acts on the signals of its stage. Called once a scan, in time order; allocates nothing.
  virtual void apply(const RigMoment& moment, TaxelSignals& signals) = 0;

  /// The whole memory of the effect, for saving and restoring; all zeros in a matrix that was never
  /// loaded. Empty where it has no memory.
  std::vector<double>& state() { return state_; }

 protected:
  std::vector<double> state_;
};

/// One entry of the library.
struct EffectEntry {
  EffectInfo info;
  /// `values` holds every parameter, each within its permitted range. Throws InputError where they do
  /// not go together.
  std::unique_ptr<Effect> (*make)(const EffectValues& values, const EffectContext& context);
};

/// EffectEntry::make of an effect whose constructor takes values and context.
template <typename Type>
std::unique_ptr<Effect> makeEffect(const EffectValues& values, const EffectContext& context) {
  return std::make_unique<Type>(values, context);
}

}  // namespace fsr
