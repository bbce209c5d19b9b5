#pragma once

#include <fsr_pressure_map/Instruction.h>
#include <fsr_pressure_map/SetSurface.h>
#include <ros/node_handle.h>
#include <std_srvs/SetBool.h>

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "emulator/emulator.h"
#include "ros/bags/surface_folder.h"
#include "ros/live/parameters.h"
#include "simulation/settings_text.h"

namespace fsr_ros {

/// What an instruction asks for.
fsr::emulator::Task toTask(const fsr_pressure_map::Instruction& instruction);

/// The person at an emulated rig: carries out what the topic `instruction` says, and calls the conductor's
/// service `confirm` where that is asked for. Without the name of a service another person confirms, and is
/// told once when it is time.
///
/// Topic: `~acts` (std_msgs/String), what is done with the hands, e.g. "put the sheet on flat", and when
/// another person is to confirm.
///
/// Parameters: `~change`, `~confirm`; see launch/rig_emulator.launch.
class RigOperator {
 public:
  using Person = std::shared_ptr<fsr::emulator::Operator>;
  using MakePerson = std::function<Person(const fsr::emulator::OperatorOptions&)>;

  /// Adds the person to the options of the rig. Throws fsr::InputError.
  RigOperator(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
              const Parameters& parameters, const SurfaceFolder& surfaces, const MakePerson& make,
              fsr::emulator::EmulatorOptions& options);
  ~RigOperator();
  RigOperator(const RigOperator&) = delete;
  RigOperator& operator=(const RigOperator&) = delete;

  /// Begins to listen to instructions.
  void workAt(fsr::emulator::Emulator& rig);

 private:
  fsr::matrix::Surface surfaceCalled(const std::string& name);
  void onInstruction(const fsr_pressure_map::Instruction& instruction);
  void onAct(const fsr::emulator::Act& act);
  void askForConfirmation();
  void callServices();
  bool confirm();

  ros::NodeHandle handle_;
  SurfaceFolder folder_;
  std::string confirm_;  // name of the service; empty = a person confirms
  ros::Publisher acts_;
  ros::Subscriber instructions_;
  fsr::emulator::Emulator* rig_ = nullptr;

  std::mutex mutex_;                                      // guards everything below
  std::map<std::string, fsr::matrix::Surface> surfaces_;  // that were read
  std::condition_variable changed_;
  std::string asked_, asked_text_;  // surface and mount to be confirmed, empty = none, and the instruction
  bool asked_for_ = false;          // the other person was told so
  bool to_confirm_ = false, stopping_ = false;
  std::thread caller_;  // calls services, so that rig time goes on meanwhile
};

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
