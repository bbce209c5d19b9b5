#include "ros/bags/abandon_bag.h"

#include <vector>

namespace fsr_ros {

void abandonBag(std::unique_ptr<rosbag::Bag> bag) noexcept {
  static auto* const abandoned = new std::vector<rosbag::Bag*>;
  if (bag == nullptr) return;
  try {
    bag->close();
  } catch (const rosbag::BagException&) {
    abandoned->push_back(bag.release());
  }
}

}  // namespace fsr_ros
