#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/regression/forest.h"
#include "fsr_pressure_map/regression/grnn.h"
#include "fsr_pressure_map/regression/regressor.h"

namespace fsr::regression {

/// Which regressor, and how each would be set.
struct RegressorOptions {
  std::string name = "grnn";  ///< one of regressorNames()
  GrnnOptions grnn;
  ForestOptions forest;
};

/// "linear", "grnn", "forest", "monotone".
std::vector<std::string> regressorNames();

/// Throws InputError that lists the names, or where the options of the one that is named cannot be.
std::unique_ptr<Regressor> makeRegressor(const RegressorOptions& options);

}  // namespace fsr::regression
