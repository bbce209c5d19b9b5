#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/simulation/simulate.h"
#include "support/simulated_rig.h"

namespace test_support {

/// A sheet of 3 x 4 taxels that is mounted once a week and loaded twice, with mounts that differ by 2 % and
/// 500 Pa and a board with noise. One recording a week.
struct LifeRig {
  std::size_t weeks = 10;
  std::uint64_t seed = 1;
  /// Factor of the sheet's readings in a week; null = 1.
  std::function<double(std::size_t week)> gain;
  /// A taxel that is dead from a week on.
  std::size_t dead_taxel = SIZE_MAX, dead_from = SIZE_MAX;
};

inline std::vector<fsr::dataset::Recording> weeklyRecordings(const LifeRig& life) {
  fsr::simulation::SimulationSettings settings = straightRig(
      "  repositioning: {offset: 500, gain: 0.02}\n  white_noise: {absolute: 30, relative: 0}\n", 3, 4);
  settings.seed = life.seed;
  settings.session.clear();
  for (std::uint32_t week = 0; week < life.weeks; ++week) {
    fsr::simulation::ChamberProtocol cycles;
    cycles.peak = 620e3;
    cycles.fill_rate = cycles.vent_rate = 100e3;
    cycles.dwell_rest = 3;
    cycles.cycles = 2;
    fsr::simulation::Station station;
    station.surface = {"flat", week + 1, {{0, 0, 0}}, {}};
    station.pause = week == 0 ? 0 : 7 * 86400.0;
    station.program = {cycles};
    settings.session.push_back(station);
  }
  std::vector<fsr::dataset::Recording> recordings = fsr::simulation::simulateSession(settings);
  for (std::size_t week = 0; week < recordings.size(); ++week) {
    const double gain = life.gain ? life.gain(week) : 1.0;
    const std::size_t taxels = recordings[week].layout.size.taxels();
    for (std::size_t i = 0; i < recordings[week].counts.size(); ++i) {
      std::uint16_t& count = recordings[week].counts[i];
      count = static_cast<std::uint16_t>(gain * count);
      if (i % taxels == life.dead_taxel && week >= life.dead_from)
        count = static_cast<std::uint16_t>(i % 90);  // the noise of a board without a sensor
    }
  }
  return recordings;
}

inline fsr::calibration::Calibration lineThrough(const fsr::dataset::Recording& recording) {
  fsr::calibration::CalibrationProblem problem;
  problem.recordings = {recording};
  problem.options.regressor.name = "linear";
  problem.options.scores = false;
  problem.options.history.automatic = false;
  problem.options.temperature = false;
  problem.options.zero = fsr::calibration::ZeroChoice::kNone;
  problem.options.threads = 1;
  return fsr::calibration::calibrate(problem);
}

}  // namespace test_support
