#pragma once

#include <fsr_pressure_map/SetSurface.h>
#include <ros/node_handle.h>
#include <std_srvs/SetBool.h>

#include <memory>

#include "emulator/emulator.h"
#include "ros/bags/surface_folder.h"
#include "ros/live/parameters.h"
#include "ros/live/rig_operator.h"
#include "simulation/settings_text.h"

namespace fsr_ros {

/// The emulated rig as a node: a board behind a serial port, in a pressure chamber that is controlled by
/// services.
///
/// Topic `~status` (std_msgs/String, latched): state and number of the run, "running 2", then "done 2"; "idle
/// 0" before the first run. A script can wait for this message after it has called `~start`. At a time scale
/// other than 1 the node also publishes `/clock` in rig time, which begins at the wall time of the start:
/// before each scan is sent, and at least 250 times a second of wall time.
///
/// Services: `~start` (starts a new run of cycles with the present parameters `~chamber/`), `~stop`,
/// `~set_surface`, `~set_damage` (true: damages the line as the present parameters `~damage/` say; false:
/// ends the damage). The node does not publish `curvature`: when the surface changes, call the curvature node
/// too, with the same surface and mount.
/// `~set_trigger` makes an edge at the board's trigger input (true: rising).
///
/// With the parameter `~operator` a RigOperator works chamber and sheet; `~start`, `~stop` and `~set_surface`
/// do not exist then.
///
/// Parameters: see launch/rig_emulator.launch and docs/nodes.md.
class RigEmulator {
 public:
  /// `make`: the operator; tests give one who makes mistakes. Throws fsr::InputError.
  RigEmulator(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
              const RigOperator::MakePerson& make =
                  std::make_shared<fsr::emulator::Operator, const fsr::emulator::OperatorOptions&>);

 private:
  fsr::simulation::SimulationSettings readSimulation();
  fsr::emulator::EmulatorOptions readOptions();
  fsr::simulation::ChamberProtocol readProtocol() const;
  fsr::emulator::LineDamage readDamage() const;
  void publishClock(double rig_time);
  void publishStatus(const fsr::emulator::RigStatus& status);

  bool setSurface(fsr_pressure_map::SetSurface::Request& request,
                  fsr_pressure_map::SetSurface::Response& response);
  bool setTrigger(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool setDamage(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);

  Parameters parameters_;
  fsr::simulation::ChamberProtocol file_protocol_;  // protocol of the simulation file: defaults of ~chamber/
  SurfaceFolder surfaces_;
  std::uint32_t mount_ = 1;
  ros::Time origin_;  // rig time 0
  ros::Publisher status_;
  ros::Publisher clock_;
  std::unique_ptr<RigOperator> operator_;         // null where there is none
  std::unique_ptr<fsr::emulator::Emulator> rig_;  // stops before the publishers are destroyed
  std::vector<ros::ServiceServer> services_;
};

}  // namespace fsr_ros
