#include "regression/regressors.h"

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::regression {

// Each is defined in the source of its regressor.
RegressorEntry linearEntry();
RegressorEntry grnnEntry();
RegressorEntry forestEntry();
RegressorEntry monotoneEntry();

const RegressorTable& packageRegressors() {
  static const RegressorTable table{{
      linearEntry(),
      grnnEntry(),
      forestEntry(),
      monotoneEntry(),
  }};
  return table;
}

const RegressorEntry* RegressorTable::find(const std::string& name) const {
  for (const RegressorEntry& entry : entries) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

const RegressorTable& tableOf(const RegressorOptions& options) {
  return options.table != nullptr ? *options.table : packageRegressors();
}

const RegressorEntry& entryOf(const RegressorOptions& options) {
  const RegressorTable& table = tableOf(options);
  if (const RegressorEntry* const entry = table.find(options.name)) return *entry;
  std::string known;
  for (const RegressorEntry& entry : table.entries)
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  throw settings::InputError("model is \"" + options.name + "\", but must be one of " + known);
}

std::vector<std::string> regressorNames() {
  std::vector<std::string> names;
  for (const RegressorEntry& entry : packageRegressors().entries) names.emplace_back(entry.name);
  return names;
}

std::unique_ptr<Regressor> makeRegressor(const RegressorOptions& options) {
  return entryOf(options).make(options);
}

}  // namespace fsr::regression
