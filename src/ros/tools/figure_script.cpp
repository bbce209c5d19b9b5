#include "ros/tools/figure_script.h"

#include <ros/package.h>

#include <boost/filesystem/operations.hpp>
#include <boost/process/args.hpp>
#include <boost/process/child.hpp>
#include <boost/process/io.hpp>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

namespace {

// Debian's python, whose matplotlib comes as a package. Another python may come first in PATH.
constexpr char kPython[] = "/usr/bin/python3";

// The last line that is not empty. If python fails, this line holds the reason.
std::string lastLine(std::istream& lines) {
  std::string line, last;
  while (std::getline(lines, line)) {
    if (line.find_first_not_of(" \t") != std::string::npos) last = line;
  }
  return last;
}

}  // namespace

void runPython(const std::string& path, const std::vector<std::string>& arguments) {
  namespace process = boost::process;
  if (!boost::filesystem::exists(path)) throw fsr::settings::InputError(path + ": there is no such script");
  std::vector<std::string> words = {path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  process::ipstream output;
  std::error_code failed;
  process::child python(kPython, process::args(words), (process::std_out & process::std_err) > output,
                        process::std_in < process::null, failed);
  if (failed)
    throw fsr::settings::InputError(std::string(kPython) + " cannot be started: " + failed.message());
  const std::string reason = lastLine(output);
  python.wait();
  if (python.exit_code() == 0) return;
  throw fsr::settings::InputError(
      "the figures were not drawn: " + path + ": " +
      (reason.empty() ? "exit status " + std::to_string(python.exit_code()) : reason));
}

void drawFigures(const std::string& script, const std::vector<std::string>& arguments) {
  const std::string package = ros::package::getPath("fsr_pressure_map");
  if (package.empty()) {
    throw fsr::settings::InputError(
        "the figures were not drawn: ROS_PACKAGE_PATH does not contain fsr_pressure_map; source the "
        "setup.bash of its "
        "workspace");
  }
  runPython(package + "/scripts/figures/" + script, arguments);
}

}  // namespace fsr_ros
