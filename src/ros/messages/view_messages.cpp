#include "ros/messages/view_messages.h"

#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>

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

namespace {

// One point as it is stored in the message.
struct Point {
  float x, y, z;    // [m]
  float intensity;  // [Pa]
  std::uint16_t row, column, flags;
  std::uint16_t padding;
};
static_assert(sizeof(Point) == 24, "there must be no gaps between the fields");

sensor_msgs::PointField field(const char* name, std::size_t offset, std::uint8_t type) {
  sensor_msgs::PointField result;
  result.name = name;
  result.offset = static_cast<std::uint32_t>(offset);
  result.datatype = type;
  result.count = 1;
  return result;
}

std::vector<sensor_msgs::PointField> fields() {
  using Field = sensor_msgs::PointField;
  return {field("x", offsetof(Point, x), Field::FLOAT32),
          field("y", offsetof(Point, y), Field::FLOAT32),
          field("z", offsetof(Point, z), Field::FLOAT32),
          field("intensity", offsetof(Point, intensity), Field::FLOAT32),
          field("row", offsetof(Point, row), Field::UINT16),
          field("column", offsetof(Point, column), Field::UINT16),
          field("flags", offsetof(Point, flags), Field::UINT16)};
}

Point pointOf(const fsr::map::PressureMap& map, const fsr::view::Vector3& position, std::size_t taxel) {
  return {static_cast<float>(position.x),
          static_cast<float>(position.y),
          static_cast<float>(position.z),
          map.pressure[taxel],
          map.layout.row({taxel}),
          map.layout.column({taxel}),
          map.flags[taxel],
          0};
}

}  // namespace

sensor_msgs::PointCloud2 toPoints(const fsr::map::PressureMap& map,
                                  const std::vector<fsr::view::TaxelPose>& poses) {
  sensor_msgs::PointCloud2 cloud;
  cloud.height = map.layout.size.rows;
  cloud.width = map.layout.size.columns;
  cloud.fields = fields();
  cloud.is_bigendian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
  cloud.point_step = sizeof(Point);
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.is_dense = true;  // every point has a position, though its pressure may be NaN
  cloud.data.resize(poses.size() * sizeof(Point));
  for (std::size_t taxel = 0; taxel < poses.size(); ++taxel) {
    const Point point = pointOf(map, poses[taxel].position, taxel);
    std::memcpy(cloud.data.data() + taxel * sizeof(Point), &point, sizeof(Point));
  }
  return cloud;
}

sensor_msgs::Image toMessage(const std_msgs::Header& header, fsr::view::Image image) {
  sensor_msgs::Image message;
  message.header = header;
  message.width = static_cast<std::uint32_t>(image.width());
  message.height = static_cast<std::uint32_t>(image.height());
  message.encoding = sensor_msgs::image_encodings::RGB8;
  message.step = message.width * 3;
  message.data = std::move(image.bytes());
  return message;
}

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

fsr_pressure_map::PressureStatistics toMessage(const fsr::map::RegionStatistics& statistics,
                                               const fsr::matrix::Layout& layout) {
  fsr_pressure_map::PressureStatistics message;
  message.region = statistics.region;
  message.peak = statistics.peak;
  message.mean = statistics.mean;
  message.standard_deviation = statistics.standard_deviation;
  message.contact_area = statistics.contact_area;
  message.total_area = statistics.total_area;
  message.force = statistics.force;
  message.pressure_time_integral = statistics.pressure_time_integral;
  message.duration = statistics.duration;
  if (layout.size.taxels() > 0) {
    message.peak_row = layout.row(statistics.peak_taxel);
    message.peak_column = layout.column(statistics.peak_taxel);
  }
  message.bad = static_cast<std::uint16_t>(std::min<std::size_t>(statistics.bad, 65535));
  message.saturated = static_cast<std::uint16_t>(std::min<std::size_t>(statistics.at_least, 65535));
  message.centre.x = statistics.centre ? statistics.centre->x : kNone;
  message.centre.y = statistics.centre ? statistics.centre->y : kNone;
  message.centre.z = statistics.centre ? 0 : kNone;
  message.alarm = static_cast<std::uint8_t>(statistics.alarm);
  return message;
}

fsr::map::RegionStatistics toStatistics(const fsr_pressure_map::PressureStatistics& message) {
  using Message = fsr_pressure_map::PressureStatistics;
  using fsr::map::AlarmState;
  static_assert(static_cast<std::uint8_t>(AlarmState::kOk) == Message::OK);
  static_assert(static_cast<std::uint8_t>(AlarmState::kAlarm) == Message::ALARM);
  static_assert(static_cast<std::uint8_t>(AlarmState::kUnknown) == Message::UNKNOWN);
  fsr::map::RegionStatistics statistics;
  statistics.region = message.region;
  statistics.peak = message.peak;
  statistics.mean = message.mean;
  statistics.standard_deviation = message.standard_deviation;
  statistics.contact_area = message.contact_area;
  statistics.total_area = message.total_area;
  statistics.force = message.force;
  statistics.pressure_time_integral = message.pressure_time_integral;
  statistics.duration = message.duration;
  statistics.bad = message.bad;
  statistics.at_least = message.saturated;
  const bool known = message.alarm <= static_cast<std::uint8_t>(AlarmState::kNotSet);
  statistics.alarm = known ? static_cast<AlarmState>(message.alarm) : AlarmState::kUnknown;
  return statistics;
}

namespace {

// The scan is drawn this far behind the sheet, in the direction of the middle taxel. Without it the two,
// which differ by hundredths of a millimetre, shine through each other in patches. About the thickness of a
// sheet [m].
constexpr double kBehind = 0.001;

geometry_msgs::Quaternion toMessage(const std::array<double, 4>& quaternion) {
  geometry_msgs::Quaternion message;
  message.x = quaternion[0];
  message.y = quaternion[1];
  message.z = quaternion[2];
  message.w = quaternion[3];
  return message;
}

template <typename Vector>
Vector toVector(const std::array<double, 3>& position) {
  Vector message;
  message.x = position[0];
  message.y = position[1];
  message.z = position[2];
  return message;
}

}  // namespace

std::string fileUrl(const std::string& path) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string url = "file://";
  for (const char letter : path) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte < 128 && (std::isalnum(byte) != 0 || std::string("/-._~").find(letter) != std::string::npos)) {
      url += letter;
    } else {
      url += {'%', kDigits[byte / 16], kDigits[byte % 16]};
    }
  }
  return url;
}

Marker toMarker(const std_msgs::Header& header, const fsr::matrix::MeshPlace& place) {
  Marker result = marker(header, "mesh", Marker::MESH_RESOURCE);
  const fsr::matrix::Pose mesh = fsr::matrix::inverse(place.matrix);
  result.pose.position = toVector<geometry_msgs::Point>(mesh.position);
  result.pose.position.z -= kBehind;
  result.pose.orientation = toMessage(mesh.quaternion);
  result.mesh_resource = fileUrl(place.file);
  result.scale.x = result.scale.y = result.scale.z = place.unit;
  result.color.r = result.color.g = result.color.b = 0.8f;
  result.color.a = 0.4f;
  return result;
}

Marker noMesh(const std_msgs::Header& header) {
  Marker result = marker(header, "mesh", Marker::MESH_RESOURCE);
  result.action = Marker::DELETE;
  result.scale = {};
  result.color = {};
  return result;
}

geometry_msgs::TransformStamped toTransform(const std_msgs::Header& header, const std::string& mesh_frame,
                                            const fsr::matrix::Pose& matrix) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = header.stamp;
  transform.header.frame_id = mesh_frame;
  transform.child_frame_id = header.frame_id;
  transform.transform.translation = toVector<geometry_msgs::Vector3>(matrix.position);
  transform.transform.rotation = toMessage(matrix.quaternion);
  return transform;
}

}  // namespace fsr_ros
