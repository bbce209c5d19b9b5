#pragma once

#include <string>
#include <vector>

#include "session_plan/plan.h"

namespace fsr::conductor {

/// Names of the files in the folder of a session. They begin with the plan's name; whatever is not a letter,
/// a digit, - or _ becomes _.

/// "day_session.yaml": the state, see writeState().
std::string stateFileName(const std::string& plan);
/// "day_plan.yaml": the plan with the forms of its surfaces.
std::string planFileName(const std::string& plan);
/// "day_report.html".
std::string reportFileName(const std::string& plan);
/// "day_calibration.h5".
std::string calibrationFileName(const std::string& plan);
/// "day_report": a folder with what the tools wrote for the report.
std::string resultsFolderName(const std::string& plan);

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

}  // namespace fsr::conductor
