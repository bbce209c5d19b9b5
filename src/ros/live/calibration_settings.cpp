#include "ros/live/calibration_settings.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/resource_path.h"
#include "ros/live/own_file.h"

namespace fsr_ros {

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

}  // namespace fsr_ros
