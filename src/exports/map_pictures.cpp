#include "exports/map_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "view/taxel_look.h"

namespace fsr::exports {

namespace {

constexpr int kMargins = 24;  // left and right of a line [pixels]

// Rounds up to two significant digits: 301234 -> 310000.
double roundedUp(double value) {
  const double step = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::ceil(value / step - 1e-9) * step;
}

std::string timeText(std::int64_t since_ns) {
  return "t = " + settings::fixedText(1e-9 * static_cast<double>(since_ns), 2) + " s";
}

std::string peakText(const map::PressureMap& map, view::PressureUnit unit) {
  double peak = ScanRecord::kUnknown;
  for (const float pressure : map.pressure) peak = std::fmax(peak, double(pressure));
  return "peak " +
         view::limitText(peak, unit, std::any_of(map.flags.begin(), map.flags.end(), map::isLowerLimit));
}

std::string surfaceText(const matrix::Surface* surface) {
  if (surface == nullptr) return "surface unknown";
  std::string text = surface->name.empty() ? "surface without name" : surface->name;
  if (surface->mount != 0) text += ", mount " + std::to_string(surface->mount);
  return text;
}

std::string settlingPart(const map::PressureMap& map) {
  const std::string word = view::settlingWord(map::unsettledShare(map.pressure, map.flags));
  return word.empty() ? "" : ", " + word;
}

}  // namespace

void PictureSink::begin(const ExportSubject& subject) {
  if (!subject.maps) {
    throw settings::InputError(
        "holds no topic pressure_map to draw; compute the maps with --calibration FILE");
  }
  view::PressureScale scale = options_.style.scale;
  if (options_.range) {
    std::tie(scale.low, scale.high) = *options_.range;
  } else if (subject.trained_high > 0) {
    scale.high = roundedUp(subject.trained_high);
  }
  // Deviations are much smaller than pressures: a tenth of the range shows them.
  if (!options_.range && options_.style.layer == view::MapLayer::kDeviation) scale.high *= 0.1;
  painter_.setScale(scale);
  name_ = subject.name;
}

// A line that is too long for the picture ends with "...".
std::string PictureSink::fitted(const std::string& line) const {
  const int letters = (width_ - kMargins) / view::Image::textWidth("x");
  const auto most = static_cast<std::size_t>(std::max(letters, 8));
  return line.size() <= most ? line : line.substr(0, most - 3) + "...";
}

void PictureSink::add(const ScanRecord& scan) {
  if (!scan.map) return;
  if (width_ == 0) {
    size_ = scan.layout.size;
    width_ = painter_.draw(*scan.map).width();
  }
  if (scan.layout.size != size_) {
    throw settings::InputError(
        name_ + ": the matrix changes from " + matrix::sizeText(size_) + " to " +
        matrix::sizeText(scan.layout.size) +
        " taxels, but all pictures have one size; end the export before the change with --until");
  }
  const view::PressureUnit unit = painter_.style().scale.unit;
  const std::vector<std::string> lines = {
      name_,
      surfaceText(scan.surface.get()),
      timeText(scan.since_ns) + "   chamber " + view::pressureText(scan.chamber_pressure, unit),
      peakText(*scan.map, unit) + "   state " + stateWord(scan.map->state) + settlingPart(*scan.map),
  };
  std::vector<std::string> shown;
  for (const std::string& line : lines) shown.push_back(fitted(line));
  picture(scan.since_ns, painter_.draw(*scan.map, shown));
}

}  // namespace fsr::exports
