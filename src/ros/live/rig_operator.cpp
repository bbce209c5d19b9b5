#include "ros/live/rig_operator.h"

#include <XmlRpc.h>
#include <ros/console.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/service.h>
#include <ros/this_node.h>
#include <std_msgs/String.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <sstream>

namespace fsr_ros {

namespace {

constexpr const char* kPerson = "person";           // instead of a service: roslaunch drops empty arguments
constexpr double kSlowest = 1.33, kFastest = 0.67;  // change of a surface, as shares of `~change`
constexpr std::chrono::milliseconds kAgain{500};    // until a service that is not there is called again

std_msgs::String text(const std::string& data) {
  std_msgs::String message;
  message.data = data;
  return message;
}

}  // namespace

fsr::emulator::Task toTask(const fsr_pressure_map::Instruction& instruction) {
  if (instruction.kind > fsr_pressure_map::Instruction::DONE) {
    throw fsr::settings::InputError("instruction of step " + std::to_string(instruction.step) + ": kind is " +
                                    std::to_string(instruction.kind) + ", but must be 0 to 7");
  }
  fsr::emulator::Task task;
  task.kind = static_cast<fsr::emulator::TaskKind>(instruction.kind);
  task.step = instruction.step;
  task.surface = instruction.surface;
  task.mount = instruction.mount;
  task.cycle = instruction.cycle;
  task.cycles = instruction.cycles;
  task.low = instruction.low;
  task.peak = instruction.peak;
  task.rate = instruction.rate;
  task.dwell_peak = instruction.dwell_peak;
  task.dwell_rest = instruction.dwell_rest;
  task.duration = instruction.duration;
  task.confirm = instruction.confirm;
  task.remark = instruction.remark;
  return task;
}

RigOperator::RigOperator(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                         const Parameters& parameters, const SurfaceFolder& surfaces,
                         fsr::emulator::EmulatorOptions& options)
    : handle_(handle), folder_(surfaces) {
  ros::NodeHandle own(private_handle);
  fsr::emulator::OperatorOptions person;
  person.mistakes = fsr::emulator::readMistakes(parameters.text("mistakes", ""));
  person.shelf = readShelf(parameters);
  person.seed = options.simulation.seed;
  person.lies_on = options.surface.name;
  const double change = parameters.number("change", 30, {0, 3600, "s"});
  person.habits.change_least = kFastest * change;
  person.habits.change_most = kSlowest * change;
  confirm_ = parameters.text("confirm", "conduct/confirm");
  if (confirm_ == kPerson) confirm_.clear();
  conductor_ = parameters.text("conductor", "conduct");
  options.person = person;
  options.autostart = false;
  options.surface_called = [this](const std::string& name) { return surfaceCalled(name); };
  options.on_act = [this](const fsr::emulator::Act& act) { onAct(act); };
  acts_ = own.advertise<std_msgs::String>("acts", 100);
  mistakes_ = own.advertise<std_msgs::String>("mistakes", 10, true);
  caller_ = std::thread([this] { callServices(); });
}

RigOperator::~RigOperator() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  caller_.join();
}

void RigOperator::workAt(fsr::emulator::Emulator& rig) {
  rig_ = &rig;
  instructions_ = handle_.subscribe("instruction", 100, &RigOperator::onInstruction, this);
}

std::vector<std::string> RigOperator::readShelf(const Parameters& parameters) {
  std::vector<std::string> shelf;
  std::istringstream given(parameters.text("shelf", ""));
  for (std::string name; std::getline(given, name, ',');) shelf.push_back(name);
  if (!shelf.empty()) return shelf;
  for (const std::string& name : folder_.names()) {
    try {
      surfaceCalled(name);
      shelf.push_back(name);
    } catch (const fsr::settings::InputError& error) {
      ROS_DEBUG_STREAM("not on the shelf: " << error.what());  // e.g. made for a matrix of another size
    }
  }
  return shelf;
}

fsr::matrix::Surface RigOperator::surfaceCalled(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto known = surfaces_.find(name);
  if (known != surfaces_.end()) return known->second;
  return surfaces_[name] = folder_.load(name);
}

void RigOperator::onInstruction(const fsr_pressure_map::Instruction& instruction) {
  try {
    rig_->instruct(toTask(instruction));
  } catch (const fsr::settings::InputError& error) {
    ROS_WARN_STREAM_THROTTLE(10, error.what());
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!instruction.confirm) to_confirm_ = false;  // somebody else has confirmed
    const std::string asked =
        instruction.confirm ? instruction.surface + ", mount " + std::to_string(instruction.mount) : "";
    if (asked != asked_ || instruction.text != asked_text_) asked_for_ = false;
    asked_ = asked;
    asked_text_ = instruction.text;
  }
  publishMistakes();
}

void RigOperator::publishMistakes() {
  const auto made = rig_->mistakesMade();
  if (made.size() == published_) return;
  std::string all;
  for (const auto& mistake : made) {
    all += (all.empty() ? "" : ", ") + mistake.name + "@" + std::to_string(mistake.step);
  }
  published_ = made.size();
  ROS_INFO_STREAM(
      "the operator makes a mistake: " << fsr::emulator::mistakeCalled(made.back().name).description);
  mistakes_.publish(text(all));
}

// In the thread of the emulator.
void RigOperator::onAct(const fsr::emulator::Act& act) {
  using Kind = fsr::emulator::Act::Kind;
  if (act.kind == Kind::kConfirm && confirm_.empty()) {
    askForConfirmation();
    return;
  }
  ROS_INFO_STREAM("operator: " << describe(act));
  acts_.publish(text(describe(act)));
  const std::lock_guard<std::mutex> lock(mutex_);
  to_confirm_ = to_confirm_ || act.kind == Kind::kConfirm;
  to_close_ = to_close_ || act.kind == Kind::kCloseTerminal;
  changed_.notify_all();
}

// Another person confirms: says once in each instruction that it is time.
void RigOperator::askForConfirmation() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (asked_.empty() || asked_for_) return;
  asked_for_ = true;
  const std::string sentence = "the sheet lies on " + asked_ + ": confirm it in the panel";
  ROS_INFO_STREAM("operator: " << sentence);
  acts_.publish(text(sentence));
}

// --- services, in a thread of their own ------------------------------------------------------------

void RigOperator::callServices() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_) {
    changed_.wait(lock, [this] { return to_confirm_ || to_close_ || stopping_; });
    if (stopping_) return;
    const bool close = std::exchange(to_close_, false), wants_confirmation = to_confirm_;
    lock.unlock();
    if (close) closeTerminal();
    const bool confirmed = !wants_confirmation || confirm();
    lock.lock();
    if (confirmed && wants_confirmation) to_confirm_ = false;
    if (!confirmed) changed_.wait_for(lock, kAgain, [this] { return stopping_; });
  }
}

bool RigOperator::confirm() {
  std_srvs::Trigger service;
  const std::string name = handle_.resolveName(confirm_);
  if (!ros::service::call(name, service)) {
    ROS_WARN_STREAM_THROTTLE(10, "operator: the service " << name << " does not answer");
    return false;
  }
  ROS_INFO_STREAM("operator: confirmed: " << service.response.message);
  return true;
}

// Ends the conductor as a closed terminal does. Who started it may start it again.
void RigOperator::closeTerminal() {
  const std::string node = handle_.resolveName(conductor_);
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  request[1] = node;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("lookupNode", request, response, payload, false) ||
      !ros::network::splitURI(static_cast<std::string>(payload), host, port)) {
    ROS_WARN_STREAM("operator: there is no node " << node << " to close");
    return;
  }
  request[1] = "the operator closed the terminal";
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  client.execute("shutdown", request, response);
}

}  // namespace fsr_ros
