#include "report/admission_report.h"

#include <algorithm>
#include <cmath>

#include "check/check.h"
#include "report/calibration_report.h"
#include "report/text_table.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

std::string percent(double share, int digits = 1) {
  return std::isnan(share) ? "not known" : settings::fixedText(100 * share, digits) + " %";
}

std::string numbers(const std::vector<std::size_t>& values) {
  std::string list;
  for (const std::size_t value : values) list += (list.empty() ? "" : ", ") + std::to_string(value);
  return list;
}

std::string recordingsTable(const discrepancy::Admission& admission) {
  TextTable table(
      {"bag", "scans", "time [s]", "surfaces", "lost", "gaps", "lag [s]", "saturated %", "dead", "stuck"});
  for (const discrepancy::AdmittedRecording& row : admission.recordings)
    table.row({row.name, std::to_string(row.scans), settings::fixedText(row.seconds, 1),
               std::to_string(row.surfaces), std::to_string(row.losses.lost_scans),
               std::to_string(row.losses.sequence_gaps),
               row.lag ? settings::fixedText(row.lag->seconds, 2) : "-",
               settings::fixedText(100 * row.health.saturated, 2), std::to_string(row.health.dead.size()),
               std::to_string(row.health.stuck.size())});
  return table.text();
}

std::string healthText(const discrepancy::AdmittedRecording& row, const matrix::Layout& layout) {
  const health::RecordingHealth& health = row.health;
  std::vector<std::string> sentences;
  if (!health.dead.empty())
    sentences.push_back("dead (row, column): " + check::placesText(health.dead, layout));
  if (!health.stuck.empty())
    sentences.push_back("stuck (row, column): " + check::placesText(health.stuck, layout));
  if (!health.rows.empty()) sentences.push_back("failed rows: " + numbers(health.rows));
  if (!health.columns.empty()) sentences.push_back("failed columns: " + numbers(health.columns));
  if (health.saturated_taxels > 0)
    sentences.push_back(std::to_string(health.saturated_taxels) + " taxels reach full scale" +
                        (std::isnan(health.saturated_from)
                             ? ""
                             : ", at " + settings::fixedPressure(health.saturated_from, 0) + " or more"));
  return linesOf(sentences, row.name + ": ");
}

std::string faultText(const health::Fault& fault, const matrix::Layout& layout) {
  const bool line = fault.isLine();
  const std::string where =
      line ? " " + std::to_string(fault.line) : " (row, column): " + check::placesText(fault.taxels, layout);
  return discrepancy::effectOf(fault).id + where + ", " + percent(fault.share, 2) +
         " of the scans, longest " + settings::fixedText(fault.longest, 1) + " s";
}

// ", because A; and 2 more". The lines above list all reasons.
std::string because(const std::vector<std::string>& reasons) {
  if (reasons.empty()) return "";
  const std::string more = reasons.size() == 1 ? "" : "; and " + std::to_string(reasons.size() - 1) + " more";
  return ", because " + reasons.front() + more;
}

std::string verdict(const discrepancy::Admission& admission, const std::vector<std::string>& problems) {
  if (!problems.empty()) return "Not fit" + because(problems) + ".";
  const std::string look = admission.mounts.empty() ? "" : " First look at the mounts that differ.";
  if (admission.discrepancy.empty()) return "Fit for training and for discrepancy." + look;
  return "Fit for training; not for discrepancy, because " + admission.discrepancy + "." + look;
}

std::string restText(const std::string& name, const std::optional<check::SocketRest>& rest) {
  return "Rest " + name + ": " +
         (rest ? settings::fixedText(rest->from, 1) + " to " + settings::fixedText(rest->to, 1) + " s\n"
               : "none recorded\n");
}

std::string changeOfRest(const check::SocketCheck& check) {
  if (check.change.empty()) return "";
  const std::string pressure = std::isnan(check.median_pressure_change)
                                   ? ""
                                   : " (" + settings::fixedPressure(check.median_pressure_change, 1) + ")";
  return "Change of the readings at rest: median " + percent(check.median_change, 2) + " of full scale" +
         pressure + ", largest " + percent(check.change[check.worst], 2) + " at (row, column) " +
         check::placesText({check.worst}, check.layout) + "; " + std::to_string(check.changed) +
         (check.changed == 1 ? " taxel" : " taxels") + " beyond the limit\n";
}

}  // namespace

std::string admissionText(const discrepancy::Admission& admission) {
  std::string text = recordingsTable(admission);
  for (const discrepancy::AdmittedRecording& row : admission.recordings)
    text += healthText(row, admission.layout);
  for (const health::Fault& fault : admission.faults)
    text += "Intermittent fault: " + faultText(fault, admission.layout) + '\n';
  if (!admission.coverage.conditions.empty()) text += '\n' + coverageText(admission.coverage);
  std::vector<std::string> problems = admission.problems;
  if (!admission.training.empty()) problems.insert(problems.begin(), admission.training);
  return text + '\n' + linesOf(admission.remarks, "Note: ") + linesOf(admission.mounts, "Mounts differ: ") +
         linesOf(problems, "Problem: ") + verdict(admission, problems) + '\n';
}

std::string socketText(const check::SocketCheck& check) {
  const std::string longest = check.longest.seconds > 0
                                  ? ", from second " + settings::fixedText(check.longest.from, 0) +
                                        ", at (row, column) " +
                                        check::placesText({check.longest.taxel}, check.layout)
                                  : "";
  const auto listed = [&](const std::vector<std::size_t>& taxels) {
    return taxels.empty() ? "none" : check::placesText(taxels, check.layout);
  };
  return check.name + '\n' + restText("before", check.before) + restText("after", check.after) +
         changeOfRest(check) + "At full scale: " + percent(check.saturated, 2) +
         " of the readings\nOutside the readings of training: " + percent(check.beyond, 2) +
         "; outside its curvatures: " + percent(check.bent_beyond, 2) +
         (std::isnan(check.beyond) ? " (give --calibration)" : "") +
         "\nLongest static load: " + settings::fixedText(check.longest.seconds, 0) + " s" + longest +
         "\nDead (row, column): " + listed(check.dead) + "; stuck: " + listed(check.stuck) + '\n' +
         linesOf(check.reasons, "Problem: ") +
         (check.reasons.empty() ? "Readings are usable" : "Look again" + because(check.reasons)) +
         "; no reference: accuracy not assessed.\n";
}

}  // namespace fsr::report
