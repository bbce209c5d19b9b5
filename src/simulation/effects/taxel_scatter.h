#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

/// Values that scatter from taxel to taxel round `value`: value exp(d N), one normal number N for each
/// taxel from the stream `name`. Log-normal, so that a sign never changes; at deviation 0 exactly
/// `value`.
std::vector<double> scatteredValues(double value, double deviation, const std::string& name,
                                    const EffectContext& context);

/// A smooth random function of one variable, of mean 0, deviation 1 and the correlation
/// exp(-dx^2 / (2 length^2)): a sum of cosines of random frequency and phase.
/// Source: A. Rahimi, B. Recht, Random features for large-scale kernel machines, NIPS 2007.
class SmoothRandomFunction {
 public:
  SmoothRandomFunction(double length, std::uint64_t seed, const std::string& name, std::uint64_t member);
  double operator()(double x) const;

 private:
  static constexpr int kWaves = 16;
  double frequency_[kWaves];
  double phase_[kWaves];
};

/// The same of a place on the sheet [m].
class SmoothRandomField {
 public:
  SmoothRandomField(double length, std::uint64_t seed, const std::string& name, std::uint64_t member);
  double operator()(matrix::Position place) const;

 private:
  static constexpr int kWaves = 32;
  double frequency_x_[kWaves];
  double frequency_y_[kWaves];
  double phase_[kWaves];
};

}  // namespace fsr::simulation
