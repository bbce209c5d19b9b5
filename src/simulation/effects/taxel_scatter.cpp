#include "simulation/effects/taxel_scatter.h"

#include <cmath>

#include "statistics/random_stream.h"

namespace fsr::simulation {

std::vector<double> scatteredValues(double value, double deviation, const std::string& name,
                                    const EffectContext& context) {
  std::vector<double> values(context.layout.size.taxels());
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = value * std::exp(deviation * statistics::randomStream(context.seed, name, i).normal(0));
  }
  return values;
}

SmoothRandomFunction::SmoothRandomFunction(double length, std::uint64_t seed, const std::string& name,
                                           std::uint64_t member) {
  const statistics::RandomStream stream = statistics::randomStream(seed, name, member);
  for (std::uint64_t i = 0; i < kWaves; ++i) {
    frequency_[i] = stream.normal(2 * i) / length;
    phase_[i] = 2 * M_PI * stream.uniform(2 * i + 1);
  }
}

double SmoothRandomFunction::operator()(double x) const {
  double sum = 0;
  for (int i = 0; i < kWaves; ++i) sum += std::cos(frequency_[i] * x + phase_[i]);
  return sum * std::sqrt(2.0 / kWaves);
}

SmoothRandomField::SmoothRandomField(double length, std::uint64_t seed, const std::string& name,
                                     std::uint64_t member) {
  const statistics::RandomStream stream = statistics::randomStream(seed, name, member);
  for (std::uint64_t i = 0; i < kWaves; ++i) {
    frequency_x_[i] = stream.normal(3 * i) / length;
    frequency_y_[i] = stream.normal(3 * i + 1) / length;
    phase_[i] = 2 * M_PI * stream.uniform(3 * i + 2);
  }
}

double SmoothRandomField::operator()(matrix::Position place) const {
  double sum = 0;
  for (int i = 0; i < kWaves; ++i) {
    sum += std::cos(frequency_x_[i] * place.x + frequency_y_[i] * place.y + phase_[i]);
  }
  return sum * std::sqrt(2.0 / kWaves);
}

}  // namespace fsr::simulation
