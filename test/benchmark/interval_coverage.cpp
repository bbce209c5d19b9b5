// Prints how many readings of new mounts, or new cycles, the intervals of `train` contain, on simulated rigs:
// the table in docs/uncertainty.md.
//
//     interval_coverage [SHEETS]      sheets a row; default 20

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/simulation/simulate.h"
#include "simulation/read_settings.h"
#include "statistics/running_moments.h"

namespace {

using namespace fsr;

constexpr std::size_t kLevels = calibration::kIntervalLevels.size();

struct Row {
  const char* name;
  const char* effects;
  int mounts;  // of training, and as many new ones; 1 = new cycles of the same mount
  int cycles;  // of each mount
};

constexpr char kLoop[] = "  hysteresis: {loop_width: 0.095, span: 620000, reach: 150000}\n";
constexpr char kMounts[] = "  repositioning: {offset: 4000, gain: 0.03}\n";

const Row kRows[] = {
    {"scatter of mounts", kMounts, 20, 3},
    {"scatter of mounts", kMounts, 40, 3},
    {"loop and scatter of mounts", nullptr, 20, 3},
    {"loop and scatter of mounts", nullptr, 40, 3},
    {"loop, new cycles", kLoop, 1, 20},
    {"loop, new cycles", kLoop, 1, 40},
};

// Twice the mounts or cycles of training.
std::vector<dataset::Recording> record(const Row& row, unsigned seed) {
  std::string session;
  const int stations = row.mounts == 1 ? 2 : 2 * row.mounts;
  for (int m = 0; m < stations; ++m)
    session += std::string(m == 0 ? "" : ", ") + "{surface: flat, flat: true}";
  const std::string effects = row.effects != nullptr ? row.effects : std::string(kLoop) + kMounts;
  const std::string text =
      "simulation: coverage\nseed: " + std::to_string(seed) +
      "\nmatrix: {rows: 2, columns: 4}\nboard: {scan_rate: 4}\n"
      "chamber: {peak: 620000, rate: 30000, dwell_peak: 1, dwell_rest: 8, cycles: " +
      std::to_string(row.cycles) + "}\nsession: [" + session +
      "]\neffects:\n"
      "  static_curve: {conductance: 3.0e-4, reference_pressure: 620000, exponent: 0.9, saturation_pressure: "
      "1.2e6, conductance_scatter: 0.05, exponent_scatter: 0.03}\n"
      "  white_noise: {absolute: 3, relative: 0.001}\n"
      "  converter: {full_scale: 4095, feedback_resistance: 3600}\n" +
      effects;
  return simulation::simulateSession(
      simulation::readSimulation(settings::Settings::fromText(text, "coverage.yaml")));
}

// Shares of the readings of `recordings` within the intervals of a calibration of one surface.
std::array<double, kLevels> coverage(const calibration::Calibration& calibration,
                                     const std::vector<dataset::Recording>& recordings, std::size_t first) {
  std::array<double, kLevels> within = {};
  double readings = 0;
  for (std::size_t r = first; r < recordings.size(); ++r) {
    for (std::size_t i = 0; i < recordings[r].scans(); ++i) {
      for (std::size_t taxel = 0; taxel < recordings[r].layout.size.taxels(); ++taxel) {
        const std::uint16_t code = recordings[r].scan(i)[taxel];
        const regression::CodeTable& table = calibration.tables.table(taxel, 0);
        const double answer = double(table.pressure[code]);
        const auto& factor = calibration.budget.intervals.bins[statistics::pressureBin(answer)].factor;
        const double error = std::abs(answer - recordings[r].pressure[i]);
        for (std::size_t level = 0; level < kLevels; ++level)
          within[level] += error <= factor[level] * double(table.deviation[code]);
        readings += 1;
      }
    }
  }
  for (double& share : within) share /= readings;
  return within;
}

void measure(const Row& row, unsigned sheets) {
  std::array<statistics::RunningMoments, kLevels> covered;
  for (unsigned seed = 1; seed <= sheets; ++seed) {
    const std::vector<dataset::Recording> all = record(row, seed);
    const auto half = static_cast<std::ptrdiff_t>(all.size() / 2);
    calibration::CalibrationProblem problem{{all.begin(), all.begin() + half}, {}};
    problem.options.folds = row.mounts == 1 ? 5 : 3;
    problem.options.zero = calibration::ZeroChoice::kNone;
    problem.options.history = {false, compensation::HistoryFamily::kNone};
    problem.options.date = "2026-11-23T00:00:00Z";
    const auto share = coverage(calibration::calibrate(problem), all, all.size() / 2);
    for (std::size_t level = 0; level < kLevels; ++level) covered[level].add(100 * share[level]);
  }
  const int units = row.mounts == 1 ? row.cycles : row.mounts;
  std::printf("| %s | %d %s | %.1f +- %.1f | %.1f +- %.1f |\n", row.name, units,
              row.mounts == 1 ? "cycles" : "mounts", covered[0].mean, covered[0].deviation(), covered[1].mean,
              covered[1].deviation());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const unsigned sheets = argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 20;
  std::printf("| rig | units of training | 68.3 %% covers [%%] | 95 %% covers [%%] |\n|---|---|---|---|\n");
  for (const Row& row : kRows) measure(row, sheets);
}
