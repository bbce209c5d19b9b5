#include "calibration/tare.h"

#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

bool hasReading(const map::PressureMap& map, std::size_t taxel) {
  constexpr std::uint16_t kFailed = map::taxel_flag::kDead | map::taxel_flag::kStuck;
  return std::isfinite(map.pressure[taxel]) && (map.flags[taxel] & kFailed) == 0;
}

}  // namespace

double meanCurvature(const matrix::Surface& surface) {
  double sum = 0;
  for (const matrix::Curvature& curvature : surface.curvature) sum += matrix::principalCurvature(curvature);
  return surface.known() ? sum / static_cast<double>(surface.curvature.size()) : 0.0;
}

bool holds(const Tare& tare, const std::string& calibration, const matrix::Surface& surface) {
  return tare.calibration == calibration && tare.surface == surface.name && tare.mount == surface.mount &&
         std::abs(tare.curvature - meanCurvature(surface)) <= kTareCurvatureTolerance;
}

TareMeasurement::TareMeasurement(const matrix::Layout& layout, const TareOptions& options)
    : layout_(layout), options_(options), moments_(layout.size.taxels()) {}

bool TareMeasurement::add(const map::PressureMap& map, double time) noexcept {
  if (map.layout.size != layout_.size) return false;
  if (scans_ == 0 || time < start_) {
    moments_.assign(moments_.size(), {});
    scans_ = 0;
    start_ = time;
  }
  for (std::size_t taxel = 0; taxel < moments_.size(); ++taxel) {
    if (hasReading(map, taxel)) moments_[taxel].add(map.pressure[taxel]);
  }
  ++scans_;
  return scans_ >= options_.least_scans && time - start_ >= options_.window;
}

std::vector<float> TareMeasurement::offset(const std::vector<float>& standing) const {
  std::vector<float> result = standing.empty() ? std::vector<float>(moments_.size(), 0.0f) : standing;
  std::size_t read = 0;
  for (std::size_t taxel = 0; taxel < moments_.size(); ++taxel) {
    const statistics::RunningMoments& m = moments_[taxel];
    if (m.count == 0) continue;
    ++read;
    const double offset = result[taxel] + m.mean;
    if (std::abs(offset) > options_.limit) {
      throw settings::InputError("the tare is refused: " + place(taxel) + " reads " +
                                 settings::roundedKilopascals(offset, 3) + " at rest, but must be within " +
                                 settings::roundedKilopascals(options_.limit, 3) + " (~tare_limit)");
    }
    const double scatter = m.deviation();
    if (scatter > options_.scatter) {
      throw settings::InputError("the tare is refused: " + place(taxel) + " scatters by " +
                                 settings::roundedKilopascals(scatter, 3) +
                                 " as on a limb, but must be within " +
                                 settings::roundedKilopascals(options_.scatter, 3) + " (~tare_scatter)");
    }
    result[taxel] = static_cast<float>(offset);
  }
  if (read == 0)
    throw settings::InputError("the tare is refused: no taxel has a reading, but at least one must");
  return result;
}

std::string TareMeasurement::place(std::size_t taxel) const {
  return "the taxel in row " + std::to_string(layout_.row({taxel})) + ", column " +
         std::to_string(layout_.column({taxel}));
}

}  // namespace fsr::calibration
