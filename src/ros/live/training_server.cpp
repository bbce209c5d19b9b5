#include <diagnostic_msgs/DiagnosticStatus.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/ros.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

#include "dataset/recording_builder.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "report/calibration_report.h"
#include "ros/bags/message_events.h"
#include "ros/bags/resource_path.h"
#include "ros/bags/training_options.h"
#include "ros/live/parameters.h"
#include "ros/live/serve.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"

namespace fsr_ros {

namespace {

// A bag replayed at many times its speed may send faster than a busy computer receives. The messages are
// small.
constexpr std::uint32_t kQueue = 100000;
constexpr double kReportPeriod = 0.5;  // [s], wall time
// Counts lie in a file from here on, as those of the tools.
constexpr std::size_t kCountsInMemory = 64u << 20;  // [bytes]

std::uint64_t number(const fsr::dataset::RecordingBuilder::Events& events) {
  return events.scans + events.chamber_pressures + events.surfaces + events.temperatures +
         events.descriptions;
}

std::string whatIsMissing(const fsr::dataset::RecordingBuilder::Events& events) {
  std::string missing;
  const auto need = [&](std::uint64_t number, const std::string& topic) {
    if (number == 0) missing += (missing.empty() ? "" : ", ") + topic;
  };
  need(events.scans, "raw");
  need(events.chamber_pressures, "chamber_pressure");
  need(events.surfaces, "curvature");
  return missing.empty() ? "" : "waiting for " + missing;
}

std::string summary(const fsr::calibration::Calibration& calibration, const std::string& path) {
  std::uint64_t scans = 0;
  for (const fsr::calibration::SourceBag& bag : calibration.provenance.bags) scans += bag.scans;
  std::ostringstream text;
  text << "calibration " << calibration.id << " (" << fsr::compensation::schemeName(calibration.tables.scheme)
       << ", " << scans << " scans, " << calibration.coverage.conditions.size() << " surfaces";
  if (!calibration.scores.conditions.empty()) {
    text << ", RMSE " << calibration.scores.whole.rmse_percent.mean << " %";
  }
  text << ") is in " << path;
  return text.str();
}

class TrainingServer {
 public:
  TrainingServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
      : handle_(handle), builder_(kCountsInMemory) {
    const Parameters parameters(private_handle);
    std::error_code ignored;  // if the folder cannot be made, writing to it raises an error
    std::filesystem::create_directories(rosHome(), ignored);
    output_ = resolveResource(parameters.text("output", rosHome() + "/calibration.h5"));
    if (output_.empty()) throw parameters.error("output", "must name the calibration file to write");
    report_ = resolveResource(parameters.text("report", ""));
    options_ = trainingOptions(parameters);
    options_.scores = parameters.flag("scores", true);
    most_ = static_cast<std::uint64_t>(parameters.integer("most_messages", 20000000, {1, 1e12, ""}));
    const double ambient = parameters.number("ambient_pressure", -1, {-1, 120e3, "Pa"});
    if (ambient >= 0) recording_options_.ambient_pressure = ambient;
    parameters.warnOfUnknown("training node");
    recording_options_.name = "topics of " + handle_.getNamespace();

    ros::NodeHandle own(private_handle);
    gathered_ = own.advertise<diagnostic_msgs::DiagnosticStatus>("gathered", 1, true);
    services_ = {advertiseTrigger(own, "train", [this] { return train(); }),
                 advertiseTrigger(own, "clear", [this] { return clear(); })};
    subscribe<fsr_pressure_map::MatrixFrame>("raw");
    subscribe<sensor_msgs::FluidPressure>("chamber_pressure");
    subscribe<fsr_pressure_map::SurfaceCurvature>("curvature");
    subscribe<sensor_msgs::Temperature>("temperature");
    subscribe<fsr_pressure_map::MatrixInfo>("matrix_info");
    subscribe<fsr_pressure_map::Event>("events");
    timer_ = handle_.createWallTimer(ros::WallDuration(kReportPeriod),
                                     [this](const ros::WallTimerEvent&) { publishGathered(); });
    publishGathered();
  }

 private:
  template <typename Message>
  void subscribe(const std::string& topic) {
    const boost::function<void(const Message&)> callback = [this](const Message& message) {
      gather(message);
    };
    subscribers_.push_back(handle_.subscribe<Message>(topic, kQueue, callback));
  }

  template <typename Message>
  void gather(const Message& message) {
    const std::lock_guard<std::mutex> lock(gathering_);
    try {
      if (number(builder_.events()) >= most_) {
        throw fsr::settings::InputError(std::to_string(most_) +
                                        " are gathered, as many as ~most_messages allows; call ~train, then "
                                        "~clear");
      }
      addEvent(message, builder_);
    } catch (const fsr::settings::InputError& error) {
      ++refused_;
      ROS_WARN_STREAM_THROTTLE(10.0, "A message was left out: " << error.what());
    }
  }

  std::string train() {
    const std::unique_lock<std::mutex> alone(training_, std::try_to_lock);
    if (!alone.owns_lock())
      throw fsr::settings::InputError("another training is running; wait for its reply");
    fsr::settings::requireReplaceable(output_, fsr::settings::file_kind::kCalibration);
    if (!report_.empty()) fsr::settings::requireReplaceable(report_, fsr::settings::file_kind::kJson);
    fsr::calibration::CalibrationProblem problem;
    problem.options = options_;
    problem.recordings.push_back(gatheredRecording());
    fsr::calibration::validate(problem);
    ROS_INFO_STREAM(
        '\n'
        << fsr::report::coverageText(fsr::dataset::coverageOf(problem.recordings, options_.folds)));
    fsr::calibration::Calibration calibration = fsr::calibration::calibrate(problem);
    ROS_INFO_STREAM('\n'
                    << fsr::report::warningsText(calibration)
                    << fsr::report::scoresText(calibration.scores, calibration.layout)
                    << fsr::report::sessionText(calibration.scores.session)
                    << fsr::report::learnedText(calibration));
    calibration.id = fsr::calibration::saveCalibration(calibration, output_);
    if (!report_.empty()) fsr::settings::replaceFile(report_, fsr::report::calibrationJson(calibration));
    return summary(calibration, output_);
  }

  std::string clear() {
    std::string removed;
    {
      const std::lock_guard<std::mutex> lock(gathering_);
      removed = "removed " + std::to_string(builder_.events().scans) + " scans";
      builder_.clear();
      copying_ = false;
      refused_ = 0;
    }
    publishGathered();
    return removed;
  }

  // Copying takes long. What comes meanwhile is gathered beside it, so that receiving never waits.
  fsr::dataset::Recording gatheredRecording() {
    fsr::dataset::RecordingBuilder taken(kCountsInMemory);
    const auto exchange = [&](bool begin) {
      const std::lock_guard<std::mutex> lock(gathering_);
      if (begin) {
        const std::string missing = whatIsMissing(builder_.events());
        if (!missing.empty()) {
          throw fsr::settings::InputError(missing + " in " + handle_.getNamespace() +
                                          "; replay a bag with rosbag play");
        }
      } else if (!copying_) {
        return;  // ~clear was called
      } else {
        taken.append(builder_);
      }
      std::swap(taken, builder_);
      copying_ = begin;
    };
    exchange(true);
    try {
      fsr::dataset::Recording recording = taken.build(recording_options_);
      exchange(false);
      return recording;
    } catch (...) {
      exchange(false);
      throw;
    }
  }

  void publishGathered() {
    const std::lock_guard<std::mutex> lock(gathering_);
    if (copying_) return;
    const fsr::dataset::RecordingBuilder::Events& events = builder_.events();
    const std::string missing = whatIsMissing(events);
    diagnostic_updater::DiagnosticStatusWrapper status;
    status.name = ros::this_node::getName();
    status.summary(
        missing.empty() ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
        missing.empty() ? "ready to train" : missing);
    status.add("raw", events.scans);
    status.add("chamber_pressure", events.chamber_pressures);
    status.add("curvature", events.surfaces);
    status.add("temperature", events.temperatures);
    status.add("matrix_info", events.descriptions);
    status.add("left out", refused_);
    std::string shown;
    for (const diagnostic_msgs::KeyValue& value : status.values) shown += value.value + " ";
    if (shown == last_gathered_) return;
    last_gathered_ = shown;
    gathered_.publish<diagnostic_msgs::DiagnosticStatus>(status);
  }

  ros::NodeHandle handle_;
  std::string output_, report_;
  fsr::calibration::CalibrationOptions options_;
  fsr::dataset::RecordingOptions recording_options_;

  std::uint64_t most_ = 0;  // messages that are gathered

  std::mutex gathering_;  // guards builder_, copying_ and refused_
  fsr::dataset::RecordingBuilder builder_;
  bool copying_ = false;       // what was gathered; builder_ has what has come since
  std::uint64_t refused_ = 0;  // messages
  std::mutex training_;        // held during a training: one at a time

  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher gathered_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer timer_;
  std::string last_gathered_;
};

}  // namespace

Server makeTrainingServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle) {
  return std::make_shared<TrainingServer>(handle, private_handle);
}

}  // namespace fsr_ros
