#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "blind/campaign.h"

namespace blind {

/// The sensor sheet without hidden effects: the reading of a taxel at a pressure on a surface. The package
/// contains none of its laws.
///
/// Static laws, F(load), 1 at the peak:
///     lognormal    share of the asperities in contact, with log-normal turn-on pressures
///     rational     (x^2 + a x) / (x^2 + b x + c), x in units of 100 kPa
///     percolation  (load / (load + w))^t
///     weibull      1 - exp(-(load / a)^b): asperities whose turn-on pressures follow Weibull's distribution
///     logarithmic  ln(1 + load / a)^b
/// Preload by bending: c k / (k + k0), c sqrt(k), c tanh(k / k0) or c k^2 / (k^2 + k0^2),
/// k = curvature.
/// Gain by bending: 1 / (1 + (k / k1)^1.5), (1 + k / k1)^-q, 1 - b k / (k + k1) or
/// 1 - b (1 - exp(-k / k1)).
/// `Laws::kFirst` draws from the first three of each kind only.
/// Level, shape, preload and gain vary at random from taxel to taxel.
enum class Laws { kFirst, kAll };

class Sheet {
 public:
  Sheet(const Campaign& campaign, std::uint64_t seed, Laws laws = Laws::kFirst);

  /// Reading at zero conductance [share of full scale].
  double zero(std::size_t taxel) const { return taxels_[taxel].zero; }
  /// Reading above zero() on the flat surface [share of full scale]; 0 where `load` <= 0 [Pa].
  double rise(std::size_t taxel, double load) const;
  double preload(std::size_t taxel, std::size_t surface) const { return preload_[surface][taxel]; }  ///< [Pa]
  double gain(std::size_t taxel, std::size_t surface) const { return gain_[surface][taxel]; }

  const std::string& staticLaw() const { return law_names_[law_]; }
  const std::string& preloadLaw() const { return preload_names_[preload_law_]; }
  const std::string& gainLaw() const { return gain_names_[gain_law_]; }

 private:
  struct Taxel {
    double zero, level, a, b;  // a, b: shape parameters of the law
  };
  void drawTaxels(std::size_t number, std::uint64_t seed);
  void drawSurface(const fsr::matrix::Surface& surface, std::size_t taxels, std::uint64_t seed);
  double shape(const Taxel& taxel, double load) const;
  double commonPreload(double curvature) const;
  double commonGain(double curvature) const;

  static const std::vector<std::string> law_names_, preload_names_, gain_names_;
  std::size_t law_, preload_law_, gain_law_;
  double preload_size_, preload_scale_, gain_size_, gain_scale_;
  std::vector<Taxel> taxels_;
  std::vector<std::vector<double>> preload_;  // [surface][taxel]
  std::vector<std::vector<double>> gain_;
};

}  // namespace blind
