// A prediction is a distribution: what new recordings of the same protocol would give for the size of the
// effects. It is as wide as the scatter of the parameters, of the new cycles, and between mounts and
// protocols makes it.

#include "discrepancy/prove/freeze.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <utility>

#include "discrepancy/samples/held_out.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy {

namespace {

double varianceBetween(const std::vector<double>& weight, const std::vector<double>& size,
                       const std::vector<double>& within) {
  double all = 0, squares = 0, mean = 0;
  for (std::size_t g = 0; g < size.size(); ++g) {
    all += weight[g];
    squares += weight[g] * weight[g];
    mean += weight[g] * size[g];
  }
  mean /= all;
  double seen = 0, by_chance = 0;
  for (std::size_t g = 0; g < size.size(); ++g) {
    seen += weight[g] * std::pow(size[g] - mean, 2);
    by_chance += weight[g] * within[g] * (1 - weight[g] / all);
  }
  return std::max(0.0, (seen - by_chance) / (all - squares / all));
}

}  // namespace

std::vector<double> weightsOf(const std::vector<std::vector<double>>& densities, std::size_t draws,
                              std::uint64_t seed) {
  std::vector<double> weights(densities.size(), 0.0);
  const statistics::RandomStream stream = statistics::randomStream(seed, "discrepancy.weights");
  const std::size_t cycles = densities.front().size();
  std::vector<double> share(cycles), score(densities.size());
  for (std::size_t draw = 0; draw < draws; ++draw) {
    double sum = 0;
    for (std::size_t c = 0; c < cycles; ++c) {
      share[c] = -std::log(stream.uniform(draw * cycles + c));
      sum += share[c];
    }
    for (std::size_t e = 0; e < densities.size(); ++e) {
      score[e] = 0;
      for (std::size_t c = 0; c < cycles; ++c)
        score[e] += densities[e][c] * share[c] / sum * static_cast<double>(cycles);
    }
    const double most = *std::max_element(score.begin(), score.end());
    double all = 0;
    for (double& one : score) all += one = std::exp(one - most);
    for (std::size_t e = 0; e < score.size(); ++e) weights[e] += score[e] / all / static_cast<double>(draws);
  }
  return weights;
}

void judgeGroups(const Measured& measured, const Predicted& here, ParameterSpread& spread) {
  std::vector<std::size_t> protocol(measured.cycles.size(), 0);
  const std::vector<Part> parts = partsByProtocol(measured);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const std::size_t c : parts[p].cycles) protocol[c] = p + 1;
  }
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> groups;
  for (std::size_t c = 0; c < measured.cycles.size(); ++c) {
    if (measured.cycles[c].use == CycleUse::kFit)
      groups[{measured.cycles[c].visit, protocol[c]}].push_back(c);
  }
  std::vector<double> weight, size, within;
  for (const auto& [key, cycles] : groups) {
    double all = 0, mean = 0, squares = 0;
    for (const std::size_t c : cycles) {
      all += here.information[c];
      mean += here.information[c] * here.apart[c];
    }
    if (cycles.size() < 2 || !(all > 0)) continue;
    mean /= all;
    for (const std::size_t c : cycles)
      squares += std::pow(here.information[c] / all * (here.apart[c] - mean), 2);
    const auto number = static_cast<double>(cycles.size());
    weight.push_back(all);
    size.push_back(mean);
    within.push_back(squares * number / (number - 1));
  }
  spread.groups = size.size();
  if (size.size() >= 2) spread.between = varianceBetween(weight, size, within);
}

Interval predictiveInterval(const Predicted& here, const ParameterSpread& spread, std::size_t cycles) {
  const auto atLeastTwo = [](std::size_t n) { return static_cast<double>(std::max<std::size_t>(n, 2)); };
  const double known = atLeastTwo(spread.cycles);
  const double parts[] = {here.of_spread * known / (known - 1), here.variance, spread.between};
  const double degrees[] = {known - 1, atLeastTwo(cycles) - 1, atLeastTwo(spread.groups) - 1};
  double variance = 0, of_variance = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    variance += parts[k];
    of_variance += parts[k] * parts[k] / degrees[k];
  }
  if (!(variance > 0)) return {1, 1};
  const boost::math::students_t t(variance * variance / of_variance);
  const double reach = boost::math::quantile(t, 0.975) * std::sqrt(variance);
  return {std::max(0.0, 1 - reach), 1 + reach};
}

Interval sizeInterval(const Predicted& here, std::size_t cycles) {
  const auto degrees = static_cast<double>(std::max<std::size_t>(cycles, 2) - 1);
  const double reach =
      boost::math::quantile(boost::math::students_t(degrees), 0.975) * std::sqrt(here.variance);
  return {std::max(0.0, here.size - reach), here.size + reach};
}

Prediction freeze(const Decision& decision, const Measured& measured, const CommonTraces& common,
                  const StaticFit& fit, const simulation::SimulationSettings& base,
                  const DiscrepancyOptions& options) {
  Prediction prediction;
  prediction.effects = decision.refined.effects;
  for (const Refined& rival : decision.rivals) prediction.rivals.push_back(rival.effects);
  prediction.weights = weightsOf(decision.densities, options.resamples, options.seed);
  prediction.spread = decision.refined.spread;
  const Predicted again = predict(measured, common, fit, base, prediction.effects, prediction.spread);
  judgeGroups(measured, again, prediction.spread);
  prediction.size = predictiveInterval(again, prediction.spread, measured.fitCycles());
  return prediction;
}

}  // namespace fsr::discrepancy
