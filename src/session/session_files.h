#pragma once

#include <string>
#include <vector>

#include "session/conductor.h"
#include "session/plan.h"

namespace fsr::session {

/// Names of the files in the folder of a session. They begin with the plan's name; whatever is not a letter,
/// a digit, - or _ becomes _.

constexpr char kStateFile[] = "_session.yaml";          ///< the state, see writeState()
constexpr char kPlanFile[] = "_plan.yaml";              ///< the plan with the forms of its surfaces
constexpr char kReportFile[] = "_report.html";          ///< of the day
constexpr char kCalibrationFile[] = "_calibration.h5";  ///< likewise
constexpr char kResultsFolder[] = "_report";            ///< what the tools wrote for the report

/// "day_plan.yaml" for the plan `day` and kPlanFile; with its folder where one is given.
std::string sessionFile(const std::string& plan, const char* ending, const std::string& folder = "");

/// "day_02_cylinder_5cm": without part and ending.
std::string bagStem(const std::string& plan, unsigned mount, const std::string& surface);
/// A path in `folder` that no bag has: the stem, or "..._part2" and so on. Without ending.
std::string freeBagName(const std::string& folder, const std::string& stem);
/// The finished bags of one mount, by the number of their part: file names.
std::vector<std::string> bagsOfMount(const std::string& folder, const std::string& stem);

/// The bags of a session that are still open, because they are being written or were left so: file names,
/// sorted.
std::vector<std::string> openBags(const std::string& folder, const std::string& plan);

struct MovedBag {
  std::string from, to;
  std::string failure;  ///< why it was not moved; empty = it was
};
/// Moves the bags of a mount, and one that a crash left open, to `folder`/set_aside under names that no file
/// there has. Nothing is lost, but FOLDER/*.bag must not hold them: the sheet may have lain on something else
/// than they say.
std::vector<MovedBag> setMountAside(const std::string& folder, const std::string& stem);

/// The name of the one state in `folder`. Throws InputError where there is none, or more than one and no
/// `plan` says which.
std::string stateFileIn(const std::string& folder, const std::string& plan);

/// Makes the folder of a session that of one conductor. The lock ends with the process that holds it, however
/// that ends.
class FolderLock {
 public:
  /// Throws InputError where another process holds it. A file system that has no locks is no hindrance.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// Writes the state of a session; a program that is killed leaves the old file or the new one. Form:
///
///     plan: "day"
///     digest: "9f86d0..."    # see digestOf(); earlier ones are of the text of the plan beside the state
///     time: 1700000000.5     # [s]
///     rejected: 3            # attempts
///     steps: "aaas......"    # a = accepted, s = skipped, . = open
///     remarks:               # may be left out; steps from 1; no reason = accepted by hand
///       - {step: 8, reason: peak_missed, sentence: "the highest pressure was 400 kPa"}
///
/// Throws InputError.
void writeState(const std::string& path, const ConductorState& state);

/// Throws InputError where the file is no such state.
ConductorState readState(const std::string& path);

}  // namespace fsr::session
