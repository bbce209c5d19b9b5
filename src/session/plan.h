#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/layout.h"
#include "fsr_pressure_map/simulation/chamber.h"
#include "settings/settings.h"

namespace fsr::session {

/// What the recordings of a session are for.
enum class Purpose {
  kPerCurvature,  ///< a calibration of several surfaces
  kHistory,       ///< a calibration with a model of the sheet's memory
  kDiscrepancy,   ///< to find what the sheet does that the simulation lacks
  kFieldCheck,    ///< whether a calibration still holds
};

/// "per_curvature", "history", "discrepancy", "field_check".
std::string name(Purpose purpose);
std::vector<std::string> purposeNames();
/// Throws std::out_of_range for another name.
Purpose purposeCalled(const std::string& name);

/// Cycles above the largest peak before the first recording. They are not recorded. FlexiForce's manual asks
/// for four or five at 110 % of the test load (Tekscan, FlexiForce Sensors User Manual, "Conditioning").
struct Conditioning {
  unsigned cycles = 5;         ///< 0 = none
  double share_of_peak = 1.1;  ///< of the largest peak of the program
  double rate = 17e3;          ///< of filling and venting [Pa/s]
  double dwell_peak = 1;       ///< [s]
  double dwell_rest = 1;       ///< [s]
};

/// Rest without load at the start and at the end of each recording [s].
struct Rests {
  double before = 30;
  double after = 30;
};

/// By how much a cycle may differ from the plan.
struct Tolerance {
  double peak = 0.05;  ///< share of the peak
  double rate = 0.25;  ///< share of the rate
  double dwell = 2;    ///< [s]
};

/// A surface and the number of times that the sheet is put on it.
struct PlannedSurface {
  matrix::Surface surface;  ///< without the number of a mount
  unsigned mounts = 1;
};

/// A long pause without load.
struct Break {
  unsigned after = 1;   ///< number of the mount behind which it comes, from 1
  double duration = 0;  ///< [s]
};

/// A day at the rig: config/sessions/*.yaml.
struct SessionPlan {
  std::string origin;  ///< the file, for messages
  std::string name;
  Purpose purpose = Purpose::kPerCurvature;
  std::uint64_t seed = 1;                             ///< of the order
  bool drawn_order = true;                            ///< false: rounds in the order of `surfaces`
  bool repeat_first = true;                           ///< the first surface once more at the end
  bool thermometer = false;                           ///< the temperature of the sheet is recorded
  double chamber_limit = simulation::kChamberRating;  ///< highest pressure of this chamber, gauge [Pa]
  double change = 180;                                ///< time to put the sheet on the next surface [s]
  matrix::MatrixSize matrix{7, 10};                   ///< of surfaces with a curvature for each taxel
  Conditioning conditioning;
  Rests rest;
  Tolerance tolerance;
  std::vector<PlannedSurface> surfaces;  ///< at least one
  simulation::ChamberProgram program;    ///< on each mount, between the rests
  std::vector<Break> breaks;             ///< by ascending `after`
};

/// Curvature of a surface: the principal one of the taxel where it is largest, with its sign [1/m].
double bendOf(const matrix::Surface& surface);
/// Largest pressure of the program [Pa].
double largestPeak(const SessionPlan& plan);
/// Pressure of the conditioning [Pa].
double conditioningPeak(const SessionPlan& plan);
/// Number of mounts, and of recordings.
std::size_t mountsOf(const SessionPlan& plan);

/// Throws InputError that names the field which does not fit the others: a peak above the limit of the
/// chamber, two surfaces with one name, a break behind the last mount, cycles that never end.
void validate(const SessionPlan& plan);

// ---- the file ----------------------------------------------------------------------------------------

/// Reads and checks a plan strictly. Form (all but `plan`, `surfaces` and `program` may be left out):
///
///     plan: full_day
///     purpose: discrepancy           # or per_curvature, history, field_check
///     seed: 1                        # of the order
///     order: drawn                   # or listed
///     repeat_first: true             # the first surface once more at the end
///     thermometer: false
///     chamber_limit: 793000          # [Pa]
///     change: 180                    # [s]
///     matrix: {rows: 7, columns: 10}
///     conditioning: {cycles: 5, share_of_peak: 1.1, rate: 17000, dwell_peak: 1, dwell_rest: 1}
///     rest: {before: 30, after: 30}  # [s]
///     tolerance: {peak: 0.05, rate: 0.25, dwell: 2}
///     surfaces:                      # a name in `surface_folder`, or with a form, see matrix::readSurface()
///       - {surface: flat, mounts: 2}
///       - {surface: bowl, two_planes: {x: 5, y: 5}}
///     program: [{cycles: {...}}, {hold: {...}}, ...]   # see simulation::readChamberProgram()
///     breaks: [{after: 6, duration: 7200}]             # behind which mount, [s]
///
/// `surface_folder`: where the files of surfaces without a form are; empty = ../surfaces, seen from the plan.
SessionPlan readPlanFile(const std::string& path, const std::string& surface_folder = "");
/// The same of settings that were read already.
SessionPlan readPlan(const settings::Settings& settings, const std::string& surface_folder = "");

/// The surface of that name in a folder of surface files. Throws InputError, which begins with `field`
/// ("FILE: FIELD is VALUE") and lists the surfaces that there are.
matrix::Surface surfaceInFolder(const std::string& name, const std::string& folder, matrix::MatrixSize size,
                                const std::string& field);

/// The plan as readPlanFile() reads it. The surfaces have their forms, so that the file needs no other one.
/// `remarks`: lines of comment at its head.
std::string planText(const SessionPlan& plan, const std::vector<std::string>& remarks = {});

// ---- a proposal --------------------------------------------------------------------------------------

/// What a session is wanted for, and what there is.
struct PlanRequest {
  SessionPlan like;                       ///< purpose, seed, thermometer, chamber_limit, change and matrix
  double time = 0;                        ///< that there is [s]
  std::vector<matrix::Surface> surfaces;  ///< at least one
  double peak = 620e3;                    ///< largest pressure to measure, gauge [Pa]
};

struct ProposedPlan {
  SessionPlan plan;
  SessionPlan whole;  ///< the plan for this purpose and these surfaces without a limit of time
};

/// Makes a plan for a purpose: of the sizes in its table (propose.cpp) the first that fits the time. Throws
/// InputError where not even one cycle fits, and where the conditioning would pass the chamber's limit.
/// Messages name the options of the tool plan_session.
ProposedPlan proposePlan(const PlanRequest& request);

// ---- what it takes and tells -------------------------------------------------------------------------

/// "3 h 12 min", "20 min", rounded up to whole minutes.
std::string timeText(double seconds);

/// One line: name, duration, mounts, surfaces.
std::string headline(const SessionPlan& plan);

/// What is needed, how long it takes, and what the recordings can and cannot tell, as far as the plan
/// decides. How well they tell it depends on the sheet.
std::string planReport(const SessionPlan& plan);

/// Ids of the effects that `discrepancy` could name alone.
std::vector<std::string> effectsToldBy(const SessionPlan& plan);

/// Sentences on what recordings of the plan cannot tell.
std::vector<std::string> limitsOf(const SessionPlan& plan);

/// A line for each step: time since the begin, mount, instruction.
std::string stepsText(const SessionPlan& plan);

}  // namespace fsr::session
