#pragma once

#include <boost/process/child.hpp>
#include <string>
#include <vector>

namespace fsr_ros {

/// Path of a program of the package: it is in the folder of the program that runs. Throws fsr::InputError
/// where it is missing.
std::string siblingProgram(const std::string& name);

/// Where a program runs, and where its output goes.
struct ProgramFiles {
  std::string folder;  ///< in which it works
  std::string output;  ///< file of its standard output
  std::string errors;  ///< file of its standard error
};

/// Starts a program without a shell, with low priority. It ends when this thread ends, however that happens.
/// Throws fsr::InputError.
boost::process::child startProgram(const std::string& path, const std::vector<std::string>& arguments,
                                   const ProgramFiles& files);

/// Why a program that has ended failed: the last line in `errors` without the program's name, or its exit
/// status; empty where the status is 0.
std::string whyItFailed(const boost::process::child& program, const std::string& errors);

}  // namespace fsr_ros
