#pragma once

#include <string>
#include <vector>

#include "report/result_json.h"
#include "session/conductor.h"

namespace fsr::session {

using report::Json;

// The report of a day at the rig: what was recorded, how good the calibration is, what the sheet does that
// the simulation lacks, and what to record next. Nothing is computed here: every number comes from a tool.

enum class StepFate { kOpen, kAccepted, kSkipped };

/// A step of the plan.
struct DayStep {
  std::string kind;  ///< e.g. "condition", "cycle"
  std::string text;  ///< the instruction
  StepFate fate = StepFate::kOpen;
  bool conditioning = false;
  unsigned rejected = 0;             ///< attempts
  std::vector<std::string> remarks;  ///< why attempts were rejected, or one was accepted by hand
};

/// One stay of the sheet on a surface.
struct DayMount {
  unsigned number = 1;
  std::string surface;
  std::vector<DayStep> steps;
  std::vector<std::string> bags;  ///< file names
};

/// What a tool gave.
struct DayPart {
  std::string command;  ///< with which a reader computes it again, in the folder of the session
  std::string refused;  ///< why there is no result; empty = there is one
  std::string printed;  ///< by the tool
  Json result;          ///< its JSON; null = none
};

struct DayReport {
  std::string plan;       ///< its name
  std::string headline;   ///< the plan in one line
  std::string folder;     ///< of the session, full path
  unsigned rejected = 0;  ///< attempts, in all
  std::vector<DayMount> mounts;
  std::vector<std::string> closed_now;  ///< sentences on bags that the session had left open
  std::vector<std::string> not_closed;  ///< likewise on those that are open still, and are not in this report
  std::string coverage;                 ///< SVG
  std::vector<std::string> plan_limits;  ///< sentences on what the plan cannot tell; see limitsOf()
  std::string calibration;               ///< name of the calibration file
  DayPart check, training, discrepancy;
};

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

/// What training says about the sheet's memory, a tare at the start of a session and the temperature.
std::vector<std::string> choicesOfTraining(const Json& training);

/// The page. A part that is refused appears with its sentence.
std::string dayHtml(const DayReport& day);

/// What the plan, the state of its session and the names of the bags in `folder` say for the report of the
/// day: each step, coverage and the limits of the plan. The parts of the tools stay empty. Throws InputError
/// where the state belongs to another plan.
DayReport dayRecord(const SessionPlan& plan, const ConductorState& state, const std::string& folder);

}  // namespace fsr::session
