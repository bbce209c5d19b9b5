#pragma once

#include <fsr_pressure_map/Instruction.h>
#include <ros/node_handle.h>

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

}  // namespace fsr_ros
