#include "ros/live/rig_operator.h"

#include <ros/console.h>
#include <ros/service.h>
#include <std_msgs/String.h>
#include <std_srvs/Trigger.h>

#include <chrono>

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
                         const Parameters& parameters, const SurfaceFolder& surfaces, const MakePerson& make,
                         fsr::emulator::EmulatorOptions& options)
    : handle_(handle), folder_(surfaces) {
  ros::NodeHandle own(private_handle);
  fsr::emulator::OperatorOptions person;
  person.seed = options.simulation.seed;
  person.lies_on = options.surface.name;
  const double change = parameters.number("change", 30, {0, 3600, "s"});
  person.habits.change_least = kFastest * change;
  person.habits.change_most = kSlowest * change;
  confirm_ = parameters.text("confirm", "conduct/confirm");
  if (confirm_ == kPerson) confirm_.clear();
  options.person = make(person);
  options.autostart = false;
  options.surface_called = [this](const std::string& name) { return surfaceCalled(name); };
  options.on_act = [this](const fsr::emulator::Act& act) { onAct(act); };
  acts_ = own.advertise<std_msgs::String>("acts", 100);
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
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!instruction.confirm) to_confirm_ = false;  // somebody else has confirmed
  const std::string asked =
      instruction.confirm ? instruction.surface + ", mount " + std::to_string(instruction.mount) : "";
  if (asked != asked_ || instruction.text != asked_text_) asked_for_ = false;
  asked_ = asked;
  asked_text_ = instruction.text;
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
    changed_.wait(lock, [this] { return to_confirm_ || stopping_; });
    if (stopping_) return;
    lock.unlock();
    const bool confirmed = confirm();
    lock.lock();
    if (confirmed) to_confirm_ = false;
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

}  // namespace fsr_ros
