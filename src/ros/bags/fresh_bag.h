#pragma once

#include <rosbag/bag.h>

#include <memory>
#include <string>

#include "settings/fresh_file.h"

namespace fsr_ros {

/// A bag to write. It has a temporary name until finish(), so that `path` is either the old file or the
/// complete new one. Throws fsr::InputError, which names the path and the cause, where the bag cannot be
/// written.
class FreshBag {
 public:
  explicit FreshBag(const std::string& path);
  /// Removes the temporary file unless finish() was called.
  ~FreshBag();
  FreshBag(const FreshBag&) = delete;
  FreshBag& operator=(const FreshBag&) = delete;

  /// Calls rosbag::Bag::write() with the arguments.
  template <typename... Arguments>
  void write(const Arguments&... arguments) {
    try {
      bag_->write(arguments...);
    } catch (const rosbag::BagException& error) {
      refuse(error.what());
    }
  }
  /// Closes the bag and gives it its name.
  void finish();

 private:
  [[noreturn]] void refuse(const std::string& why) const;

  std::string path_;
  fsr::settings::FreshPath fresh_;
  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace fsr_ros
