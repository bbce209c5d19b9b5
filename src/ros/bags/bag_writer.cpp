#include "ros/bags/bag_writer.h"

#include <fcntl.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <rosbag/exceptions.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Temperature.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/messages/surface_message.h"
#include "settings/regular_file.h"

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

namespace {

constexpr std::int64_t kSecond = 1000000000;  // [ns]

ros::Time rosTime(std::int64_t stamp_ns, const std::string& path) {
  if (stamp_ns <= 0 || stamp_ns / kSecond > std::numeric_limits<std::uint32_t>::max()) {
    throw fsr::settings::InputError(path + ": a stamp of " + std::to_string(stamp_ns) +
                                    " ns cannot be written to a bag, which holds the years 1970 to 2106");
  }
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  return time;
}

fsr_pressure_map::MatrixInfo describe(const fsr::dataset::Recording& recording, const BagOptions& options) {
  fsr_pressure_map::MatrixInfo info;
  info.sensor_id = recording.sensor.sensor_id;
  info.serial = recording.sensor.serial;
  info.firmware = recording.sensor.firmware;
  info.sensor_model = recording.sensor.model;
  info.sealing = recording.sensor.sealing;
  info.transducer = recording.sensor.transducer;
  info.rows = recording.layout.size.rows;
  info.columns = recording.layout.size.columns;
  info.full_scale = recording.full_scale;
  info.pitch_x = static_cast<float>(recording.layout.pitch_x);
  info.pitch_y = static_cast<float>(recording.layout.pitch_y);
  info.reference_voltage = static_cast<float>(options.reference_voltage);
  info.feedback_resistance = static_cast<float>(options.feedback_resistance);
  info.ambient_pressure = options.ambient_pressure;
  info.mask = recording.mask;
  return info;
}

// The header of a connection whose publisher latches, as rosbag record writes it, so that a replay latches
// too. nullptr for other topics.
template <typename Message>
boost::shared_ptr<ros::M_string> latched(const std::string& topic) {
  if (topic != "matrix_info" && topic != "curvature" && topic != "session") return nullptr;
  return boost::make_shared<ros::M_string>(
      ros::M_string{{"type", ros::message_traits::datatype<Message>()},
                    {"md5sum", ros::message_traits::md5sum<Message>()},
                    {"message_definition", ros::message_traits::definition<Message>()},
                    {"latching", "1"}});
}

// Writes description, surface and session once a second; the surface also when it changes.
class Repeater {
 public:
  Repeater(const fsr::dataset::Recording& recording, const BagOptions& options)
      : recording_(recording), session_(options.session), info_(describe(recording, options)) {}

  void before(std::size_t scan, std::int64_t stamp_ns, BagWriter& bag) {
    const bool due = scan == 0 || stamp_ns - last_ns_ >= kSecond;
    const bool changed = scan > 0 && recording_.condition[scan] != recording_.condition[scan - 1];
    if (due) {
      bag.addMatrixInfo(stamp_ns, info_);
      if (!session_.session_id.empty()) bag.addSession(stamp_ns, session_);
      last_ns_ = stamp_ns;
    }
    if (due || changed) bag.addSurface(stamp_ns, recording_.conditions.at(recording_.condition[scan]));
  }

 private:
  const fsr::dataset::Recording& recording_;
  const fsr_pressure_map::Session& session_;
  fsr_pressure_map::MatrixInfo info_;
  std::int64_t last_ns_ = 0;
};

}  // namespace

BagWriter::BagWriter(const std::string& path, const std::string& topics, const std::string& frame_id)
    : path_(path), topics_(topics), frame_id_(frame_id), bag_(path) {}

template <typename Message>
void BagWriter::write(const std::string& topic, std::int64_t stamp_ns, Message& message) {
  message.header.stamp = rosTime(stamp_ns, path_);
  message.header.frame_id = frame_id_;
  add(topic, message);
}

template <typename Message>
void BagWriter::add(const std::string& topic, const Message& message) {
  const std::string name = "/" + topics_ + "/" + topic;
  bag_.write(name, message.header.stamp, message, latched<Message>(topic));
}

void BagWriter::copy(const rosbag::MessageInstance& instance) {
  bag_.write(instance.getTopic(), instance.getTime(), instance);
}

template <typename Message>
void BagWriter::replace(const rosbag::MessageInstance& instance, const Message& message) {
  bag_.write(instance.getTopic(), instance.getTime(), message, instance.getConnectionHeader());
}

template void BagWriter::replace(const rosbag::MessageInstance&, const fsr_pressure_map::MatrixFrame&);
template void BagWriter::replace(const rosbag::MessageInstance&, const fsr_pressure_map::MatrixInfo&);
template void BagWriter::add(const std::string&, const fsr_pressure_map::MatrixFrame&);
template void BagWriter::add(const std::string&, const fsr_pressure_map::MatrixInfo&);
template void BagWriter::add(const std::string&, const fsr_pressure_map::Session&);
template void BagWriter::add(const std::string&, const fsr_pressure_map::SurfaceCurvature&);
template void BagWriter::add(const std::string&, const sensor_msgs::FluidPressure&);
template void BagWriter::add(const std::string&, const sensor_msgs::Temperature&);

void BagWriter::addScan(std::int64_t stamp_ns, std::uint32_t sequence, const fsr::matrix::ScanView& scan) {
  fsr::matrix::requireSound(scan);
  fsr_pressure_map::MatrixFrame message;
  message.sequence = sequence;
  message.rows = scan.size.rows;
  message.columns = scan.size.columns;
  message.full_scale = scan.full_scale;
  message.counts.assign(scan.counts, scan.counts + scan.count);
  write("raw", stamp_ns, message);
}

void BagWriter::addChamberPressure(std::int64_t stamp_ns, double absolute_pressure, double variance) {
  sensor_msgs::FluidPressure message;
  message.fluid_pressure = absolute_pressure;
  message.variance = variance;
  write("chamber_pressure", stamp_ns, message);
}

void BagWriter::addTemperature(std::int64_t stamp_ns, double temperature) {
  sensor_msgs::Temperature message;
  message.temperature = temperature;
  write("temperature", stamp_ns, message);
}

void BagWriter::addSurface(std::int64_t stamp_ns, const fsr::matrix::Surface& surface) {
  fsr_pressure_map::SurfaceCurvature message = toMessage(surface);
  write("curvature", stamp_ns, message);
}

void BagWriter::addMatrixInfo(std::int64_t stamp_ns, fsr_pressure_map::MatrixInfo info) {
  write("matrix_info", stamp_ns, info);
}

void BagWriter::addSession(std::int64_t stamp_ns, fsr_pressure_map::Session session) {
  write("session", stamp_ns, session);
}

void BagWriter::close() {
  bag_.finish();
}

void writeBag(const std::string& path, const fsr::dataset::Recording& recording, const BagOptions& options) {
  BagWriter bag(path, options.topics);
  Repeater repeater(recording, options);
  const std::size_t taxels = recording.layout.size.taxels();
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    const std::int64_t stamp_ns = recording.start_ns + std::llround(recording.time[i] * 1e9);
    repeater.before(i, stamp_ns, bag);
    if (!recording.pressure.empty()) {
      const double absolute = recording.pressure[i] + options.ambient_pressure;
      bag.addChamberPressure(stamp_ns, absolute, options.pressure_variance);
    }
    if (!recording.temperature.empty()) bag.addTemperature(stamp_ns, recording.temperature[i]);
    bag.addScan(stamp_ns, static_cast<std::uint32_t>(i),
                {recording.layout.size, recording.full_scale, recording.scan(i), taxels});
  }
  bag.close();
}

}  // namespace fsr_ros
