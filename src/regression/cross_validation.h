#pragma once

#include <cstdint>
#include <vector>

#include "fsr_pressure_map/regression/code_table.h"
#include "regression/code_statistics.h"
#include "regression/regressor.h"

namespace fsr::regression {

/// A model trained without one section.
struct HeldOutModel {
  std::vector<double> pressure;  ///< of each code [Pa]; empty = no readings were left to train on
  std::vector<float>
      deviation;  ///< of each code [Pa], from the errors on the other sections; empty = not asked for
};

/// One model of one taxel with its held-out deviation.
struct CrossValidatedModel {
  CodeTable table;                     ///< trained on everything
  std::vector<HeldOutModel> held_out;  ///< one for each section
};

/// Whether each held-out model gets a deviation of its own, which scores need.
enum class HeldOutDeviation { kNo, kYes };

/// Assembles the models of a cross-validation: `whole` was trained on all sections, `held_out` [sections]
/// without that section, empty if no readings were left. `sections` has at least one reading in all. If only
/// one section has readings, nothing can be held out, and the deviation is that of the training readings.
CrossValidatedModel assembleModel(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale,
                                  const Fit& whole, std::vector<std::vector<double>> held_out,
                                  HeldOutDeviation held_out_deviation);

}  // namespace fsr::regression
