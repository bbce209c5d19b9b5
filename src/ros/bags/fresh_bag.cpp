#include "ros/bags/fresh_bag.h"

#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/abandon_bag.h"
#include "settings/file_kind.h"

namespace fsr_ros {

FreshBag::FreshBag(const std::string& path)
    : path_(path), fresh_(path, fsr::settings::file_kind::kBag), bag_(std::make_unique<rosbag::Bag>()) {
  try {
    bag_->open(fresh_.name(), rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    abandonBag(std::move(bag_));
    refuse(error.what());
  }
}

FreshBag::~FreshBag() {
  abandonBag(std::move(bag_));
}

void FreshBag::refuse(const std::string& why) const {
  throw fsr::settings::InputError(
      path_ + ": the bag cannot be written (" + why +
      "); give a path in a directory that exists and may be written to, on a disk with room");
}

void FreshBag::finish() {
  try {
    bag_->close();
  } catch (const rosbag::BagException& error) {
    refuse(error.what());
  }
  bag_.reset();
  fresh_.finish();
}

}  // namespace fsr_ros
