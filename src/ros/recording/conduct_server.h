#pragma once

#include <fsr_pressure_map/Instruction.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <ros/node_handle.h>
#include <sensor_msgs/FluidPressure.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "fsr_pressure_map/health/taxel_watch.h"
#include "ros/recording/day_reporter.h"
#include "ros/recording/recorder.h"
#include "session/chamber_command.h"
#include "session/conductor.h"
#include "session/session_files.h"

namespace fsr_ros {

/// Leads a person through the plan of a session (session::Conductor). Publishes `instruction` and
/// `session_coverage`, both latched, the surface of the plan on `curvature` and what happens on `events`.
/// Records one bag for each mount. The services `~confirm`, `~accept`, `~reject` and `~skip` are a person's
/// answers. The state is kept in a file in the folder of the bags, so that a session goes on after a crash or
/// the night.
///
/// Parameters: `~plan` (path), `~surfaces` (folder), `~folder` (of bags and state), `~minutes` (time that
/// there is; 0 = no limit), `~command` (true: publish `chamber_command` for a regulator, at each reading),
/// `~silence` (time without a reading until it is said [s]), `~report` (true: write the report of the day
/// once the session is over), `~frame_id`, and those of the Recorder in `~recorder/`.
class ConductServer {
 public:
  /// Throws fsr::InputError.
  ConductServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

  /// Ends the recording. Returns false where a bag of this run was not closed.
  bool finish();

 private:
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;

  void onPressure(const sensor_msgs::FluidPressureConstPtr& message);
  void onScan(const fsr_pressure_map::MatrixFrameConstPtr& message);
  void onInfo(const fsr_pressure_map::MatrixInfoConstPtr& message);
  void onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message);
  void onTimer();
  void advertiseAnswers(const std::function<fsr::session::Answer()>& action, const std::string& name);
  void start(const Parameters& parameters);
  void noteTime(double stamp);
  void follow();
  void report(const fsr::session::Outcome& outcome);
  void tellConditioning(unsigned mount);
  void save();
  void say();
  void publishInstruction(const fsr::session::Instruction& now);
  void publishCoverage();
  void publishSurface();
  void publishCommand(double time);
  double ambient() const;
  void followRecording();
  void startRecording();
  void endRecording();
  std::string whyNoRecording() const;
  void checkFolder();
  void checkDisk();
  void setAside(const fsr::session::SessionStep& step);
  fsr::session::Instruction instructionNow() const;

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

/// Starts the conductor. While it cannot start, e.g. because the plan is missing or has a mistake, it says
/// why in the terminal and on `instruction`, and tries again each second: a file that is put right is taken
/// up. Null where ROS is shut down before.
std::unique_ptr<ConductServer> waitForSession(const ros::NodeHandle& handle,
                                              const ros::NodeHandle& private_handle);

}  // namespace fsr_ros
