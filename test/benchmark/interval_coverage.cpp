// Prints how many readings of new mounts, or new cycles, lie within one deviation and within the intervals of
// `train`, on simulated rigs: the table in docs/uncertainty.md.
//
//     interval_coverage [SHEETS]      sheets a row; default 20

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/simulation/simulate.h"
#include "simulation/settings_text.h"
#include "statistics/samples.h"

namespace {

using namespace fsr;

constexpr std::size_t kLevels = calibration::kIntervalLevels.size();

struct Row {
  const char* name;
  const char* effects;
  int mounts;  // of training, and as many new ones; 1 = new cycles of the same mount
  int cycles;  // of each mount
  std::size_t folds;
};

// Columns of the table.
enum Column { kTables, kMap, kFirstLevel };
constexpr std::size_t kColumns = kFirstLevel + kLevels;

constexpr char kLoop[] = "  hysteresis: {loop_width: 0.095, span: 620000, reach: 150000}\n";
constexpr char kMounts[] = "  repositioning: {offset: 4000, gain: 0.03}\n";

const Row kRows[] = {
    {"scatter of mounts", kMounts, 20, 3, 3},
    {"scatter of mounts", kMounts, 40, 3, 3},
    {"loop and scatter of mounts", nullptr, 20, 3, 3},
    {"loop and scatter of mounts", nullptr, 40, 3, 3},
    {"loop, new cycles", kLoop, 1, 20, 5},
    {"loop, new cycles, 20 sections", kLoop, 1, 20, 20},
    {"loop, new cycles", kLoop, 1, 40, 5},
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

// Shares of the readings of `recordings` within one deviation of the tables, one of the map, and the
// intervals of a calibration of one surface.
std::array<double, kColumns> coverage(const calibration::Calibration& calibration,
                                      const std::vector<dataset::Recording>& recordings, std::size_t first) {
  std::array<double, kColumns> within = {};
  const calibration::ErrorIntervals& intervals = calibration.budget.intervals;
  double readings = 0;
  for (std::size_t r = first; r < recordings.size(); ++r) {
    for (std::size_t i = 0; i < recordings[r].scans(); ++i) {
      for (std::size_t taxel = 0; taxel < recordings[r].layout.size.taxels(); ++taxel) {
        const std::uint16_t code = recordings[r].scan(i)[taxel];
        const regression::CodeTable& table = calibration.tables.table(taxel, 0);
        const double answer = double(table.pressure[code]);
        const auto& factor = intervals.bins[statistics::pressureBin(answer)].factor;
        const double deviation = double(table.deviation[code]);
        const double error = std::abs(answer - recordings[r].pressure[i]);
        within[kTables] += error <= deviation;
        within[kMap] += error <= intervals.scale.at(answer) * deviation;
        for (std::size_t level = 0; level < kLevels; ++level)
          within[kFirstLevel + level] += error <= factor[level] * deviation;
        readings += 1;
      }
    }
  }
  for (double& share : within) share /= readings;
  return within;
}

void measure(const Row& row, unsigned sheets) {
  std::array<statistics::RunningMoments, kColumns> covered;
  for (unsigned seed = 1; seed <= sheets; ++seed) {
    const std::vector<dataset::Recording> all = record(row, seed);
    const auto half = static_cast<std::ptrdiff_t>(all.size() / 2);
    calibration::CalibrationProblem problem{{all.begin(), all.begin() + half}, {}};
    problem.options.folds = row.folds;
    problem.options.zero = calibration::ZeroChoice::kNone;
    problem.options.history = {false, calibration::HistoryFamily::kNone};
    problem.options.date = "2026-11-23T00:00:00Z";
    const auto share = coverage(calibration::calibrate(problem), all, all.size() / 2);
    for (std::size_t column = 0; column < kColumns; ++column) covered[column].add(100 * share[column]);
  }
  const int units = row.mounts == 1 ? row.cycles : row.mounts;
  std::printf("| %s | %d %s |", row.name, units, row.mounts == 1 ? "cycles" : "mounts");
  for (const statistics::RunningMoments& column : covered)
    std::printf(" %.1f +- %.1f |", column.mean, column.deviation());
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const unsigned sheets = argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 20;
  std::printf(
      "| rig | units of training | deviation of the tables covers [%%] | of the map [%%] | 68.3 %% interval "
      "[%%] | "
      "95 %% interval [%%] |\n|---|---|---|---|---|---|\n");
  for (const Row& row : kRows) measure(row, sheets);
}
