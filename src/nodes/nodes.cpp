#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <pluginlib/class_list_macros.hpp>

#include <csignal>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/live/parameters.h"
#include "ros/live/serve.h"
#include "ros/recording/procedures.h"
#include "ros/recording/recorder.h"
#include "settings/foreign_error.h"

namespace fsr_ros {

namespace {

constexpr double kNodeletRetryPeriod = 1;  // [s]

// ROS closes on SIGINT alone. kill and a closed terminal must not leave a bag without its index. A signal
// that is ignored, as under nohup, stays so.
void closeOnSignals() {
  for (const int signal : {SIGTERM, SIGHUP}) {
    if (std::signal(signal, [](int) { ros::requestShutdown(); }) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

// The main part of a node that roslaunch starts again when it ends: makes its server, and spins. A wrong
// setting does not end the node where roslaunch started it, which would fill the screen each second: it is
// said once, and the node waits until it is put right. A node that was started alone ends with status 2.
template <MakeServer maker>
int serve() {
  return runNode([] {
    const ros::NodeHandle handle, private_handle("~");
    Server server;
    const auto made = [&] { server = maker(handle, private_handle); };
    std::string said;
    const auto say = [&](const std::string& sentence) {
      if (said != sentence)
        ROS_FATAL_STREAM(sentence << " (" << ros::this_node::getName() << " tries again each second)");
      said = sentence;
    };
    if (!private_handle.hasParam("launched")) made();
    if (server || makeUntilRight(made, say)) ros::spin();
  });
}

template <MakeServer maker>
int spin() {
  return runNode([] {
    const Server server = maker(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
  });
}

// Messages are collected while ~train runs. The server is called by name, so that nodes also start where a
// build leaves the training out.
int train() {
  return runNode([] {
    const Server server = makeTrainingServer(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::MultiThreadedSpinner(2).spin();
  });
}

int conduct() {
  bool closed = true;
  const int status =
      runNode([&] { closed = conductSession(ros::NodeHandle{}, ros::NodeHandle{"~"}, closeOnSignals); });
  return closed ? status : 1;
}

int recheckOnce() {
  bool done = false;
  const int status = runNode([&] { done = recheck(ros::NodeHandle{}, ros::NodeHandle{"~"}, std::cout); });
  return status != 0 || done ? status : 1;
}

int record() {
  bool failed = false;
  const int status = runNode([&] {
    Recorder recorder(ros::NodeHandle{}, ros::NodeHandle{"~"});
    closeOnSignals();
    ros::spin();
    recorder.finish();
    failed = recorder.failed();
  });
  return failed ? 1 : status;
}

}  // namespace

// The main part of the node of this name, e.g. "driver". Returns its exit status.
int nodeMain(const std::string& name, int argc, char** argv) {
  static const std::map<std::string, int (*)()> nodes = {{"calibration", serve<makeCalibrationServer>},
                                                         {"conduct", conduct},
                                                         {"curvature", serve<makeCurvatureServer>},
                                                         {"driver", serve<makeDriver>},
                                                         {"limb", spin<makeLimbServer>},
                                                         {"recheck", recheckOnce},
                                                         {"recorder", record},
                                                         {"rig_emulator", spin<makeRigEmulator>},
                                                         {"session", serve<makeSessionServer>},
                                                         {"training", train},
                                                         {"view", serve<makeViewServer>}};
  ros::init(argc, argv, name == "recorder" ? "record" : name);
  return nodes.at(name)();
}

/// A node as a nodelet. As serve() does it: where roslaunch started it, a wrong setting is said once, and
/// tried again each second. Elsewhere the manager reports that the nodelet did not load.
template <MakeServer make_server>
class ServerNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      make();
    } catch (const fsr::settings::InputError& error) {
      const bool waits = getPrivateNodeHandle().hasParam("launched");
      said_ = error.what();
      NODELET_FATAL_STREAM(said_ << (waits ? " (" + getName() + " tries again each second)" : ""));
      if (!waits) throw;
      again_ = getNodeHandle().createWallTimer(ros::WallDuration(kNodeletRetryPeriod),
                                               [this](const ros::WallTimerEvent&) { makeAgain(); });
    }
  }

  void make() {
    fsr::settings::inSentences([this] { server_ = make_server(getNodeHandle(), getPrivateNodeHandle()); });
  }

  void makeAgain() {
    try {
      make();
      again_.stop();
    } catch (const fsr::settings::InputError& error) {
      if (said_ != error.what()) NODELET_FATAL_STREAM(error.what());
      said_ = error.what();
    }
  }

  ros::WallTimer again_;
  std::string said_;
  Server server_;
};

class DriverNodelet : public ServerNodelet<makeDriver> {};
class CalibrationNodelet : public ServerNodelet<makeCalibrationServer> {};
class ViewNodelet : public ServerNodelet<makeViewServer> {};

}  // namespace fsr_ros

PLUGINLIB_EXPORT_CLASS(fsr_ros::DriverNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fsr_ros::CalibrationNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fsr_ros::ViewNodelet, nodelet::Nodelet)
