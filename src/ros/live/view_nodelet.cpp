#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>

#include "ros/live/parameters.h"
#include "ros/live/view_server.h"
#include "settings/foreign_error.h"

namespace fsr_ros {

/// The view node as a nodelet.
class ViewNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      fsr::settings::inSentences(
          [this] { server_ = std::make_unique<ViewServer>(getNodeHandle(), getPrivateNodeHandle()); });
    } catch (const fsr::settings::InputError& error) {
      NODELET_FATAL_STREAM(error.what());
      throw;  // so that the manager reports that the nodelet did not load
    }
  }

  std::unique_ptr<ViewServer> server_;
};

}  // namespace fsr_ros

PLUGINLIB_EXPORT_CLASS(fsr_ros::ViewNodelet, nodelet::Nodelet)
