#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/simulation/load_pattern.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "simulation/effect.h"
#include "simulation/taxel_curves.h"

namespace fsr::simulation {

/// Memory of all effects of a chain, by effect id, and of its own clock.
using ChainState = std::map<std::string, std::vector<double>>;

/// The sensor matrix in its chamber: gauge pressure in, converter counts out, through the effects that
/// the settings enable, in the order of ChainStage. Cost is linear in scans and taxels; reading
/// allocates nothing. The same settings and the same samples give the same counts.
class SensorChain {
 public:
  /// Lies on the flat at first, never loaded. Throws InputError.
  explicit SensorChain(const SimulationSettings& settings);

  /// Lays the matrix on a surface and says what part of it is loaded; the sheet remembers what it went
  /// through before. Throws InputError where the number of curvatures is neither 1 nor that of the
  /// taxels, or none is known.
  void mount(const matrix::Surface& surface, const LoadPattern& pattern = {});

  /// Counts of one scan, [rows x columns], row-major; valid until the next call. Samples must come in
  /// time order. Throws std::invalid_argument where an effect of timing is on and the sample has no
  /// course of pressure.
  const std::vector<std::uint16_t>& read(const RigSample& sample);

  /// The last scan.
  const std::vector<std::uint16_t>& counts() const { return counts_; }
  /// The last scan before it was rounded and clipped [counts], [rows x columns], row-major.
  const std::vector<double>& reading() const { return signals_.reading; }
  /// All signals of the last scan: load and gain are what the static curve saw.
  const TaxelSignals& signals() const { return signals_; }

  std::uint16_t fullScale() const { return full_scale_; }

  ChainState state() const;
  /// Throws InputError where the state belongs to another chain.
  void restore(const ChainState& state);
  /// A sheet that was never loaded.
  void reset();

 private:
  struct Link {
    std::string id;
    ChainStage stage;
    std::unique_ptr<Effect> effect;
    std::vector<std::uint8_t> acts;     // [taxels]; empty = everywhere
    std::vector<std::string> surfaces;  // empty = all
    bool here = true;                   // on the surface where the matrix lies
    bool confined() const { return !here || !acts.empty(); }
  };
  void apply(Link& link, const RigSample& sample);
  RigSample clocked(const RigSample& sample);
  void load(const RigSample& sample);
  void addCurves(double pressure);

  matrix::Layout layout_;
  std::uint16_t full_scale_;
  std::vector<Link> links_;  // in the order in which they act
  std::shared_ptr<const TaxelCurves> curves_;
  const TaxelCurves::OnSurface* on_surface_ = nullptr;  // of `curves_`, where it lies now
  std::vector<double> share_;                           // [taxels], of the chamber's pressure
  std::vector<double> clock_;                           // whether a scan was read, and when the last one [s]
  TaxelSignals signals_;
  TaxelSignals before_;  // an effect that acts on some taxels only
  std::vector<std::uint16_t> counts_;
};

}  // namespace fsr::simulation
