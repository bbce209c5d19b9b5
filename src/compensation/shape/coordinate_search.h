#pragma once

#include <functional>
#include <vector>

namespace fsr::compensation {

enum class SearchScale { kLinear, kLogarithmic };

/// A parameter that is searched between two values.
struct Searched {
  double* value;
  double low, high;
  SearchScale scale = SearchScale::kLogarithmic;
};

/// Minimises `cost` along each parameter in turn (R. P. Brent, Algorithms for Minimization Without
/// Derivatives, 1973), until a round over all parameters gains less than a thousandth. Leaves the parameters
/// at the minimum and returns it.
double search(const std::vector<Searched>& parameters, const std::function<double()>& cost);

}  // namespace fsr::compensation
