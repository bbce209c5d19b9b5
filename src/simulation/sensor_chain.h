#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "simulation/effects/effect_library.h"
#include "simulation/taxel_curves.h"

namespace fsr::simulation {

/// Memory of all effects of a chain, by effect id, and of its own clock.
using ChainState = std::map<std::string, std::vector<double>>;

/// The sensor matrix in its chamber. Input: gauge pressure. Output: counts of the converter. In between act
/// the effects that the settings enable, in the order of ChainStage. Cost is linear in scans and taxels.
/// Reading allocates nothing. Equal settings and equal samples give equal counts.
class SensorChain {
 public:
  /// At first the sheet lies on the flat and was never loaded. Throws InputError.
  explicit SensorChain(const SimulationSettings& settings);

  /// Lays the matrix on a surface; `pattern` is the loaded part of it. The sheet keeps its state. Throws
  /// InputError where no curvature is known, or where their number is neither 1 nor the number of taxels.
  void mount(const matrix::Surface& surface, const LoadPattern& pattern = {});

  /// Counts of one scan, [rows x columns], row-major; valid until the next call. Samples must come in
  /// time order. Throws std::invalid_argument where an effect of timing is on and the sample has no
  /// course of pressure.
  const std::vector<std::uint16_t>& read(const RigSample& sample);

  /// The last scan.
  const std::vector<std::uint16_t>& counts() const { return counts_; }
  /// The last scan before it was rounded and clipped [counts], [rows x columns], row-major.
  const std::vector<double>& reading() const { return signals_.reading; }
  /// All signals of the last scan. Load and gain are the inputs of the static curve.
  const TaxelSignals& signals() const { return signals_; }

  /// Index of the surface of TaxelCurves that was used for the last scan.
  std::size_t curvesSurface() const { return on_surface_; }

  std::uint16_t fullScale() const { return full_scale_; }

  ChainState state() const;
  /// Throws InputError where the state belongs to another chain.
  void restore(const ChainState& state);
  /// Resets the sheet to one that was never loaded.
  void reset();

 private:
  struct Link {
    std::string id;
    ChainStage stage;
    std::unique_ptr<Effect> effect;
    std::vector<std::uint8_t> acts;     // [taxels]; empty = everywhere
    std::vector<std::string> surfaces;  // empty = all
    bool carried_over = true;
    bool is_static_curve = false;  // the deviations of the taxels follow it
    bool here = true;              // on the surface where the matrix lies
    bool confined() const { return !here || !acts.empty(); }
  };
  void apply(Link& link, const RigSample& sample);
  RigSample clocked(const RigSample& sample);
  void load(const RigSample& sample);
  void addToConductance();

  matrix::Layout layout_;
  std::uint16_t full_scale_;
  std::vector<Link> links_;  // in the order in which they act
  std::shared_ptr<const TaxelCurves> curves_;
  std::vector<LoadCurves> load_curves_;  // of each surface of `curves_`
  std::size_t on_surface_ = 0;           // index of the surface in `curves_` where the sheet lies now
  double siemens_ = 0;                   // conductance of a reading of full scale [S]
  std::vector<double> share_;            // [taxels], of the chamber's pressure
  std::vector<double> clock_;            // whether a scan was read, and when the last one [s]
  TaxelSignals signals_;
  TaxelSignals before_;  // an effect that acts on some taxels only
  std::vector<std::uint16_t> counts_;
};

}  // namespace fsr::simulation
