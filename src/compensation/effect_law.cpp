#include "compensation/effect_law.h"

#include <algorithm>
#include <cmath>

#include "regression/monotone.h"

namespace fsr::compensation {

namespace {

constexpr std::size_t kLeastKnots = 3;
constexpr double kSameCurvature = 1e-6;  // [1/m]

// Makes values first .. last monotone, in the direction of their trend.
void makeMonotone(std::vector<double>& values, std::size_t first, std::size_t last) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = values.begin() + static_cast<std::ptrdiff_t>(last) + 1;
  std::vector<double> run(begin, end);
  double trend = 0;
  for (std::size_t i = 0; i < run.size(); ++i) {
    trend += run[i] * (static_cast<double>(i) - 0.5 * static_cast<double>(run.size() - 1));
  }
  const double sign = trend < 0 ? -1.0 : 1.0;
  for (double& value : run) value *= sign;
  for (const regression::IsotonicBlock& block :
       regression::isotonicRegression(run, std::vector<double>(run.size(), 1.0))) {
    std::fill(begin + static_cast<std::ptrdiff_t>(block.begin),
              begin + static_cast<std::ptrdiff_t>(block.end), sign * block.level);
  }
}

// Opposite bends may both decrease or both increase the pressure, so each side has its own trend.
void makeMonotoneToEitherSide(const std::vector<double>& curvature, std::vector<double>& values) {
  std::size_t flattest = 0;
  for (std::size_t i = 1; i < curvature.size(); ++i) {
    if (std::abs(curvature[i]) < std::abs(curvature[flattest])) flattest = i;
  }
  makeMonotone(values, flattest, values.size() - 1);
  makeMonotone(values, 0, flattest);
}

double meanOf(const std::vector<TaxelEffect>& taxels, std::vector<double> TaxelEffect::*column,
              std::size_t k) {
  double sum = 0, number = 0;
  for (const TaxelEffect& taxel : taxels) {
    if ((taxel.*column).empty()) continue;
    sum += (taxel.*column)[k];
    number += 1;
  }
  return sum / number;
}

}  // namespace

TaxelEffect effectOf(const regression::CodeTable* tables, std::size_t classes) {
  std::size_t first = 0, last = tables[0].pressure.size() - 1;
  for (std::size_t k = 0; k < classes; ++k) {
    if (std::isnan(tables[k].pressure.front())) return {};
    first = std::max<std::size_t>(first, tables[k].lowest);
    last = std::min<std::size_t>(last, tables[k].highest);
  }
  if (first >= last) return {};
  const auto number = static_cast<double>(last - first + 1);
  std::vector<double> mean(last - first + 1, 0.0);
  double centre = 0, scatter = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    for (std::size_t k = 0; k < classes; ++k)
      mean[i] += tables[k].pressure[first + i] / static_cast<double>(classes);
    centre += mean[i] / number;
  }
  for (const double value : mean) scatter += (value - centre) * (value - centre);
  if (scatter == 0) return {};
  TaxelEffect effect;
  for (std::size_t k = 0; k < classes; ++k) {
    double own = 0, product = 0;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      own += tables[k].pressure[first + i] / number;
      product += (mean[i] - centre) * tables[k].pressure[first + i];
    }
    effect.gain.push_back(product / scatter);
    effect.offset.push_back(own - effect.gain.back() * centre);
  }
  return effect;
}

EffectLaw learnLaw(const std::vector<dataset::CurvatureClass>& classes,
                   const std::vector<TaxelEffect>& taxels, std::size_t left_out) {
  EffectLaw law;
  const auto known = [](const TaxelEffect& taxel) { return !taxel.gain.empty(); };
  if (std::none_of(taxels.begin(), taxels.end(), known)) return law;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    if (k == left_out || classes[k].curvature.size() != 1) continue;
    const double curvature = classes[k].at(0);
    if (!law.curvature.empty() && curvature < law.curvature.back() + kSameCurvature) continue;
    law.curvature.push_back(curvature);
    law.gain.push_back(meanOf(taxels, &TaxelEffect::gain, k));
    law.offset.push_back(meanOf(taxels, &TaxelEffect::offset, k));
  }
  if (law.curvature.size() < kLeastKnots) return {};
  makeMonotoneToEitherSide(law.curvature, law.gain);
  makeMonotoneToEitherSide(law.curvature, law.offset);
  return law;
}

}  // namespace fsr::compensation
