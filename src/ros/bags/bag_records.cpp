#include "ros/bags/bag_records.h"

#include <rosbag/chunked_file.h>
#include <rosbag/constants.h>
#include <rosbag/exceptions.h>

#include <filesystem>

namespace fsr_ros::bag_records {

namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";
// Largest unpacked size of a chunk [bytes]; rosbag record makes chunks of 768 KB.
constexpr std::uint32_t kLargestChunk = 1u << 27;
constexpr std::uint64_t kLargestRecord = 1u << 28;  // [bytes]

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

RecordFile::RecordFile(const std::string& path, Hash hash)
    : file_(path, std::ios::binary), size_(std::filesystem::file_size(path)), hashes_(hash == Hash::kSha256) {
  take(sizeof(kMagic) - 1, header_);
  if (header_ != kMagic) damaged("it does not begin with #ROSBAG V2.0");
}

void RecordFile::goTo(std::uint64_t position) {
  if (position > size_) damaged("its index begins behind the file's end");
  position_ = position;
  file_.seekg(static_cast<std::streamoff>(position));
}

std::uint32_t RecordFile::nextHeader() {
  take(sizeof(std::uint32_t), header_);
  take(number<std::uint32_t>(header_), header_);
  take(sizeof(std::uint32_t), data_);
  return number<std::uint32_t>(data_);
}

void RecordFile::next() {
  take(nextHeader(), data_);
}

void RecordFile::take(std::uint64_t size, std::string& into) {
  if (size > size_ - position_) damaged("a record ends behind the file's end");
  if (size > kLargestRecord) damaged("a record is larger than 256 MiB");
  into.resize(size);
  if (!file_.read(into.data(), static_cast<std::streamsize>(size))) damaged("it cannot be read to its end");
  position_ += size;
  if (hashes_) hash_.add(into.data(), size);
}

void unpackChunk(RecordFile& file, std::string& chunk) {
  const auto compression = field<std::string_view>(file.header(), rosbag::COMPRESSION_FIELD_NAME);
  const auto size = field<std::uint32_t>(file.header(), rosbag::SIZE_FIELD_NAME);
  std::string& packed = file.data();
  if (compression == rosbag::COMPRESSION_NONE) {
    if (size != packed.size()) damaged("a chunk has another size than it says");
    chunk.swap(packed);
    return;
  }
  const bool lz4 = compression == rosbag::COMPRESSION_LZ4;
  if (!lz4 && compression != rosbag::COMPRESSION_BZ2) damaged("a chunk is packed in an unknown way");
  if (size > kLargestChunk) damaged("a chunk says that it is larger than 128 MiB");
  chunk.resize(size);
  rosbag::ChunkedFile().decompress(lz4 ? rosbag::compression::LZ4 : rosbag::compression::BZ2,
                                   reinterpret_cast<std::uint8_t*>(chunk.data()), size,
                                   reinterpret_cast<std::uint8_t*>(packed.data()),
                                   static_cast<unsigned int>(packed.size()));
}

}  // namespace fsr_ros::bag_records
