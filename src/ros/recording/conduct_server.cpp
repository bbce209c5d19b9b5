#include "ros/recording/procedures.h"

#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/Instruction.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "dataset/conditioning.h"
#include "dataset/recording_builder.h"
#include "fsr_pressure_map/health/taxel_watch.h"
#include "ros/bags/rescue_bag.h"
#include "ros/bags/resource_path.h"
#include "ros/bags/surface_folder.h"
#include "ros/live/serve.h"
#include "ros/messages/surface_message.h"
#include "ros/messages/view_messages.h"
#include "ros/recording/day_reporter.h"
#include "ros/recording/recorder.h"
#include "session/chamber_command.h"
#include "session/conductor.h"
#include "session/coverage.h"
#include "session/plan.h"
#include "session/session_files.h"
#include "settings/number_text.h"
#include "settings/replace_file.h"

namespace fsr_ros {

namespace fs = std::filesystem;
using fsr::session::Outcome;
using fsr::session::StepKind;
using fsr::session::StepState;

namespace {

constexpr double kTick = 0.25;      // [s]
constexpr double kQuiet = 2;        // without any message, until the time of the computer is taken [s]
constexpr double kRetry = 10;       // until a recording that stopped is begun again [s]
constexpr double kLastEvents = 1;   // time for the last messages of a mount [s]
constexpr int kPressureBytes = 80;  // of a reading of the transducer in a bag

double since(const ros::SteadyTime& time) {
  return (ros::SteadyTime::now() - time).toSec();
}

// A remark says how long a trouble has lasted; that it goes on is not news.
std::string withoutNumbers(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(),
                            [](unsigned char one) { return std::isdigit(one) != 0 || one == '.'; }),
             text.end());
  return text;
}

std::string measuredText(const fsr::session::Measured& measured) {
  std::string text;
  const auto add = [&text](const char* name, double value, double unit, const char* unit_name) {
    if (value == value)
      text += std::string(text.empty() ? ": " : ", ") + name + " " +
              fsr::settings::roundedText(value / unit, 3) + " " + unit_name;
  };
  add("peak", measured.peak, 1e3, "kPa");
  add("filled at", measured.fill_rate, 1e3, "kPa/s");
  add("dwell", measured.dwell, 1, "s");
  add("vented at", measured.vent_rate, 1e3, "kPa/s");
  add("rest", measured.rest, 1, "s");
  return text;
}

// See conductSession().
class ConductServer {
 public:
  // Throws fsr::InputError.
  ConductServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
      : handle_(handle), private_handle_(private_handle) {
    start(Parameters(private_handle));
    instruction_ = handle_.advertise<fsr_pressure_map::Instruction>("instruction", 10, true);
    coverage_ = handle_.advertise<sensor_msgs::Image>("session_coverage", 1, true);
    curvature_ = handle_.advertise<fsr_pressure_map::SurfaceCurvature>("curvature", 10, true);
    events_ = handle_.advertise<fsr_pressure_map::Event>("events", 100);
    if (Parameters(private_handle).flag("command", false))
      command_ = handle_.advertise<sensor_msgs::FluidPressure>("chamber_command", 10);
    const ros::TransportHints fast = ros::TransportHints().tcpNoDelay();
    subscribers_ = {handle_.subscribe("chamber_pressure", 10000, &ConductServer::onPressure, this, fast),
                    handle_.subscribe("raw", 10000, &ConductServer::onScan, this, fast),
                    handle_.subscribe("matrix_info", 10, &ConductServer::onInfo, this),
                    handle_.subscribe("curvature", 10, &ConductServer::onCurvature, this)};
    advertiseAnswers([this] { return conductor_->confirm(); }, "confirm");
    advertiseAnswers([this] { return conductor_->accept(); }, "accept");
    advertiseAnswers([this] { return conductor_->reject(""); }, "reject");
    advertiseAnswers([this] { return conductor_->skip(); }, "skip");
    timer_ = handle_.createWallTimer(ros::WallDuration(kTick), [this](const auto&) { onTimer(); });
    follow();
  }

  // Ends the recording. Returns false where a bag of this run was not closed.
  bool finish() {
    endRecording();
    return all_closed_;
  }

 private:
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;

  // ---- messages ----------------------------------------------------------------------------------------

  void onPressure(const sensor_msgs::FluidPressureConstPtr& message) {
    const double stamp = message->header.stamp.toSec();
    noteTime(stamp);
    conductor_->pressure(stamp, message->fluid_pressure - ambient());
    follow();
    publishCommand(stamp);
  }

  void onScan(const fsr_pressure_map::MatrixFrameConstPtr& message) {
    const fsr_pressure_map::MatrixFrame& frame = *message;
    const std::size_t taxels = static_cast<std::size_t>(frame.rows) * frame.columns;
    if (taxels == 0 || frame.counts.size() != taxels || frame.full_scale == 0) return;
    const bool same = last_frame_ && last_frame_->rows == frame.rows &&
                      last_frame_->columns == frame.columns && last_frame_->full_scale == frame.full_scale;
    if (!same)
      taxels_ = std::make_unique<fsr::health::TaxelWatch>(fsr::matrix::MatrixSize{frame.rows, frame.columns},
                                                          frame.full_scale);
    fsr::session::ScanSummary scan;
    scan.time = frame.header.stamp.toSec();
    scan.taxels = static_cast<unsigned>(taxels);
    if (same && frame.sequence > last_frame_->sequence + 1)
      scan.lost = frame.sequence - last_frame_->sequence - 1;
    scan.counts = frame.counts.data();
    scan.columns = frame.columns;
    taxels_->setNoise(conductor_->noiseAtRest());
    taxels_->observe(frame.counts.data(), scan.time);
    for (std::size_t t = 0; t < taxels; ++t) {
      if (info_ && info_->mask.size() == taxels && info_->mask[t] != 0) continue;
      scan.saturated += frame.counts[t] >= frame.full_scale ? 1 : 0;
      scan.dead += taxels_->flags()[t] != 0 ? 1 : 0;
    }
    if (!same || scan.time < first_scan_) {
      first_scan_ = scan.time;
      scan_bytes_ = 0;
    }
    scan_bytes_ += 2 * taxels + 60 + kPressureBytes;
    last_frame_ = message;
    noteTime(scan.time);
    conductor_->scan(scan);
    follow();
  }

  void onInfo(const fsr_pressure_map::MatrixInfoConstPtr& message) { info_ = message; }

  void onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message) {
    conductor_->surface(message->surface);
  }

  void onTimer() {
    const double quiet = latest_ > 0 ? since(heard_) : 0;
    const double ros_now = ros::Time::now().toSec();
    double now = latest_ > 0 ? latest_ : ros_now;
    // The clock of the stamps may run faster than this computer's, or stand still.
    if (quiet > kQuiet) now = std::max(latest_, std::min(ros_now, latest_ + quiet));
    if (now > 0) conductor_->tick(now);
    if (now > 0 && quiet > kQuiet) publishCommand(now);  // vent
    checkDisk();
    followRecording();
    if (reporter_) reporter_->follow(conductor_->done() && !recorder_);
    follow();
    static constexpr int kEach = static_cast<int>(1 / kTick);
    if (++ticks_ % kEach == 0) {
      checkFolder();
      if (!save_trouble_.empty()) save();
      publishInstruction(instructionNow());
      publishSurface();
    }
  }

  void advertiseAnswers(const std::function<fsr::session::Answer()>& action, const std::string& name) {
    services_.push_back(private_handle_.advertiseService<Request, Response>(
        name, [this, action, name](Request&, Response& response) {
          const fsr::session::Answer answer = action();
          response.success = answer.done;
          response.message = answer.sentence;
          ROS_INFO_STREAM(name << ": " << answer.sentence);
          if (answer.done) publishSurface();
          follow();
          return true;
        }));
  }

  void start(const Parameters& parameters) {
    const std::string path = resolveLaunchPath(parameters.text("plan", ""));
    if (path.empty()) throw parameters.error("plan", "must be the path of a plan; plan_session writes one");
    plan_ = fsr::session::readPlanFile(path, resolveLaunchPath(parameters.text("surfaces", "")));
    folder_ = resolveLaunchPath(parameters.text("folder", "session"));
    frame_id_ = parameters.text("frame_id", "fsr_matrix");
    minutes_ = parameters.number("minutes", 0, {0, 1e5, "min"});
    reserve_ =
        1e6 *
        Parameters(ros::NodeHandle(private_handle_, "recorder")).number("min_space", 200, {0, 1e9, "MB"});
    const double silence = parameters.number("silence", 2, {0.1, 1e4, "s"});
    std::error_code failed;
    fs::create_directories(folder_, failed);
    if (!fs::is_directory(folder_)) throw parameters.error("folder", "is no folder and cannot be made");
    lock_ = std::make_unique<fsr::session::FolderLock>(folder_);
    const RescuedSession rescued = rescueSession(folder_, plan_.name);
    for (const std::string& sentence : rescued.closed) ROS_WARN_STREAM(sentence);
    for (const std::string& sentence : rescued.open) ROS_ERROR_STREAM(sentence);
    state_file_ = fsr::session::sessionFile(plan_.name, fsr::session::kStateFile, folder_);
    if (fs::exists(state_file_)) {
      conductor_ =
          std::make_unique<fsr::session::Conductor>(plan_, fsr::session::readState(state_file_), silence);
      ROS_INFO_STREAM("the session of " << state_file_ << " goes on; remove that file to begin anew");
    } else {
      conductor_ = std::make_unique<fsr::session::Conductor>(plan_, silence);
    }
    // So that the folder tells by itself what was planned.
    fsr::settings::replaceFile(fsr::session::sessionFile(plan_.name, fsr::session::kPlanFile, folder_),
                               planText(plan_, {"The plan of this session."}));
    if (parameters.flag("report", true)) reporter_ = std::make_unique<DayReporter>(folder_, plan_.name);
  }

  void noteTime(double stamp) {
    if (latest_ == 0 && minutes_ > 0) conductor_->deadline(stamp + 60 * minutes_);
    latest_ = stamp;
    heard_ = ros::SteadyTime::now();
  }

  // ---- what follows from them --------------------------------------------------------------------------

  void follow() {
    for (const Outcome& outcome : conductor_->takeOutcomes()) report(outcome);
    if (conductor_->revision() != saved_) {
      save();
      publishCoverage();
      followRecording();
    }
    say();
  }

  void report(const fsr::session::Outcome& outcome) {
    const fsr::session::SessionStep& step = conductor_->steps()[outcome.step];
    const std::string mount = "mount " + std::to_string(step.mount);
    const std::string what = step.kind == StepKind::kMount
                                 ? mount + " on " + step.surface
                                 : name(step.kind) + " " + std::to_string(step.number) + " of " +
                                       std::to_string(step.of) + " on " + step.surface + ", " + mount;
    fsr_pressure_map::Event event;
    event.header.stamp = ros::Time::now();
    if (outcome.state == StepState::kAccepted) {
      event.kind = step.kind == StepKind::kCondition ? "conditioning" : "step";
      event.label = what + " accepted" + measuredText(outcome.verdict.measured);
      if (!outcome.verdict.sentence.empty()) event.label += "; " + outcome.verdict.sentence;
      ROS_INFO_STREAM(event.label);
    } else if (outcome.state == StepState::kSkipped) {
      event.kind = "note";
      event.label = what + " skipped";
      ROS_WARN_STREAM(event.label);
    } else {
      event.kind = "reject";
      event.label = fsr::dataset::rejectLabel(what, outcome.verdict.reason, outcome.verdict.sentence);
      ROS_WARN_STREAM(event.label);
    }
    events_.publish(event);
    if (outcome.mount_again) setAside(step);
    if (outcome.state == StepState::kAccepted && step.kind != StepKind::kCondition)
      tellConditioning(step.mount);
  }

  // Conditioning comes before the recording. The bag of its mount says so, after its first step: until then
  // its recorder may not listen yet.
  void tellConditioning(unsigned mount) {
    if (!recorder_ || conditioning_told_) return;
    std::size_t accepted = 0;
    for (std::size_t i = 0; i < conductor_->steps().size(); ++i) {
      const fsr::session::SessionStep& step = conductor_->steps()[i];
      if (step.kind != StepKind::kCondition || step.mount != mount) continue;
      if (conductor_->states()[i] != StepState::kAccepted) return;
      ++accepted;
    }
    if (accepted == 0) return;
    conditioning_told_ = true;
    fsr_pressure_map::Event event;
    event.header.stamp = ros::Time::now();
    // With this event a bag counts as conditioned.
    const bool enough = accepted >= fsr::dataset::ConditioningOptions{}.cycles;
    event.kind = enough ? "conditioning" : "note";
    event.label = std::to_string(accepted) + (accepted == 1 ? " cycle" : " cycles") +
                  " before this recording" + (enough ? "" : ", too few to condition a sheet");
    events_.publish(event);
  }

  void save() {
    saved_ = conductor_->revision();
    try {
      writeState(state_file_, conductor_->state());
      save_trouble_.clear();
    } catch (const fsr::settings::InputError& error) {
      const bool said = !save_trouble_.empty();
      save_trouble_ = std::string("after a crash the session would not go on from here: ") + error.what();
      if (!said) ROS_ERROR_STREAM(save_trouble_);
    }
  }

  // Publishes and logs the instruction where it has changed.
  void say() {
    const fsr::session::Instruction now = instructionNow();
    if (now.text == said_text_ && now.remark == said_remark_) return;
    if (now.text != said_text_) ROS_INFO_STREAM("[" << now.step << " of " << now.steps << "] " << now.text);
    // Told by report(), or by the reporter.
    const bool told =
        now.remark.empty() || now.remark.rfind("last attempt rejected: ", 0) == 0 || conductor_->done();
    if (!told && withoutNumbers(now.remark) != withoutNumbers(said_remark_)) ROS_WARN_STREAM(now.remark);
    said_text_ = now.text;
    said_remark_ = now.remark;
    publishInstruction(now);
  }

  void publishInstruction(const fsr::session::Instruction& now) {
    fsr_pressure_map::Instruction message;
    message.header.stamp = ros::Time::now();
    message.plan = now.plan;
    message.step = static_cast<std::uint32_t>(now.step);
    message.steps = static_cast<std::uint32_t>(now.steps);
    message.kind = static_cast<std::uint8_t>(now.kind);
    message.text = now.text;
    message.surface = now.surface;
    message.mount = now.mount;
    message.cycle = now.number;
    message.cycles = now.of;
    message.low = now.low;
    message.peak = now.peak;
    message.rate = now.fill_rate > 0 ? now.fill_rate : now.vent_rate;
    message.dwell_peak = now.dwell_peak;
    message.dwell_rest = now.dwell_rest;
    message.duration = now.duration;
    message.remark = now.remark;
    message.confirm = now.confirm;
    instruction_.publish(message);
  }

  void publishCoverage() {
    const fsr::session::Instruction now = conductor_->instruction();
    const auto coverage = coverageOf(plan_, conductor_->steps(), conductor_->states());
    const std::string left = fsr::settings::fixedText(conductor_->timeLeft() / 60, 0);
    std_msgs::Header header;
    header.stamp = ros::Time::now();
    coverage_.publish(
        toMessage(header, drawCoverage(coverage, {plan_.name + ": step " + std::to_string(now.step) + " of " +
                                                  std::to_string(now.steps) + ", " + left + " min left"})));
  }

  // The surface under the sheet, once a person has confirmed it.
  void publishSurface() {
    const fsr::session::SessionStep* step = conductor_->step();
    if (step == nullptr || conductor_->instruction().confirm || step->kind == StepKind::kBreak) return;
    for (const fsr::session::PlannedSurface& one : plan_.surfaces) {
      if (one.surface.name != step->surface) continue;
      fsr::matrix::Surface surface = one.surface;
      surface.mount = step->mount;
      fsr_pressure_map::SurfaceCurvature message = toMessage(surface);
      message.header.stamp = ros::Time::now();
      message.header.frame_id = frame_id_;
      curvature_.publish(message);
      conductor_->surface(surface.name);
    }
  }

  void publishCommand(double time) {
    if (!command_) return;
    sensor_msgs::FluidPressure message;
    message.header.stamp = ros::Time::now();
    message.fluid_pressure = ambient() + command_course_.next(*conductor_, time);
    command_.publish(message);
  }

  double ambient() const {
    return info_ && info_->ambient_pressure > 0 ? info_->ambient_pressure : fsr::dataset::kStandardAmbient;
  }

  // ---- bags --------------------------------------------------------------------------------------------

  // A bag holds one mount. What was published last gets a second to arrive.
  void followRecording() {
    const bool wanted = conductor_->recording();
    const bool same = wanted && conductor_->step()->mount == recorded_mount_;
    if (recorder_ && recorder_ended_) {
      const std::string why = recorder_->complaint();
      endRecording();
      recorder_retry_ = ros::SteadyTime::now() + ros::WallDuration(kRetry);
      conductor_->recordingTrouble(
          why.empty() ? "the recording has stopped by itself, see the terminal; it is begun again" : why);
    }
    if (recorder_ && !same) {
      if (!recorder_idle_) recorder_idle_ = ros::SteadyTime::now();
      if (wanted || since(*recorder_idle_) > kLastEvents) endRecording();
    } else {
      recorder_idle_.reset();
    }
    if (wanted && !recorder_ && ros::SteadyTime::now() >= recorder_retry_) startRecording();
  }

  void startRecording() {
    const std::string hindered = whyNoRecording();
    if (!hindered.empty()) {
      recorder_retry_ = ros::SteadyTime::now() + ros::WallDuration(kRetry);
      return conductor_->recordingTrouble(hindered);
    }
    const fsr::session::SessionStep& step = *conductor_->step();
    const std::string bag =
        fsr::session::freeBagName(folder_, fsr::session::bagStem(plan_.name, step.mount, step.surface));
    const ros::NodeHandle recorder(private_handle_, "recorder");
    recorder.setParam("bag", bag);
    try {
      recorder_ended_ = false;
      recorder_ = std::make_unique<Recorder>(handle_, recorder, [this] { recorder_ended_ = true; });
      recorded_mount_ = step.mount;
      conductor_->recordingTrouble("");
    } catch (const fsr::settings::InputError& error) {
      recorder_.reset();
      recorder_retry_ = ros::SteadyTime::now() + ros::WallDuration(kRetry);
      conductor_->recordingTrouble(error.what());
    }
  }

  void endRecording() {
    recorder_idle_.reset();
    if (!recorder_) return;
    recorder_->finish();
    all_closed_ = all_closed_ && recorder_->closed();
    recorder_.reset();
  }

  // Empty = a recording can begin. Where it cannot, none is tried: each try would leave an empty bag.
  std::string whyNoRecording() const {
    std::error_code failed;
    if (!fs::is_directory(folder_, failed))
      return "nothing is recorded: the folder " + folder_ + " is gone; bring it back";
    const fs::space_info space = fs::space(folder_, failed);
    if (failed || static_cast<double>(space.available) >= reserve_) return "";
    return "nothing is recorded: only " + fsr::settings::megabytesText(space.available) +
           " are left on the disk, and " +
           fsr::settings::megabytesText(static_cast<std::uint64_t>(reserve_)) + " must stay free; make room";
  }

  // Once a second. What is written to a file that was removed is lost without an error. A bag that is just
  // given its name is missing for a moment.
  void checkFolder() {
    constexpr unsigned kLooks = 2;
    std::error_code failed;
    const bool folder = fs::is_directory(folder_, failed);
    const bool bag = !recorder_ || recorder_ended_ || fs::exists(recorder_->file(), failed);
    if (folder && bag) {
      if (std::exchange(gone_, 0) >= kLooks && !recorder_) conductor_->recordingTrouble("");
      return;
    }
    if (++gone_ != kLooks) return;
    const std::string lost =
        recorder_ ? recorder_->file() + " was removed while it was written: what was in it is lost" : "";
    endRecording();
    save();
    recorder_retry_ = ros::SteadyTime::now() + ros::WallDuration(kRetry);
    const std::string why = whyNoRecording();
    conductor_->recordingTrouble(lost + (lost.empty() || why.empty() ? "" : "; ") + why);
  }

  void checkDisk() {
    std::error_code failed;
    const fs::space_info space = fs::space(folder_, failed);
    if (failed || !last_frame_ || latest_ - first_scan_ < 5) return;
    conductor_->disk(std::max(0.0, static_cast<double>(space.available) - reserve_),
                     static_cast<double>(scan_bytes_) / (latest_ - first_scan_));
  }

  // The bags of a mount that begins again do not count.
  void setAside(const fsr::session::SessionStep& step) {
    endRecording();
    const std::string stem = fsr::session::bagStem(plan_.name, step.mount, step.surface);
    for (const fsr::session::MovedBag& bag : fsr::session::setMountAside(folder_, stem)) {
      if (bag.failure.empty())
        ROS_WARN_STREAM(bag.from << " does not count any more; it is kept as " << bag.to);
      else
        ROS_ERROR_STREAM(bag.from << ": does not count, but cannot be moved to " << bag.to << " ("
                                  << bag.failure << "); do not train from it");
    }
  }

  // With what there is to say about the report.
  fsr::session::Instruction instructionNow() const {
    fsr::session::Instruction now = conductor_->instruction();
    if (reporter_ && conductor_->done()) now.remark = reporter_->sentence();
    if (!save_trouble_.empty()) now.remark += (now.remark.empty() ? "" : "; ") + save_trouble_;
    return now;
  }

  ros::NodeHandle handle_, private_handle_;
  fsr::session::SessionPlan plan_;
  std::string folder_, state_file_, frame_id_;
  double minutes_ = 0;
  std::unique_ptr<fsr::session::Conductor> conductor_;
  std::unique_ptr<fsr::health::TaxelWatch> taxels_;
  fsr_pressure_map::MatrixInfoConstPtr info_;
  fsr_pressure_map::MatrixFrameConstPtr last_frame_;

  std::unique_ptr<fsr::session::FolderLock> lock_;
  std::unique_ptr<DayReporter> reporter_;  // null: no report is wanted
  std::unique_ptr<Recorder> recorder_;
  unsigned recorded_mount_ = 0;
  bool conditioning_told_ = false;  // in a bag
  std::atomic<bool> recorder_ended_{false};
  ros::SteadyTime recorder_retry_;                // not before
  std::optional<ros::SteadyTime> recorder_idle_;  // since the last recorded step of its mount
  bool all_closed_ = true;                        // bags of this run
  unsigned gone_ = 0;                             // looks in a row at which the folder or the bag was gone
  std::string save_trouble_;                      // why the state is not in its file; empty = it is

  std::uint64_t scan_bytes_ = 0;             // in scan_time_
  double first_scan_ = 0;                    // [s]
  double latest_ = 0;                        // latest stamp [s]
  ros::SteadyTime heard_;                    // when it came
  std::uint64_t saved_ = ~std::uint64_t{0};  // revision in the file
  std::string said_text_, said_remark_;
  unsigned ticks_ = 0;
  double reserve_ = 0;  // space that stays free on the disk [bytes]

  fsr::session::ChamberCommand command_course_;
  ros::Publisher instruction_, coverage_, curvature_, events_;
  ros::Publisher command_;  // none unless ~command
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer timer_;
};

// Null where ROS is shut down before.
std::unique_ptr<ConductServer> waitForSession(const ros::NodeHandle& handle,
                                              const ros::NodeHandle& private_handle) {
  ros::NodeHandle own(handle);
  ros::Publisher instruction;
  std::string said;
  std::unique_ptr<ConductServer> server;
  const auto make = [&] { server = std::make_unique<ConductServer>(handle, private_handle); };
  makeUntilRight(make, [&](const std::string& sentence) {
    if (said != sentence) ROS_ERROR_STREAM("the session cannot begin: " << sentence);
    said = sentence;
    if (!instruction) instruction = own.advertise<fsr_pressure_map::Instruction>("instruction", 1, true);
    fsr_pressure_map::Instruction message;
    message.header.stamp = ros::Time::now();
    message.kind = fsr_pressure_map::Instruction::BREAK;
    message.text = "The session cannot begin. Put right what is said below; it is tried again each second.";
    message.remark = sentence;
    instruction.publish(message);
  });
  return server;
}

}  // namespace

bool conductSession(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                    const std::function<void()>& begun) {
  const std::unique_ptr<ConductServer> server = waitForSession(handle, private_handle);
  if (server == nullptr) return true;
  begun();
  ros::spin();
  return server->finish();
}

}  // namespace fsr_ros
