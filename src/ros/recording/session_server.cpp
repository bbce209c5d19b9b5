#include "ros/recording/session_server.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/Mark.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <filesystem>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include "ros/bags/resource_path.h"
#include "ros/live/parameters.h"
#include "ros/live/serve.h"
#include "settings/number_text.h"
#include "settings/text.h"

namespace fsr_ros {

namespace fs = std::filesystem;

namespace {

using Level = diagnostic_msgs::DiagnosticStatus;

constexpr double kSessionComplaintPeriod = 10.0;  // [s]
constexpr double kGrowthPatience = 10.0;          // time without growth of the bag until an error [s]

const std::vector<std::string> kUses = {"chamber", "socket", "bench"};
const std::vector<std::string> kMounts = {"fixture", "mould", "limb", "liner", "socket_wall"};
const std::vector<std::string> kKinds = {"cycle_start", "conditioning", "don",  "doff",
                                         "step",        "sync",         "note", "reject"};

}  // namespace

fsr_pressure_map::Session readSession(const ros::NodeHandle& session_node) {
  // `protocol` of a rig file is the board's.
  const Parameters parameters(session_node, {{"session_id", "session"},
                                             {"subject_code", "subject"},
                                             {"operator_code", "operator"},
                                             {"protocol", ""}});
  fsr_pressure_map::Session session;
  session.session_id = parameters.text("session_id", "");
  session.subject_code = parameters.text("subject_code", "");
  session.sensor_id = parameters.text("sensor_id", "");
  session.use = parameters.choice("use", kUses, "chamber");
  session.mounted_on = parameters.choice("mounted_on", kMounts, "fixture");
  session.trial = parameters.text("trial", "");
  session.protocol = parameters.text("protocol", "");
  session.operator_code = parameters.text("operator_code", "");
  session.ethics_reference = parameters.text("ethics_reference", "");
  session.person = parameters.flag("person", false);
  static const std::regex code("[A-Z]{1,3}[0-9]{2,4}");
  if (!session.subject_code.empty() && !std::regex_match(session.subject_code, code)) {
    throw parameters.error("subject_code",
                           "must be a code of one to three capitals and two to four digits, e.g. S012");
  }
  if (session.person && session.subject_code.empty()) {
    throw parameters.error("subject_code", "must be given if person is true");
  }
  return session;
}

RecordingLook lookAtRecording(const std::string& bag) {
  const std::string closed = boost::ends_with(bag, ".bag") ? bag : bag + ".bag";
  for (const std::string& file : {closed + ".active", closed}) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (error) continue;
    const fs::space_info space = fs::space(file, error);
    return {file, size, error ? 0 : space.available};
  }
  return {};
}

void RecordingWatch::noteGrowth(std::uint64_t size, double time) {
  if (!first_) first_ = Growth{size, time};
  if (!last_ || size != last_->size) last_ = Growth{size, time};
}

void RecordingWatch::judge(const RecordingLook& look, double time,
                           diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (look.file.empty()) {
    status.summary(Level::ERROR, "waiting for the recorder: there is no bag yet");
    return;
  }
  noteGrowth(look.size, time);
  const double still = time - last_->time;
  const std::string left = fsr::settings::megabytesText(look.space) + " are left on its disk";
  if (!boost::ends_with(look.file, ".active")) {
    status.summary(Level::WARN, "the recording has ended: " + look.file + " is closed");
  } else if (look.space < least_space_) {
    status.summary(Level::ERROR, "RECORDING STOPPED: " + left + ", and recording stops below " +
                                     fsr::settings::megabytesText(least_space_) +
                                     "; make room, then start a new recording");
  } else if (still > patience_) {
    status.summary(Level::ERROR,
                   look.file + " has not grown for " + fsr::settings::fixedText(still, 0) + " s" +
                       ": does the board send scans (see the diagnostics of the driver)? " + left);
  } else {
    status.summary(Level::OK, "recording to " + look.file + ": " + fsr::settings::megabytesText(look.size) +
                                  ", " + left);
  }
  const double span = last_->time - first_->time;
  status.add("size [bytes]", look.size);
  status.add("space left [bytes]", look.space);
  status.add("bytes a second", span > 0 ? static_cast<double>(last_->size - first_->size) / span : 0.0);
}

namespace {

class SessionServer {
 public:
  // Throws fsr::InputError.
  SessionServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
      : handle_(handle), session_(readSession(private_handle)) {
    session_publisher_ = handle_.advertise<fsr_pressure_map::Session>("session", 10, true);
    event_publisher_ = handle_.advertise<fsr_pressure_map::Event>("events", 100);
    ros::NodeHandle services(private_handle);
    service_ = services.advertiseService("mark", &SessionServer::mark, this);
    timer_ = handle_.createTimer(ros::Duration(1.0), [this](const ros::TimerEvent&) { publish(); });
    publish();
    const Parameters parameters(private_handle);
    const std::string bag = resolveLaunchPath(parameters.text("bag", ""));
    if (!bag.empty()) watchRecording(bag, parameters.number("min_space", 200, {0, 1e9, "MB"}));
  }

 private:
  bool mark(fsr_pressure_map::Mark::Request& request, fsr_pressure_map::Mark::Response& response) {
    response.success = std::find(kKinds.begin(), kKinds.end(), request.kind) != kKinds.end();
    if (!response.success) {
      response.message = "kind is '" + request.kind + "', but must be one of " +
                         fsr::settings::joined(kKinds) + "; nothing was marked";
      return true;
    }
    fsr_pressure_map::Event event;
    event.header.stamp = ros::Time::now();
    event.kind = request.kind;
    event.label = request.label;
    event_publisher_.publish(event);
    response.message = "marked " + request.kind + " '" + request.label + "' at " +
                       std::to_string(event.header.stamp.toSec()) + " s on " + event_publisher_.getTopic();
    return true;
  }

  void publish() {
    session_.header.stamp = ros::Time::now();
    session_publisher_.publish(session_);
  }

  void watchRecording(const std::string& bag, double least_space) {
    recording_ =
        std::make_unique<RecordingWatch>(static_cast<std::uint64_t>(least_space * 1e6), kGrowthPatience);
    diagnostics_ = std::make_unique<diagnostic_updater::Updater>();
    diagnostics_->setHardwareID(bag);
    diagnostics_->add("recording", [this, bag](auto& status) { judgeRecording(bag, status); });
    recording_timer_ = handle_.createWallTimer(
        ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_->force_update(); });
  }

  void judgeRecording(const std::string& bag, diagnostic_updater::DiagnosticStatusWrapper& status) {
    recording_->judge(lookAtRecording(bag), ros::SteadyTime::now().toSec(), status);
    if (status.level == diagnostic_msgs::DiagnosticStatus::ERROR) {
      ROS_ERROR_STREAM_THROTTLE(kSessionComplaintPeriod, status.message);
    }
  }

  ros::NodeHandle handle_;
  fsr_pressure_map::Session session_;
  ros::Publisher session_publisher_;
  ros::Publisher event_publisher_;
  ros::ServiceServer service_;
  ros::Timer timer_;
  std::unique_ptr<RecordingWatch> recording_;
  std::unique_ptr<diagnostic_updater::Updater> diagnostics_;
  ros::WallTimer recording_timer_;
};

}  // namespace

Server makeSessionServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle) {
  return std::make_shared<SessionServer>(handle, private_handle);
}

}  // namespace fsr_ros
