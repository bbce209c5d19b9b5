#include "ros/recording/procedures.h"

#include <fsr_pressure_map/CalibrationInfo.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/FluidPressure.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "check/check.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "report/check_report.h"
#include "ros/bags/resource_path.h"
#include "ros/recording/recorder.h"
#include "settings/number_text.h"

namespace fsr_ros {

namespace {

constexpr double kStill = 3.0;         // wall time without a change after which the last cycle has ended [s]
constexpr double kStillShare = 0.02;   // share of the least span that is no change
constexpr double kInfoPatience = 5.0;  // for the description of the calibration node [s]
constexpr std::uint32_t kPressureQueue = 10000;
constexpr const char* kTopics[] = {"raw",       "chamber_pressure", "temperature", "matrix_info",
                                   "curvature", "session",          "events"};

std::string withoutExtension(const std::string& path) {
  const std::filesystem::path file(path);
  return (file.parent_path() / file.stem()).string();
}

// "2026-11-23-14-05-00", local time, as rosbag names its bags.
std::string dateText() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%d-%H-%M-%S", &local);
  return text;
}

std::string runningCalibration(ros::NodeHandle handle, const Parameters& parameters) {
  const auto info = ros::topic::waitForMessage<fsr_pressure_map::CalibrationInfo>(
      "calibration_info", handle, ros::Duration(kInfoPatience));
  if (info && !info->path.empty()) return info->path;
  throw parameters.error("calibration", "must name a calibration file, because no calibration node runs");
}

// See recheck().
class Rechecker {
 public:
  // Throws fsr::InputError.
  Rechecker(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
      : handle_(handle), changed_(ros::WallTime::now()) {
    const Parameters parameters(private_handle);
    std::string path = resolveLaunchPath(parameters.text("calibration", ""));
    if (path.empty()) path = runningCalibration(handle, parameters);
    outputs_.calibration = resolveLaunchPath(parameters.text("output", ""));
    if (outputs_.calibration.empty()) outputs_.calibration = withoutExtension(path) + "_corrected.h5";
    outputs_.report = resolveLaunchPath(parameters.text("report", ""));
    std::istringstream bags(parameters.text("bags", ""));
    for (std::string bag; bags >> bag;) bags_.push_back(resolveLaunchPath(bag));
    const double ambient = parameters.number("ambient_pressure", -1, {-1, 120e3, "Pa"});
    if (ambient >= 0) ambient_ = ambient;
    const double least = static_cast<double>(fsr::check::kLeastCycles);
    wanted_ = static_cast<std::size_t>(parameters.integer("cycles", 5, {least, 1000, ""}));
    asked_.correct = true;
    asked_.same_mount = parameters.flag("same_mount", false);
    parent_ = fsr::calibration::loadCalibration(path);
    fsr::check::requireTrained(parent_);
    fsr::report::requireCheckOutputs(outputs_);
    ROS_INFO_STREAM("calibration " << parent_.id << " of " << path << " is rechecked");
    if (bags_.empty()) startRecording(private_handle);
  }

  // Records, until there are enough cycles or ROS ends, and rechecks. The result is printed to `out`.
  // Returns whether it came to a verdict. Throws fsr::InputError.
  bool run(std::ostream& out) {
    if (recorder_) {
      while (ros::ok() && !recorder_->failed() && !enough())
        ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
      timer_.stop();
      chamber_.shutdown();
      recorder_->finish();
      const std::string file = recorder_->file();
      const bool failed = recorder_->failed();
      recorder_.reset();
      if (failed) return false;
      bags_ = {file};
    }
    judge(out);
    return true;
  }

 private:
  // The recorder reads its parameters in a namespace of its own.
  void startRecording(const ros::NodeHandle& private_handle) {
    const Parameters parameters(private_handle);
    std::string bag = resolveLaunchPath(parameters.text("bag", ""));
    if (bag.empty()) bag = rosHome() + "/recheck_" + dateText();
    std::string topics;
    for (const char* const topic : kTopics) topics += handle_.resolveName(topic) + " ";
    const ros::NodeHandle recording(private_handle, "record");
    recording.setParam("bag", bag);
    recording.setParam("topics", topics);
    recording.setParam("scans", handle_.resolveName("raw"));
    recording.setParam("wait", parameters.number("wait", 10, {0.1, 3600, "s"}));
    recording.setParam("min_space", parameters.number("min_space", 200, {0, 1e9, "MB"}));
    recorder_ = std::make_unique<Recorder>(handle_, recording);
    const boost::function<void(const sensor_msgs::FluidPressure&)> keep =
        [this](const sensor_msgs::FluidPressure& message) {
          if (std::isfinite(message.fluid_pressure)) pressure_.push_back(message.fluid_pressure);
        };
    chamber_ = handle_.subscribe<sensor_msgs::FluidPressure>("chamber_pressure", kPressureQueue, keep);
    timer_ = handle_.createWallTimer(ros::WallDuration(0.5),
                                     [this](const ros::WallTimerEvent&) { countCycles(); });
    ROS_INFO_STREAM("load the sheet to " << fsr::settings::fixedText(parent_.trained.pressure.high / 1000, 0)
                                         << " kPa and unload it, " << wanted_
                                         << " times; Ctrl-C ends the recording early");
  }

  void countCycles() {
    if (pressure_.empty()) return;
    const double least = fsr::check::leastCycleSpan(parent_);
    const std::size_t before = cycles_;
    cycles_ = fsr::check::countCycles(pressure_, least, running_);
    const bool moved = std::abs(pressure_.back() - still_) > kStillShare * least;
    if (moved || cycles_ != before) changed_ = ros::WallTime::now();
    if (moved) still_ = pressure_.back();
    const std::size_t ended = cycles_ - (running_ ? 1 : 0);
    ROS_INFO_STREAM_THROTTLE(10, ended << " of " << wanted_ << " cycles");
  }

  // The last cycle has ended when the next one begins, or when the pressure stays low.
  bool enough() const {
    const bool still = (ros::WallTime::now() - changed_).toSec() > kStill;
    return cycles_ - (running_ && !still ? 1 : 0) >= wanted_;
  }

  void judge(std::ostream& out) {
    BagReadOptions options;
    options.ambient_pressure = ambient_;
    if (handle_.getNamespace() != "/") options.topics = handle_.getNamespace();
    std::vector<fsr::dataset::Recording> recordings;
    for (const std::string& bag : bags_) recordings.push_back(readBag(bag, options));
    const fsr::check::CheckResult result = fsr::check::check(parent_, recordings, asked_);
    out << fsr::report::checkText(result, parent_) << fsr::report::writeCheck(result, parent_.id, outputs_);
    if (result.child) {
      out << "Use it: rosservice call " << handle_.resolveName("calibration/load_calibration") << " "
          << outputs_.calibration << '\n';
    }
    if (result.verdict == fsr::check::Verdict::kCannotTell) {
      out << "Recorded in";
      for (const std::string& bag : bags_) out << ' ' << bag;
      out << "\nWith more mounts: roslaunch fsr_pressure_map recheck.launch bags:=\"";
      for (const std::string& bag : bags_) out << bag << ' ';
      out << "...\"\n";
    }
    out << std::flush;
  }

  ros::NodeHandle handle_;
  fsr::report::CheckOutputs outputs_;
  std::vector<std::string> bags_;
  std::optional<double> ambient_;  // [Pa]
  fsr::check::CheckOptions asked_;
  std::size_t wanted_ = 0;  // cycles
  fsr::calibration::Calibration parent_;
  std::unique_ptr<Recorder> recorder_;  // null = bags are given
  ros::Subscriber chamber_;
  ros::WallTimer timer_;
  std::vector<double> pressure_;  // of the chamber since the start [Pa]
  std::size_t cycles_ = 0;        // that have passed
  bool running_ = false;          // the last of them may not have ended
  ros::WallTime changed_;         // when pressure or cycles changed last
  double still_ = 0;              // pressure then [Pa]
};

}  // namespace

bool recheck(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, std::ostream& out) {
  return Rechecker(handle, private_handle).run(out);
}

}  // namespace fsr_ros
