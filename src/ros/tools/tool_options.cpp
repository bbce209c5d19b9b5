#include "ros/tools/tool_options.h"

#include <ros/package.h>
#include <boost/filesystem/operations.hpp>
#include <boost/process/args.hpp>
#include <boost/process/child.hpp>
#include <boost/process/io.hpp>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/settings/pressure_unit.h"
#include "ros/bags/bag_walk.h"
#include "ros/bags/simulated_bags.h"
#include "settings/progress.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCountsInMemory = 8u << 20;  // of a bag [bytes]

bool comesFirst(const fs::path& a, const fs::path& b) {
  const double first = std::atof(a.filename().c_str()), second = std::atof(b.filename().c_str());
  return first != second ? first < second : a < b;
}

}  // namespace

ToolProgress toolProgress() {
  return [progress = std::make_shared<fsr::settings::Progress>()](const std::string& step, double share) {
    progress->report(step, share);
  };
}

unsigned threadsOf(const fsr::settings::CommandLine& line) {
  return static_cast<unsigned>(line.integer("threads", 0, {0, 1024, ""}));
}

std::string outputFolder(const std::string& path) {
  const fs::path folder = fs::absolute(path).lexically_normal();
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    throw fsr::settings::InputError(folder.string() + ": the folder cannot be created (" + error.message() +
                                    "); give another one with --output");
  }
  return folder;
}

std::string shellWord(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '/' || c == '+' || c == ',' ||
           c == '=';
  });
  if (plain) return word;
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

fsr::settings::CommandLine& addBagOptions(fsr::settings::CommandLine& line) {
  return line
      .option("ambient", "PA", "ambient pressure [Pa]; default: that of matrix_info, or 101325 without one")
      .option("namespace", "NS", "namespace of the sensor, if a bag holds several");
}

fsr::settings::CommandLine& addUnitOption(fsr::settings::CommandLine& line) {
  return line.option("unit", "NAME", "print pressures in kPa or mmHg; default kPa");
}

void takeUnit(const fsr::settings::CommandLine& line) {
  using namespace fsr::settings;
  showPressuresIn(pressureUnitOf(line.choice("unit", pressureUnitNames(), name(PressureUnit::kKilopascal))));
}

BagReadOptions bagReadOptions(const fsr::settings::CommandLine& line) {
  BagReadOptions how;
  how.counts_in_memory = kCountsInMemory;
  how.topics = line.text("namespace", "");
  if (line.has("ambient")) how.ambient_pressure = line.number("ambient", 0, {0, 120e3, "Pa"});
  return how;
}

std::vector<fsr::dataset::Recording> readBags(const BagReadOptions& how, const std::vector<std::string>& bags,
                                              const ToolProgress& progress, bool whole) {
  BagReadOptions options = how;
  std::vector<fsr::dataset::Recording> recordings;
  for (const std::string& bag : bags) {
    options.progress = told("reading " + bag, progress);
    recordings.push_back(whole ? readWhole(bag, options) : readBag(bag, options));
  }
  return recordings;
}

int figuresDrawn(const std::string& script, const std::vector<std::string>& arguments, std::ostream& out) {
  try {
    drawFigures(script, arguments);
    return 0;
  } catch (const fsr::settings::InputError& error) {
    out << error.what() << std::endl;
    return kFiguresMissing;
  }
}

std::vector<std::string> bagsIn(const std::vector<std::string>& paths) {
  std::vector<std::string> bags;
  for (const std::string& path : paths) {
    if (!fs::is_directory(path)) {
      bags.push_back(path);
      continue;
    }
    std::vector<fs::path> inside;
    for (const auto& entry : fs::directory_iterator(path)) {
      if (entry.path().extension() == ".bag") inside.push_back(entry.path());
    }
    if (inside.empty()) throw fsr::settings::InputError(path + ": holds no file that ends with .bag");
    std::sort(inside.begin(), inside.end(), comesFirst);
    bags.insert(bags.end(), inside.begin(), inside.end());
  }
  return bags;
}

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
