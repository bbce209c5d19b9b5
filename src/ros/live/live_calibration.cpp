#include "ros/live/live_calibration.h"

#include <ros/console.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "fsr_pressure_map/ros/pressure_map_message.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/resource_path.h"
#include "ros/live/parameters.h"
#include "ros/messages/driver_messages.h"
#include "ros/messages/surface_message.h"
#include "settings/replace_file.h"
#include "settings/settings.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

// The file of a mask:
//
//     format: fsr_pressure_map mask 1
//     mask: [0, 0, 1, ...]    # one for each taxel, row-major; 1 = masked
constexpr char kMaskFormat[] = "fsr_pressure_map mask 1";

}  // namespace

void saveMask(const std::vector<std::uint8_t>& mask, const std::string& path) {
  if (path.empty()) return;
  std::string list;
  for (const std::uint8_t masked : mask)
    list += (list.empty() ? "" : ", ") + std::string(masked != 0 ? "1" : "0");
  std::error_code ignored;  // an error in the folder shows when the file is written
  fs::create_directories(fs::path(path).parent_path(), ignored);
  fsr::settings::replaceFile(path, std::string("format: ") + kMaskFormat + "\nmask: [" + list + "]\n");
}

std::vector<std::uint8_t> loadMask(const std::string& path) {
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return {};
  const auto settings = fsr::settings::Settings::fromFile(path);
  settings.choice("format", {kMaskFormat});
  std::vector<std::uint8_t> mask;
  for (const double value : settings.numbers("mask", {0, 1, ""})) mask.push_back(value != 0 ? 1 : 0);
  settings.refuseUnknown();
  return mask;
}

namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

}  // namespace

CalibrationSettings readCalibrationSettings(const ros::NodeHandle& private_handle) {
  const Parameters parameters(private_handle, {{"remember", ""}});
  CalibrationSettings s;
  s.calibration = resolveLaunchPath(parameters.text("calibration", ""));
  s.calibrator.class_hysteresis =
      parameters.number("class_hysteresis", s.calibrator.class_hysteresis, {0, 1000, "1/m"});
  s.calibrator.curvature_step =
      parameters.number("curvature_step", s.calibrator.curvature_step, {0, 1000, "1/m"});
  s.calibrator.curvature_timeout =
      parameters.number("curvature_timeout", s.calibrator.curvature_timeout, {0, kNoBound, "s"});
  s.calibrator.fill_bad_taxels = parameters.flag("fill_bad_taxels", s.calibrator.fill_bad_taxels);
  s.calibrator.temperature_margin =
      parameters.number("temperature_margin", s.calibrator.temperature_margin, {0, 1000, "K"});
  const std::string curvature = parameters.text("curvature", "published");
  if (curvature != "published" && curvature != "estimated")
    throw fsr::settings::InputError("~curvature is '" + curvature + "', but must be published or estimated");
  s.estimates_curvature = curvature == "estimated";
  s.contact_threshold = parameters.number("contact_threshold", s.contact_threshold, {0, 1e6, "Pa"});
  s.tare.limit = parameters.number("tare_limit", s.tare.limit, {0, 1e6, "Pa"});
  s.tare.scatter = parameters.number("tare_scatter", s.tare.scatter, {0, 1e6, "Pa"});
  s.tare.window = parameters.number("tare_window", s.tare.window, {0.1, 60, "s"});
  if (parameters.flag("remember", true)) {
    s.tare_file = ownFile(parameters, "tare_file", private_handle.getNamespace(), "tare");
    s.mask_file = ownFile(parameters, "mask_file", private_handle.getNamespace(), "mask");
  }
  s.queue_size =
      static_cast<std::uint32_t>(parameters.integer("queue_size", s.queue_size, {1, 100000, "messages"}));
  return s;
}

namespace {

constexpr double kComplaintPeriod = 10.0;  // [s]

using Lock = std::lock_guard<std::mutex>;

}  // namespace

LiveCalibration::LiveCalibration(const CalibrationSettings& settings)
    : settings_(settings), wanted_path_(settings.calibration), tare_(settings.tare_file) {
  complaint_ = wanted_path_.empty() ? "~calibration is empty: call ~load_calibration with the path of a file"
                                    : "loading " + wanted_path_;
  try {
    mask_ = loadMask(settings_.mask_file);
  } catch (const fsr::settings::InputError& error) {
    ROS_ERROR_STREAM("the stored mask is not used: " << error.what());
  }
  if (maskedTaxels() > 0)
    ROS_INFO_STREAM(maskedTaxels() << " taxels are masked, as " << settings_.mask_file << " says");
}

std::size_t LiveCalibration::maskedTaxels() const {
  return static_cast<std::size_t>(std::count(mask_.begin(), mask_.end(), 1));
}

void LiveCalibration::calibrate(const fsr_pressure_map::MatrixFrame& scan,
                                fsr_pressure_map::PressureMap& map) {
  const fsr::matrix::ScanView view = toScanView(scan);
  const double time = scan.header.stamp.toSec();
  const Lock lock(mutex_);
  if (loaded_) {
    loaded_->calibrator.calibrate(view, time, map_);
    map.calibration = loaded_->info.id;
    map.scheme = loaded_->info.scheme;
  } else {
    map_.reset(layoutOf(fsr::matrix::honestSize(view), board_));
    map_.state = fsr::map::MapState::kUncalibrated;
  }
  ++scans_;
  watchShape(view, time);
  if (measurement_) {
    fsr::map::PressureMap tables = map_;
    if (loaded_) loaded_->calibrator.showTables(tables);
    measured_ |= measurement_->add(tables, time);
    progress_.notify_all();
  }
  map.header = scan.header;
  fillMessage(map_, map);
}

void LiveCalibration::setSurface(const fsr_pressure_map::SurfaceCurvature& message) {
  const Lock lock(mutex_);
  surface_received_ = true;
  // Messages sent by hand (rostopic pub) have no stamp: the time of reception is used.
  surface_time_ = (message.header.stamp.isZero() ? ros::Time::now() : message.header.stamp).toSec();
  surface_complaint_.clear();
  const fsr::matrix::Surface before = surface_;
  try {
    surface_ = toSurface(message);
  } catch (const fsr::settings::InputError& error) {
    surface_ = {};
    surface_complaint_ = error.what();
  }
  if (!fsr::matrix::sameCondition(before, surface_)) {
    forgetShape();
    tare_refusal_.clear();
  }
  applySurface();
  applyTare();
}

void LiveCalibration::setTemperature(double temperature) {
  const Lock lock(mutex_);
  temperature_ = temperature;
  if (loaded_) loaded_->setTemperature(temperature_);
}

void LiveCalibration::setBoard(const fsr_pressure_map::MatrixInfo& message) {
  const Lock lock(mutex_);
  board_ = message;
  applyBoard();
  applyMask();
}

std::string LiveCalibration::load(const std::string& path) {
  std::unique_ptr<LoadedCalibration> next;
  try {
    next = loadForUse(path, settings_.calibrator);  // takes long; scans are processed meanwhile
  } catch (const fsr::settings::InputError& error) {
    const Lock lock(mutex_);
    if (!loaded_) complaint_ = error.what();
    throw;
  }
  const std::string what = describe(*next);
  {
    const Lock lock(mutex_);
    loaded_.swap(next);  // the old calibration is freed after the lock is released
    wanted_path_ = path;
    complaint_.clear();
    forgetShape();
    if (surface_received_) applySurface();
    loaded_->setTemperature(temperature_);
    applyBoard();
    applyMask();
    applyTare();
  }
  return "loaded " + path + ": " + what;
}

std::string LiveCalibration::reload() {
  std::string path;
  {
    const Lock lock(mutex_);
    path = wanted_path_;
  }
  if (path.empty()) {
    throw fsr::settings::InputError(
        "no calibration file is known; call ~load_calibration with the path of one");
  }
  return load(path);
}

void LiveCalibration::applySurface() {
  if (!loaded_) return;
  try {
    loaded_->calibrator.setSurface(surface_, surface_time_);
  } catch (const fsr::settings::InputError& error) {
    surface_complaint_ = error.what();
    surface_ = {};
    loaded_->calibrator.setSurface(surface_, surface_time_);
  }
  if (!surface_complaint_.empty()) ROS_WARN_STREAM_THROTTLE(kComplaintPeriod, surface_complaint_);
}

void LiveCalibration::applyBoard() {
  if (!loaded_) return;
  const std::string& trained = loaded_->info.sensor_serial;
  loaded_->calibrator.setWrongSensor(!trained.empty() && !board_.serial.empty() && trained != board_.serial);
}

// A taxel is masked if the board or the user masks it. A mask of another size does not belong to this
// calibration.
void LiveCalibration::applyMask() {
  if (!loaded_) return;
  std::vector<std::uint8_t> mask(loaded_->calibrator.layout().size.taxels(), 0);
  for (const auto* source : {&board_.mask, &mask_}) {
    if (source->size() != mask.size()) {
      if (!source->empty()) {
        ROS_WARN_STREAM_THROTTLE(kComplaintPeriod, "a mask of " << source->size()
                                                                << " taxels is ignored because "
                                                                << "the calibration has " << mask.size());
      }
      continue;
    }
    for (std::size_t taxel = 0; taxel < mask.size(); ++taxel) mask[taxel] |= (*source)[taxel];
  }
  loaded_->calibrator.setMask(mask);
}

void LiveCalibration::applyTare() {
  if (!loaded_) return;
  const std::vector<float> offset = tare_.review(id(), surface_received_ ? &surface_ : nullptr);
  loaded_->calibrator.setTare(offset);
}

std::string LiveCalibration::setMask(const std::vector<std::uint8_t>& mask) {
  std::vector<std::uint8_t> next = mask;
  for (std::uint8_t& masked : next) masked = masked != 0 ? 1 : 0;
  const Lock files(files_);
  {
    const Lock lock(mutex_);
    if (loaded_ && !mask.empty() && mask.size() != loaded_->calibrator.layout().size.taxels()) {
      throw fsr::settings::InputError(
          "the mask has " + std::to_string(mask.size()) + " values, but must have none, or " +
          std::to_string(loaded_->calibrator.layout().size.taxels()) + ", row-major");
    }
  }
  saveMask(next, settings_.mask_file);  // no scan waits for the disk
  const Lock lock(mutex_);
  mask_ = std::move(next);
  applyMask();
  return std::to_string(maskedTaxels()) + " taxels are masked" + storedText(settings_.mask_file);
}

// Waits while scans come, until `done`. `refused` begins the sentence of what is thrown.
void LiveCalibration::awaitScans(std::unique_lock<std::mutex>& lock, double patience,
                                 const std::string& refused, const std::function<bool()>& done) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kLongestWait{60};  // if the stamps do not advance
  const auto give_up = Clock::now() + kLongestWait;
  while (!done()) {
    const std::uint64_t seen = scans_;
    const bool came = progress_.wait_for(lock, std::chrono::duration<double>(patience),
                                         [&] { return scans_ != seen || stopping_ || done(); });
    if (stopping_) throw fsr::settings::InputError(refused + "the node is ending");
    if (!came)
      throw fsr::settings::InputError(refused + "no scan has come for a while; is the driver running?");
    if (Clock::now() > give_up)
      throw fsr::settings::InputError(refused + "there were not enough scans; do the stamps advance?");
  }
}

std::string LiveCalibration::storedText(const std::string& file) {
  return file.empty() ? "; it is forgotten when the node ends (~remember is false)" : "; stored in " + file;
}

std::string LiveCalibration::wanted() const {
  const Lock lock(mutex_);
  return loaded_ ? std::string() : wanted_path_;
}

fsr_pressure_map::CalibrationInfo LiveCalibration::info() const {
  const Lock lock(mutex_);
  return loaded_ ? loaded_->info : fsr_pressure_map::CalibrationInfo();
}

CalibrationHealth LiveCalibration::health() const {
  const Lock lock(mutex_);
  CalibrationHealth health;
  health.complaint = complaint_;
  health.surface_complaint = surface_complaint_;
  if (loaded_) {
    health.info = loaded_->info;
    health.deviation = loaded_->deviation;
    health.session_zero = loaded_->session_zero;
    health.corrects_temperature = loaded_->corrects_temperature;
    if (!loaded_->shape->present()) health.no_shape = loaded_->shape->missing;
    health.revivals = loaded_->calibrator.watch().revivals();
  }
  health.surface = surface_;
  health.board = board_.serial;
  health.temperature = temperature_;
  health.tare = tare_.tare();
  health.tare_refusal = tare_refusal_;
  health.shape = shape_;
  health.marked = marked_;
  health.estimates_curvature = settings_.estimates_curvature;
  health.scans = scans_;
  health.map = map_;
  return health;
}

}  // namespace fsr_ros
