#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"

namespace test_support {

struct SyntheticSurface {
  std::string name;
  double curvature = 0;  // across the rows [1/m]
};

/// A matrix in a chamber, as simple as the tests can do with: triangular cycles from zero to `peak`,
/// counts growing with the root of the pressure, less gain and some preload on a bend.
struct SyntheticRig {
  std::string name = "synthetic.bag";
  fsr::matrix::MatrixSize size{2, 3};
  std::uint16_t full_scale = 4095;
  std::vector<SyntheticSurface> surfaces = {{"flat", 0.0}};  // one after the other
  std::size_t cycles = 5;                                    // on each surface
  std::size_t scans_per_cycle = 100;
  double rate = 10.0;   // of the scans [Hz]
  double peak = 600e3;  // gauge [Pa]
  double noise = 10.0;  // half width of the uniform noise [counts]
  double loop = 0.0;    // counts by which unloading lies above loading
  /// Bending acts as if the curvature were this [1/m]; null = the curvature itself.
  double (*felt_curvature)(double curvature) = nullptr;
  unsigned seed = 1;
};

/// Gauge pressure of a triangular cycle, phase 0 to 1 [Pa].
double trianglePressure(double phase, double peak);

/// The noise-free reading of a taxel [counts].
double syntheticReading(const SyntheticRig& rig, std::size_t taxel, double curvature, double pressure);

fsr::dataset::Recording syntheticRecording(const SyntheticRig& rig);

}  // namespace test_support
