#include "ros/tools/check_bag_tool.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/shape/mount_checks.h"
#include "dataset/conditioning.h"
#include "dataset/mounts.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/admission_report.h"
#include "report/shape_report.h"
#include "ros/bags/bag_topics.h"
#include "ros/bags/bag_walk.h"
#include "ros/tools/bag_options.h"
#include "ros/tools/tool_progress.h"
#include "settings/command_line.h"

namespace fsr_ros {

namespace {

constexpr int kNotFit = 1;  // exit status with --strict

fsr::settings::CommandLine options() {
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
             "compare the surface of each bag with how the sheet rests before the first load, by this "
             "calibration; "
             "with --use socket also report what is outside its trained range")
      .option("sections", "N",
              "sections of the cross-validation for which coverage is judged, 2 to 20; default 5")
      .option("ambient", "PA", "ambient pressure [Pa]; default: that of matrix_info, or 101325 without one")
      .option("namespace", "NS", "namespace of the sensor, if a bag holds several")
      .flag("strict", "exit status 1 if the verdict is not good");
  return line;
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
    const auto is_it = [&](const TopicCourse& course) {
      return course.topic.size() >= end.size() &&
             course.topic.compare(course.topic.size() - end.size(), end.size(), end) == 0;
    };
    if (std::any_of(courses.begin(), courses.end(), is_it)) continue;
    remarks.push_back(std::string("no topic ") + base + ": " + why);
  }
  return remarks;
}

// How the sheet rests in each bag, if a calibration is given.
std::optional<std::string> shapesText(const fsr::settings::CommandLine& line,
                                      const std::vector<fsr::dataset::Recording>& recordings) {
  if (!line.has("calibration")) return std::nullopt;
  const fsr::calibration::Calibration calibration = fsr::calibration::loadCalibration(
      line.text("calibration", ""), fsr::calibration::CalibrationParts::kWithoutStatistics);
  return fsr::report::shapeText(calibration.shape, fsr::calibration::checkShapes(calibration, recordings));
}

int checkChamber(const fsr::settings::CommandLine& line, std::ostream& out) {
  fsr::discrepancy::AdmissionOptions chosen;
  chosen.sections = static_cast<std::size_t>(line.integer("sections", 5, {2, 20, ""}));
  std::vector<fsr::dataset::Recording> recordings;
  for (const std::string& path : line.files()) {
    {
      const ToolProgress progress = toolProgress();  // removes its line before the table is printed
      BagReadOptions how = bagReadOptions(line);
      how.progress = told("reading " + path, progress);
      recordings.push_back(readBag(path, how));
    }
    const std::vector<TopicCourse> courses = topicCourses(path);
    std::vector<std::string>& warnings = recordings.back().warnings;
    for (const std::string& remark : remarksOn(courses)) warnings.push_back(remark);
    out << recordings.back().name << '\n' << topicsText(courses) << '\n';
  }
  for (const fsr::dataset::MountRemark& remark : fsr::dataset::remarksOnMounts(recordings)) {
    recordings[remark.recording].warnings.push_back(remark.sentence);
  }
  const std::optional<std::string> shapes = shapesText(line, recordings);
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
  if (shapes) out << *shapes << '\n';
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
    const fsr::calibration::DonDoff events = {since(recording, eventTimes(path, "don"), true),
                                              since(recording, eventTimes(path, "doff"), false)};
    const fsr::calibration::SocketCheck check =
        fsr::calibration::checkSocket(recording, events, calibration ? &*calibration : nullptr);
    out << fsr::report::socketText(check) << std::flush;
    good = good && check.reasons.empty();
  }
  return line.has("strict") && !good ? kNotFit : 0;
}

}  // namespace

int checkBagTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = options();
  if (!line.parse(argc, argv)) {
    out << line.help();
    return 0;
  }
  if (line.files().empty()) throw fsr::settings::InputError("no BAG is given; see check_bag --help");
  const std::string use = line.text("use", "chamber");
  if (use == "socket") return checkSockets(line, out);
  if (use != "chamber")
    throw fsr::settings::InputError("--use is '" + use + "', but must be chamber or socket");
  return checkChamber(line, out);
}

}  // namespace fsr_ros
