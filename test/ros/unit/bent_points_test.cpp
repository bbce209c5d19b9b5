#include "ros/messages/view_messages.h"

#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <cmath>

namespace fsr_ros {
namespace {

TEST(BentPoints, HavePositionPressureAndFlagsOfEachTaxel) {
  fsr::map::PressureMap map;
  map.reset({{2, 3}, 0.010, 0.012});
  map.pressure = {0, 1e3f, 2e3f, 3e3f, NAN, 5e3f};
  map.flags[4] = fsr::map::taxel_flag::kDead;
  const sensor_msgs::PointCloud2 cloud = toPoints(map, fsr::view::bendSheet(map.layout, {}));

  EXPECT_EQ(cloud.height, 2u);
  EXPECT_EQ(cloud.width, 3u);
  ASSERT_EQ(cloud.data.size(), 6u * cloud.point_step);
  sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"), y(cloud, "y"), z(cloud, "z");
  sensor_msgs::PointCloud2ConstIterator<float> intensity(cloud, "intensity");
  sensor_msgs::PointCloud2ConstIterator<std::uint16_t> row(cloud, "row"), column(cloud, "column"),
      flags(cloud, "flags");
  EXPECT_FLOAT_EQ(x[0], -0.010f);
  EXPECT_FLOAT_EQ(y[0], -0.006f);
  EXPECT_FLOAT_EQ(z[0], 0.0f);
  x += 5, y += 5, intensity += 5, row += 4, column += 4, flags += 4;
  EXPECT_FLOAT_EQ(x[0], 0.010f);
  EXPECT_FLOAT_EQ(y[0], 0.006f);
  EXPECT_EQ(intensity[0], 5e3f);
  EXPECT_EQ(row[0], 1);
  EXPECT_EQ(column[0], 1);
  EXPECT_EQ(flags[0], fsr::map::taxel_flag::kDead);
}

}  // namespace
}  // namespace fsr_ros
