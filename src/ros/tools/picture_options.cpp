#include "ros/tools/picture_options.h"

#include <sstream>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

namespace {

// "LOW,HIGH" [Pa].
std::pair<double, double> rangeOf(const fsr::settings::CommandLine& line) {
  std::istringstream text(line.text("range", ""));
  double low = 0, high = 0;
  char comma = 0;
  if ((text >> low >> comma >> high) && comma == ',' && text.peek() == EOF && low < high) return {low, high};
  throw fsr::settings::InputError("--range is \"" + line.text("range", "") +
                                  "\", but must be two pressures in Pa, the lower first, e.g. 0,600000");
}

bool isSecond(const fsr::settings::CommandLine& line, const std::string& option, const std::string& first,
              const std::string& second) {
  const std::string word = line.text(option, first);
  if (word == first || word == second) return word == second;
  throw fsr::settings::InputError("--" + option + " is \"" + word + "\", but must be " + first + " or " +
                                  second);
}

}  // namespace

fsr::exports::PictureOptions pictureOptions(const fsr::settings::CommandLine& line) {
  fsr::exports::PictureOptions pictures;
  if (line.has("range")) pictures.range = rangeOf(line);
  fsr::view::HeatMapStyle& style = pictures.style;
  style.scale.unit = fsr::view::pressureUnitOf(line.text("unit", "kPa"));
  style.scale.colours = fsr::view::colourMapOf(line.text("colour-map", "viridis"));
  style.smooth = !isSecond(line, "style", "smooth", "cells");
  if (isSecond(line, "layer", "pressure", "deviation")) style.layer = fsr::view::MapLayer::kDeviation;
  style.longer_side = static_cast<int>(line.integer("size", 400, {160, 4096, "pixels"}));
  pictures.rate = line.number("rate", pictures.rate, {1e-3, 1e3, "Hz"});
  return pictures;
}

void declarePictureOptions(fsr::settings::CommandLine& line) {
  line.option("range", "LOW,HIGH",
              "pictures: range of the colour scale [Pa] (0 to the largest trained pressure; a tenth of it "
              "for the deviation)")
      .option("unit", "NAME", "pictures: kPa or mmHg (kPa)")
      .option("colour-map", "NAME", "pictures: viridis or cividis (viridis)")
      .option("style", "NAME", "pictures: smooth, or cells: one square for each taxel (smooth)")
      .option("layer", "NAME",
              "pictures: pressure, or deviation: the standard deviation of a reading (pressure)")
      .option("size", "PIXELS", "pictures: length of the matrix's longer side (400)");
}

std::vector<std::string> pictureOptionNames() {
  return {"range", "unit", "colour-map", "style", "layer", "size"};
}

}  // namespace fsr_ros
