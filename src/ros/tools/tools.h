#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "exports/scan_formats.h"

// The tools. Each prints to `out` and returns its exit status: 0, or what is said below. Each throws
// fsr::InputError where its words or files cannot be used.
namespace fsr_ros {

/// `check_bag BAG...` checks whether recordings can be used for training and for discrepancy. `check_bag
/// --use socket BAG...` checks a recording without reference. The verdict is the last line of `out`. Returns
/// 0 whatever the verdict is, or with --strict 1 if it is not good.
int checkBagTool(int argc, const char* const* argv, std::ostream& out);

/// `check_calibration CALIBRATION BAG...` says whether a calibration is still good; with --correct also
/// whether a correction of gain and offset is worth it, which is written to --output. `check_calibration DIR`
/// shows the life of each sheet: every bag and calibration file in a folder and its subfolders, by date, and
/// what changed suddenly; with --output it writes life.csv, life.json and figures.
/// Returns 0 whatever the verdict is; of a folder 1 if a file could not be used, 3 if only the figures are
/// missing.
int checkCalibrationTool(int argc, const char* const* argv, std::ostream& out);

/// `calibration_history DIR`: the earlier name of `check_calibration DIR`, for one version.
int calibrationHistoryTool(int argc, const char* const* argv, std::ostream& out);

/// The words behind check_calibration for those of `train --check FILE BAG...` and `train --correct FILE
/// BAG...`, its other earlier names; nothing for other words.
std::optional<std::vector<std::string>> wordsOfCheck(int argc, const char* const* argv);

/// Says that `earlier` is check_calibration now, and runs it with these words.
int checkInstead(const std::string& earlier, const std::vector<std::string>& words, std::ostream& out);

/// `close_bag FILE.bag.active...` closes recordings whose recorder died or whose disk was full (rescueBag()).
/// Returns 0, or 1 if there was no room for the index of one.
int closeBagTool(int argc, const char* const* argv, std::ostream& out);

/// `csv_to_bag TABLE --columns ... --output BAG`: converts a table to a bag, and prints what the bag holds
/// and how readings were converted to counts. Where it throws, no bag is left.
int csvToBagTool(int argc, const char* const* argv, std::ostream& out);

/// `day_report DIR`: runs check_bag, train and discrepancy on the bags of a conducted session, and writes the
/// report of the day. A tool that refuses the bags appears in the report with its sentence; the status is
/// then 1.
int dayReportTool(int argc, const char* const* argv, std::ostream& out);

/// `discrepancy [--simulation FILE] BAG... --output DIR` finds where simulation and measurement disagree.
/// `discrepancy --confirm verdict.yaml NEWBAG...` tests the prediction of a verdict on new bags. Prints the
/// verdict. Returns 0 whatever the verdict is, or 3 if only the report could not be drawn.
int discrepancyTool(int argc, const char* const* argv, std::ostream& out);

/// `export BAG... --to FORMAT --output PATH` writes a recording in a format that other programs read without
/// ROS: one of `formats`. Where it throws, there is no new file.
int exportTool(int argc, const char* const* argv, std::ostream& out,
               const std::vector<fsr::exports::ScanFormat>& formats = fsr::exports::scanFormats());

/// `plan_session` writes a plan for a session at the rig, or describes one.
int planSessionTool(int argc, const char* const* argv, std::ostream& out);

/// `scrub BAG --output BAG`: copies a bag without data that could identify persons, places or dates, and
/// prints what was removed. The copy has scans, chamber pressure, temperature, curvature, maps, matrix,
/// session and events. From these, notes, session id, operator, ethics reference and the labels of notes are
/// removed, and all times are moved together so that the bag begins on 2000-01-01 00:00 UTC. Everything else
/// (/rosout, /diagnostics, /tf, unknown types) and the names of the publishing nodes are not copied. Where it
/// throws, no new bag is left.
int scrubTool(int argc, const char* const* argv, std::ostream& out);

/// `simulate --simulation FILE [--drive BAG...] --output DIR`: writes bags of a simulated rig and its true
/// settings (truth.yaml), or pictures of its effects; or recomputes the gap of a verdict (--gap). Returns 0,
/// or 3 if only the figures could not be drawn.
int simulateTool(int argc, const char* const* argv, std::ostream& out);

/// `study BAG... --output DIR` or `study --simulation FILE --output DIR`: the comparison of Ahmadizadeh and
/// Menon 2019 (doi:10.3390/s19245519), its statistical tests, and further splits and schemes. Writes
/// results.json and tables (CSV) to the folder, then figures and report.html. Returns 0, or 3 if only the
/// figures could not be drawn.
int studyTool(int argc, const char* const* argv, std::ostream& out);

/// `train BAG... --output FILE`: trains a calibration. Prints coverage, scores and the full path of the file.
/// No file is written unless everything succeeded.
int trainTool(int argc, const char* const* argv, std::ostream& out);

}  // namespace fsr_ros
