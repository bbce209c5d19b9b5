#include "ros/messages/bent_points.h"

#include <cstring>

namespace fsr_ros {

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

}  // namespace fsr_ros
