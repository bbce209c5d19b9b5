// Cost of training and of predicting, beside dense sums in Eigen on the same data. With --export=FOLDER the
// program writes its data and predictions instead, for test/benchmark/peers.py.

#include <benchmark/benchmark.h>

#include <fstream>
#include <iomanip>
#include <string>

#include "benchmark/dense_grnn.h"
#include "benchmark/grnn_study.h"
#include "benchmark/rig_readings.h"
#include "regression/bandwidth_search.h"
#include "regression/forest/forest.h"
#include "regression/grnn/grnn.h"
#include "regression/monotone.h"
#include "regression/regressors.h"

namespace {

using namespace benchmark_data;
using benchmark::State;

std::vector<double> answersOf(const std::vector<double>& table, const fsr::regression::CodeSamples& test) {
  std::vector<double> answers(test.size());
  for (std::size_t i = 0; i < test.size(); ++i) answers[i] = table[test.code[i]];
  return answers;
}

// From training readings to predictions for a test set, all steps included.
void trainAndAnswer(State& state, const fsr::regression::Regressor& regressor) {
  const TrainAndTest data = trainAndTest(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(answersOf(regressor.fitSamples(data.train).pressure, data.test));
  }
}

void GrnnTable(State& state) {
  trainAndAnswer(state, fsr::regression::Grnn());
}
void LinearTable(State& state) {
  fsr::regression::RegressorOptions linear;
  linear.name = "linear";
  trainAndAnswer(state, *fsr::regression::makeRegressor(linear));
}
void ForestTable(State& state) {
  trainAndAnswer(state, fsr::regression::Forest());
}
void MonotoneTable(State& state) {
  trainAndAnswer(state, fsr::regression::Monotone());
}

void GrnnDenseEigen(State& state) {
  const TrainAndTest data = trainAndTest(static_cast<std::size_t>(state.range(0)));

  for (auto _ : state)
    benchmark::DoNotOptimize(denseGrnn(data.train, data.test, fsr::regression::kPaperBandwidth));
}

void TableLookUp(State& state) {
  const TrainAndTest data = trainAndTest(6000);
  const std::vector<double> pressure = fsr::regression::Grnn().fitSamples(data.train).pressure;
  const std::vector<float> table(pressure.begin(), pressure.end());
  std::vector<float> answers(data.test.size());
  for (auto _ : state) {
    for (std::size_t i = 0; i < answers.size(); ++i) answers[i] = table[data.test.code[i]];
    benchmark::DoNotOptimize(answers.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * answers.size()));
}

void ForestOnCurvature(State& state) {
  const TrainAndTest data = trainAndTest(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(fsr::regression::fitCurvatureForest(data.train));
}

// For one taxel; the study has seventy.
void GrnnStudyOfATaxel(State& state) {
  const auto cells = taxelReadings(0);
  for (auto _ : state) benchmark::DoNotOptimize(grnnStudy(cells, fsr::regression::bandwidthGrid()));
}

// For one taxel on one surface.
void BandwidthSearch(State& state) {
  const auto cells = taxelReadings(0);
  std::vector<fsr::regression::CodeStatistics> sections;
  for (std::size_t k = 0; k < kSections; ++k) sections.push_back(fsr::regression::statisticsOf(cells[k]));
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        fsr::regression::BandwidthErrors(sections, kFullScale, {}, fsr::regression::bandwidthGrid()));
  }
}

BENCHMARK(GrnnTable)->Arg(6000)->Arg(36000)->Unit(benchmark::kMicrosecond);
BENCHMARK(GrnnDenseEigen)->Arg(6000)->Unit(benchmark::kMicrosecond);
BENCHMARK(ForestTable)->Arg(6000)->Arg(36000)->Unit(benchmark::kMillisecond);
BENCHMARK(ForestOnCurvature)->Arg(6000)->Arg(36000)->Unit(benchmark::kMillisecond);
BENCHMARK(LinearTable)->Arg(6000)->Unit(benchmark::kMicrosecond);
BENCHMARK(MonotoneTable)->Arg(6000)->Unit(benchmark::kMicrosecond);
BENCHMARK(TableLookUp);
BENCHMARK(GrnnStudyOfATaxel)->Unit(benchmark::kMillisecond);
BENCHMARK(BandwidthSearch)->Unit(benchmark::kMillisecond);

std::ofstream csv(const std::string& path, const std::string& header) {
  std::ofstream file(path);
  file << header << "\n" << std::setprecision(17);
  return file;
}

void writeSamples(const std::string& path, const fsr::regression::CodeSamples& samples) {
  std::ofstream file = csv(path, "code,pressure,curvature");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    file << samples.code[i] << ',' << fsr::regression::fromFixed(samples.pressure[i]) << ','
         << samples.curvature[i] << "\n";
  }
}

void writeAnswers(const std::string& path, const std::vector<double>& answers) {
  std::ofstream file = csv(path, "pressure");
  for (const double answer : answers) file << answer << "\n";
}

void exportAll(const std::string& folder) {
  for (const std::size_t number : {6000, 36000}) {
    const std::string name = folder + "/" + std::to_string(number);
    const TrainAndTest data = trainAndTest(number);
    writeSamples(name + "_train.csv", data.train);
    writeSamples(name + "_test.csv", data.test);
    writeAnswers(name + "_grnn.csv",
                 answersOf(fsr::regression::Grnn().fitSamples(data.train).pressure, data.test));
    writeAnswers(name + "_grnn_table.csv", fsr::regression::Grnn().fitSamples(data.train).pressure);
    fsr::regression::ForestOptions options;
    writeAnswers(name + "_forest.csv",
                 answersOf(fsr::regression::Forest(options).fitSamples(data.train).pressure, data.test));
    options.leaf_count = fsr::regression::LeafCount::kDistinct;
    writeAnswers(name + "_forest_distinct.csv",
                 answersOf(fsr::regression::Forest(options).fitSamples(data.train).pressure, data.test));
  }
  const auto cells = taxelReadings(0);
  std::ofstream file = csv(folder + "/taxel.csv", "condition,section,code,pressure");
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    for (std::size_t i = 0; i < cells[cell].size(); ++i) {
      file << cell / kSections << ',' << cell % kSections << ',' << cells[cell].code[i] << ','
           << fsr::regression::fromFixed(cells[cell].pressure[i]) << "\n";
    }
  }
  const auto bandwidths = fsr::regression::bandwidthGrid();
  const std::vector<double> rmse = grnnStudy(cells, bandwidths);
  std::ofstream study = csv(folder + "/study.csv", "scheme,bandwidth,rmse_percent");
  for (std::size_t i = 0; i < rmse.size(); ++i) {
    study << kSchemeNames[i / bandwidths.size()] << ',' << bandwidths[i % bandwidths.size()] << ',' << rmse[i]
          << "\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string flag = "--export=";
  if (argc == 2 && std::string(argv[1]).rfind(flag, 0) == 0) {
    exportAll(argv[1] + flag.size());
    return 0;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
