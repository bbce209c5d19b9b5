#pragma once

#include <string>

#include "session/plan.h"
#include "settings/settings.h"

namespace fsr::session {

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

}  // namespace fsr::session
