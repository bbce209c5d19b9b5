#include "support/synthetic_recording.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace test_support {

double trianglePressure(double phase, double peak) {
  return peak * (1.0 - std::abs(2.0 * (phase - std::floor(phase)) - 1.0));
}

double syntheticReading(const SyntheticRig& rig, std::size_t taxel, double curvature, double pressure) {
  if (rig.felt_curvature != nullptr) curvature = rig.felt_curvature(curvature);
  const double gain = (0.75 + 0.01 * static_cast<double>(taxel)) * (1.0 - 0.008 * curvature);
  const double preload = 2e3 * curvature;  // [Pa]
  return rig.full_scale * gain *
         std::sqrt(std::max(std::max(pressure, 0.0) + preload, 0.0) / (rig.peak + 60e3));
}

fsr::dataset::Recording syntheticRecording(const SyntheticRig& rig) {
  fsr::dataset::Recording recording;
  recording.name = rig.name;
  recording.sha256 = std::string(64, static_cast<char>('a' + (rig.seed - 1) % 6));
  recording.sensor.sensor_id = "matrix_a";
  recording.sensor.serial = "0001";
  recording.layout.size = rig.size;
  recording.full_scale = rig.full_scale;
  std::mt19937 random(rig.seed);
  std::uniform_real_distribution<double> noise(-rig.noise, rig.noise);
  for (std::size_t s = 0; s < rig.surfaces.size(); ++s) {
    const double curvature = rig.surfaces[s].curvature;
    recording.conditions.push_back({rig.surfaces[s].name, 1, {fsr::matrix::Curvature{curvature, 0, 0}}, {}});
    for (std::size_t i = 0; i < rig.cycles * rig.scans_per_cycle; ++i) {
      const double phase = static_cast<double>(i) / static_cast<double>(rig.scans_per_cycle);
      const double pressure = trianglePressure(phase, rig.peak);
      const bool unloading = phase - std::floor(phase) > 0.5;
      recording.time.push_back(static_cast<double>(recording.time.size()) / rig.rate);
      recording.pressure.push_back(pressure);
      recording.condition.push_back(static_cast<std::uint32_t>(s));
      for (std::size_t taxel = 0; taxel < rig.size.taxels(); ++taxel) {
        const double reading =
            syntheticReading(rig, taxel, curvature, pressure) + noise(random) + (unloading ? rig.loop : 0.0);
        recording.counts.push_back(
            static_cast<std::uint16_t>(std::clamp(std::round(reading), 0.0, 1.0 * rig.full_scale)));
      }
    }
  }
  return recording;
}

}  // namespace test_support
