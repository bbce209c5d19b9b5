#include "ros/bags/scan_source.h"

#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/Session.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Temperature.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dataset/recording_builder.h"
#include "dataset/sections.h"
#include "dataset/time_series.h"
#include "exports/scan_record.h"
#include "fsr_pressure_map/ros/pressure_map_message.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/loaded_calibration.h"
#include "ros/bags/message_events.h"
#include "ros/bags/sensor_topics.h"
#include "ros/messages/driver_messages.h"
#include "ros/messages/message_reader.h"
#include "ros/messages/surface_message.h"

namespace fsr_ros {

namespace {

constexpr std::int64_t kLongestGap = 2000000000;  // no interpolation between readings farther apart [ns]

// The label that is valid at a stamp. `first_holds_before`: the first label is also valid before its own
// stamp.
std::string at(const std::vector<std::pair<std::int64_t, std::string>>& labels, std::int64_t stamp_ns,
               bool first_holds_before) {
  const auto after =
      std::upper_bound(labels.begin(), labels.end(), stamp_ns,
                       [](std::int64_t stamp, const auto& label) { return stamp < label.first; });
  if (after != labels.begin()) return std::prev(after)->second;
  return first_holds_before && !labels.empty() ? labels.front().second : "";
}

// The topics by which an export finds a sensor: raw, or the maps.
std::vector<SensorTopics::Mark> sensorMarks(const std::string& map) {
  return {{"raw", ros::message_traits::datatype<fsr_pressure_map::MatrixFrame>()},
          {map, ros::message_traits::datatype<fsr_pressure_map::PressureMap>()}};
}

// The data of a bag other than its scans: chamber pressure and its cycles, temperature, board, session,
// events and calibration. The bag is read once, from its beginning to its end.
class ScanContext {
 public:
  // `ambient`: ambient pressure [Pa]; none = the value in matrix_info, or 101325 without one. Throws
  // fsr::InputError.
  ScanContext(const rosbag::Bag& bag, const SensorTopics& topics, std::optional<double> ambient) {
    readBoard(bag, topics);
    ambient_ = ambient                       ? *ambient
               : board_.ambient_pressure > 0 ? board_.ambient_pressure
                                             : fsr::dataset::kStandardAmbient;
    readSeries(bag, topics);
    readLabels(bag, topics);
  }

  const fsr_pressure_map::MatrixInfo& board() const { return board_; }
  const std::shared_ptr<const fsr::matrix::Surface>& firstSurface() const { return first_surface_; }

  // Description of the recording, without its name and `maps`.
  fsr::exports::ExportSubject subject() const {
    fsr::exports::ExportSubject subject;
    subject.sensor = board_.sensor_id.empty() ? board_.serial : board_.sensor_id;
    subject.model = board_.sensor_model;
    if (!calibration_.id.empty()) describe(calibration_, subject);
    return subject;
  }

  static void describe(const fsr_pressure_map::CalibrationInfo& info, fsr::exports::ExportSubject& subject) {
    subject.calibration = info.id;
    subject.scheme = info.scheme;
    subject.trained_low = info.pressure_low;
    subject.trained_high = info.pressure_high;
  }

  // Interpolated to a stamp [degree Celsius]; NaN = not known.
  double temperatureAt(std::int64_t stamp_ns) const {
    return temperature_.empty() ? fsr::exports::ScanRecord::kUnknown : temperature_.nearby(stamp_ns);
  }

  // Fills in chamber pressure, session, cycle and event.
  void complete(fsr::exports::ScanRecord& scan) const {
    if (const auto pressure = chamber_.between(scan.stamp_ns, kLongestGap)) {
      scan.chamber_pressure = *pressure - ambient_;
    }
    scan.session = at(sessions_, scan.stamp_ns, true);
    scan.event = at(events_, scan.stamp_ns, false);
    const auto cycle = std::upper_bound(cycles_.begin(), cycles_.end(), scan.stamp_ns) - cycles_.begin();
    if (!cycles_.empty()) scan.cycle = static_cast<std::size_t>(std::max<std::ptrdiff_t>(cycle, 1));
  }

 private:
  using Label = std::pair<std::int64_t, std::string>;  // stamp [ns], text that is valid from then on

  void readBoard(const rosbag::Bag& bag, const SensorTopics& topics) {
    forEach<fsr_pressure_map::MatrixInfo>(bag, topics, topics.find("matrix_info"), [&](const auto& message) {
      board_ = message;
      return false;
    });
    forEach<fsr_pressure_map::CalibrationInfo>(bag, topics, topics.find("calibration_info"),
                                               [&](const auto& message) {
                                                 calibration_ = message;
                                                 return calibration_.id.empty();
                                               });
    forEach<fsr_pressure_map::SurfaceCurvature>(
        bag, topics, topics.find("curvature"), [&](const auto& message) {
          first_surface_ = std::make_shared<fsr::matrix::Surface>(toSurface(message));
          return false;
        });
  }

  void readSeries(const rosbag::Bag& bag, const SensorTopics& topics) {
    std::vector<std::pair<std::int64_t, double>> pressure;
    forEach<sensor_msgs::FluidPressure>(
        bag, topics, topics.find("chamber_pressure"), [&](const auto& message) {
          chamber_.add(stampOf(message.header), message.fluid_pressure);
          if (std::isfinite(message.fluid_pressure)) {
            pressure.emplace_back(stampOf(message.header), message.fluid_pressure - ambient_);
          }
          return true;
        });
    forEach<sensor_msgs::Temperature>(bag, topics, topics.find("temperature"), [&](const auto& message) {
      temperature_.add(stampOf(message.header), message.temperature);
      return true;
    });
    chamber_.sort();
    temperature_.sort();
    std::sort(pressure.begin(), pressure.end());
    findCycles(pressure);
  }

  void readLabels(const rosbag::Bag& bag, const SensorTopics& topics) {
    // One session node serves all sheets of a recording; each may have events of its own besides.
    const std::string session =
        topics.findShared("session", ros::message_traits::datatype<fsr_pressure_map::Session>());
    forEach<fsr_pressure_map::Session>(bag, topics, session, [&](const auto& message) {
      if (sessions_.empty() || sessions_.back().second != message.session_id) {
        sessions_.emplace_back(stampOf(message.header), message.session_id);
      }
      return true;
    });
    std::set<std::string> events = {topics.find("events")};
    const std::string beside = session.substr(0, session.rfind('/') + 1) + "events";
    if (!session.empty() && topics.has(beside)) events.insert(beside);
    for (const std::string& topic : events) {
      forEach<fsr_pressure_map::Event>(bag, topics, topic, [&](const auto& message) {
        const bool edge = message.kind == "sync" && message.label.rfind("trigger ", 0) == 0;
        if (edge) return true;  // many a second would hide the marks
        events_.emplace_back(stampOf(message.header),
                             message.kind + (message.label.empty() ? "" : ":" + message.label));
        return true;
      });
    }
    const auto earlier = [](const Label& a, const Label& b) { return a.first < b.first; };
    std::stable_sort(sessions_.begin(), sessions_.end(), earlier);
    std::stable_sort(events_.begin(), events_.end(), earlier);
  }

  void findCycles(const std::vector<std::pair<std::int64_t, double>>& pressure) {
    std::vector<double> values;
    for (const auto& reading : pressure) values.push_back(reading.second);
    for (const std::size_t first : fsr::dataset::findCycles(values).first)
      cycles_.push_back(pressure[first].first);
  }

  // Calls `take` for each message of a topic, until it returns false.
  template <typename Message, typename Take>
  void forEach(const rosbag::Bag& bag, const SensorTopics& topics, const std::string& topic, Take take) {
    if (topic.empty()) return;
    topics.requireType(topic, ros::message_traits::datatype<Message>());
    forEachMessage(bag, {topic}, [&](const rosbag::MessageInstance& message) {
      return take(reader_.read<Message>(message));
    });
  }

  fsr_pressure_map::MatrixInfo board_;
  fsr_pressure_map::CalibrationInfo calibration_;
  double ambient_;  // [Pa]
  std::shared_ptr<const fsr::matrix::Surface> first_surface_;
  fsr::dataset::TimeSeries chamber_;  // absolute [Pa]
  fsr::dataset::TimeSeries temperature_;
  std::vector<std::int64_t> cycles_;  // stamp of the start of each cycle [ns]
  std::vector<Label> sessions_;
  std::vector<Label> events_;
  MessageReader reader_;
};

// Computes the maps of recorded scans with a calibration file.
class MapMaker {
 public:
  // Throws fsr::InputError.
  MapMaker(const ScanSelection& selection, const fsr_pressure_map::MatrixInfo& board) {
    const bool one = selection.calibrations.size() == 1 && !selection.several_sheets;
    std::string others;
    for (const std::string& path : selection.calibrations) {
      loaded_ = loadForUse(path, {});
      const std::string& of = loaded_->info.sensor_serial;
      if (one || (of == board.serial && !of.empty())) break;
      others += (others.empty() ? "" : ", ") + path + " of " + (of.empty() ? "an unknown board" : of);
      loaded_.reset();
    }
    if (selection.calibrations.empty()) return;
    if (!loaded_) {
      throw fsr::settings::InputError(
          "the sheet " + selection.topics + " has the board " + (board.serial.empty() ? "-" : board.serial) +
          ", but --calibration names " + others +
          "; give the calibration of each sheet, separated by commas, or choose one sheet with --namespace");
    }
    const std::string& serial = loaded_->info.sensor_serial;
    loaded_->calibrator.setWrongSensor(!serial.empty() && !board.serial.empty() && serial != board.serial);
    if (board.mask.size() == loaded_->calibrator.layout().size.taxels()) {
      loaded_->calibrator.setMask(board.mask);
    }
  }

  // Description of the calibration; nullptr without one.
  const fsr_pressure_map::CalibrationInfo* info() const { return loaded_ ? &loaded_->info : nullptr; }

  // Adds the map to a scan. The scans must come in time order. Throws fsr::InputError if the scan does not
  // fit the calibration.
  void make(fsr::exports::ScanRecord& scan) {
    if (!loaded_ || scan.counts.empty()) return;
    const double time = 1e-9 * static_cast<double>(scan.stamp_ns);
    if (scan.surface != surface_ && scan.surface != nullptr) {
      surface_ = scan.surface;
      loaded_->calibrator.setSurface(*surface_, time);
    }
    loaded_->setTemperature(scan.temperature);
    fsr::map::PressureMap map;
    loaded_->calibrator.calibrate({scan.layout.size, scan.full_scale, scan.counts.data(), scan.counts.size()},
                                  time, map);
    if (map.state == fsr::map::MapState::kSizeMismatch) {
      throw fsr::settings::InputError("the scans have " + fsr::matrix::sizeText(scan.layout.size) +
                                      " taxels and up to " + std::to_string(scan.full_scale) +
                                      " counts, but the calibration is for " +
                                      fsr::matrix::sizeText(loaded_->calibrator.layout().size) +
                                      " taxels or another full scale; give the calibration of this matrix");
    }
    scan.layout = map.layout;
    scan.map = std::move(map);
  }

 private:
  std::unique_ptr<LoadedCalibration> loaded_;
  std::shared_ptr<const fsr::matrix::Surface> surface_;
};

constexpr std::int64_t kPatience = 2000000000;  // how long a scan waits for its map [ns]

// Joins each scan with its map and surface by their stamps, and sends the scans on in the order of the
// stamps.
class Joiner {
 public:
  Joiner(const ScanSelection& selection, const ScanContext& context, fsr::exports::ScanSink& sink)
      : selection_(selection),
        context_(context),
        maker_(selection, context.board()),
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
    if (scan.layout.size.taxels() == 0) scan.layout = layoutOf(size, context_.board());
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
  if (!selection.calibrations.empty()) {
    if (found.raw.empty())
      throw fsr::settings::InputError("holds no topic raw, which --calibration needs to compute maps");
    found.map.clear();
  }
  if (selection.map != ScanSelection().map && found.map.empty() && selection.calibrations.empty()) {
    throw fsr::settings::InputError("holds no topic " + selection.map + ", but " + topics.list());
  }
  return found;
}

void feed(const rosbag::Bag& bag, const ScanTopics& topics, const BagWalk::ReadProgress& progress,
          Joiner& joiner) {
  std::vector<std::string> wanted;
  for (const std::string& topic : {topics.raw, topics.map, topics.curvature}) {
    if (!topic.empty()) wanted.push_back(topic);
  }
  if (wanted.empty()) return;
  MessageReader reader;
  const auto add = [&](const rosbag::MessageInstance& message) {
    const std::string& topic = message.getTopic();
    if (topic == topics.raw) joiner.add(reader.read<fsr_pressure_map::MatrixFrame>(message));
    if (topic == topics.map) joiner.add(reader.read<fsr_pressure_map::PressureMap>(message));
    if (topic == topics.curvature) joiner.add(reader.read<fsr_pressure_map::SurfaceCurvature>(message));
    return true;
  };
  forEachMessage(bag, wanted, add, progress);
}

}  // namespace

std::vector<std::string> sheetsIn(const std::string& path, const ScanSelection& selection) {
  if (!selection.topics.empty()) return {selection.topics};
  std::set<std::string> found;
  tellingOfDamage(
      path, [&] { found = SensorTopics::namespaces(typesOf(BagWalk(path)), sensorMarks(selection.map)); });
  return {found.begin(), found.end()};
}

std::size_t sendScans(const std::string& path, const ScanSelection& selection, fsr::exports::ScanSink& sink) {
  std::size_t sent = 0;
  withSoundBag(
      path,
      [&](const rosbag::Bag& bag) {
        const SensorTopics topics(typesIn(bag), selection.topics, sensorMarks(selection.map));
        const ScanTopics scans = scanTopics(topics, selection);
        ScanContext context(bag, topics, selection.ambient);
        fsr::exports::ExportSubject subject = context.subject();
        subject.name = std::filesystem::path(path).filename().string();
        subject.sheet = selection.topics;
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
