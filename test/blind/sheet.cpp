#include "blind/sheet.h"

#include <algorithm>
#include <cmath>

namespace blind {

const std::vector<std::string> Sheet::law_names_ = {"lognormal", "rational", "percolation", "weibull",
                                                    "logarithmic"};
const std::vector<std::string> Sheet::preload_names_ = {"hyperbolic", "root", "tanh", "hill"};
const std::vector<std::string> Sheet::gain_names_ = {"power_1.5", "power_law", "hyperbolic", "exponential"};

namespace {

constexpr double kTightest = 20.0;  // curvature for which the sizes below hold [1/m]

double preloadShape(std::size_t law, double curvature, double scale) {
  if (law == 0) return curvature / (curvature + scale);
  if (law == 1) return std::sqrt(curvature);
  if (law == 2) return std::tanh(curvature / scale);
  return curvature * curvature / (curvature * curvature + scale * scale);
}

double gainLoss(std::size_t law, double curvature, double scale) {
  const double x = curvature / scale;
  if (law == 0) return 1 - 1 / (1 + std::pow(x, 1.5));
  if (law == 1) return 1 - std::pow(1 + x, -0.3);
  if (law == 2) return x / (1 + x);
  return 1 - std::exp(-x);
}

}  // namespace

Sheet::Sheet(const Campaign& campaign, std::uint64_t seed, Laws laws) {
  Random random(seed, "sheet");
  const auto drawn = [&](const std::vector<std::string>& names) {
    return random.below(laws == Laws::kFirst ? 3 : names.size());
  };
  law_ = drawn(law_names_);
  preload_law_ = drawn(preload_names_);
  gain_law_ = drawn(gain_names_);
  preload_scale_ = random.uniform(2, 6);  // [1/m]
  preload_size_ = random.uniform(30e3, 55e3) / preloadShape(preload_law_, kTightest, preload_scale_);
  gain_scale_ = random.uniform(8, 20);  // [1/m]
  gain_size_ = random.uniform(0.12, 0.23) / gainLoss(gain_law_, kTightest, gain_scale_);
  drawTaxels(campaign.taxels(), seed);
  for (const fsr::matrix::Surface& surface : campaign.surfaces) drawSurface(surface, campaign.taxels(), seed);
}

void Sheet::drawTaxels(std::size_t number, std::uint64_t seed) {
  Random common(seed, "static law");
  const double level = common.uniform(0.68, 0.75);
  const double a = law_ == 0   ? common.uniform(380e3, 600e3)
                   : law_ == 1 ? common.uniform(1, 2.5)
                   : law_ == 2 ? common.uniform(250e3, 600e3)
                   : law_ == 3 ? common.uniform(300e3, 700e3)
                               : common.uniform(60e3, 250e3);
  const double b = law_ == 0   ? common.uniform(1.1, 1.5)
                   : law_ == 1 ? common.uniform(5, 8)
                               : common.uniform(0.8, 1.3);  // exponents
  for (std::size_t i = 0; i < number; ++i) {
    Random random(seed, "taxel", i);
    const double scatter = std::clamp(random.normal(), -2.0, 2.0);
    Taxel taxel{0.045 + 0.002 * random.normal(), 1, a * (1 + 0.04 * random.normal()),
                b * (1 + 0.02 * random.normal())};
    taxel.level = level * (1 + 0.05 * scatter) / shape(taxel, kPeak);
    taxels_.push_back(taxel);
  }
}

// The random draws depend on the name of the surface, so a sheet is the same in every campaign.
void Sheet::drawSurface(const fsr::matrix::Surface& surface, std::size_t taxels, std::uint64_t seed) {
  const double curvature = surface.curvature[0].x;
  Random random(seed, "bending " + surface.name);
  std::vector<double> preload, gain;
  for (std::size_t i = 0; i < taxels; ++i) {
    // A sheet that was glued to a flat surface has a small preload, too.
    preload.push_back(3e3 + commonPreload(curvature) * (1 + 0.10 * std::clamp(random.normal(), -3.0, 3.0)));
    gain.push_back(curvature == 0 ? 1.0 : commonGain(curvature) * (1 + 0.02 * random.normal()));
  }
  preload_.push_back(preload);
  gain_.push_back(gain);
}

double Sheet::commonPreload(double curvature) const {
  return preload_size_ * preloadShape(preload_law_, curvature, preload_scale_);
}

double Sheet::commonGain(double curvature) const {
  return 1 - gain_size_ * gainLoss(gain_law_, curvature, gain_scale_);
}

double Sheet::shape(const Taxel& taxel, double load) const {
  if (load <= 0) return 0;
  if (law_ == 0) return 0.5 * std::erfc(-std::log(load / taxel.a) / (taxel.b * M_SQRT2));
  if (law_ == 1) {
    const double x = load / 100e3;
    return x * (x + taxel.a) / (x * x + taxel.b * x + 9);
  }
  if (law_ == 2) return std::pow(load / (load + taxel.a), taxel.b);
  if (law_ == 3) return 1 - std::exp(-std::pow(load / taxel.a, taxel.b));
  return std::pow(std::log1p(load / taxel.a), taxel.b);
}

double Sheet::rise(std::size_t taxel, double load) const {
  return taxels_[taxel].level * shape(taxels_[taxel], load);
}

}  // namespace blind
