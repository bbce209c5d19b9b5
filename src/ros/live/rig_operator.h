#pragma once

#include <fsr_pressure_map/Instruction.h>
#include <ros/node_handle.h>

#include <condition_variable>
#include <map>
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
/// Topics: `~acts` (std_msgs/String), what is done with the hands, e.g. "put the sheet on flat", and when
/// another person is to confirm; `~mistakes`
/// (std_msgs/String, latched), all mistakes made so far with their steps, e.g. "leak@12, too_fast@20".
///
/// Parameters: `~mistakes`, `~shelf`, `~change`, `~confirm`, `~conductor`; see launch/rig_emulator.launch.
class RigOperator {
 public:
  /// Adds the person to the options of the rig. Throws fsr::InputError.
  RigOperator(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
              const Parameters& parameters, const SurfaceFolder& surfaces,
              fsr::emulator::EmulatorOptions& options);
  ~RigOperator();
  RigOperator(const RigOperator&) = delete;
  RigOperator& operator=(const RigOperator&) = delete;

  /// Begins to listen to instructions.
  void workAt(fsr::emulator::Emulator& rig);

 private:
  fsr::matrix::Surface surfaceCalled(const std::string& name);
  std::vector<std::string> readShelf(const Parameters& parameters);
  void onInstruction(const fsr_pressure_map::Instruction& instruction);
  void onAct(const fsr::emulator::Act& act);
  void publishMistakes();
  void askForConfirmation();
  void callServices();
  bool confirm();
  void closeTerminal();

  ros::NodeHandle handle_;
  SurfaceFolder folder_;
  std::string confirm_, conductor_;  // names of the service, empty = a person confirms, and of the node
  ros::Publisher acts_, mistakes_;
  ros::Subscriber instructions_;
  fsr::emulator::Emulator* rig_ = nullptr;
  std::size_t published_ = 0;  // mistakes

  std::mutex mutex_;                                      // guards everything below
  std::map<std::string, fsr::matrix::Surface> surfaces_;  // that were read
  std::condition_variable changed_;
  std::string asked_, asked_text_;  // surface and mount to be confirmed, empty = none, and the instruction
  bool asked_for_ = false;          // the other person was told so
  bool to_confirm_ = false, to_close_ = false, stopping_ = false;
  std::thread caller_;  // calls services, so that rig time goes on meanwhile
};

}  // namespace fsr_ros
