#pragma once

#include <string>

#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "report/prediction_file.h"

namespace fsr_ros {

/// The folder, made where it is not there. Throws fsr::InputError where it cannot be made.
std::string outputFolder(const std::string& path);

/// Writes a report into a folder: verdict.yaml, simulation.yaml (with the effects found), base.yaml (fitted,
/// without them), prediction.yaml, results.json and the tables behind the figures in figures/. Every file is
/// there whole or not at all, verdict.yaml last. Throws fsr::InputError.
void writeDiscrepancy(const fsr::discrepancy::DiscrepancyReport& report, const std::string& folder);

/// A prediction and the simulation that it completes.
struct StoredPrediction {
  fsr::report::FrozenPrediction frozen;
  fsr::simulation::SimulationSettings base;
};

/// Reads what writeDiscrepancy() left beside a verdict.yaml. Throws fsr::InputError, also where the verdict
/// was edited since.
StoredPrediction readPredictionBeside(const std::string& verdict_path);

}  // namespace fsr_ros
