#pragma once

#include <rosbag/bag.h>

#include <memory>
#include <string>

#include "settings/fresh_file.h"

namespace fsr_ros {

/// Closes a bag whose content is not needed. If the disk is full, rosbag::Bag::close() throws, and so does
/// the destructor, which would end the process. Such a bag is leaked instead of destroyed.
void abandonBag(std::unique_ptr<rosbag::Bag> bag) noexcept;

/// Abandons a bag so that nothing is written to its file any more. Otherwise the C library would write what
/// it still keeps when the process ends, into a file that others may have completed meanwhile.
void releaseFile(std::unique_ptr<rosbag::Bag> bag) noexcept;

/// Writes what the C library still keeps of a bag to its file, so that neither a kill nor a disk that fills
/// later can lose it. Throws rosbag::BagIOException.
void flushBag(rosbag::Bag& bag);

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
