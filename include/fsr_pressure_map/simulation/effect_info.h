#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/range.h"

namespace fsr::simulation {

/// Where in the forward chain an effect acts. Effects run in this order, and within a stage in the order of
/// the library.
///
///     chamber P(t) -> time of reading -> less the cavity -> load P_e -> memory u -> gain g
///                  -> G = curve(u, g) -> read-out -> sample y -> reading
///     and beside it: chamber P(t) -> reference
enum class ChainStage {
  kTiming,       ///< time at which each taxel is really read: TaxelSignals::skew and offset
  kCavity,       ///< gas behind the taxels: TaxelSignals::load
  kLoad,         ///< load on a taxel: TaxelSignals::load
  kMemory,       ///< history of the load: TaxelSignals::load
  kGain,         ///< factors of the conductance: TaxelSignals::gain
  kConductance,  ///< static curve: load and gain -> TaxelSignals::conductance
  kReadOut,      ///< wires and supply: TaxelSignals::conductance
  kSample,       ///< conductance -> TaxelSignals::reading
  kReading,      ///< disturbances of the reading before it is rounded: TaxelSignals::reading
  kReference,    ///< the chamber's transducer: Effect::transduce()
};

/// What has its own realisation of an effect: the whole rig, each row, column or taxel, each mount, or each
/// session.
enum class EffectLevel { kRig, kRow, kColumn, kTaxel, kMount, kSession };

/// How `discrepancy` looks for an effect in recordings.
enum class EffectKind {
  kBase,      ///< part of every rig: never looked for
  kAdditive,  ///< by the derivatives of the reading with respect to its strengths
  kGrid,      ///< the same, for each combination of the `tried` values of its shapes
  kDetector,  ///< by a test of its own, see Detector
  kListed,    ///< not simulated: a gas chamber cannot show it
};

/// The test that finds an effect which derivatives cannot find.
enum class Detector {
  kNone,         ///< no test of its own
  kStuckTaxels,  ///< taxels that keep one code while the others move
  kDeadTaxels,   ///< taxels that read far below what the others say
  kRowFaults,    ///< rows whose taxels leave the others together
  kColumnFaults,
  kMains,       ///< a periodic pattern that runs through the matrix with the scan
  kMounts,      ///< changes of preload and gain from one mount to the next on the same surface
  kSaturation,  ///< static curves that differ by a function of the reading alone
};

/// Which sign a strength may have.
enum class SignRule { kEither, kPositive, kNegative };

/// What the traces of an effect in a reading depend on.
enum class Covariate {
  kPressure,
  kDirection,  ///< loading or unloading
  kPressureRate,
  kTimeSinceReversal,
  kPreviousExtremes,
  kCycle,
  kAccumulatedChange,  ///< of the pressure, up and down alike
  kClockTime,
  kTemperature,
  kCurvature,
  kMount,
  kRow,
  kColumn,
  kTaxel,
  kCode,
  kTotalLoad,
  kSession,  ///< the board was switched off and on in between
};

/// What the recordings must contain before an effect may be named alone.
enum class Evidence {
  kThermometer,
  kMountLabels,
  kTwoRampRates,     ///< or dwells: at one speed a loop cannot be distinguished from a short memory
  kUnevenLoad,       ///< under uniform pressure the static curve absorbs all of it
  kSecondReference,  ///< another pressure gauge
  kVentedSheet,      ///< the same sheet without its seal
  kManyCycles,       ///< 10,000 and more, or so unevenly spread that they are not proportional to clock time
  kRemounts,         ///< some surface was mounted twice
  kUnevenPace,       ///< many cycles at some times and none for hours at others
  kTwoSessions,      ///< some mount was recorded in two sessions
};

/// The experiment that shows an effect.
enum class Experiment {
  kNone,  ///< ordinary cycles
  kTwoRampRates,
  kDwells,
  kStepAndHold,
  kMinorLoops,
  kRest,
  kSlowStart,  ///< slow ramps below 50 kPa
  kTwoAmbients,
  kManyCycles,
  kRemount,
  kFlatAgain,  ///< the flat surface again at the end, other surfaces in random order
  kUnevenLoad,
  kOpenRow,
  kVentedSheet,
  kSecondReference,
  kIndenterAndLiner,
  kTwoHumidities,
  kNewSession,  ///< the same mount again, after the board was switched off
};

/// The role of a parameter.
enum class ParameterRole {
  kStrength,  ///< scales the effect. Where the effect acts it is linear in it; at `neutral` it is off
  kShape,     ///< gives the form of the effect
  kScatter,   ///< standard deviation between taxels or mounts, drawn by the seed; off at `neutral`
};

/// What a random walk over clock time moves.
enum class Walk { kNone, kZero, kGain };

constexpr double kUsualRange = 620e3;  ///< of the chamber pressure [Pa]

/// One parameter of an effect.
struct EffectParameter {
  std::string name;
  std::string meaning;
  ParameterRole role = ParameterRole::kShape;
  settings::Range permitted;  ///< with the unit; values outside it are refused
  double usual = 0;           ///< value where the settings give none
  /// At this value the parameter changes nothing, bit for bit. NaN for a shape, unless the shape switches to
  /// another form of the effect: then this is the value of the usual form.
  double neutral = std::numeric_limits<double>::quiet_NaN();
  /// Range of real rigs. A fit outside it is no explanation.
  settings::Range plausible = {};
  /// Of a shape: the values that are tried when the effect is looked for. Empty = the usual one.
  std::vector<double> tried = {};
  /// `discrepancy` fits the simulation to the static curves of the recordings before it looks for anything.
  /// Place of this parameter in that fit, from 1; 0 = it is not fitted.
  int place_in_base_fit = 0;
  /// A pressure in proportion to the range of the chamber: usual, plausible and tried values are those of
  /// `kUsualRange`.
  bool of_range = false;
  /// This scatter is set to the relative deviation of the taxels' readings that was measured.
  bool from_taxel_deviation = false;
  /// This scatter is the standard deviation of the step that a random walk takes in an hour: of the zero
  /// [counts], or of the reading as a share of itself. No simulation repeats the walk of a recording.
  Walk walk = Walk::kNone;
  std::string fades_over = {};  ///< of a walk: the shape that is its time constant [s]; .inf = it never fades

  EffectParameter within(double low, double high) const;     ///< sets `plausible`
  EffectParameter offAt(double value) const;                 ///< sets `neutral`
  EffectParameter trying(std::vector<double> values) const;  ///< sets `tried` and, by it, `plausible`
  EffectParameter ofRange() const;                           ///< sets `of_range`
  EffectParameter scaledTo(double range) const;  ///< to the range of a chamber [Pa], where it is `of_range`
  EffectParameter inBaseFit(int place) const;    ///< sets `place_in_base_fit`
  EffectParameter fromTaxelDeviation() const;    ///< sets `from_taxel_deviation`
  EffectParameter walking(Walk what, std::string fades_over) const;  ///< sets `walk` and `fades_over`
};

/// Make a parameter. Strengths and scatters are off at 0. `plausible` is the permitted range until within()
/// is called.
EffectParameter strength(std::string name, std::string meaning, const settings::Range& permitted,
                         double usual);
EffectParameter scatter(std::string name, std::string meaning, const settings::Range& permitted,
                        double usual);
EffectParameter shape(std::string name, std::string meaning, const settings::Range& permitted, double usual);

/// Values of all parameters of one effect, by name, in SI units.
using EffectValues = std::map<std::string, double>;

/// The properties of an effect.
struct EffectInfo {
  std::string id;
  std::string summary;
  std::string equation;
  std::string source;
  ChainStage stage = ChainStage::kLoad;
  EffectLevel level = EffectLevel::kRig;
  EffectKind kind = EffectKind::kAdditive;
  std::vector<EffectParameter> parameters;
  SignRule sign = SignRule::kPositive;  ///< of its strengths
  std::vector<Covariate> depends_on;
  std::vector<Evidence> needs;         ///< needed to name the effect alone
  std::vector<std::string> collinear;  ///< ids of effects with similar traces
  Experiment experiment = Experiment::kNone;
  bool required = false;  ///< every chain contains it

  // Further properties that `discrepancy` uses.
  Detector detector = Detector::kNone;
  bool looked_for = true;   ///< false: not among the candidates in this version
  bool stochastic = false;  ///< draws new random numbers at each scan
  bool by_chance =
      false;  ///< its course is random, or its phase unknown: no simulation repeats that of a recording
  bool slow = false;             ///< changes from cycle to cycle, hardly within a cycle
  bool any_course = false;       ///< slow, and its form can imitate any other slow effect
  bool constant = false;         ///< of one size, whenever and at each pace, else it is another effect
  bool mixture = false;          ///< sums of it with several shapes are forms of the same effect
  bool with_bending = false;     ///< belongs to the simplest simulation of a bent sensor
  std::string if_negative = {};  ///< sentence where a strength below zero was found
  std::string also_called = {};  ///< name in data sheets, where it could be confused with another effect
};

/// The parameter of that name; throws std::out_of_range.
const EffectParameter& parameter(const EffectInfo& info, const std::string& name);
std::vector<EffectParameter> strengths(const EffectInfo& info);
/// The parameters that are the steps of a random walk.
std::vector<EffectParameter> walks(const EffectInfo& info);
bool dependsOn(const EffectInfo& info, Covariate covariate);

/// Names as files and reports spell them, e.g. "time_since_reversal".
std::string name(ChainStage stage);
std::string name(EffectLevel level);
std::string name(EffectKind kind);
std::string name(SignRule sign);
std::string name(ParameterRole role);
std::string name(Covariate covariate);
std::string name(Evidence evidence);
std::string name(Experiment experiment);

}  // namespace fsr::simulation
