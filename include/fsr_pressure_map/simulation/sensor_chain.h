#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr {

/// Memory of all effects of a chain, by effect id.
using ChainState = std::map<std::string, std::vector<double>>;

/// The sensor matrix in its chamber: gauge pressure in, converter counts out, through the effects that
/// the settings enable, in the order of ChainStage. Cost is linear in scans and taxels; reading
/// allocates nothing. The same settings and the same moments give the same counts.
class SensorChain {
 public:
  /// Lies on the flat at first, never loaded. Throws InputError.
  explicit SensorChain(const SimulationSettings& settings);

  /// Lays the matrix on a surface; the sheet remembers what it went through before. Throws InputError
  /// where the number of curvatures is neither 1 nor that of the taxels, or none is known.
  void mount(const Surface& surface);

  /// Counts of one scan, [rows x columns], row-major; valid until the next call. Moments must come in
  /// time order.
  const std::vector<std::uint16_t>& read(const RigMoment& moment);

  /// The last scan before it was rounded and clipped [counts], [rows x columns], row-major.
  const std::vector<double>& reading() const { return signals_.reading; }

  std::uint16_t fullScale() const { return full_scale_; }

  ChainState state() const;
  /// Throws InputError where the state belongs to another chain.
  void restore(const ChainState& state);
  /// A sheet that was never loaded.
  void reset();

 private:
  struct Link {
    std::string id;
    std::unique_ptr<Effect> effect;
  };
  MatrixSize size_;
  std::uint16_t full_scale_;
  std::vector<Link> links_;  // in the order in which they act
  TaxelSignals signals_;
  std::vector<std::uint16_t> counts_;
};

}  // namespace fsr
