#include "ros/bags/fresh_bag.h"

#include <fcntl.h>
#include <rosbag/exceptions.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/file_kind.h"

namespace fsr_ros {

namespace {

// rosbag shows nobody the stream of its file. An explicit instantiation may name private members.
template <typename Of, typename Of::Member member>
struct Reveal {
  friend typename Of::Member reveal(Of /*of*/) { return member; }
};
struct FileOfBag {
  using Member = rosbag::ChunkedFile rosbag::Bag::*;
  friend Member reveal(FileOfBag of);
};
struct StreamOfFile {
  using Member = FILE* rosbag::ChunkedFile::*;
  friend Member reveal(StreamOfFile of);
};
template struct Reveal<FileOfBag, &rosbag::Bag::file_>;
template struct Reveal<StreamOfFile, &rosbag::ChunkedFile::file_>;

FILE* streamOf(rosbag::Bag& bag) {
  return bag.*reveal(FileOfBag{}).*reveal(StreamOfFile{});
}

}  // namespace

void abandonBag(std::unique_ptr<rosbag::Bag> bag) noexcept {
  static auto* const abandoned = new std::vector<rosbag::Bag*>;
  if (bag == nullptr) return;
  try {
    bag->close();
  } catch (const rosbag::BagException&) {
    abandoned->push_back(bag.release());
  }
}

void releaseFile(std::unique_ptr<rosbag::Bag> bag) noexcept {
  FILE* const stream = streamOf(*bag);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (stream != nullptr && nowhere >= 0) ::dup2(nowhere, ::fileno(stream));
  if (nowhere >= 0) ::close(nowhere);
  abandonBag(std::move(bag));
}

void flushBag(rosbag::Bag& bag) {
  if (std::fflush(streamOf(bag)) != 0) throw rosbag::BagIOException(std::strerror(errno));
}

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
