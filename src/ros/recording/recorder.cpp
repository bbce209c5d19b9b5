#include "ros/recording/recorder.h"

#include <ros/console.h>
#include <topic_tools/shape_shifter.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <utility>

#include "ros/bags/resource_path.h"
#include "ros/bags/surface_folder.h"
#include "ros/messages/driver_messages.h"
#include "ros/recording/session_server.h"
#include "settings/number_text.h"

namespace fsr_ros {

namespace {

using topic_tools::ShapeShifter;
using Event = ros::MessageEvent<ShapeShifter const>;
using Level = diagnostic_msgs::DiagnosticStatus;

constexpr std::uint32_t kQueue = 10000;    // queue of each topic [messages]: ten seconds at 1 kHz
constexpr double kScanPatience = 10.0;     // time without a scan until an error, once scans have come [s]
constexpr double kComplaintPeriod = 10.0;  // [s]

template <typename Message>
bool isA(const ShapeShifter& message) {
  return message.getMD5Sum() == ros::message_traits::MD5Sum<Message>::value();
}

double now() {
  return ros::SteadyTime::now().toSec();
}

// The session and curvature nodes of record.launch refuse the same; they are started again, and would never
// publish what a bag needs.
void checkDescription(const ros::NodeHandle& handle, const Parameters& parameters) {
  readSession(ros::NodeHandle(handle, "session"));
  std::string surface = parameters.text("surface", "");
  const SurfaceFolder surfaces(parameters.text("surfaces", SurfaceFolder::shipped()), {});
  if (surface.empty()) return;
  if (surface.find('/') != std::string::npos) surface = resolveLaunchPath(surface);
  surfaces.pathOf(surface);
}

BagSinkOptions readOptions(const Parameters& parameters) {
  BagSinkOptions options;
  options.bag = resolveLaunchPath(parameters.text("bag", "recorded"));
  options.chunk_size = static_cast<std::uint32_t>(1024 * parameters.integer("chunk_kb", 1, {1, 1e5, "KB"}));
  options.least_space = static_cast<std::uint64_t>(1e6 * parameters.number("min_space", 200, {0, 1e9, "MB"}));
  options.buffer = static_cast<std::uint64_t>(1e6 * parameters.number("buffer", 256, {1, 1e6, "MB"}));
  return options;
}

}  // namespace

Recorder::Recorder(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                   std::function<void()> ended)
    : handle_(handle),
      ended_(ended ? std::move(ended) : [] { ros::requestShutdown(); }),
      diagnostics_(handle, private_handle, private_handle.getNamespace()) {
  const Parameters parameters(private_handle);
  const BagSinkOptions options = readOptions(parameters);
  checkDescription(handle, parameters);
  std::istringstream scans(parameters.text("scans", ""));
  for (std::string topic; scans >> topic;) scans_[handle_.resolveName(topic)].last = now();
  wait_ = parameters.number("wait", 10, {0.1, 3600, "s"});
  std::istringstream topics(parameters.text("topics", ""));
  parameters.warnOfUnknown("recorder");
  sink_ = std::make_unique<BagSink>(options, [this](const std::string& complaint) {
    ROS_FATAL_STREAM(complaint);
    if (!ros::ok()) std::cerr << complaint << std::endl;  // ROS has closed the log
    failed_ = true;
    ended_();
  });
  diagnostics_.setHardwareID(sink_->report().file);
  diagnostics_.add("recording", [this](auto& status) { judge(status); });
  for (std::string topic; topics >> topic;) subscribe(topic);
  if (subscribers_.empty()) throw parameters.error("topics", "must name at least one topic");
  start_ = now();
  timer_ = handle_.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) {
    watchScans();
    diagnostics_.force_update();
  });
  ROS_INFO_STREAM("recording " << subscribers_.size() << " topics to " << sink_->report().file);
}

void Recorder::finish() {
  subscribers_.clear();
  sink_->finish();
  const std::string remark = sink_->report().remark;
  if (!remark.empty()) std::cerr << remark << std::endl;
}

bool Recorder::closed() const {
  return std::filesystem::path(file()).extension() == ".bag" && std::filesystem::exists(file());
}

void Recorder::subscribe(const std::string& topic) {
  const std::string name = handle_.resolveName(topic);
  const boost::function<void(const Event&)> keep = [this, name](const Event& event) {
    const ros::Time time = ros::Time::now();
    if (time.isZero()) {
      ++without_time_;
      return;
    }
    ++received_[name];
    const auto scans = scans_.find(name);
    if (scans != scans_.end() && isA<fsr_pressure_map::MatrixFrame>(*event.getConstMessage())) {
      scans->second.tally.add(*event.getConstMessage()->instantiate<fsr_pressure_map::MatrixFrame>());
      scans->second.last = fsr_ros::now();
    } else if (isA<fsr_pressure_map::MatrixInfo>(*event.getConstMessage())) {
      keepSerial(name, *event.getConstMessage()->instantiate<fsr_pressure_map::MatrixInfo>());
    }
    sink_->add(event.getConstMessage()->size(), [name, time, event](rosbag::Bag& bag) {
      bag.write(name, time, *event.getConstMessage(), event.getConnectionHeaderPtr());
    });
  };
  received_[name] = 0;
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const Event&>(name, kQueue, keep);
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(handle_.subscribe(options));
}

Recorder::~Recorder() {
  subscribers_.clear();
  sink_->finish();
  const BagSinkReport report = sink_->report();
  if (refused_) {
    std::error_code ignored;
    std::filesystem::remove(report.file, ignored);  // this node has made it, and it holds no scan
  } else {
    // Not to the log, which ROS has closed by now.
    std::cout << "recorded ";
    for (const auto& [topic, scans] : scans_)
      std::cout << scans.tally.text() << (scans_.size() > 1 ? " on " + topic : "") << ", ";
    std::cout << report.messages << " messages (" << report.lost << " lost on the way to the disk) in "
              << report.file << (missingTopics().empty() ? "" : "; nothing came on" + missingTopics())
              << std::endl;
  }
}

// Topics on which nothing has come, but should: " /fsr/curvature". Events come when they are marked, and not
// every board measures the temperature.
std::string Recorder::missingTopics() const {
  std::string missing;
  for (const auto& [topic, messages] : received_) {
    const std::string last = topic.substr(topic.rfind('/') + 1);
    if (messages == 0 && last != "events" && last != "temperature") missing += " " + topic;
  }
  return missing;
}

void Recorder::keepSerial(const std::string& topic, const fsr_pressure_map::MatrixInfo& info) {
  std::string& serial = serials_[topic.substr(0, topic.rfind('/'))];
  if (serial == info.serial) return;
  serial = info.serial;
  const std::string twice = sameBoardSentence(serials_);
  if (!twice.empty()) ROS_ERROR_STREAM(twice << "; the recording goes on");
}

// Of the topic that has been silent for the longest time.
std::string Recorder::whyNoScan() const {
  const auto earlier = [](const auto& a, const auto& b) { return a.second.last < b.second.last; };
  const auto& [topic, scans] = *std::min_element(scans_.begin(), scans_.end(), earlier);
  const std::string start = "no scan has come on " + topic + " for " +
                            fsr::settings::fixedText(fsr_ros::now() - scans.last, 0) + " s: ";
  for (const ros::Subscriber& subscriber : subscribers_) {
    if (subscriber.getTopic() == topic && subscriber.getNumPublishers() == 0) {
      return start + "no driver runs; start driver.launch or calibrated.launch in another terminal";
    }
  }
  if (without_time_ > 0 && ros::Time::now().isZero()) {
    return start + "/use_sim_time is true, but no time comes on /clock; call `rosparam set /use_sim_time " +
           "false` and start the driver and this recording again";
  }
  return start + "the driver says in its terminal what it waits for";
}

// Called once a second.
void Recorder::watchScans() {
  if (scans_.empty() || failed_) return;
  bool heard = false, silent = false;
  for (auto& [topic, scans] : scans_) {
    const bool any = scans.tally.scans() > 0;
    const bool now_silent = now() - scans.last > (any ? kScanPatience : wait_);
    if (std::exchange(scans.silent, now_silent) && !now_silent)
      ROS_INFO_STREAM("scans come again on " << topic);
    heard = heard || any;
    silent = silent || now_silent;
  }
  if (!heard) {
    if (silent) refuse();
    return;
  }
  if (now() - start_ > wait_ && !std::exchange(looked_, true) && !missingTopics().empty()) {
    ROS_WARN_STREAM("the recording goes on, but nothing has come yet on" << missingTopics());
  }
  if (silent) ROS_ERROR_STREAM_THROTTLE(kComplaintPeriod, whyNoScan());
}

void Recorder::refuse() {
  ROS_FATAL_STREAM("the recording is refused, and no bag is left: " << whyNoScan());
  refused_ = true;
  failed_ = true;
  ended_();
}

void Recorder::judge(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const BagSinkReport now = sink_->report();
  const std::uint64_t lost = now.lost - before_.lost;
  const std::uint64_t rate = now.messages - before_.messages;
  before_ = now;
  const bool silent = std::any_of(scans_.begin(), scans_.end(), [](const auto& of) {
    return of.second.silent || of.second.tally.scans() == 0;
  });
  const std::string twice = sameBoardSentence(serials_);
  if (!now.complaint.empty()) {
    status.summary(Level::ERROR, now.complaint);
  } else if (lost > 0) {
    status.summary(Level::ERROR, std::to_string(lost) + " messages lost: the disk is slower than the data");
  } else if (silent) {
    status.summary(Level::ERROR, whyNoScan());
  } else if (!twice.empty()) {
    status.summary(Level::ERROR, twice);
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

void ScanTally::add(const fsr_pressure_map::MatrixFrame& scan) {
  const double stamp = scan.header.stamp.toSec();
  const std::uint32_t step = scan.sequence - sequence_;
  // A step back is a restart of the board, which says nothing about lost scans.
  constexpr std::uint32_t kBack = 1u << 31;
  if (scans_ > 0 && step > 1 && step < kBack) lost_ += step - 1;
  if (scans_ == 0) first_ = stamp;
  sequence_ = scan.sequence;
  last_ = std::max(last_, stamp);
  ++scans_;
}

std::string ScanTally::text() const {
  return std::to_string(scans_) + (scans_ == 1 ? " scan in " : " scans in ") +
         fsr::settings::fixedText(scans_ > 0 ? std::max(0.0, last_ - first_) : 0.0, 1) + " s (" +
         std::to_string(lost_) + " lost by the board's counter)";
}

}  // namespace fsr_ros
