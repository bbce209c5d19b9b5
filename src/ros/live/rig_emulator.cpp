#include "ros/live/rig_emulator.h"

#include <fsr_pressure_map/Instruction.h>
#include <fsr_pressure_map/SetSurface.h>
#include <ros/console.h>
#include <ros/param.h>
#include <ros/service.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>

#include "ros/bags/resource_path.h"
#include "ros/bags/surface_folder.h"
#include "ros/live/parameters.h"
#include "simulation/settings_text.h"

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

// What an instruction asks for.
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

// The person at an emulated rig: carries out what the topic `instruction` says, and calls the conductor's
// service `confirm` where that is asked for. Without the name of a service another person confirms, and is
// told once when it is time.
//
// Topic: `~acts` (std_msgs/String), what is done with the hands, e.g. "put the sheet on flat", and when
// another person is to confirm.
//
// Parameters: `~change`, `~confirm`; see launch/rig_emulator.launch.
class RigOperator {
 public:
  // Adds the person to the options of the rig. Throws fsr::InputError.
  RigOperator(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
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

  ~RigOperator() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    caller_.join();
  }

  RigOperator(const RigOperator&) = delete;
  RigOperator& operator=(const RigOperator&) = delete;

  // Begins to listen to instructions.
  void workAt(fsr::emulator::Emulator& rig) {
    rig_ = &rig;
    instructions_ = handle_.subscribe("instruction", 100, &RigOperator::onInstruction, this);
  }

 private:
  fsr::matrix::Surface surfaceCalled(const std::string& name) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = surfaces_.find(name);
    if (known != surfaces_.end()) return known->second;
    return surfaces_[name] = folder_.load(name);
  }

  void onInstruction(const fsr_pressure_map::Instruction& instruction) {
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
  void onAct(const fsr::emulator::Act& act) {
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
  void askForConfirmation() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (asked_.empty() || asked_for_) return;
    asked_for_ = true;
    const std::string sentence = "the sheet lies on " + asked_ + ": confirm it in the panel";
    ROS_INFO_STREAM("operator: " << sentence);
    acts_.publish(text(sentence));
  }

  // --- services, in a thread of their own ----------------------------------------------------------

  void callServices() {
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

  bool confirm() {
    std_srvs::Trigger service;
    const std::string name = handle_.resolveName(confirm_);
    if (!ros::service::call(name, service)) {
      ROS_WARN_STREAM_THROTTLE(10, "operator: the service " << name << " does not answer");
      return false;
    }
    ROS_INFO_STREAM("operator: confirmed: " << service.response.message);
    return true;
  }

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

std::string describe(const fsr::simulation::ChamberProtocol& protocol) {
  std::ostringstream text;
  text << (protocol.cycles == 0 ? "endless" : std::to_string(protocol.cycles))
       << (protocol.cycles == 1 ? " cycle to " : " cycles to ") << protocol.peak / 1000 << " kPa gauge, "
       << fsr::simulation::cycleDuration(protocol) << " s each";
  return text.str();
}

std::string describe(const fsr::emulator::LineDamage& damage) {
  std::ostringstream text;
  text << "lost bytes " << damage.lost_bytes << ", flipped bits " << damage.flipped_bits << ", lost packets "
       << damage.lost_packets << ", doubled packets " << damage.doubled_packets << ", noise " << damage.noise
       << ", pause " << damage.pause << " s";
  if (damage.unplugged) text << ", unplugged";
  if (damage.baud != 0) text << ", sends at " << damage.baud << " baud";
  return text.str();
}

void warnOfOtherTime(double time_scale) {
  bool simulated = false;
  ros::param::get("/use_sim_time", simulated);
  if (simulated != (time_scale != 1)) {
    ROS_WARN("/use_sim_time is %s, but must be %s at a time scale of %g; set it before the nodes start",
             simulated ? "true" : "false", simulated ? "false" : "true", time_scale);
  }
}

class RigEmulator {
 public:
  // `make`: the operator; tests give one who makes mistakes. Throws fsr::InputError.
  RigEmulator(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, const MakePerson& make)
      : parameters_(private_handle) {
    ros::NodeHandle global(handle), own(private_handle);
    fsr::emulator::EmulatorOptions options = readOptions();
    warnOfOtherTime(options.time_scale);
    origin_.fromSec(std::floor(ros::WallTime::now().toSec()));
    status_ = own.advertise<std_msgs::String>("status", 10, true);
    options.on_status = [this](const fsr::emulator::RigStatus& status) { publishStatus(status); };
    if (options.time_scale != 1) {
      clock_ = global.advertise<rosgraph_msgs::Clock>("/clock", 100);
      options.on_clock = [this](double rig_time) { publishClock(rig_time); };
    }
    if (parameters_.flag("operator", false)) {
      operator_ =
          std::make_unique<RigOperator>(handle, private_handle, parameters_, surfaces_, make, options);
    }
    rig_ = std::make_unique<fsr::emulator::Emulator>(options);
    services_ = {own.advertiseService("set_damage", &RigEmulator::setDamage, this),
                 own.advertiseService("set_trigger", &RigEmulator::setTrigger, this)};
    if (operator_) {
      operator_->workAt(*rig_);
    } else {
      services_.push_back(advertiseTrigger(own, "start", [this] {
        const fsr::simulation::ChamberProtocol protocol = readProtocol();
        return "run " + std::to_string(rig_->startCycles(protocol)) + ": " + describe(protocol);
      }));
      services_.push_back(advertiseTrigger(own, "stop", [this] {
        rig_->stopCycles();
        return std::string("the chamber vents to rest");
      }));
      services_.push_back(own.advertiseService("set_surface", &RigEmulator::setSurface, this));
    }
    ROS_INFO_STREAM("emulated board " << options.simulation.board.serial << " (" << options.simulation.origin
                                      << ") on port " << rig_->port() << ", surface "
                                      << options.surface.name);
  }

 private:
  fsr::simulation::SimulationSettings readSimulation() {
    fsr::simulation::SimulationSettings simulation = fsr::simulation::readSimulationFile(resolveResource(
        parameters_.text("simulation", "package://fsr_pressure_map/config/simulation/demo.yaml")));
    const auto side = [this](const char* name, std::uint16_t fallback) {
      return static_cast<std::uint16_t>(
          parameters_.integer(name, fallback, {1, fsr::matrix::kMaxMatrixSide, ""}));
    };
    fsr::matrix::MatrixSize& size = simulation.layout.size;
    size = {side("rows", size.rows), side("columns", size.columns)};
    const auto seed = static_cast<std::int64_t>(simulation.seed);
    simulation.seed = static_cast<std::uint64_t>(parameters_.integer("seed", seed, {0, 2147483647, ""}));
    fsr::simulation::SimulatedBoard& board = simulation.board;
    board.serial = parameters_.text("serial", board.serial);
    board.scan_rate = parameters_.number("scan_rate", board.scan_rate, {0.01, 10000, "Hz"});
    file_protocol_ = simulation.chamber;
    simulation.chamber = readProtocol();
    return simulation;
  }

  fsr::emulator::EmulatorOptions readOptions() {
    fsr::emulator::EmulatorOptions options;
    options.simulation = readSimulation();
    surfaces_ =
        SurfaceFolder(parameters_.text("surfaces", SurfaceFolder::shipped()), options.simulation.layout.size);
    options.surface = surfaces_.load(parameters_.text("surface", "flat"));
    mount_ = static_cast<std::uint32_t>(parameters_.integer("mount", 1, {0, 1e9, ""}));
    options.surface.mount = mount_;
    options.link = resolveResource(parameters_.text("link", "${ROS_HOME}/fsr_rig_port"));
    options.baud = static_cast<std::uint32_t>(parameters_.integer("baud", 0, {0, 4e6, "1/s"}));
    options.time_scale = parameters_.number("time_scale", 1, {0.01, 1000, ""});
    options.autostart = parameters_.flag("autostart", true);
    options.clock.offset =
        static_cast<std::uint32_t>(parameters_.integer("clock_offset", 0, {0, 2147483647, "us"}));
    options.clock.drift = parameters_.number("clock_drift", 0, {-10000, 10000, "ppm"});
    return options;
  }

  fsr::simulation::ChamberProtocol readProtocol() const {
    fsr::simulation::ChamberProtocol protocol = file_protocol_;
    const fsr::settings::Range any;
    protocol.peak = parameters_.number("chamber/peak", protocol.peak, any);
    protocol.fill_rate = parameters_.number("chamber/fill_rate", protocol.fill_rate, any);
    protocol.vent_rate = parameters_.number("chamber/vent_rate", protocol.vent_rate, any);
    protocol.dwell_peak = parameters_.number("chamber/dwell_peak", protocol.dwell_peak, any);
    protocol.dwell_rest = parameters_.number("chamber/dwell_rest", protocol.dwell_rest, any);
    protocol.cycles =
        static_cast<unsigned>(parameters_.integer("chamber/cycles", protocol.cycles, {0, 1e6, ""}));
    validate(protocol, "parameters ~chamber/");
    return protocol;
  }

  fsr::emulator::LineDamage readDamage() const {
    fsr::emulator::LineDamage damage;
    damage.lost_bytes = parameters_.number("damage/lost_bytes", 0, {0, 1, ""});
    damage.flipped_bits = parameters_.number("damage/flipped_bits", 0, {0, 1, ""});
    damage.lost_packets = parameters_.number("damage/lost_packets", 0, {0, 1, ""});
    damage.doubled_packets = parameters_.number("damage/doubled_packets", 0, {0, 1, ""});
    damage.noise = parameters_.number("damage/noise", 0, {0, 100, ""});
    damage.pause = parameters_.number("damage/pause", 0, {0, 86400, "s"});
    damage.unplugged = parameters_.flag("damage/unplug", false);
    damage.baud = static_cast<std::uint32_t>(parameters_.integer("damage/wrong_baud", 0, {0, 4e6, "1/s"}));
    return damage;
  }

  void publishClock(double rig_time) {
    rosgraph_msgs::Clock message;
    message.clock = origin_ + ros::Duration(rig_time);
    clock_.publish(message);
  }

  void publishStatus(const fsr::emulator::RigStatus& status) {
    std_msgs::String message;
    message.data = stateName(status.state) + " " + std::to_string(status.run);
    status_.publish(message);
  }

  bool setSurface(fsr_pressure_map::SetSurface::Request& request,
                  fsr_pressure_map::SetSurface::Response& response) {
    return answer(response, [&] {
      fsr::matrix::Surface surface = surfaces_.load(request.surface);
      surface.mount = request.mount != 0 ? request.mount : mount_ + 1;
      rig_->setSurface(surface);
      mount_ = surface.mount;
      return "the emulated matrix lies on " + surface.name + " (mount " + std::to_string(mount_) + ")";
    });
  }

  bool setTrigger(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
    return answer(response, [&] {
      rig_->setTrigger(request.data);
      return std::string(request.data ? "a rising" : "a falling") + " edge at the trigger input";
    });
  }

  bool setDamage(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
    return answer(response, [&] {
      const fsr::emulator::LineDamage damage = request.data ? readDamage() : fsr::emulator::LineDamage{};
      rig_->setDamage(damage);
      if (!request.data) return std::string("the line is undamaged");
      const bool reset = parameters_.flag("damage/reset", false);
      if (reset) rig_->resetBoard();
      const double jump = parameters_.number("damage/clock_jump", 0, {-1000, 1000, "s"});
      if (jump != 0) rig_->jumpClock(jump);
      return "the line is damaged: " + describe(damage) + (reset ? "; the board was reset" : "") +
             (jump != 0 ? "; its clock jumped" : "");
    });
  }

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

}  // namespace

Server makeRigEmulator(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                       const MakePerson& make) {
  return std::make_shared<RigEmulator>(handle, private_handle, make);
}

Server makeRigEmulator(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle) {
  return makeRigEmulator(handle, private_handle,
                         std::make_shared<fsr::emulator::Operator, const fsr::emulator::OperatorOptions&>);
}

}  // namespace fsr_ros
