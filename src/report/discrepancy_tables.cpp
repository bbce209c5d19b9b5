#include <cmath>

#include "report/discrepancy_report.h"
#include "settings/yaml_text.h"

namespace fsr::report {

namespace {

// A number, or nothing if there is no value: spreadsheets read this as an empty cell.
std::string cell(double value) {
  return std::isfinite(value) ? settings::numberText(value) : "";
}

double at(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? values[i] : NAN;
}

std::string curveTable(const discrepancy::ResidualCurve& curve) {
  std::string text = "\"" + curve.covariate + (curve.unit.empty() ? "" : " [" + curve.unit + "]") +
                     "\",before [% FS],after [% FS],standard error [% FS]\n";
  for (std::size_t i = 0; i < curve.at.size(); ++i) {
    text += cell(curve.at[i]);
    for (const auto* values : {&curve.before, &curve.after, &curve.error}) {
      text += "," + cell(100 * at(*values, i));
    }
    text += '\n';
  }
  return text;
}

std::string gapRow(const std::string& name, double value, const discrepancy::Interval& interval,
                   double pressure) {
  return name + "," + cell(100 * value) + "," + cell(100 * interval.low) + "," + cell(100 * interval.high) +
         "," + cell(pressure) + "\n";
}

std::string gapTable(const discrepancy::Gap& gap) {
  return "gap,rms [% FS],low [% FS],high [% FS],rms [Pa]\n" +
         gapRow("before", gap.before, gap.before_interval, gap.before_pressure) +
         gapRow("after", gap.after, gap.after_interval, gap.after_pressure) +
         gapRow("floor", gap.floor, gap.floor_interval, gap.floor_pressure);
}

std::string candidatesTable(const std::vector<discrepancy::CandidateScore>& candidates) {
  std::string text = "explanation,outcome,nats,p,z,share of ceiling [%],at the map [Pa]\n";
  for (const discrepancy::CandidateScore& candidate : candidates) {
    std::string ids;
    for (const std::string& id : candidate.ids) ids += (ids.empty() ? "" : " + ") + id;
    text += ids + "," + candidate.outcome + "," + cell(candidate.nats) + "," + cell(candidate.p) + "," +
            cell(candidate.z) + "," + cell(100 * candidate.share_of_explainable) + "," +
            cell(candidate.at_map) + "\n";
  }
  return text;
}

}  // namespace

std::map<std::string, std::string> discrepancyTables(const discrepancy::DiscrepancyReport& report) {
  std::map<std::string, std::string> tables = {{"gap.csv", gapTable(report.gap)},
                                               {"candidates.csv", candidatesTable(report.candidates)}};
  for (const discrepancy::ResidualCurve& curve : report.curves)
    tables["residual_" + curve.covariate + ".csv"] = curveTable(curve);
  return tables;
}

}  // namespace fsr::report
