#include "ros/tools/tools.h"

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "check/socket_check.h"
#include "dataset/conditioning.h"
#include "dataset/mounts.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/admission_report.h"
#include "ros/bags/bag_topics.h"
#include "ros/bags/bag_walk.h"
#include "ros/tools/tool_options.h"
#include "settings/command_line.h"

namespace fsr_ros {

namespace {

constexpr int kNotFit = 1;  // exit status with --strict

fsr::settings::CommandLine checkBagOptions() {
  fsr::settings::CommandLine line(
      "check_bag", "[--use socket] [--calibration FILE] BAG...",
      "Checks recordings before they are used: topics, rates, gaps and stamps; lag between matrix and "
      "chamber; "
      "dead, stuck and clipped taxels and failing lines; coverage of pressure, curvature and direction. The "
      "last line is the verdict.\n"
      "Exit status: 0 whatever the verdict is; with --strict 1 if the verdict is not good; 2 if a bag cannot "
      "be "
      "read.");
  line.option("use", "NAME",
              "chamber (default), or socket: recorded without a reference, judged by the bag alone")
      .input("calibration", "FILE",
             "with --use socket also report what is outside its trained range; otherwise the same as "
             "check_calibration FILE BAG...")
      .option("sections", "N",
              "sections of the cross-validation for which coverage is judged, 2 to 20; default 5")
      .flag("strict", "exit status 1 if the verdict is not good");
  return addBagOptions(line);
}

// Remarks about stamps that the reader sorted, and about missing topics that it does not need.
std::vector<std::string> remarksOn(const std::vector<TopicCourse>& courses) {
  std::vector<std::string> remarks;
  for (const TopicCourse& course : courses) {
    if (course.backwards == 0) continue;
    remarks.push_back(course.topic + " has " + std::to_string(course.backwards) +
                      " stamps that run backwards; they were sorted");
  }
  for (const auto& [base, why] :
       {std::pair{"temperature", "slow drift cannot be distinguished from effects of temperature"},
        std::pair{"session", "the bag does not say to which session it belongs"}}) {
    const std::string end = std::string("/") + base;
    const auto is_it = [&](const TopicCourse& course) { return boost::ends_with(course.topic, end); };
    if (std::any_of(courses.begin(), courses.end(), is_it)) continue;
    remarks.push_back(std::string("no topic ") + base + ": " + why);
  }
  return remarks;
}

int checkChamber(const fsr::settings::CommandLine& line, std::ostream& out) {
  fsr::discrepancy::AdmissionOptions chosen;
  chosen.sections = static_cast<std::size_t>(line.integer("sections", 5, {2, 20, ""}));
  std::vector<fsr::dataset::Recording> recordings;
  for (const std::string& path : line.files()) {
    // Its progress removes its line before the table is printed.
    recordings.push_back(readBags(bagReadOptions(line), {path}).front());
    const std::vector<TopicCourse> courses = topicCourses(path);
    std::vector<std::string>& warnings = recordings.back().warnings;
    for (const std::string& remark : remarksOn(courses)) warnings.push_back(remark);
    out << recordings.back().name << '\n' << topicsText(courses) << '\n';
  }
  for (const fsr::dataset::MountRemark& remark : fsr::dataset::remarksOnMounts(recordings)) {
    recordings[remark.recording].warnings.push_back(remark.sentence);
  }
  const std::vector<std::string> conditioning = fsr::dataset::conditioningSentences(
      fsr::dataset::findConditioning(recordings, conditioningSaid(line.files())));
  fsr::discrepancy::Admission admission =
      fsr::discrepancy::inspectRecordings(std::move(recordings), chosen, toolProgress());
  for (const std::string& path : line.files()) {
    if (sessionUse(path) != "socket") continue;
    admission.problems.insert(
        admission.problems.begin(),
        path.substr(path.find_last_of('/') + 1) +
            " was recorded in a socket, where no chamber tells the pressure; check it with --use socket");
  }
  for (const std::string& sentence : conditioning) admission.remarks.push_back(sentence);
  if (line.has("calibration")) {
    std::vector<std::string> words = line.files();
    words.insert(words.begin(), line.text("calibration", ""));
    for (const char* const option : {"ambient", "namespace"}) {
      if (line.has(option)) words.push_back("--" + std::string(option) + "=" + line.text(option, ""));
    }
    checkInstead("check_bag --calibration", words, out);
  }
  out << fsr::report::admissionText(admission) << std::flush;
  return line.has("strict") && !admission.fit() ? kNotFit : 0;
}

// The first or the last of the times, since the first scan [s].
std::optional<double> since(const fsr::dataset::Recording& recording, const std::vector<std::int64_t>& times,
                            bool first) {
  if (times.empty()) return std::nullopt;
  return 1e-9 * static_cast<double>((first ? times.front() : times.back()) - recording.start_ns);
}

int checkSockets(const fsr::settings::CommandLine& line, std::ostream& out) {
  std::optional<fsr::calibration::Calibration> calibration;
  if (line.has("calibration")) {
    calibration = fsr::calibration::loadCalibration(line.text("calibration", ""),
                                                    fsr::calibration::CalibrationParts::kWithoutStatistics);
  }
  bool good = true;
  for (const std::string& path : line.files()) {
    const fsr::dataset::Recording recording = readBag(path, bagReadOptions(line));
    out << topicsText(topicCourses(path)) << '\n';
    const fsr::check::DonDoff events = {since(recording, eventTimes(path, "don"), true),
                                        since(recording, eventTimes(path, "doff"), false)};
    const fsr::check::SocketCheck check =
        fsr::check::checkSocket(recording, events, calibration ? &*calibration : nullptr);
    out << fsr::report::socketText(check) << std::flush;
    good = good && check.reasons.empty();
  }
  return line.has("strict") && !good ? kNotFit : 0;
}

}  // namespace

int checkBagTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = checkBagOptions();
  if (!line.parse(argc, argv, out)) return 0;
  if (line.files().empty()) throw fsr::settings::InputError("no BAG is given; see check_bag --help");
  const bool socket = line.choice("use", {"chamber", "socket"}, "chamber") == "socket";
  return socket ? checkSockets(line, out) : checkChamber(line, out);
}

}  // namespace fsr_ros
