#include "ros/live/recorder.h"

#include <ros/console.h>
#include <topic_tools/shape_shifter.h>

#include <iostream>
#include <sstream>
#include <utility>

#include "ros/live/parameters.h"

namespace fsr_ros {

namespace {

using topic_tools::ShapeShifter;
using Event = ros::MessageEvent<ShapeShifter const>;
using Level = diagnostic_msgs::DiagnosticStatus;

constexpr std::uint32_t kQueue = 10000;  // queue of each topic [messages]: ten seconds at 1 kHz

BagSinkOptions readOptions(const Parameters& parameters) {
  BagSinkOptions options;
  options.bag = parameters.text("bag", "recorded");
  options.chunk_size = static_cast<std::uint32_t>(1024 * parameters.integer("chunk_kb", 1, {1, 1e5, "KB"}));
  options.least_space = static_cast<std::uint64_t>(1e6 * parameters.number("min_space", 200, {0, 1e9, "MB"}));
  options.buffer = static_cast<std::uint64_t>(1e6 * parameters.number("buffer", 256, {1, 1e6, "MB"}));
  return options;
}

}  // namespace

Recorder::Recorder(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
    : handle_(handle), diagnostics_(handle, private_handle, private_handle.getNamespace()) {
  const Parameters parameters(private_handle);
  const BagSinkOptions options = readOptions(parameters);
  std::istringstream topics(parameters.text("topics", ""));
  for (const std::string& name : parameters.unknown()) {
    ROS_WARN_STREAM(
        "parameter " << name
                     << " is set, but the recorder has no parameter of that name, so it has no effect");
  }
  sink_ = std::make_unique<BagSink>(options, [this](const std::string& complaint) {
    ROS_FATAL_STREAM(complaint);
    if (!ros::ok()) std::cerr << complaint << std::endl;  // ROS has closed the log
    failed_ = true;
    ros::requestShutdown();
  });
  diagnostics_.setHardwareID(sink_->report().file);
  diagnostics_.add("recording", [this](auto& status) { judge(status); });
  for (std::string topic; topics >> topic;) subscribe(topic);
  if (subscribers_.empty()) throw parameters.error("topics", "must name at least one topic");
  timer_ = handle_.createWallTimer(ros::WallDuration(1.0),
                                   [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  ROS_INFO_STREAM("recording " << subscribers_.size() << " topics to " << sink_->report().file);
}

void Recorder::finish() {
  subscribers_.clear();
  sink_->finish();
  const std::string remark = sink_->report().remark;
  if (!remark.empty()) std::cerr << remark << std::endl;
}

void Recorder::subscribe(const std::string& topic) {
  const std::string name = handle_.resolveName(topic);
  const boost::function<void(const Event&)> keep = [this, name](const Event& event) {
    const ros::Time now = ros::Time::now();
    if (now.isZero()) {
      ++without_time_;
      return;
    }
    sink_->add(event.getConstMessage()->size(), [name, now, event](rosbag::Bag& bag) {
      bag.write(name, now, *event.getConstMessage(), event.getConnectionHeaderPtr());
    });
  };
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const Event&>(name, kQueue, keep);
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(handle_.subscribe(options));
}

void Recorder::judge(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const BagSinkReport now = sink_->report();
  const std::uint64_t lost = now.lost - before_.lost;
  const std::uint64_t rate = now.messages - before_.messages;
  before_ = now;
  if (!now.complaint.empty()) {
    status.summary(Level::ERROR, now.complaint);
  } else if (lost > 0) {
    status.summary(Level::ERROR, std::to_string(lost) + " messages lost: the disk is slower than the data");
  } else if (rate == 0) {
    status.summary(Level::WARN, "no message to record to " + now.file);
  } else {
    status.summary(Level::OK, "recording to " + now.file);
  }
  status.add("messages written", now.messages);
  status.add("messages a second", rate);
  status.add("messages lost", now.lost);
  status.add("messages before /clock", without_time_.load());
  status.add("waiting for the disk [bytes]", now.waiting);
  status.add("space left [bytes]", now.space);
}

}  // namespace fsr_ros
