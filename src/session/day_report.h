#pragma once

#include <string>
#include <vector>

#include "report/result_json.h"
#include "session/conductor.h"

namespace fsr::session {

using report::Json;

// The report of a day at the rig: what was recorded, how good the calibration is, what the sheet does that
// the simulation lacks, and what to record next. Nothing is computed here: every number comes from a tool.

/// What a tool gave.
struct DayPart {
  std::string command;  ///< with which a reader computes it again, in the folder of the session
  std::string refused;  ///< why there is no result; empty = there is one
  std::string printed;  ///< by the tool
  Json result;          ///< its JSON; null = none
};

struct DayReport {
  SessionPlan plan;
  std::vector<SessionStep> steps;  ///< of the plan
  ConductorState state;
  std::string folder;                   ///< of the session, full path
  std::vector<std::string> closed_now;  ///< sentences on bags that the session had left open
  std::vector<std::string> not_closed;  ///< likewise on those that are open still, and are not in this report
  std::string calibration;              ///< name of the calibration file
  DayPart check, training, discrepancy;  ///< of `train`: with all its tables
};

/// A report without the parts of the tools. Throws InputError where the state belongs to another plan.
DayReport dayOf(const SessionPlan& plan, const ConductorState& state, const std::string& folder);

/// File names of the bags of one mount in their order; 0 = of all.
std::vector<std::string> bagsOf(const DayReport& day, unsigned mount = 0);

/// What to record, each with its reason, and who says so. What matters most comes first.
struct Advice {
  std::string title;
  std::string source;
  std::vector<std::string> sentences;
};

/// What a tool asks for before it gives a result, what train warns of, steps that were not done, cells of the
/// coverage that are thin, lines of the error budget that are not assessed, what training and discrepancy
/// miss: in this order, since without a calibration nothing else counts, and what may be wrong is worse than
/// what is missing. Groups without sentences are left out.
std::vector<Advice> whatToRecordNext(const DayReport& day);

/// The page. A part that is refused appears with its sentence.
std::string dayHtml(const DayReport& day);

}  // namespace fsr::session
