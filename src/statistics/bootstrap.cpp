#include "statistics/bootstrap.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <future>
#include <map>

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/random_stream.h"
#include "statistics/samples.h"

namespace fsr::statistics {

namespace {

using Units = std::vector<std::vector<std::size_t>>;  // observations of each unit

void require(bool holds, const std::string& sentence) {
  if (!holds) throw settings::InputError("bootstrap: " + sentence);
}

void validate(const BootstrapProblem& problem, const BootstrapOptions& options) {
  require(!problem.levels.empty(), "no level to resample is given; name at least one");
  const std::size_t size = problem.levels.front().unit.size();
  require(size > 0, "no observations given");
  for (const ResamplingLevel& level : problem.levels) {
    require(level.unit.size() == size, "level '" + level.name + "' labels " +
                                           std::to_string(level.unit.size()) + " observations where '" +
                                           problem.levels.front().name + "' labels " + std::to_string(size));
  }
  require(options.confidence > 0 && options.confidence < 1, "confidence must lie between 0 and 1");
  require(options.resamples > 0, "the number of resamples must be 1 or more");
}

Units unitsOf(const ResamplingLevel& level) {
  std::map<std::size_t, std::vector<std::size_t>> by_label;
  for (std::size_t i = 0; i < level.unit.size(); ++i) by_label[level.unit[i]].push_back(i);
  Units units;
  for (auto& [label, observations] : by_label) units.push_back(std::move(observations));
  return units;
}

std::vector<double> leaveOneOut(const BootstrapProblem& problem, const Units& units) {
  std::vector<double> values;
  std::vector<std::size_t> rest;
  for (std::size_t out = 0; out < units.size(); ++out) {
    rest.clear();
    for (std::size_t u = 0; u < units.size(); ++u) {
      if (u != out) rest.insert(rest.end(), units[u].begin(), units[u].end());
    }
    values.push_back(problem.statistic(rest));
  }
  return values;
}

double replicate(const BootstrapProblem& problem, const Units& units, const RandomStream& stream) {
  std::vector<std::size_t> sample;
  for (std::size_t draw = 0; draw < units.size(); ++draw) {
    const auto u = static_cast<std::size_t>(stream.uniform(draw) * static_cast<double>(units.size()));
    sample.insert(sample.end(), units[u].begin(), units[u].end());
  }
  return problem.statistic(sample);
}

std::vector<double> replicates(const BootstrapProblem& problem, const Units& units,
                               const BootstrapOptions& options) {
  std::vector<double> values(options.resamples);
  const std::size_t threads = std::clamp<std::size_t>(options.threads, 1, options.resamples);
  const auto work = [&](std::size_t first) {
    for (std::size_t r = first; r < values.size(); r += threads) {
      values[r] = replicate(problem, units, randomStream(options.seed, options.stream, r));
    }
  };
  std::vector<std::future<void>> others;
  for (std::size_t t = 1; t < threads; ++t) others.push_back(std::async(std::launch::async, work, t));
  work(0);
  for (auto& other : others) other.get();
  return values;
}

bool allFinite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

void studentInterval(const std::vector<double>& jackknife, double confidence, BootstrapResult* result) {
  const double n = static_cast<double>(jackknife.size());
  result->standard_error = std::sqrt((n - 1) / n * squaredDeviations(jackknife));
  const boost::math::students_t t(n - 1);
  const double reach = result->standard_error * boost::math::quantile(t, 0.5 * (1 + confidence));
  result->low = result->estimate - reach;
  result->high = result->estimate + reach;
  result->method = IntervalMethod::kT;
}

void resampledInterval(const BootstrapProblem& problem, const Units& units, const BootstrapOptions& options,
                       const std::vector<double>& jackknife, BootstrapResult* result) {
  std::vector<double> values = replicates(problem, units, options);
  values.erase(std::remove_if(values.begin(), values.end(), [](double x) { return !std::isfinite(x); }),
               values.end());
  result->resamples = values.size();
  if (values.size() < 2 || 2 * values.size() < options.resamples) return;
  const Interval interval = bcaInterval(result->estimate, values, jackknife, options.confidence);
  result->low = interval.low;
  result->high = interval.high;
  result->standard_error = std::sqrt(squaredDeviations(values) / static_cast<double>(values.size() - 1));
  result->method = IntervalMethod::kBca;
}

}  // namespace

BootstrapResult bootstrap(const BootstrapProblem& problem, const BootstrapOptions& options) {
  validate(problem, options);
  BootstrapResult result;
  Units units;
  for (const ResamplingLevel& level : problem.levels) {
    units = unitsOf(level);
    result.level = level.name;
    if (units.size() >= kFewestUnits) break;
  }
  result.units = units.size();

  std::vector<std::size_t> all(problem.levels.front().unit.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  result.estimate = problem.statistic(all);
  require(std::isfinite(result.estimate), "the statistic of all observations is not finite");
  if (units.size() < kFewestUnits) return result;

  const std::vector<double> jackknife = leaveOneOut(problem, units);
  if (!allFinite(jackknife)) return result;
  if (units.size() < kFewestForBca) {
    studentInterval(jackknife, options.confidence, &result);
  } else {
    resampledInterval(problem, units, options, jackknife, &result);
  }
  return result;
}

namespace {

double phi(double z) {
  return boost::math::cdf(boost::math::normal(), z);
}

double phiInverse(double p) {
  return boost::math::quantile(boost::math::normal(), p);
}

double biasCorrection(double estimate, const std::vector<double>& sorted) {
  const auto range = std::equal_range(sorted.begin(), sorted.end(), estimate);
  const double below = static_cast<double>(range.first - sorted.begin());
  const double equal = static_cast<double>(range.second - range.first);
  const double size = static_cast<double>(sorted.size());
  return phiInverse(std::clamp((below + 0.5 * equal) / size, 0.5 / size, 1 - 0.5 / size));
}

double acceleration(const std::vector<double>& jackknife) {
  const double mean = meanOf(jackknife);
  double squares = 0, cubes = 0;
  for (const double value : jackknife) {
    const double influence = mean - value;
    squares += influence * influence;
    cubes += influence * influence * influence;
  }
  return squares > 0 ? cubes / (6 * std::pow(squares, 1.5)) : 0;
}

/// Davison and Hinkley's quantile: linear in the normal deviate between order statistics.
double normalScaleQuantile(const std::vector<double>& sorted, double p) {
  const double places = static_cast<double>(sorted.size()) + 1, position = places * p;
  if (position <= 1) return sorted.front();
  if (position >= places - 1) return sorted.back();
  const double k = std::floor(position);
  const double low = sorted[static_cast<std::size_t>(k) - 1], high = sorted[static_cast<std::size_t>(k)];
  const double from = phiInverse(k / places), to = phiInverse((k + 1) / places);
  return low + (phiInverse(p) - from) / (to - from) * (high - low);
}

}  // namespace

Interval bcaInterval(double estimate, std::vector<double> replicates, const std::vector<double>& jackknife,
                     double confidence) {
  std::sort(replicates.begin(), replicates.end());
  const double z0 = biasCorrection(estimate, replicates), a = acceleration(jackknife);
  const auto limit = [&](double z) {
    const double shifted = z0 + z, divisor = 1 - a * shifted;
    // Beyond the pole the correction has no meaning. As |a| <= 1 / 6, only a very large z0 reaches it.
    if (divisor <= 0) return shifted < 0 ? replicates.front() : replicates.back();
    return normalScaleQuantile(replicates, phi(z0 + shifted / divisor));
  };
  const double z = phiInverse(0.5 * (1 + confidence));
  return {limit(-z), limit(z)};
}

}  // namespace fsr::statistics
