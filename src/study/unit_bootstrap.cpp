#include "study/unit_bootstrap.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <thread>
#include <utility>

#include "study/fold.h"

namespace fsr::study {

namespace {

// The levels of resampling, highest first. Mounts are a level if each surface was mounted more than once.
std::vector<statistics::ResamplingLevel> levelsOf(const CycleUnits& units,
                                                  const std::vector<std::size_t>& cycles) {
  const statistics::ResamplingLevel by_cycle{"cycle", cycles};
  if (!units.by_mount) return {by_cycle};
  statistics::ResamplingLevel by_mount{"mount", {}};
  for (const std::size_t cycle : cycles) by_mount.unit.push_back(units.mount[cycle]);
  return {by_mount, by_cycle};
}

template <typename Statistic>
statistics::BootstrapResult interval(const CycleUnits& units, const StudyPlan& plan,
                                     const std::vector<std::size_t>& cycles, Statistic statistic) {
  statistics::BootstrapOptions options;
  options.resamples = plan.resamples;
  options.seed = plan.seed;
  options.stream = "study";
  options.threads = plan.threads > 0 ? plan.threads : std::max(1u, std::thread::hardware_concurrency());
  const auto of_observations = [&](const std::vector<std::size_t>& observations) {
    std::vector<std::size_t> drawn;
    for (const std::size_t i : observations) drawn.push_back(cycles[i]);
    return statistic(drawn);
  };
  return statistics::bootstrap({levelsOf(units, cycles), of_observations}, options);
}

}  // namespace

CycleUnits cycleUnits(const StudyData& data) {
  CycleUnits units{std::vector<std::size_t>(data.cycles, 0), !leaveMountOut(data).folds.empty()};
  for (const ScanList& scans : data.scans)
    scans.forEach([&](const ScanPlace& scan) { units.mount[data.cycle(scan)] = data.mount(scan); });
  return units;
}

CycleSums::CycleSums(const StudyData& data, const Evaluation& evaluation) {
  values_.taxels = evaluation.errors.size();
  values_.models = evaluation.models;
  values_.cycles = data.cycles;
  values_.range = data.highest - data.lowest;
  values_.squares.assign(values_.cycles * values_.models * values_.taxels, 0.0);
  values_.readings.assign(values_.cycles * values_.models, 0.0);
  for (std::size_t t = 0; t < values_.taxels; ++t) {
    evaluation.forEachError(t, [&](const TestPart& part, const ScanPlace& scan, double error) {
      const std::size_t place = data.cycle(scan) * values_.models + part.model;
      values_.squares[place * values_.taxels + t] += error * error;
      if (t == 0) values_.readings[place] += 1;
    });
  }
  addUp();
}

CycleSums::CycleSums(Values values) : values_(std::move(values)) {
  addUp();
}

void CycleSums::addUp() {
  all_squares_.assign(values_.cycles, 0.0);
  for (std::size_t i = 0; i < values_.squares.size(); ++i)
    all_squares_[i / (values_.models * values_.taxels)] += values_.squares[i];
}

double CycleSums::rmsePercent(const std::vector<std::size_t>& cycles) const {
  std::vector<double> squares(values_.models * values_.taxels, 0.0), readings(values_.models, 0.0);
  for (const std::size_t cycle : cycles) {
    const double* const of_cycle = &values_.squares[cycle * squares.size()];
    for (std::size_t i = 0; i < squares.size(); ++i) squares[i] += of_cycle[i];
    for (std::size_t m = 0; m < values_.models; ++m)
      readings[m] += values_.readings[cycle * values_.models + m];
  }
  double sum = 0;
  for (std::size_t i = 0; i < squares.size(); ++i)
    sum += std::sqrt(squares[i] / readings[i / values_.taxels]);
  return 100.0 * sum / static_cast<double>(squares.size()) / values_.range;
}

double CycleSums::rmse(const std::vector<std::size_t>& cycles) const {
  double squares = 0, readings = 0;
  for (const std::size_t cycle : cycles) {
    squares += all_squares_[cycle];
    for (std::size_t m = 0; m < values_.models; ++m) readings += values_.readings[cycle * values_.models + m];
  }
  return std::sqrt(squares / (readings * static_cast<double>(values_.taxels)));
}

std::vector<std::size_t> CycleSums::cycles() const {
  std::vector<std::size_t> scored;
  for (std::size_t cycle = 0; cycle < values_.cycles; ++cycle) {
    const auto begin = values_.readings.begin() + static_cast<std::ptrdiff_t>(cycle * values_.models);
    if (std::any_of(begin, begin + static_cast<std::ptrdiff_t>(values_.models),
                    [](double n) { return n > 0; })) {
      scored.push_back(cycle);
    }
  }
  return scored;
}

statistics::BootstrapResult rmsePercentInterval(const CycleSums& sums, const StudyData& data,
                                                const StudyPlan& plan) {
  return interval(cycleUnits(data), plan, sums.cycles(),
                  [&](const std::vector<std::size_t>& cycles) { return sums.rmsePercent(cycles); });
}

statistics::BootstrapResult rmseInterval(const CycleSums& sums, const StudyData& data,
                                         const StudyPlan& plan) {
  return interval(cycleUnits(data), plan, sums.cycles(),
                  [&](const std::vector<std::size_t>& cycles) { return sums.rmse(cycles); });
}

statistics::BootstrapResult rmseInterval(const std::vector<double>& squares,
                                         const std::vector<double>& readings, const StudyData& data,
                                         const StudyPlan& plan) {
  std::vector<std::size_t> scored;
  for (std::size_t cycle = 0; cycle < readings.size(); ++cycle)
    if (readings[cycle] > 0) scored.push_back(cycle);
  return interval(cycleUnits(data), plan, scored, [&](const std::vector<std::size_t>& cycles) {
    double square = 0, number = 0;
    for (const std::size_t cycle : cycles) {
      square += squares[cycle];
      number += readings[cycle];
    }
    return std::sqrt(square / number);
  });
}

statistics::BootstrapResult differenceInterval(const CycleSums& first, const CycleSums& second,
                                               const CycleUnits& units, const StudyPlan& plan) {
  std::vector<std::size_t> either;
  const std::vector<std::size_t> a = first.cycles(), b = second.cycles();
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(either));
  return interval(units, plan, either, [&](const std::vector<std::size_t>& cycles) {
    return first.rmsePercent(cycles) - second.rmsePercent(cycles);
  });
}

}  // namespace fsr::study
