#pragma once

#include <map>
#include <string>

#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "simulation/settings_text.h"

namespace fsr::report {

// A discrepancy report as text, JSON and tables. Nothing is computed here: every number is in the
// DiscrepancyReport.

/// Text for the terminal: the first screen (see firstScreen()), effects that are not testable, gap on each
/// surface and limitations.
std::string discrepancyText(const discrepancy::DiscrepancyReport& report);

/// results.json: the whole report but the simulation's settings, indented. Numbers are SI; null = no value.
std::string discrepancyJson(const discrepancy::DiscrepancyReport& report);

/// Remarks on the fitted values for simulationText(): "fitted", with the interval.
simulation::ValueRemarks fitRemarks(const discrepancy::DiscrepancyReport& report);

/// Data of the figures by file name: residual_COVARIATE.csv, gap.csv, candidates.csv. Headings include the
/// unit.
std::map<std::string, std::string> discrepancyTables(const discrepancy::DiscrepancyReport& report);

/// Result of --confirm, for the terminal and as confirmation.yaml.
std::string confirmationText(const discrepancy::Confirmation& confirmation);
std::string confirmationYaml(const discrepancy::Confirmation& confirmation,
                             const std::string& prediction_hash,
                             const std::vector<discrepancy::InputUse>& inputs);

}  // namespace fsr::report
