#pragma once

#include <cstdint>
#include <vector>

#include "fsr_pressure_map/regression/code_table.h"
#include "regression/code_statistics.h"
#include "regression/regressor.h"

namespace fsr::regression {

/// A model trained without one section, and what the other sections' held-out errors say of it.
struct HeldOutModel {
  std::vector<double> pressure;  ///< of each code [Pa]; empty = nothing was left to train on
  std::vector<float>
      deviation;  ///< of each code [Pa], from the other sections' errors; empty = not asked for
};

/// One model of one taxel with its held-out deviation.
struct CrossValidatedModel {
  CodeTable table;                     ///< trained on everything
  std::vector<HeldOutModel> held_out;  ///< one for each section
};

/// Whether each held-out model shall state a deviation of its own (scores need it).
enum class HeldOutDeviation { kNo, kYes };

/// Trains on all sections, and once without each. `sections` holds at least one reading in all; where
/// only one of them has any, nothing can be held out and the deviation is that of the training
/// readings themselves.
CrossValidatedModel crossValidate(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale,
                                  const Regressor& regressor, HeldOutDeviation held_out_deviation);

/// The same from single readings, for any regressor.
CrossValidatedModel crossValidateSamples(const std::vector<CodeSamples>& sections, const Regressor& regressor,
                                         HeldOutDeviation held_out_deviation);

/// What crossValidate() makes of models that the caller has trained: `whole` on all sections,
/// `held_out` [one for each section] without that section, empty where nothing was left to train on.
CrossValidatedModel assembleModel(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale,
                                  const Fit& whole, std::vector<std::vector<double>> held_out,
                                  HeldOutDeviation held_out_deviation);

}  // namespace fsr::regression
