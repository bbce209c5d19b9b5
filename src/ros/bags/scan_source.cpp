#include "ros/bags/scan_source.h"

#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/SurfaceCurvature.h>

#include <cmath>
#include <deque>
#include <filesystem>
#include <map>

#include "dataset/recording_builder.h"
#include "fsr_pressure_map/ros/pressure_map_message.h"
#include "ros/bags/bag_stream.h"
#include "ros/bags/message_events.h"
#include "ros/bags/scan_context.h"
#include "ros/bags/scan_maps.h"
#include "ros/bags/sensor_topics.h"
#include "ros/messages/message_reader.h"
#include "ros/messages/surface_message.h"

namespace fsr_ros {

namespace {

constexpr std::int64_t kPatience = 2000000000;  // how long a scan waits for its map [ns]

// Joins each scan with its map and surface by their stamps, and sends the scans on in the order of the
// stamps.
class Joiner {
 public:
  Joiner(const ScanSelection& selection, const ScanContext& context, fsr::exports::ScanSink& sink)
      : selection_(selection),
        context_(context),
        maker_(selection.calibration, context.board()),
        sink_(sink),
        until_ns_(nanoseconds(selection.until)) {}

  void begin(fsr::exports::ExportSubject subject) {
    if (maker_.info() != nullptr) {
      subject.maps = true;
      context_.describe(*maker_.info(), subject);
    }
    sink_.begin(subject);
  }

  void add(const fsr_pressure_map::MatrixFrame& message) {
    fsr::matrix::requireSound(toScanView(message));
    fsr::exports::ScanRecord& scan = at(stampOf(message.header));
    requireOneSize(scan, {message.rows, message.columns});
    scan.sequence = message.sequence;
    scan.full_scale = message.full_scale;
    scan.counts = message.counts;
  }

  void add(const fsr_pressure_map::PressureMap& message) {
    fsr::map::PressureMap map = toPressureMap(message);
    fsr::exports::ScanRecord& scan = at(stampOf(message.header));
    requireOneSize(scan, map.layout.size);
    scan.layout = map.layout;
    scan.map = std::move(map);
  }

  void add(const fsr_pressure_map::SurfaceCurvature& message) {
    surfaces_.emplace_back(stampOf(message.header),
                           std::make_shared<fsr::matrix::Surface>(toSurface(message)));
  }

  std::size_t finish() {
    while (!waiting_.empty()) sendFirst();
    return sent_;
  }

 private:
  static std::int64_t nanoseconds(double seconds) {
    return seconds < 9e9 ? std::llround(seconds * 1e9) : std::numeric_limits<std::int64_t>::max();
  }

  // The record of a stamp. Sends the records that have waited long enough.
  fsr::exports::ScanRecord& at(std::int64_t stamp_ns) {
    while (!waiting_.empty() && waiting_.begin()->first < stamp_ns - kPatience) sendFirst();
    fsr::exports::ScanRecord& scan = waiting_[stamp_ns];
    scan.stamp_ns = stamp_ns;
    return scan;
  }

  void requireOneSize(fsr::exports::ScanRecord& scan, fsr::matrix::MatrixSize size) const {
    if (scan.layout.size.taxels() == 0) scan.layout = context_.layout(size);
    if (scan.layout.size == size) return;
    throw fsr::settings::InputError("the scan of " + fsr::matrix::sizeText(scan.layout.size) + " taxels at " +
                                    std::to_string(scan.stamp_ns) + " ns has a map of " +
                                    fsr::matrix::sizeText(size));
  }

  void sendFirst() {
    auto node = waiting_.extract(waiting_.begin());
    fsr::exports::ScanRecord& scan = node.mapped();
    if (!first_ns_) first_ns_ = scan.stamp_ns;
    scan.since_ns = scan.stamp_ns - *first_ns_;
    scan.surface = surfaceAt(scan.stamp_ns);
    if (scan.surface != nullptr) fsr::matrix::requireFit(*scan.surface, scan.layout.size);
    scan.temperature = context_.temperatureAt(scan.stamp_ns);
    maker_.make(scan);  // also for scans that are not exported: the checks for dead taxels need every scan
    if (!wanted(scan.since_ns)) return;
    context_.complete(scan);
    sink_.add(scan);
    ++sent_;
  }

  bool wanted(std::int64_t since_ns) {
    if (since_ns < nanoseconds(selection_.from) || since_ns > until_ns_) return false;
    if (selection_.rate <= 0) return true;
    const double due = std::floor(1e-9 * static_cast<double>(since_ns) * selection_.rate + 1e-6);
    if (due <= last_due_) return false;
    last_due_ = due;
    return true;
  }

  // The first surface is also valid before its stamp, because it is repeated each second.
  std::shared_ptr<const fsr::matrix::Surface> surfaceAt(std::int64_t stamp_ns) {
    while (!surfaces_.empty() && surfaces_.front().first <= stamp_ns) {
      surface_ = surfaces_.front().second;
      surfaces_.pop_front();
    }
    return surface_ != nullptr ? surface_ : context_.firstSurface();
  }

  const ScanSelection& selection_;
  const ScanContext& context_;
  MapMaker maker_;
  fsr::exports::ScanSink& sink_;
  std::int64_t until_ns_;
  std::map<std::int64_t, fsr::exports::ScanRecord> waiting_;
  std::deque<std::pair<std::int64_t, std::shared_ptr<const fsr::matrix::Surface>>> surfaces_;
  std::shared_ptr<const fsr::matrix::Surface> surface_;
  std::optional<std::int64_t> first_ns_;
  double last_due_ = -1;
  std::size_t sent_ = 0;
};

// The topics that are read, as the bag spells them; empty = not read.
struct ScanTopics {
  std::string raw, map, curvature;
};

ScanTopics scanTopics(const SensorTopics& topics, const ScanSelection& selection) {
  ScanTopics found;
  const auto find = [&](const std::string& base, const std::string& type) {
    const std::string topic = topics.find(base);
    if (!topic.empty()) topics.requireType(topic, type);
    return topic;
  };
  found.raw = find("raw", ros::message_traits::datatype<fsr_pressure_map::MatrixFrame>());
  found.map = find(selection.map, ros::message_traits::datatype<fsr_pressure_map::PressureMap>());
  found.curvature = find("curvature", ros::message_traits::datatype<fsr_pressure_map::SurfaceCurvature>());
  if (!selection.calibration.empty()) {
    if (found.raw.empty())
      throw fsr::settings::InputError("holds no topic raw, which --calibration needs to compute maps");
    found.map.clear();
  }
  if (selection.map != ScanSelection().map && found.map.empty() && selection.calibration.empty()) {
    throw fsr::settings::InputError("holds no topic " + selection.map + ", but " + topics.list());
  }
  return found;
}

void feed(const BagStream& bag, const ScanTopics& topics, const BagWalk::ReadProgress& progress,
          Joiner& joiner) {
  std::vector<std::string> wanted;
  for (const std::string& topic : {topics.raw, topics.map, topics.curvature}) {
    if (!topic.empty()) wanted.push_back(topic);
  }
  if (wanted.empty()) return;
  StreamQuery query{wanted};
  query.progress = progress;
  bag.forEach(query, [&](const StreamedMessage& message) {
    const std::string& topic = message.about.topic;
    if (topic == topics.raw) joiner.add(readStreamed<fsr_pressure_map::MatrixFrame>(message));
    if (topic == topics.map) joiner.add(readStreamed<fsr_pressure_map::PressureMap>(message));
    if (topic == topics.curvature) joiner.add(readStreamed<fsr_pressure_map::SurfaceCurvature>(message));
    return true;
  });
}

}  // namespace

std::size_t sendScans(const std::string& path, const ScanSelection& selection, fsr::exports::ScanSink& sink) {
  std::size_t sent = 0;
  withBagStream(
      path,
      [&](const BagStream& bag) {
        const SensorTopics topics(bag.types(), selection.topics, sensorMarks(selection.map));
        const ScanTopics scans = scanTopics(topics, selection);
        ScanContext context(bag, topics, selection.ambient);
        fsr::exports::ExportSubject subject = context.subject();
        subject.name = std::filesystem::path(path).filename().string();
        subject.maps = !scans.map.empty();
        Joiner joiner(selection, context, sink);
        joiner.begin(subject);
        feed(bag, scans, told("exporting " + path, selection.progress), joiner);
        sent = joiner.finish();
      },
      told("checking " + path, selection.progress));
  return sent;
}

}  // namespace fsr_ros
