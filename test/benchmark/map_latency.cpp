// Time from publishing a scan to receiving its pressure map, both in this process. The calibration runs as a
// separate node (two hops over TCP) or, with --nodelet, inside this process (no copy, no socket). Start it
// with map_latency.launch.

#include <fsr_pressure_map/LoadFile.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <nodelet/loader.h>
#include <ros/ros.h>
#include <unistd.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "support/small_calibration.h"

namespace {

using Clock = std::chrono::steady_clock;
using fsr_pressure_map::MatrixFrame;
using fsr_pressure_map::PressureMap;

constexpr std::uint16_t kFullScale = 4095;
constexpr int kWarmUp = 100;  // scans that are not counted

struct Plan {
  int rows, columns, scans;
  double rate;  // [1/s]
};

/// The stamp of each scan is its number, so that a map shows which scan it belongs to.
class Stopwatch {
 public:
  explicit Stopwatch(int scans) : sent_(scans), received_(scans) {}

  void send(int scan) { sent_[scan] = Clock::now(); }
  void receive(const PressureMap::ConstPtr& map) {
    const Clock::time_point now = Clock::now();
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::size_t scan = map->header.stamp.sec - 1;
    if (scan < received_.size()) received_[scan] = now;
  }

  bool cameBack(int scan) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return received_[scan] != Clock::time_point{};
  }

  void print() const {
    std::vector<double> latency;  // [us]
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t i = kWarmUp; i < sent_.size(); ++i) {
      if (received_[i] == Clock::time_point{}) continue;
      latency.push_back(std::chrono::duration<double, std::micro>(received_[i] - sent_[i]).count());
    }
    std::sort(latency.begin(), latency.end());
    const auto quantile = [&](double q) { return latency[std::size_t(q * double(latency.size() - 1))]; };
    const std::size_t sent = sent_.size() - kWarmUp;
    if (latency.empty()) std::printf("no map came back\n");
    if (latency.empty()) return;
    std::printf("publish to map: median %.0f us, p99 %.0f us, longest %.0f us; %zu of %zu maps came\n",
                quantile(0.5), quantile(0.99), latency.back(), latency.size(), sent);
  }

 private:
  std::vector<Clock::time_point> sent_;
  std::vector<Clock::time_point> received_;
  mutable std::mutex mutex_;
};

void loadCalibration(const fsr::matrix::MatrixSize& size) {
  const auto path = std::filesystem::temp_directory_path() / ("map_latency_" + std::to_string(getpid()));
  const std::vector<double> curvatures = {0.0, 1 / 0.13, 1 / 0.11, 1 / 0.09, 1 / 0.07, 1 / 0.05};
  fsr::calibration::saveCalibration(test_support::smallCalibration(size, curvatures, "", kFullScale), path);
  fsr_pressure_map::LoadFile call;
  call.request.path = path;
  ros::service::waitForService("calibration/load_calibration");
  if (!ros::service::call("calibration/load_calibration", call) || !call.response.success) {
    ROS_FATAL_STREAM(call.response.message);
  }
  std::filesystem::remove(path);
}

MatrixFrame::Ptr scanOf(const Plan& plan, int number) {
  const auto scan = boost::make_shared<MatrixFrame>();
  scan->header.stamp.sec = std::uint32_t(number + 1);
  scan->rows = std::uint16_t(plan.rows);
  scan->columns = std::uint16_t(plan.columns);
  scan->full_scale = kFullScale;
  scan->counts.assign(std::size_t(plan.rows) * plan.columns, std::uint16_t(number % kFullScale));
  return scan;
}

void publishScans(const ros::Publisher& raw, const Plan& plan, Stopwatch& watch) {
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / plan.rate));
  while (!watch.cameBack(0) && ros::ok()) {  // until all connections are made
    raw.publish(scanOf(plan, 0));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  Clock::time_point next = Clock::now();
  for (int i = 1; i < plan.scans && ros::ok(); ++i) {
    std::this_thread::sleep_until(next += period);
    const MatrixFrame::Ptr scan = scanOf(plan, i);
    watch.send(i);
    raw.publish(scan);
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));  // for the last maps
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "map_latency");
  ros::NodeHandle handle, parameters("~");
  const Plan plan{parameters.param("rows", 7), parameters.param("columns", 10),
                  parameters.param("scans", 2000) + kWarmUp, parameters.param("rate", 100.0)};
  std::unique_ptr<nodelet::Loader> loader;
  if (parameters.param("nodelet", false)) {
    loader = std::make_unique<nodelet::Loader>(parameters);
    loader->load(handle.resolveName("calibration"), "fsr_pressure_map/calibration", {}, {});
  }
  ros::AsyncSpinner spinner(1);
  spinner.start();
  loadCalibration({std::uint16_t(plan.rows), std::uint16_t(plan.columns)});

  Stopwatch watch(plan.scans);
  const auto receive = [&](const PressureMap::ConstPtr& map) { watch.receive(map); };
  const ros::Subscriber eye = handle.subscribe<PressureMap>("pressure_map", 1000, receive, nullptr,
                                                            ros::TransportHints().tcpNoDelay());
  const ros::Publisher raw = handle.advertise<MatrixFrame>("raw", 1000);
  publishScans(raw, plan, watch);
  watch.print();
  return 0;
}
