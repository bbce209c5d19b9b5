#pragma once

#include <map>
#include <string>

#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "fsr_pressure_map/simulation/simulation_text.h"

namespace fsr {

// A discrepancy report for people and for programs. Nothing is computed here: every number stands in the
// DiscrepancyReport.

/// What the terminal shows: the verdict, what is not excluded, what is not testable, the gap, the next
/// experiment.
std::string discrepancyText(const DiscrepancyReport& report);

/// results.json: everything but the settings, indented. Numbers are SI; null = no value.
std::string discrepancyJson(const DiscrepancyReport& report);

/// Intervals and provenance of the values that were fitted, for simulationText().
ValueRemarks fitRemarks(const DiscrepancyReport& report);

/// What the figures are drawn from, by file name: residual_COVARIATE.csv, gap.csv, candidates.csv.
/// Headings say the unit.
std::map<std::string, std::string> discrepancyTables(const DiscrepancyReport& report);

/// Of --confirm, for the terminal and as confirmation.yaml.
std::string confirmationText(const Confirmation& confirmation);
std::string confirmationYaml(const Confirmation& confirmation, const std::string& prediction_hash,
                             const std::vector<InputUse>& inputs);

}  // namespace fsr
