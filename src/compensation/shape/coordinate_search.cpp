#include "compensation/shape/coordinate_search.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

namespace fsr::compensation {

namespace {

constexpr int kRounds = 6;           // over all parameters
constexpr int kBits = 14;            // precision along each: a ten-thousandth of the range
constexpr double kLeastGain = 1e-3;  // of a round

}  // namespace

double search(const std::vector<Searched>& parameters, const std::function<double()>& cost) {
  double best = cost();
  for (int round = 0; round < kRounds; ++round) {
    const double before = best;
    for (const Searched& parameter : parameters) {
      const bool logarithmic = parameter.scale == SearchScale::kLogarithmic;
      const auto scaled = [&](double value) { return logarithmic ? std::log(value) : value; };
      const double kept = *parameter.value;
      const auto valueAt = [&](double place) { return logarithmic ? std::exp(place) : place; };
      const auto along = [&](double place) {
        *parameter.value = valueAt(place);
        return cost();
      };
      const auto [at, least] =
          boost::math::tools::brent_find_minima(along, scaled(parameter.low), scaled(parameter.high), kBits);
      *parameter.value = least < best ? valueAt(at) : kept;
      best = std::min(best, least);
    }
    if (before - best < kLeastGain) break;
  }
  return best;
}

}  // namespace fsr::compensation
