#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/driver/driver.h"
#include "ros/live/calibration_server.h"
#include "ros/live/view_server.h"
#include "settings/foreign_error.h"

namespace fsr_ros {

namespace {

constexpr double kAgain = 1;  // [s]

}  // namespace

/// A node as a nodelet. As serve() does it: where roslaunch started it, a wrong setting is said once, and tried
/// again each second. Elsewhere the manager reports that the nodelet did not load.
template <typename Server>
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
      again_ = getNodeHandle().createWallTimer(ros::WallDuration(kAgain),
                                               [this](const ros::WallTimerEvent&) { makeAgain(); });
    }
  }

  void make() {
    fsr::settings::inSentences(
        [this] { server_ = std::make_unique<Server>(getNodeHandle(), getPrivateNodeHandle()); });
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
  std::unique_ptr<Server> server_;
};

class DriverNodelet : public ServerNodelet<Driver> {};
class CalibrationNodelet : public ServerNodelet<CalibrationServer> {};
class ViewNodelet : public ServerNodelet<ViewServer> {};

}  // namespace fsr_ros

PLUGINLIB_EXPORT_CLASS(fsr_ros::DriverNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fsr_ros::CalibrationNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fsr_ros::ViewNodelet, nodelet::Nodelet)
