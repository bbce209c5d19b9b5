#include "report/admission_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "report/calibration_report.h"
#include "settings/number_text.h"

namespace fsr::report {

namespace {

std::string percent(double share, int digits = 1) {
  return std::isnan(share) ? "not known" : settings::cellText(100 * share, digits) + " %";
}

// "(row, column)" of the first eight taxels.
std::string places(const std::vector<std::size_t>& taxels, const matrix::Layout& layout) {
  constexpr std::size_t kListed = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(taxels.size(), kListed); ++i) {
    list += (i == 0 ? "(" : ", (") + std::to_string(layout.row({taxels[i]})) + ", " +
            std::to_string(layout.column({taxels[i]})) + ")";
  }
  return taxels.size() > kListed ? list + ", ..." : list;
}

std::string numbers(const std::vector<std::size_t>& values) {
  std::string list;
  for (const std::size_t value : values) list += (list.empty() ? "" : ", ") + std::to_string(value);
  return list;
}

std::string lagText(const discrepancy::AdmittedRecording& recording) {
  return recording.lag ? settings::cellText(recording.lag->seconds, 2) : "-";
}

void addRow(const discrepancy::AdmittedRecording& row, int width, std::ostringstream& out) {
  out << std::left << std::setw(width) << row.name << std::right << std::setw(8) << row.scans << std::setw(10)
      << settings::cellText(row.seconds, 1) << std::setw(10) << row.surfaces << std::setw(7)
      << row.losses.lost_scans << std::setw(7) << row.losses.sequence_gaps << std::setw(9) << lagText(row)
      << std::setw(13) << settings::cellText(100 * row.health.saturated, 2) << std::setw(6)
      << row.health.dead.size() << std::setw(7) << row.health.stuck.size() << '\n';
}

void addTable(const discrepancy::Admission& admission, std::ostringstream& out) {
  std::size_t width = 6;
  for (const discrepancy::AdmittedRecording& row : admission.recordings)
    width = std::max(width, row.name.size() + 2);
  out << std::left << std::setw(static_cast<int>(width)) << "bag" << std::right << std::setw(8) << "scans"
      << std::setw(10) << "time [s]" << std::setw(10) << "surfaces" << std::setw(7) << "lost" << std::setw(7)
      << "gaps" << std::setw(9) << "lag [s]" << std::setw(13) << "saturated %" << std::setw(6) << "dead"
      << std::setw(7) << "stuck" << '\n';
  for (const discrepancy::AdmittedRecording& row : admission.recordings)
    addRow(row, static_cast<int>(width), out);
}

void addHealth(const discrepancy::AdmittedRecording& row, const matrix::Layout& layout,
               std::ostringstream& out) {
  const health::RecordingHealth& health = row.health;
  if (!health.dead.empty())
    out << row.name << ": dead (row, column): " << places(health.dead, layout) << '\n';
  if (!health.stuck.empty())
    out << row.name << ": stuck (row, column): " << places(health.stuck, layout) << '\n';
  if (!health.rows.empty()) out << row.name << ": failed rows: " << numbers(health.rows) << '\n';
  if (!health.columns.empty()) out << row.name << ": failed columns: " << numbers(health.columns) << '\n';
  if (health.saturated_taxels == 0) return;
  out << row.name << ": " << health.saturated_taxels << " taxels reach full scale";
  if (!std::isnan(health.saturated_from)) {
    out << ", at " << settings::cellText(health.saturated_from / 1000, 0) << " kPa or more";
  }
  out << '\n';
}

std::string faultText(const discrepancy::Fault& fault, const matrix::Layout& layout) {
  const bool line = fault.isLine();
  const std::string where =
      line ? " " + std::to_string(fault.line) : " (row, column): " + places(fault.taxels, layout);
  return fault.id + where + ", " + percent(fault.share, 2) + " of the scans, longest " +
         settings::cellText(fault.longest, 1) + " s";
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

void addRests(const check::SocketCheck& check, std::ostringstream& out) {
  for (const auto& [name, rest] : {std::pair{"before", &check.before}, std::pair{"after", &check.after}}) {
    out << "Rest " << name << ": ";
    if (*rest) {
      out << settings::cellText((*rest)->from, 1) << " to " << settings::cellText((*rest)->to, 1) << " s\n";
    } else {
      out << "none recorded\n";
    }
  }
  if (check.change.empty()) return;
  const double worst = check.change[check.worst];
  out << "Change of the readings at rest: median " << percent(check.median_change, 2) << " of full scale";
  if (!std::isnan(check.median_pressure_change)) {
    out << " (" << settings::cellText(check.median_pressure_change / 1000, 1) << " kPa)";
  }
  out << ", largest " << percent(worst, 2) << " at (row, column) " << places({check.worst}, check.layout)
      << "; " << check.changed << (check.changed == 1 ? " taxel" : " taxels") << " beyond the limit\n";
}

}  // namespace

std::string admissionText(const discrepancy::Admission& admission) {
  std::ostringstream out;
  addTable(admission, out);
  for (const discrepancy::AdmittedRecording& row : admission.recordings)
    addHealth(row, admission.layout, out);
  for (const discrepancy::Fault& fault : admission.faults) {
    out << "Intermittent fault: " << faultText(fault, admission.layout) << '\n';
  }
  if (!admission.coverage.conditions.empty()) out << '\n' << coverageText(admission.coverage);
  out << '\n';
  for (const std::string& remark : admission.remarks) out << "Note: " << remark << '\n';
  for (const std::string& mount : admission.mounts) out << "Mounts differ: " << mount << '\n';
  std::vector<std::string> problems = admission.problems;
  if (!admission.training.empty()) problems.insert(problems.begin(), admission.training);
  for (const std::string& problem : problems) out << "Problem: " << problem << '\n';
  out << verdict(admission, problems) << '\n';
  return out.str();
}

std::string socketText(const check::SocketCheck& check) {
  std::ostringstream out;
  out << check.name << '\n';
  addRests(check, out);
  out << "At full scale: " << percent(check.saturated, 2) << " of the readings\n"
      << "Outside the readings of training: " << percent(check.beyond, 2)
      << "; outside its curvatures: " << percent(check.bent_beyond, 2)
      << (std::isnan(check.beyond) ? " (give --calibration)" : "") << '\n'
      << "Longest static load: " << settings::cellText(check.longest.seconds, 0) << " s";
  if (check.longest.seconds > 0) {
    out << ", from second " << settings::cellText(check.longest.from, 0) << ", at (row, column) "
        << places({check.longest.taxel}, check.layout);
  }
  out << "\nDead (row, column): " << (check.dead.empty() ? "none" : places(check.dead, check.layout))
      << "; stuck: " << (check.stuck.empty() ? "none" : places(check.stuck, check.layout)) << '\n';
  for (const std::string& reason : check.reasons) out << "Problem: " << reason << '\n';
  out << (check.reasons.empty() ? "Readings are usable" : "Look again" + because(check.reasons))
      << "; no reference: accuracy not assessed.\n";
  return out.str();
}

}  // namespace fsr::report
