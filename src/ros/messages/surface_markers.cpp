#include "ros/messages/surface_markers.h"

#include <cmath>

#include "view/taxel_look.h"

namespace fsr_ros {

namespace {

using visualization_msgs::Marker;

constexpr double kMarkLift =
    0.0004;                          // height of the strokes above the surface, so that they stay visible [m]
constexpr double kDotLift = 0.0015;  // height of the spheres' centres above the surface [m]

geometry_msgs::Point toPoint(const fsr::view::Vector3& v) {
  geometry_msgs::Point point;
  point.x = v.x;
  point.y = v.y;
  point.z = v.z;
  return point;
}

std_msgs::ColorRGBA toColour(fsr::view::Colour colour) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(colour.red) / 255;
  result.g = static_cast<float>(colour.green) / 255;
  result.b = static_cast<float>(colour.blue) / 255;
  result.a = 1;
  return result;
}

Marker marker(const std_msgs::Header& header, const char* space, int type) {
  Marker result;
  result.header = header;
  result.ns = space;
  result.type = type;
  result.action = Marker::ADD;
  result.pose.orientation.w = 1;
  result.scale.x = result.scale.y = result.scale.z = 1;
  result.color.r = result.color.g = result.color.b = result.color.a = 1;
  return result;
}

Marker sheet(const std_msgs::Header& header, const fsr::map::PressureMap& map,
             const fsr::view::SheetMesh& mesh, const fsr::view::HeatMapStyle& style) {
  Marker result = marker(header, "sheet", Marker::TRIANGLE_LIST);
  std::vector<fsr::view::Colour> colours;
  if (style.smooth) {
    mesh.colourSmoothly(fsr::view::layerOf(map, style.layer), style.scale, colours);
  } else {
    mesh.colourCells(fsr::view::layerOf(map, style.layer), style.scale, colours);
  }
  result.points.reserve(colours.size());
  result.colors.reserve(colours.size());
  for (const fsr::view::Vector3& corner : mesh.corners()) result.points.push_back(toPoint(corner));
  for (const fsr::view::Colour& colour : colours) result.colors.push_back(toColour(colour));
  return result;
}

Marker marks(const std_msgs::Header& header, const fsr::map::PressureMap& map,
             const fsr::view::SheetMesh& mesh, const fsr::view::HeatMapStyle& style) {
  Marker result = marker(header, "marks", Marker::LINE_LIST);
  const fsr::matrix::Layout& layout = map.layout;
  result.scale.x = 0.06 * std::min(layout.pitch_x, layout.pitch_y);
  for (std::size_t i = 0; i < map.pressure.size(); ++i) {
    const double row = layout.row({i}), column = layout.column({i});
    const double value = fsr::view::layerOf(map, style.layer)[i];
    const auto under = std::isnan(value) ? fsr::view::kNoReadingColour : style.scale.colour(value);
    for (const fsr::view::Stroke& stroke :
         fsr::view::mark(fsr::view::lookOf(map.pressure[i], map.flags[i]))) {
      for (const fsr::matrix::Position& end : {stroke.from, stroke.to}) {
        result.points.push_back(toPoint(mesh.point(row + end.y, column + end.x, kMarkLift)));
        result.colors.push_back(toColour(fsr::view::markColour(under)));
      }
    }
  }
  if (result.points.empty()) result.action = Marker::DELETE;
  return result;
}

// A small sphere on the surface at a row and column; it is deleted if they are NaN.
Marker dot(const std_msgs::Header& header, const char* space, const fsr::view::SheetMesh& mesh, double row,
           double column, fsr::view::Colour colour) {
  Marker result = marker(header, space, Marker::SPHERE);
  if (std::isnan(row) || std::isnan(column)) {
    result.action = Marker::DELETE;
    return result;
  }
  result.pose.position = toPoint(mesh.point(row, column, kDotLift));
  result.scale.x = result.scale.y = result.scale.z = 0.003;
  result.color = toColour(colour);
  return result;
}

std::string legendText(const fsr::view::HeatMapStyle& style, const fsr::map::RegionStatistics& whole,
                       const std::string& state) {
  const fsr::view::PressureUnit unit = style.scale.unit;
  std::string text = std::string(fsr::view::name(style.layer)) + ", " +
                     fsr::view::pressureText(style.scale.low, unit) + " (dark) to " +
                     fsr::view::pressureText(style.scale.high, unit) + " (bright)";
  const bool at_least = whole.at_least > 0;
  text += "\npeak " + fsr::view::limitText(whole.peak, unit, at_least) + ", mean over contact " +
          fsr::view::limitText(whole.mean, unit, at_least);
  return state.empty() ? text : text + "\n" + state;
}

Marker legend(const std_msgs::Header& header, const fsr::matrix::Layout& layout, const std::string& text) {
  Marker result = marker(header, "legend", Marker::TEXT_VIEW_FACING);
  result.text = text;
  result.scale.z = 0.005;  // height of a capital letter [m]
  result.pose.position.y = -0.5 * layout.pitch_y * layout.size.rows - 0.012;
  return result;
}

}  // namespace

std::string stateText(fsr::map::MapState state) {
  switch (state) {
    case fsr::map::MapState::kOk:
      return "";
    case fsr::map::MapState::kUncalibrated:
      return "uncalibrated: no pressure to show";
    case fsr::map::MapState::kCurvatureUnknown:
      return "curvature unknown: fallback in use";
    case fsr::map::MapState::kCurvatureStale:
      return "curvature stale";
    case fsr::map::MapState::kSizeMismatch:
      return "the calibration is for another matrix size";
    case fsr::map::MapState::kWrongSensor:
      return "the calibration belongs to another sensor";
  }
  return "unknown state";
}

std::string remarkText(const fsr::map::PressureMap& map) {
  const std::string state = stateText(map.state);
  const std::string settling = fsr::view::settlingText(fsr::map::unsettledShare(map.pressure, map.flags));
  return state + (state.empty() || settling.empty() ? "" : "; ") + settling;
}

visualization_msgs::MarkerArray toMarkers(const std_msgs::Header& header, const fsr::map::PressureMap& map,
                                          const fsr::view::SheetMesh& mesh,
                                          const fsr::view::HeatMapStyle& style,
                                          const fsr::map::RegionStatistics& whole, const std::string& state) {
  const fsr::matrix::Layout& layout = map.layout;
  const double nowhere = fsr::map::RegionStatistics::kNone;
  const fsr::matrix::Position centre = whole.centre.value_or(fsr::matrix::Position{nowhere, nowhere});
  const bool peak = !std::isnan(whole.peak);
  visualization_msgs::MarkerArray array;
  array.markers.push_back(sheet(header, map, mesh, style));  // large, so moved instead of copied from a list
  array.markers.push_back(marks(header, map, mesh, style));
  array.markers.push_back(dot(header, "centre_of_pressure", mesh,
                              centre.y / layout.pitch_y + 0.5 * (layout.size.rows - 1),
                              centre.x / layout.pitch_x + 0.5 * (layout.size.columns - 1), {255, 255, 255}));
  array.markers.push_back(dot(header, "peak", mesh, peak ? layout.row(whole.peak_taxel) : nowhere,
                              peak ? layout.column(whole.peak_taxel) : nowhere, {0, 0, 0}));
  array.markers.push_back(legend(header, layout, legendText(style, whole, state)));
  return array;
}

}  // namespace fsr_ros
