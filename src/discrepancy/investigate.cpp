#include "fsr_pressure_map/discrepancy/discrepancy.h"
#include "fsr_pressure_map/discrepancy/measured.h"

namespace fsr {

DiscrepancyReport investigate(const DiscrepancyProblem& problem, const DiscrepancyProgress& progress) {
  validate(problem);
  if (progress) progress("reading", 0);
  const Measured measured = admit(problem);
  DiscrepancyReport report;
  report.seed = problem.options.seed;
  report.version = FSR_VERSION;
  report.base = report.added = problem.simulation;
  report.limitations = measured.limitations;
  for (const Recording& recording : problem.recordings) {
    report.inputs.push_back({recording.name, recording.sha256, recording.scans(), 1});
  }
  report.sentence = "Nothing was found.";
  return report;
}

}  // namespace fsr
