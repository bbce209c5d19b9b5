#include "fsr_pressure_map/regression/regressors.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "regression/linear_regression.h"
#include "regression/monotone.h"

namespace fsr::regression {

std::vector<std::string> regressorNames() {
  return {"linear", "grnn", "forest", "monotone"};
}

std::unique_ptr<Regressor> makeRegressor(const RegressorOptions& options) {
  if (options.name == "linear") return std::make_unique<LinearRegression>();
  if (options.name == "grnn") return std::make_unique<Grnn>(options.grnn);
  if (options.name == "forest") return std::make_unique<Forest>(options.forest);
  if (options.name == "monotone") return std::make_unique<Monotone>();
  std::string known;
  for (const std::string& name : regressorNames()) known += (known.empty() ? "" : ", ") + name;
  throw settings::InputError("model is \"" + options.name + "\", but must be one of " + known);
}

}  // namespace fsr::regression
