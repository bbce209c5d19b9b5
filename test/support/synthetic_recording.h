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

/// A simple matrix in a chamber. Pressure runs in triangular cycles from zero to `peak`. Counts are
/// proportional to the root of the pressure. Bending reduces the gain and adds a preload.
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
  double loop = 0.0;    // unloading minus loading [counts]
  /// Curvature that acts on the sensor as a function of the true one [1/m]; null = the true one.
  double (*felt_curvature)(double curvature) = nullptr;
  unsigned seed = 1;
};

/// Gauge pressure of a triangular cycle [Pa]; `phase` is 0 to 1.
double trianglePressure(double phase, double peak);

/// Reading of a taxel without noise [counts].
double syntheticReading(const SyntheticRig& rig, std::size_t taxel, double curvature, double pressure);

fsr::dataset::Recording syntheticRecording(const SyntheticRig& rig);

}  // namespace test_support
