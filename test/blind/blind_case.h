#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blind/campaign.h"
#include "blind/hidden.h"
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
struct CaseSpec {
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
  double left = 0;  ///< rms after the best static fit of each taxel [share of full scale]
  double snr = 0;   ///< left / noise, computed from the finished case
  LeftAfter left_after = LeftAfter::kCurveEach;
  std::vector<HiddenParameter> parameters;
  std::vector<std::string> depends_on;
  std::vector<std::size_t> taxels;    ///< where the effect shows; see Signature
  std::vector<std::size_t> surfaces;  ///< likewise, indices into Campaign::surfaces
  std::pair<double, double> pressures;
  std::string direction;
  std::vector<std::pair<double, double>> times;  ///< [s] since the first scan; empty = always
};

struct BlindCase {
  CaseSpec spec;
  Campaign campaign;
  std::string static_law, preload_law, gain_law, noise_colour;
  double noise = 0;  ///< rms of everything random, computed from the finished case [share of full scale]
  double reference_noise = 0;  ///< the part of `noise` that comes from the reference
  std::vector<HiddenTruth> hidden;
  std::vector<fsr::dataset::Recording> recordings;  ///< one for each mount
  std::vector<Trace> base;   ///< [taxel][scan] without hidden effects and noise [share of full scale]
  std::vector<Trace> clean;  ///< [taxel][scan] with the hidden effects, without noise [share of full scale]
};

/// Throws fsr::InputError where the spec is invalid or an effect does not show under the protocol.
BlindCase makeCase(const CaseSpec& spec);

constexpr std::uint16_t kFullScale = 4095;
constexpr double kAmbientPressure = 101325;  ///< [Pa]

}  // namespace blind
