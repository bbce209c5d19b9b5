// Cost of calibrating a scan (pressure, deviation, flags and the watch for dead and stuck taxels) beside the
// cost of copying a scan from counts to floats. The scans follow load cycles with noise and a taxel scatter
// of 4 %. Each scan is new, so that the cache lines of the tables change; under a constant load they would
// not.

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "fsr_pressure_map/calibration/calibrator.h"
#include "support/small_tables.h"

namespace {

constexpr std::uint16_t kFullScale = 4095;
constexpr std::size_t kScans = 4096;  // a power of two
constexpr double kRate = 100.0;       // [scans/s]
constexpr double kCycle = 72.0;       // fill and vent [s]
const std::vector<double> kCurvatures = {0.0, 1 / 0.13, 1 / 0.11, 1 / 0.09, 1 / 0.07, 1 / 0.05};

/// [kScans x taxels] counts.
std::vector<std::uint16_t> loadCycles(std::size_t taxels) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> gain(taxels);
  for (double& g : gain) g = 3000 * (1 + 0.04 * normal(random));
  std::vector<std::uint16_t> counts;
  for (std::size_t scan = 0; scan < kScans; ++scan) {
    const double load = 0.5 - 0.5 * std::cos(2 * M_PI * double(scan) / kRate / kCycle);
    for (const double g : gain) {
      const double reading = g * std::pow(load, 0.7) + 2 * normal(random);
      counts.push_back(std::uint16_t(std::min(std::max(reading, 0.0), double{kFullScale})));
    }
  }
  return counts;
}

fsr::matrix::MatrixSize size(const benchmark::State& state) {
  return {std::uint16_t(state.range(0)), std::uint16_t(state.range(1))};
}

// `scans`: number of different scans in sequence, a power of two.
void Calibrate(benchmark::State& state, std::size_t scans) {
  const fsr::matrix::MatrixSize matrix = size(state);
  fsr::calibration::Calibrator calibrator(test_support::smallTables(matrix, kCurvatures, kFullScale),
                                          {matrix});
  fsr::matrix::Surface surface;
  surface.curvature = {{kCurvatures[3], 0, 0}};
  calibrator.setSurface(surface, 0);
  const auto counts = loadCycles(matrix.taxels());
  fsr::map::PressureMap map;
  std::size_t i = 0;
  for (auto _ : state) {
    const std::uint16_t* scan = counts.data() + (i % scans + kScans - scans) * matrix.taxels();
    calibrator.calibrate({matrix, kFullScale, scan, matrix.taxels()}, double(i) / kRate, map);
    benchmark::DoNotOptimize(map.pressure.data());
    benchmark::ClobberMemory();
    ++i;
  }
  state.counters["MB"] = static_cast<double>(calibrator.bytes()) / 1e6;
}

// Memory of a calibration of a 16 bit converter, extrapolated from two taxels.
void FineConverter(benchmark::State& state) {
  const fsr::matrix::MatrixSize matrix = size(state), pair{1, 2};
  const fsr::calibration::Calibrator calibrator(test_support::smallTables(pair, kCurvatures, 65535), {pair});
  for (auto _ : state) benchmark::DoNotOptimize(calibrator.bytes());
  state.counters["MB"] =
      static_cast<double>(calibrator.bytes()) / 1e6 / double(pair.taxels()) * double(matrix.taxels());
}

/// Between curvature classes, where every taxel has its own table.
void CalibrateBlended(benchmark::State& state) {
  const fsr::matrix::MatrixSize matrix = size(state);
  fsr::compensation::CurvatureTables tables = test_support::smallTables(matrix, kCurvatures, kFullScale);
  tables.rule.blend = fsr::compensation::BlendRule::kInterpolate;
  fsr::calibration::Calibrator calibrator(tables, {matrix});
  calibrator.setSurface({"bend", 1, {{12.5, 0, 0}}, {}}, 0);
  const auto counts = loadCycles(matrix.taxels());
  fsr::map::PressureMap map;
  std::size_t i = 0;
  for (auto _ : state) {
    const std::uint16_t* scan = counts.data() + (i % kScans) * matrix.taxels();
    calibrator.calibrate({matrix, kFullScale, scan, matrix.taxels()}, double(i) / kRate, map);
    benchmark::DoNotOptimize(map.pressure.data());
    benchmark::ClobberMemory();
    ++i;
  }
}

/// With a model of the sheet's memory of five plays and six memories.
void CalibrateWithHistory(benchmark::State& state) {
  const fsr::matrix::MatrixSize matrix = size(state);
  fsr::calibration::Calibration calibration;
  calibration.tables = test_support::smallTables(matrix, kCurvatures, kFullScale);
  calibration.layout = {matrix};
  fsr::calibration::HistoryModel& model = calibration.history;
  model.family = fsr::calibration::HistoryFamily::kBoth;
  for (int k = 0; k <= 16; ++k) model.knot.push_back(40e3 * k);
  model.correction.assign(model.knot.size(), 100);
  model.radius = {12e3, 30e3, 60e3, 120e3, 210e3};
  model.play_weight = {-0.3, -0.2, -0.1, -0.05, -0.02};
  model.time_constant = {0.3, 0.7, 1.8, 4, 9, 20};
  model.memory_weight = {-0.02, -0.02, -0.02, -0.02, -0.02, -0.02};
  model.deviation_knot = {0, 640e3};
  model.loading_deviation = model.unloading_deviation = {50e3, 50e3};
  fsr::calibration::Calibrator calibrator(calibration);
  calibrator.setSurface({"bend", 1, {{kCurvatures[3], 0, 0}}, {}}, 0);
  calibrator.markRest();
  const auto counts = loadCycles(matrix.taxels());
  fsr::map::PressureMap map;
  std::size_t i = 0;
  for (auto _ : state) {
    const std::uint16_t* scan = counts.data() + (i % kScans) * matrix.taxels();
    // Stamps jitter, so that the steps of the memories are computed for each scan.
    const double time = (double(i) + 0.1 * double(i % 3)) / kRate;
    calibrator.calibrate({matrix, kFullScale, scan, matrix.taxels()}, time, map);
    benchmark::DoNotOptimize(map.pressure.data());
    benchmark::ClobberMemory();
    ++i;
  }
  state.counters["settled"] = (map.flags[0] & fsr::map::taxel_flag::kHistoryShort) == 0;
}

/// Cost of one change of curvature, by rule: 0 nearest, 1 kernel, 2 interpolate.
void CompileTables(benchmark::State& state) {
  const fsr::matrix::MatrixSize matrix = size(state);
  fsr::compensation::CurvatureTables tables = test_support::smallTables(matrix, kCurvatures, kFullScale);
  tables.rule.blend = static_cast<fsr::compensation::BlendRule>(state.range(2));
  tables.rule.length_scale = {2.0};
  tables.rule.unseen = {{0, 300e3}, {10e3, 20e3}};
  for (fsr::regression::CodeTable& table : tables.tables) table.log_weight.assign(kFullScale + 1u, 1.0f);
  fsr::calibration::Calibrator calibrator(tables, {matrix});
  std::uint32_t i = 0;
  for (auto _ : state) {
    calibrator.setSurface({"bend", ++i, {{i % 2 == 0 ? 12.5 : 16.5, 0, 0}}, {}}, 0);
  }
}

void CopyScanToFloat(benchmark::State& state) {
  const std::size_t taxels = size(state).taxels();
  const auto counts = loadCycles(taxels);
  std::vector<float> out(taxels);
  std::size_t i = 0;
  for (auto _ : state) {
    const std::uint16_t* scan = counts.data() + (i++ % kScans) * taxels;
    for (std::size_t t = 0; t < taxels; ++t) out[t] = scan[t];
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
}

}  // namespace

BENCHMARK_CAPTURE(Calibrate, load_cycles, kScans)->Args({7, 10})->Args({16, 10})->Args({32, 32});
BENCHMARK_CAPTURE(Calibrate, standing_load, 1)->Args({7, 10})->Args({16, 10})->Args({32, 32});
BENCHMARK(FineConverter)->Args({16, 10});
BENCHMARK(CalibrateBlended)->Args({7, 10})->Args({16, 10})->Args({32, 32});
BENCHMARK(CalibrateWithHistory)->Args({7, 10})->Args({16, 10})->Args({32, 32});
BENCHMARK(CompileTables)->Unit(benchmark::kMillisecond)->Args({7, 10, 0})->Args({7, 10, 1})->Args({7, 10, 2});
BENCHMARK(CopyScanToFloat)->Args({7, 10})->Args({16, 10})->Args({32, 32});
