#include "study/unit_bootstrap.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <thread>

#include "study/fold.h"

namespace fsr::study {

namespace {

// The levels of resampling, highest first. Mounts are a level if each surface was mounted more than once.
std::vector<statistics::ResamplingLevel> levelsOf(const StudyData& data,
                                                  const std::vector<std::size_t>& cycles) {
  const statistics::ResamplingLevel by_cycle{"cycle", cycles};
  if (leaveMountOut(data).folds.empty()) return {by_cycle};
  std::vector<std::size_t> mount(data.cycles, 0);  // of each cycle
  for (const ScanList& scans : data.scans)
    scans.forEach([&](const ScanPlace& scan) { mount[data.cycle(scan)] = data.mount(scan); });
  statistics::ResamplingLevel by_mount{"mount", {}};
  for (const std::size_t cycle : cycles) by_mount.unit.push_back(mount[cycle]);
  return {by_mount, by_cycle};
}

template <typename Statistic>
statistics::BootstrapResult interval(const StudyData& data, const StudyPlan& plan,
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
  return statistics::bootstrap({levelsOf(data, cycles), of_observations}, options);
}

}  // namespace

CycleSums::CycleSums(const StudyData& data, const Evaluation& evaluation)
    : taxels_(evaluation.errors.size()),
      models_(evaluation.models),
      cycles_(data.cycles),
      range_(data.highest - data.lowest),
      squares_(cycles_ * models_ * taxels_, 0.0),
      readings_(cycles_ * models_, 0.0),
      all_squares_(cycles_, 0.0) {
  for (std::size_t t = 0; t < taxels_; ++t) {
    evaluation.forEachError(t, [&](const TestPart& part, const ScanPlace& scan, double error) {
      const std::size_t place = data.cycle(scan) * models_ + part.model;
      squares_[place * taxels_ + t] += error * error;
      if (t == 0) readings_[place] += 1;
    });
  }
  for (std::size_t i = 0; i < squares_.size(); ++i) all_squares_[i / (models_ * taxels_)] += squares_[i];
}

double CycleSums::rmsePercent(const std::vector<std::size_t>& cycles) const {
  std::vector<double> squares(models_ * taxels_, 0.0), readings(models_, 0.0);
  for (const std::size_t cycle : cycles) {
    const double* const of_cycle = &squares_[cycle * squares.size()];
    for (std::size_t i = 0; i < squares.size(); ++i) squares[i] += of_cycle[i];
    for (std::size_t m = 0; m < models_; ++m) readings[m] += readings_[cycle * models_ + m];
  }
  double sum = 0;
  for (std::size_t i = 0; i < squares.size(); ++i) sum += std::sqrt(squares[i] / readings[i / taxels_]);
  return 100.0 * sum / static_cast<double>(squares.size()) / range_;
}

double CycleSums::rmse(const std::vector<std::size_t>& cycles) const {
  double squares = 0, readings = 0;
  for (const std::size_t cycle : cycles) {
    squares += all_squares_[cycle];
    for (std::size_t m = 0; m < models_; ++m) readings += readings_[cycle * models_ + m];
  }
  return std::sqrt(squares / (readings * static_cast<double>(taxels_)));
}

std::vector<std::size_t> CycleSums::cycles() const {
  std::vector<std::size_t> scored;
  for (std::size_t cycle = 0; cycle < cycles_; ++cycle) {
    const auto begin = readings_.begin() + static_cast<std::ptrdiff_t>(cycle * models_);
    if (std::any_of(begin, begin + static_cast<std::ptrdiff_t>(models_), [](double n) { return n > 0; })) {
      scored.push_back(cycle);
    }
  }
  return scored;
}

statistics::BootstrapResult rmsePercentInterval(const CycleSums& sums, const StudyData& data,
                                                const StudyPlan& plan) {
  return interval(data, plan, sums.cycles(),
                  [&](const std::vector<std::size_t>& cycles) { return sums.rmsePercent(cycles); });
}

statistics::BootstrapResult rmseInterval(const CycleSums& sums, const StudyData& data,
                                         const StudyPlan& plan) {
  return interval(data, plan, sums.cycles(),
                  [&](const std::vector<std::size_t>& cycles) { return sums.rmse(cycles); });
}

statistics::BootstrapResult rmseInterval(const std::vector<double>& squares,
                                         const std::vector<double>& readings, const StudyData& data,
                                         const StudyPlan& plan) {
  std::vector<std::size_t> scored;
  for (std::size_t cycle = 0; cycle < readings.size(); ++cycle)
    if (readings[cycle] > 0) scored.push_back(cycle);
  return interval(data, plan, scored, [&](const std::vector<std::size_t>& cycles) {
    double square = 0, number = 0;
    for (const std::size_t cycle : cycles) {
      square += squares[cycle];
      number += readings[cycle];
    }
    return std::sqrt(square / number);
  });
}

statistics::BootstrapResult differenceInterval(const CycleSums& first, const CycleSums& second,
                                               const StudyData& data, const StudyPlan& plan) {
  std::vector<std::size_t> either;
  const std::vector<std::size_t> a = first.cycles(), b = second.cycles();
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(either));
  return interval(data, plan, either, [&](const std::vector<std::size_t>& cycles) {
    return first.rmsePercent(cycles) - second.rmsePercent(cycles);
  });
}

}  // namespace fsr::study
