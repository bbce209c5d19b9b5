#pragma once

#include "fsr_pressure_map/calibration/calibration.h"
#include "regression/regressors.h"

namespace fsr_ros {

/// The options of a training that the tool `train` and the training node share. `from` gives them by the
/// names of the node's parameters: a Parameters, or likewise the words of the tool. Throws fsr::InputError.
template <typename Source>
fsr::calibration::CalibrationOptions trainingOptions(const Source& from) {
  namespace regression = fsr::regression;
  fsr::calibration::CalibrationOptions options;
  options.scheme = fsr::compensation::schemeFromName(
      from.choice("scheme", fsr::compensation::schemeNames(), fsr::compensation::schemeName(options.scheme)));
  regression::RegressorOptions& model = options.regressor;
  model.name = from.choice("model", regression::regressorNames(), model.name);
  model.grnn.spread = regression::spreadFromName(from.choice("spread", regression::spreadNames(), "sigma"));
  model.grnn.distance =
      regression::distanceFromName(from.choice("distance", regression::distanceNames(), "squared"));
  if (from.flag("equal_bins", false)) model.grnn.weighting = regression::SampleWeighting::kEachPressureBin;
  model.forest.trees = static_cast<std::size_t>(from.integer("trees", 150, {1, 1e5, ""}));
  model.forest.minimum_leaf = static_cast<std::size_t>(from.integer("minimum_leaf", 5, {1, 1e6, ""}));
  model.forest.leaf_count =
      regression::leafRuleFromName(from.choice("leaf_rule", regression::leafRuleNames(), "draws"));
  const auto bandwidth = regression::bandwidthFromText(from.text("bandwidth", "auto"));
  options.choose_bandwidth = !bandwidth;
  if (bandwidth) model.grnn.bandwidth = *bandwidth;
  options.folds = static_cast<std::size_t>(from.integer("folds", 5, {2, 20, ""}));
  options.threads = static_cast<unsigned>(from.integer("threads", 0, {0, 1024, ""}));
  options.seed = static_cast<std::uint64_t>(from.integer("seed", 1, {0, 1e15, ""}));
  return options;
}

}  // namespace fsr_ros
