#pragma once

#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <ros/ros.h>

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "support/ros_listener.h"

namespace test_support {

constexpr std::uint16_t kRigRows = 3;
constexpr std::uint16_t kRigColumns = 4;
constexpr std::size_t kRigTaxels = 12;
constexpr std::uint16_t kRigFullScale = 1023;

/// The environment of a calibration node: it publishes a board's scans and identity and a curvature, and
/// receives the maps. It makes its own stamps, so that no test waits for a clock.
class CalibrationRig {
 public:
  explicit CalibrationRig(const std::string& map_topic = "pressure_map") {
    raw_ = handle_.advertise<fsr_pressure_map::MatrixFrame>("raw", 1000);
    info_ = handle_.advertise<fsr_pressure_map::MatrixInfo>("matrix_info", 10, true);
    curvature_ = handle_.advertise<fsr_pressure_map::SurfaceCurvature>("curvature", 10, true);
    const auto keep = [this](const fsr_pressure_map::PressureMap::ConstPtr& map) { maps_.push_back(map); };
    map_subscriber_ = handle_.subscribe<fsr_pressure_map::PressureMap>(map_topic, 1000, keep);
  }

  /// Publishes scans until a map comes back. From then on no scan is lost.
  bool connected() {
    return await([this] {
      publishScan(500);
      return !maps_.empty();
    });
  }

  fsr_pressure_map::MatrixFrame scan(const std::vector<std::uint16_t>& counts) const {
    fsr_pressure_map::MatrixFrame frame;
    frame.header.stamp = ros::Time(stamp);
    frame.header.frame_id = "sheet";
    frame.rows = kRigRows;
    frame.columns = kRigColumns;
    frame.full_scale = kRigFullScale;
    frame.counts = counts;
    return frame;
  }
  fsr_pressure_map::MatrixFrame scan(std::uint16_t code) const {
    return scan(std::vector<std::uint16_t>(kRigTaxels, code));
  }

  /// Publishes a scan 0.1 s after the last one and waits for its map. Returns an empty map if none comes.
  fsr_pressure_map::PressureMap mapOf(fsr_pressure_map::MatrixFrame frame) {
    frame.header.stamp = ros::Time(stamp += 0.1);
    raw_.publish(frame);
    const auto came = [&] { return !maps_.empty() && maps_.back()->header.stamp == frame.header.stamp; };
    return await(came) ? *maps_.back() : fsr_pressure_map::PressureMap();
  }
  fsr_pressure_map::PressureMap mapOf(std::uint16_t code) { return mapOf(scan(code)); }

  /// The first map of `code` for which `good` returns true, or after 30 s the last map.
  fsr_pressure_map::PressureMap mapWhen(
      std::uint16_t code, const std::function<bool(const fsr_pressure_map::PressureMap&)>& good) {
    fsr_pressure_map::PressureMap map;
    await([&] { return good(map = mapOf(code)); });
    return map;
  }

  void publishScan(std::uint16_t code) {
    stamp += 0.1;
    raw_.publish(scan(code));
  }

  /// Publishes a surface with the curvature `x` (one for all taxels or one for each; empty = unknown),
  /// stamped now.
  void lieOn(const std::vector<float>& x, const std::string& name = "surface", std::uint32_t mount = 1) {
    fsr_pressure_map::SurfaceCurvature message;
    message.header.stamp = ros::Time(stamp);
    message.surface = name;
    message.mount = mount;
    message.x = x;
    curvature_.publish(message);
  }

  void identify(const std::string& serial, const std::vector<std::uint8_t>& mask = {}) {
    fsr_pressure_map::MatrixInfo message;
    message.serial = serial;
    message.mask = mask;
    info_.publish(message);
  }

  const std::deque<fsr_pressure_map::PressureMap::ConstPtr>& maps() const { return maps_; }

  double stamp = 1e9;  ///< of the last scan [s]

 private:
  ros::NodeHandle handle_;
  ros::Publisher raw_, info_, curvature_;
  ros::Subscriber map_subscriber_;
  std::deque<fsr_pressure_map::PressureMap::ConstPtr> maps_;
};

}  // namespace test_support
