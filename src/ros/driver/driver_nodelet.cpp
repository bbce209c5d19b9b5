#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/driver/driver.h"
#include "settings/foreign_error.h"

namespace fsr_ros {

/// The driver as a nodelet.
class DriverNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      fsr::settings::inSentences(
          [this] { driver_ = std::make_unique<Driver>(getNodeHandle(), getPrivateNodeHandle()); });
    } catch (const fsr::settings::InputError& error) {
      NODELET_FATAL_STREAM(error.what());
      throw;  // so that the manager reports that the nodelet did not load
    }
  }

  std::unique_ptr<Driver> driver_;
};

}  // namespace fsr_ros

PLUGINLIB_EXPORT_CLASS(fsr_ros::DriverNodelet, nodelet::Nodelet)
