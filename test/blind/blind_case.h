#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blind/campaign.h"
#include "blind/hidden.h"
#include "blind/identifiability.h"
#include "blind/noise.h"
#include "blind/sheet.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace blind {

/// One effect to hide.
struct EffectSpec {
  std::string id;
  std::string form;                ///< empty = drawn by the seed
  std::optional<double> strength;  ///< used as it is where given; else the SNR sets it
};

/// Everything that defines a case. The same spec gives the same case, count for count.
///
/// A case with a name has a drawn plan: protocol, rig, sheet, noise, reference and climate all come from the
/// hash of the name, and `protocol`, `matrix`, `size` and `thermometer` have no meaning. What is hidden
/// enters no hash, so two cases of one name differ in what is hidden only.
struct CaseSpec {
  std::string name;
  std::string protocol_class;  ///< of a case with a name; empty = drawn
  double most_readings = kSmallReadings;
  std::optional<RigPlan> plan;  ///< of a case with a name, instead of a drawn one
  bool judged = true;           ///< false: leave out the identifiability, which takes most of the time
  /// Instead of `snr`: error at the map that each effect causes [kPa]; see Rig::errorAtMap.
  std::optional<double> kpa;
  std::uint64_t seed = 1;
  std::vector<EffectSpec> effects;  ///< empty = nothing is hidden
  /// Ratio: rms that each effect leaves after the best static fit / rms of all noise; 0 = nothing is hidden.
  double snr = 1;
  std::string protocol = "two_speeds";
  /// Protocol of a second campaign after the first; only the second one is recorded; empty = none.
  std::string then;
  fsr::matrix::MatrixSize matrix{7, 10};
  ProtocolSize size;
  bool thermometer = true;
  bool local = true;            ///< effects may be limited to some taxels or surfaces
  std::optional<double> noise;  ///< rms of all noise [share of full scale]; drawn at random where not given
};

/// Sets the small size that the tests use: 3 x 4 taxels, three surfaces, half the cycles.
void makeSmall(CaseSpec& spec);

/// What was hidden, for the key.
struct HiddenTruth {
  std::string id;
  std::string form;
  bool foreign = false;
  bool carried_over = false;
  bool has_state = false;
  double strength = 0;
  double left = 0;           ///< rms after the best static fit of each taxel [share of full scale]
  double snr = 0;            ///< left / noise, computed from the finished case
  double kpa_at_map = 0;     ///< see Rig::errorAtMap
  bool size_reached = true;  ///< false where no strength gives the size that was asked for
  char set = 'A';
  LeftAfter left_after = LeftAfter::kCurveEach;
  std::vector<HiddenParameter> parameters;
  std::vector<std::string> depends_on;
  std::vector<std::size_t> taxels;    ///< where the effect shows; see Signature
  std::vector<std::size_t> surfaces;  ///< likewise, indices into Campaign::surfaces
  std::pair<double, double> pressures;
  std::string direction;
  std::vector<std::pair<double, double>> times;  ///< [s] since the first scan; empty = always
};

/// A bag of a case with a name. Reference and thermometer have stamps of their own.
struct CaseBag {
  fsr::dataset::Recording recording;    ///< as the package reads it back, except for scans at the very ends
  std::vector<std::uint32_t> sequence;  ///< scan counter of the board; it skips what was lost
  std::vector<std::pair<std::int64_t, double>> reference;    ///< stamp [ns], gauge pressure [Pa]
  std::vector<std::pair<std::int64_t, double>> thermometer;  ///< stamp [ns], [degree Celsius]; may be empty
};

struct BlindCase {
  CaseSpec spec;
  std::optional<RigPlan> plan;  ///< of a case with a name
  std::uint16_t full_scale = 4095;
  std::vector<CaseBag> bags;  ///< of a case with a name
  std::size_t lost_scans = 0;
  Identifiability identifiable;
  Campaign campaign;
  std::string static_law, preload_law, gain_law, noise_colour;
  double noise = 0;       ///< rms of everything random, computed from the finished case [share of full scale]
  double cycle_gain = 0;  ///< standard deviation of the gain of a cycle, relative; 0 without a name
  double reference_noise = 0;  ///< the part of `noise` that comes from the reference
  std::vector<HiddenTruth> hidden;
  std::vector<fsr::dataset::Recording> recordings;  ///< one for each mount
  std::vector<Trace> base;   ///< [taxel][scan] without hidden effects and noise [share of full scale]
  std::vector<Trace> clean;  ///< [taxel][scan] with the hidden effects, without noise [share of full scale]
};

/// Throws fsr::InputError where the spec is invalid or an effect does not show under the protocol.
BlindCase makeCase(const CaseSpec& spec);

constexpr double kAmbientPressure = 101325;  ///< [Pa]

}  // namespace blind
