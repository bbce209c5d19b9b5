#pragma once

#include <fsr_pressure_map/SetSurface.h>
#include <ros/node_handle.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <memory>

#include "emulator/emulator.h"
#include "ros/bags/surface_folder.h"
#include "ros/live/parameters.h"
#include "simulation/read_settings.h"

namespace fsr_ros {

/// The emulated rig as a node: a board behind a serial port, in a chamber that services operate.
///
/// Topic `~status` (std_msgs/String, latched): state and number of the run, "running 2", then "done 2";
/// before the first run "idle 0". A script that waits for the message behind its `~start` needs no sleep.
/// At a time scale other than 1 it also publishes `/clock` in rig time, counted from the wall time of its
/// start: before each scan is sent, and 250 times a second of wall time at least.
///
/// Services: `~start` (a fresh run of cycles as `~chamber/` says by now), `~stop`, `~set_surface`,
/// `~set_damage` (true: as `~damage/` says by now; false: healthy). The rig does not publish
/// `curvature`: whoever remounts tells the curvature node, too, with the same name and mount.
///
/// Parameters: see launch/rig_emulator.launch and the README.
class RigEmulator {
 public:
  /// Throws fsr::InputError.
  RigEmulator(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

 private:
  fsr::simulation::SimulationSettings readSimulation();
  fsr::emulator::EmulatorOptions readOptions();
  fsr::simulation::ChamberProtocol readProtocol() const;
  fsr::emulator::LineDamage readDamage() const;
  void publishClock(double rig_time);
  void publishStatus(const fsr::emulator::RigStatus& status);

  bool start(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool stop(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool setSurface(fsr_pressure_map::SetSurface::Request& request,
                  fsr_pressure_map::SetSurface::Response& response);
  bool setDamage(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);

  Parameters parameters_;
  fsr::simulation::ChamberProtocol file_protocol_;  // of the simulation file, where ~chamber/ says nothing
  SurfaceFolder surfaces_;
  std::uint32_t mount_ = 1;
  ros::Time origin_;  // rig time 0
  ros::Publisher status_;
  ros::Publisher clock_;
  std::unique_ptr<fsr::emulator::Emulator> rig_;  // stops before the publishers go
  std::vector<ros::ServiceServer> services_;
};

}  // namespace fsr_ros
