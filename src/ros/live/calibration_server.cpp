#include <diagnostic_updater/diagnostic_updater.h>
#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/LoadFile.h>
#include <fsr_pressure_map/SetMask.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Temperature.h>
#include <boost/make_shared.hpp>

#include <filesystem>
#include <functional>
#include <string>

#include "ros/bags/resource_path.h"
#include "ros/live/calibration_health.h"
#include "ros/live/live_calibration.h"
#include "ros/live/serve.h"
#include "ros/messages/surface_message.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr double kPatience = 5.0;      // a tare gives up after this time without a scan [s]
constexpr double kWatchPeriod = 0.25;  // period of looking for a file that could not be loaded [s]
constexpr std::uint32_t kEventQueue = 100;
constexpr double kSecond = 1.0;  // [s]

// A text that changes when the file changes.
std::string fingerprint(const std::string& path) {
  std::error_code error;
  const auto time = fs::last_write_time(path, error).time_since_epoch().count();
  if (error) return path + " is missing";
  const auto size = fs::file_size(path, error);
  return path + " " + std::to_string(time) + " " + std::to_string(size);
}

class CalibrationServer {
 public:
  CalibrationServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
      : handle_(handle),
        private_handle_(private_handle),
        settings_(readCalibrationSettings(private_handle)),
        live_(settings_),
        diagnostics_(handle, private_handle, private_handle.getNamespace()),
        slow_thread_(1, &slow_queue_) {
    advertise();
    serve();
    subscribe();
    slow_thread_.start();
    ROS_INFO_STREAM(private_handle_.getNamespace() << ": waiting for scans on " << scans_.getTopic());
  }

  ~CalibrationServer() {
    live_.stop();  // otherwise a tare that waits for scans would block the thread
    slow_thread_.stop();
  }

 private:
  void advertise() {
    maps_ = handle_.advertise<fsr_pressure_map::PressureMap>("pressure_map", settings_.queue_size);
    info_ = handle_.advertise<fsr_pressure_map::CalibrationInfo>("calibration_info", 10, true);
    diagnostics_.add("calibration", [this](auto& status) { judgeCalibration(now_, status); });
    diagnostics_.add("maps", [this](auto& status) {
      judgeMaps(before_, now_, kSecond, scans_.getTopic(), settings_.contact_threshold, status);
    });
    if (settings_.estimates_curvature)
      estimated_ = handle_.advertise<fsr_pressure_map::SurfaceCurvature>("curvature", 10, true);
    second_ = handle_.createWallTimer(ros::WallDuration(kSecond),
                                      [this](const ros::WallTimerEvent&) { everySecond(); });
  }

  void serve() {
    ros::NodeHandle slow(private_handle_);
    slow.setCallbackQueue(&slow_queue_);
    services_ = {slow.advertiseService("load_calibration", &CalibrationServer::loadCalibration, this),
                 slow.advertiseService("set_mask", &CalibrationServer::setMask, this),
                 advertiseTrigger(slow, "reload", [this] { return reload(); }),
                 advertiseTrigger(slow, "tare", [this] { return live_.tare(kPatience); }),
                 advertiseTrigger(slow, "check_surface", [this] { return live_.checkSurface(kPatience); }),
                 advertiseTrigger(slow, "estimate_surface", [this] { return useEstimate(false); }),
                 advertiseTrigger(slow, "clear_tare", [this] { return live_.clearTare(); })};
    watch_ = slow.createWallTimer(ros::WallDuration(kWatchPeriod), [this](const ros::WallTimerEvent&) {
      tryWanted();
      live_.removeDroppedTare();
      live_.compareAtRest();
      compareAtMark();
    });
  }

  void subscribe() {
    const auto at_once = ros::TransportHints().tcpNoDelay();
    curvature_ = handle_.subscribe("curvature", 10, &CalibrationServer::onCurvature, this, at_once);
    board_ = handle_.subscribe<fsr_pressure_map::MatrixInfo>(
        "matrix_info", 10,
        [this](const fsr_pressure_map::MatrixInfoConstPtr& info) { live_.setBoard(*info); });
    temperature_ = handle_.subscribe<sensor_msgs::Temperature>(
        "temperature", 10, [this](const sensor_msgs::TemperatureConstPtr& message) {
          live_.setTemperature(message->temperature);
        });
    chamber_ = handle_.subscribe<sensor_msgs::FluidPressure>(
        "chamber_pressure", 10, [this](const sensor_msgs::FluidPressureConstPtr& message) {
          live_.setChamber(message->fluid_pressure);
        });
    events_ = handle_.subscribe("events", kEventQueue, &CalibrationServer::onEvent, this);
    scans_ = handle_.subscribe("raw", settings_.queue_size, &CalibrationServer::onScan, this, at_once);
  }

  void onScan(const fsr_pressure_map::MatrixFrameConstPtr& scan) {
    const auto map = boost::make_shared<fsr_pressure_map::PressureMap>();
    live_.calibrate(*scan, *map);
    maps_.publish(map);
  }

  void onCurvature(const fsr_pressure_map::SurfaceCurvatureConstPtr& message) { live_.setSurface(*message); }

  void everySecond() {
    publishInfo();
    before_ = std::move(now_);
    now_ = live_.health();
    diagnostics_.setHardwareID(now_.board.empty() ? scans_.getTopic() : now_.board);
    diagnostics_.force_update();
    logChange();
  }

  void tryWanted() {
    const std::string path = live_.wanted();
    if (path.empty()) return;
    const std::string now = fingerprint(path);
    if (now == tried_) return;
    tried_ = now;
    fsr_pressure_map::LoadFile::Response reply;
    answer(reply, [&] {
      try {
        return live_.load(path);
      } catch (const fsr::settings::InputError& error) {
        throw fsr::settings::InputError(std::string(error.what()) +
                                        "; the node tries again when the file changes");
      }
    });
    if (reply.success) publishInfo();
  }

  void onEvent(const fsr_pressure_map::EventConstPtr& event) {
    if (event->kind == "don") live_.markLoaded();
    if (event->kind == "doff") live_.markUnloaded();
  }

  // A rest that the operator marked: compared, and estimated if this node is the source of the curvature.
  // After a tare only compared: another surface would end the tare.
  void compareAtMark() {
    const std::string done = live_.answerMark([this](RestMark mark) {
      const bool estimates = settings_.estimates_curvature && mark == RestMark::kDoff;
      return estimates ? useEstimate(true) : live_.checkSurface(kPatience);
    });
    if (!done.empty()) ROS_INFO_STREAM(private_handle_.getNamespace() << ": " << done);
  }

  // The estimate is published, and comes back as any other curvature. `only_if_it_differs`: where the sheet
  // agrees with the curvature in use, that one stays, and with it the number of the mount and the tare.
  std::string useEstimate(bool only_if_it_differs) {
    std::string sentence;
    fsr::matrix::Surface surface = live_.estimateSurface(kPatience, sentence);
    if (!settings_.estimates_curvature) {
      return sentence +
             "; it is not used, because another node publishes the curvature: start with "
             "curvature:=estimated to use it";
    }
    if (only_if_it_differs && live_.restAgrees()) return sentence + "; the curvature in use stays";
    surface.mount = ++estimates_;
    fsr_pressure_map::SurfaceCurvature message = toMessage(surface);
    message.header.stamp = ros::Time::now();
    estimated_.publish(message);
    return sentence + "; it is used from now on, as mount " + std::to_string(surface.mount);
  }

  void publishInfo() {
    fsr_pressure_map::CalibrationInfo info = live_.info();
    info.header.stamp = ros::Time::now();
    info_.publish(info);
  }

  // Called once a second, so that frequent changes do not flood the log.
  void logChange() {
    const std::string sentence = stateSentence(now_);
    if (now_.scans == 0 || sentence == logged_) return;
    logged_ = sentence;
    if (sentence.empty()) {
      ROS_INFO_STREAM(private_handle_.getNamespace() << ": maps are calibrated");
    } else {
      ROS_WARN_STREAM(private_handle_.getNamespace() << ": " << sentence);
    }
  }

  bool loadCalibration(fsr_pressure_map::LoadFile::Request& request,
                       fsr_pressure_map::LoadFile::Response& response) {
    answer(response, [&] {
      if (request.path.empty())
        throw fsr::settings::InputError("path is empty, but must name a calibration file");
      return live_.load(resolveResource(request.path));
    });
    if (!response.success) {
      const std::string used = live_.info().path;
      response.message += used.empty() ? "; no calibration is loaded" : "; still in use: " + used;
    }
    publishInfo();
    return true;
  }

  std::string reload() {
    const std::string done = live_.reload();
    publishInfo();
    return done;
  }

  bool setMask(fsr_pressure_map::SetMask::Request& request, fsr_pressure_map::SetMask::Response& response) {
    return answer(response, [&] { return live_.setMask(request.mask); });
  }

  ros::NodeHandle handle_;
  ros::NodeHandle private_handle_;
  CalibrationSettings settings_;
  LiveCalibration live_;
  std::string logged_ = "nothing";  // sentence about the maps that was logged last
  std::string tried_;               // fingerprint of the wanted file at the last attempt

  ros::Publisher maps_;
  ros::Publisher info_;
  ros::Subscriber scans_;
  ros::Subscriber curvature_;
  ros::Subscriber board_;
  ros::Subscriber temperature_;
  ros::Subscriber chamber_;
  ros::Subscriber events_;
  ros::Publisher estimated_;     // of the curvature, if this node is its source
  std::uint32_t estimates_ = 0;  // number of the mount that was estimated last

  diagnostic_updater::Updater diagnostics_;
  CalibrationHealth before_;  // one second before now_
  CalibrationHealth now_;
  ros::WallTimer second_;

  ros::CallbackQueue slow_queue_;  // for services and loading
  ros::WallTimer watch_;
  std::vector<ros::ServiceServer> services_;
  ros::AsyncSpinner slow_thread_;  // last: it uses everything above
};

}  // namespace

Server makeCalibrationServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle) {
  return std::make_shared<CalibrationServer>(handle, private_handle);
}

}  // namespace fsr_ros
