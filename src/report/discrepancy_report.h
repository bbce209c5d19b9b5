#pragma once

#include <map>
#include <string>

#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "simulation/simulation_text.h"

namespace fsr::report {

// A discrepancy report for people and for programs. Nothing is computed here: every number stands in the
// DiscrepancyReport.

/// What the terminal shows: the verdict, what is not excluded, what is not testable, the gap, the next
/// experiment.
std::string discrepancyText(const discrepancy::DiscrepancyReport& report);

/// results.json: everything but the settings, indented. Numbers are SI; null = no value.
std::string discrepancyJson(const discrepancy::DiscrepancyReport& report);

/// Intervals and provenance of the values that were fitted, for simulationText().
simulation::ValueRemarks fitRemarks(const discrepancy::DiscrepancyReport& report);

/// What the figures are drawn from, by file name: residual_COVARIATE.csv, gap.csv, candidates.csv.
/// Headings say the unit.
std::map<std::string, std::string> discrepancyTables(const discrepancy::DiscrepancyReport& report);

/// Of --confirm, for the terminal and as confirmation.yaml.
std::string confirmationText(const discrepancy::Confirmation& confirmation);
std::string confirmationYaml(const discrepancy::Confirmation& confirmation,
                             const std::string& prediction_hash,
                             const std::vector<discrepancy::InputUse>& inputs);

}  // namespace fsr::report
