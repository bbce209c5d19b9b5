#include "calibration/stages/shape/rest_window.h"

#include <limits>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::calibration {

RestWindow::RestWindow(const ShapeModel& model, const TareOptions& options)
    : layout_(model.layout),
      full_scale_(model.full_scale),
      scale_(model.scale),
      options_(options),
      moments_(model.used.size()),
      zeros_(model.used.size(), 0.0) {}

bool RestWindow::add(const matrix::ScanView& scan, const std::vector<std::uint8_t>& ignored, double time) {
  if (scan.size != layout_.size || scan.full_scale != full_scale_ || scan.count != moments_.size())
    return false;
  if (scans_ == 0 || time < last_) {
    moments_.assign(moments_.size(), {});
    zeros_.assign(zeros_.size(), 0.0);
    scans_ = 0;
    start_ = time;
  }
  last_ = time;
  ++scans_;
  for (std::size_t t = 0; t < moments_.size(); ++t) {
    if (t < ignored.size() && ignored[t] != 0) continue;
    moments_[t].add(scan.counts[t]);
    zeros_[t] += scan.counts[t] == 0 ? 1 : 0;
  }
  return scans_ >= options_.least_scans && time - start_ >= options_.window;
}

RestReading RestWindow::reading() const {
  RestReading rest;
  double widest = 0;
  std::size_t worst = 0;
  for (std::size_t t = 0; t < moments_.size(); ++t) {
    const statistics::RunningMoments& m = moments_[t];
    rest.reading.push_back(m.count > 0 ? m.mean : std::numeric_limits<double>::quiet_NaN());
    rest.zero.push_back(zeros_[t] > kCutShare * m.count ? 1 : 0);
    const double deviation = m.deviation() * scale_[t] / full_scale_;
    if (deviation <= widest) continue;
    widest = deviation;
    worst = t;
  }
  if (widest > options_.scatter) {
    throw settings::InputError(
        "how the sheet lies cannot be told: taxel (" + std::to_string(layout_.row({worst})) + ", " +
        std::to_string(layout_.column({worst})) + ") scatters by " + settings::roundedText(widest / 1000, 2) +
        " kPa, so the sheet is not at rest; unload it");
  }
  return rest;
}

}  // namespace fsr::calibration
