#include "ros/bags/scan_context.h"

#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/Session.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Temperature.h>

#include <algorithm>
#include <cmath>

#include "dataset/recording_builder.h"
#include "dataset/sections.h"
#include "ros/messages/surface_message.h"

namespace fsr_ros {

namespace {

constexpr std::int64_t kLongestGap = 2000000000;  // no interpolation between readings farther apart [ns]

std::int64_t stampOf(const std_msgs::Header& header) {
  return static_cast<std::int64_t>(header.stamp.toNSec());
}

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

}  // namespace

std::vector<SensorTopics::Mark> sensorMarks(const std::string& map) {
  return {{"raw", ros::message_traits::datatype<fsr_pressure_map::MatrixFrame>()},
          {map, ros::message_traits::datatype<fsr_pressure_map::PressureMap>()}};
}

ScanContext::ScanContext(const BagStream& bag, const SensorTopics& topics, std::optional<double> ambient) {
  readBoard(bag, topics);
  ambient_ = ambient                       ? *ambient
             : board_.ambient_pressure > 0 ? board_.ambient_pressure
                                           : fsr::dataset::kStandardAmbient;
  readSeries(bag, topics);
  readLabels(bag, topics);
}

// Calls `take` for each message of a topic, until it returns false.
template <typename Message, typename Take>
void ScanContext::forEach(const BagStream& bag, const SensorTopics& topics, const std::string& base,
                          Take take) {
  const std::string topic = topics.find(base);
  if (topic.empty()) return;
  topics.requireType(topic, ros::message_traits::datatype<Message>());
  bag.forEach({{topic}},
              [&](const StreamedMessage& message) { return take(readStreamed<Message>(message)); });
}

void ScanContext::readBoard(const BagStream& bag, const SensorTopics& topics) {
  forEach<fsr_pressure_map::MatrixInfo>(bag, topics, "matrix_info", [&](const auto& message) {
    board_ = message;
    return false;
  });
  forEach<fsr_pressure_map::CalibrationInfo>(bag, topics, "calibration_info", [&](const auto& message) {
    calibration_ = message;
    return calibration_.id.empty();
  });
  forEach<fsr_pressure_map::SurfaceCurvature>(bag, topics, "curvature", [&](const auto& message) {
    first_surface_ = std::make_shared<fsr::matrix::Surface>(toSurface(message));
    return false;
  });
}

void ScanContext::readSeries(const BagStream& bag, const SensorTopics& topics) {
  std::vector<std::pair<std::int64_t, double>> pressure;
  forEach<sensor_msgs::FluidPressure>(bag, topics, "chamber_pressure", [&](const auto& message) {
    chamber_.add(stampOf(message.header), message.fluid_pressure);
    if (std::isfinite(message.fluid_pressure)) {
      pressure.emplace_back(stampOf(message.header), message.fluid_pressure - ambient_);
    }
    return true;
  });
  forEach<sensor_msgs::Temperature>(bag, topics, "temperature", [&](const auto& message) {
    temperature_.add(stampOf(message.header), message.temperature);
    return true;
  });
  chamber_.sort();
  temperature_.sort();
  std::sort(pressure.begin(), pressure.end());
  findCycles(pressure);
}

void ScanContext::findCycles(const std::vector<std::pair<std::int64_t, double>>& pressure) {
  std::vector<double> values;
  for (const auto& reading : pressure) values.push_back(reading.second);
  for (const std::size_t first : fsr::dataset::findCycles(values).first)
    cycles_.push_back(pressure[first].first);
}

void ScanContext::readLabels(const BagStream& bag, const SensorTopics& topics) {
  forEach<fsr_pressure_map::Session>(bag, topics, "session", [&](const auto& message) {
    if (sessions_.empty() || sessions_.back().second != message.session_id) {
      sessions_.emplace_back(stampOf(message.header), message.session_id);
    }
    return true;
  });
  forEach<fsr_pressure_map::Event>(bag, topics, "events", [&](const auto& message) {
    events_.emplace_back(stampOf(message.header),
                         message.kind + (message.label.empty() ? "" : ":" + message.label));
    return true;
  });
  const auto earlier = [](const Label& a, const Label& b) { return a.first < b.first; };
  std::stable_sort(sessions_.begin(), sessions_.end(), earlier);
  std::stable_sort(events_.begin(), events_.end(), earlier);
}

fsr::matrix::Layout ScanContext::layout(fsr::matrix::MatrixSize size) const {
  fsr::matrix::Layout layout{size};
  if (board_.pitch_x > 0) layout.pitch_x = board_.pitch_x;
  if (board_.pitch_y > 0) layout.pitch_y = board_.pitch_y;
  return layout;
}

fsr::exports::ExportSubject ScanContext::subject() const {
  fsr::exports::ExportSubject subject;
  subject.sensor = board_.sensor_id.empty() ? board_.serial : board_.sensor_id;
  subject.model = board_.sensor_model;
  if (!calibration_.id.empty()) describe(calibration_, subject);
  return subject;
}

void ScanContext::describe(const fsr_pressure_map::CalibrationInfo& info,
                           fsr::exports::ExportSubject& subject) {
  subject.calibration = info.id;
  subject.scheme = info.scheme;
  subject.trained_low = info.pressure_low;
  subject.trained_high = info.pressure_high;
}

double ScanContext::temperatureAt(std::int64_t stamp_ns) const {
  return temperature_.empty() ? fsr::exports::ScanRecord::kUnknown : temperature_.nearby(stamp_ns);
}

void ScanContext::complete(fsr::exports::ScanRecord& scan) const {
  if (const auto pressure = chamber_.between(scan.stamp_ns, kLongestGap)) {
    scan.chamber_pressure = *pressure - ambient_;
  }
  scan.session = at(sessions_, scan.stamp_ns, true);
  scan.event = at(events_, scan.stamp_ns, false);
  const auto cycle = std::upper_bound(cycles_.begin(), cycles_.end(), scan.stamp_ns) - cycles_.begin();
  if (!cycles_.empty()) scan.cycle = static_cast<std::size_t>(std::max<std::ptrdiff_t>(cycle, 1));
}

}  // namespace fsr_ros
