#pragma once

#include <map>
#include <string>

#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "report/prediction_file.h"

namespace fsr_ros {

/// The files at the top of the folder that writeDiscrepancy() replaces, with their kinds (kindOf()).
std::map<std::string, std::string> discrepancyFiles();

/// Writes a report into a folder: verdict.yaml, simulation.yaml (with the effects found), base.yaml (fitted,
/// without them), prediction.yaml, results.json, and the tables for the figures in figures/. Each file is
/// either complete or not written; verdict.yaml is written last. `recordings` are those of the report,
/// for the prediction. Throws fsr::InputError.
void writeDiscrepancy(const fsr::discrepancy::DiscrepancyReport& report, const std::string& folder,
                      const std::vector<fsr::dataset::Recording>& recordings = {});

/// SHA-256 of the counts of all scans: a copy of a bag that was compressed, renamed or written anew has the
/// same.
std::string readingsSha256(const fsr::dataset::Recording& recording);

/// A prediction and the simulation to which its effects are added.
struct StoredPrediction {
  fsr::report::FrozenPrediction frozen;
  fsr::simulation::SimulationSettings base;
};

/// Reads the prediction that writeDiscrepancy() wrote beside a verdict.yaml. Throws fsr::InputError, also if
/// the verdict was edited afterwards.
StoredPrediction readPredictionBeside(const std::string& verdict_path);

}  // namespace fsr_ros
