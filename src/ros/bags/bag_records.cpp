#include "ros/bags/bag_records.h"

#include <rosbag/exceptions.h>

#include <filesystem>

namespace fsr_ros::bag_records {

namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";
constexpr std::uint64_t kLargestRecord = 1u << 28;  // [bytes]; rosbag record makes chunks of 768 KB

}  // namespace

void damaged(const std::string& what) {
  throw rosbag::BagFormatException(what);
}

std::string_view takeBlock(std::string_view& rest) {
  const auto size = number<std::uint32_t>(rest);
  rest.remove_prefix(sizeof(size));
  if (size > rest.size()) damaged("a length points behind its end");
  const std::string_view block = rest.substr(0, size);
  rest.remove_prefix(size);
  return block;
}

std::string_view fieldBytes(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::string_view entry = takeBlock(header);
    const std::size_t equals = entry.find('=');
    if (equals == std::string_view::npos) damaged("a header field has no value");
    if (entry.substr(0, equals) == name) return entry.substr(equals + 1);
  }
  damaged("a record has no field " + std::string(name));
}

RecordFile::RecordFile(const std::string& path)
    : file_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {
  take(sizeof(kMagic) - 1, header_);
  if (header_ != kMagic) damaged("it does not begin with #ROSBAG V2.0");
}

void RecordFile::goTo(std::uint64_t position) {
  if (position > size_) damaged("its index begins behind the file's end");
  position_ = position;
  file_.seekg(static_cast<std::streamoff>(position));
}

void RecordFile::next() {
  takeBlock(header_);
  takeBlock(data_);
}

void RecordFile::take(std::uint64_t size, std::string& into) {
  if (size > size_ - position_) damaged("a record ends behind the file's end");
  if (size > kLargestRecord) damaged("a record is larger than 256 MiB");
  into.resize(size);
  if (!file_.read(into.data(), static_cast<std::streamsize>(size))) damaged("it cannot be read to its end");
  position_ += size;
  hash_.add(into.data(), size);
}

void RecordFile::takeBlock(std::string& into) {
  take(sizeof(std::uint32_t), into);
  take(number<std::uint32_t>(into), into);
}

}  // namespace fsr_ros::bag_records
