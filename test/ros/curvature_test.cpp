#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/Mark.h>
#include <fsr_pressure_map/Session.h>
#include <fsr_pressure_map/SetSurface.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>
#include <visualization_msgs/Marker.h>

#include <filesystem>
#include <fstream>

#include "support/ros_listener.h"

namespace {

using fsr_pressure_map::SurfaceCurvature;

SurfaceCurvature setSurface(const std::string& surface, std::uint32_t mount, std::string* reply = nullptr) {
  fsr_pressure_map::SetSurface::Request request;
  request.surface = surface;
  request.mount = mount;
  const auto response = test_support::call<fsr_pressure_map::SetSurface>("curvature/set_surface", request);
  if (reply != nullptr) *reply = response.message;
  const auto message = ros::topic::waitForMessage<SurfaceCurvature>("curvature", ros::Duration(30));
  return message ? *message : SurfaceCurvature();
}

TEST(CurvatureNode, PublishesTheSurfaceNamedByTheService) {
  const SurfaceCurvature message = setSurface("cylinder_5cm", 4);
  EXPECT_EQ(message.surface, "cylinder_5cm");
  EXPECT_EQ(message.mount, 4u);
  ASSERT_EQ(message.x.size(), 1u);
  EXPECT_FLOAT_EQ(message.x[0], 20.0f);
  EXPECT_FLOAT_EQ(message.y[0], 0.0f);
}

TEST(CurvatureNode, IncreasesTheMountByOneIfNoneIsGiven) {
  setSurface("flat", 7);
  EXPECT_EQ(setSurface("cylinder_9cm", 0).mount, 8u);
}

TEST(CurvatureNode, RefusesAnUnknownSurfaceAndKeepsTheOldOne) {
  setSurface("flat", 2);
  std::string reply;
  EXPECT_EQ(setSurface("cylinder_6cm", 3, &reply).surface, "flat");
  EXPECT_NE(reply.find("cylinder_6cm"), std::string::npos);
  EXPECT_NE(reply.find("cylinder_7cm"), std::string::npos) << "lists what there is: " << reply;
}

TEST(CurvatureNode, RefusesLoopsOfLinksAndLongNamesInASentence) {
  setSurface("flat", 2);
  const auto loop = std::filesystem::temp_directory_path() / ("loop_" + std::to_string(::getpid()) + ".yaml");
  std::filesystem::create_symlink(loop, loop);
  for (const std::string& name : {loop.string(), std::string(300, 'x'), "/tmp/" + std::string(5000, 'x')}) {
    std::string reply;
    EXPECT_EQ(setSurface(name, 3, &reply).surface, "flat");
    EXPECT_NE(reply.find("there is no file"), std::string::npos) << reply;
    EXPECT_NE(reply.find("the surface is still flat"), std::string::npos) << reply;
  }
  std::filesystem::remove(loop);
}

TEST(CurvatureNode, TakesAFileWithAValueForEachTaxel) {
  const auto path =
      std::filesystem::temp_directory_path() / ("limb_surface_" + std::to_string(::getpid()) + ".yaml");
  std::ofstream file(path);
  file << "surface: limb\ntaxels:\n  x: [";
  for (int i = 0; i < 70; ++i) file << (i != 0 ? ", " : "") << i * 0.25;
  file << "]\n";
  file.close();
  const SurfaceCurvature message = setSurface(path.string(), 1);
  ASSERT_EQ(message.x.size(), 70u);
  EXPECT_FLOAT_EQ(message.x[69], 17.25f);
  std::filesystem::remove(path);
}

// A surface file as surface_from_mesh writes it, and an empty file in the place of the scan.
class ScannedSurface : public testing::Test {
 protected:
  ScannedSurface()
      : folder_(std::filesystem::temp_directory_path() / ("scanned_surface_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "limb.yaml")
        << "surface: limb\nflat: true\nmesh:\n  file: limb.stl\n  unit: 0.001\n"
           "  middle: [0.05, 0, 0]\n  row: [0, 1, 0]\n  normal: [1, 0, 0]\n";
    std::ofstream(folder_ / "limb.stl") << "";
  }
  ~ScannedSurface() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

visualization_msgs::Marker meshNow() {
  const auto marker = ros::topic::waitForMessage<visualization_msgs::Marker>("mesh", ros::Duration(30));
  return marker ? *marker : visualization_msgs::Marker();
}

TEST_F(ScannedSurface, IsDrawnInTheFrameOfTheMatrixUntilTheNextSurface) {
  setSurface((folder_ / "limb.yaml").string(), 1);
  const visualization_msgs::Marker scan = meshNow();
  EXPECT_EQ(scan.action, visualization_msgs::Marker::ADD);
  EXPECT_EQ(scan.mesh_resource, "file://" + (folder_ / "limb.stl").string());
  EXPECT_EQ(scan.header.frame_id, "fsr_matrix");
  EXPECT_NEAR(scan.pose.position.z, -0.051, 1e-12);
  setSurface("flat", 2);
  EXPECT_EQ(meshNow().action, visualization_msgs::Marker::DELETE);
}

TEST_F(ScannedSurface, PlacesTheMatrixInTheFrameOfTheScan) {
  setSurface((folder_ / "limb.yaml").string(), 1);
  const auto message = ros::topic::waitForMessage<tf2_msgs::TFMessage>("/tf_static", ros::Duration(30));
  ASSERT_TRUE(message);
  ASSERT_EQ(message->transforms.size(), 1u);
  EXPECT_EQ(message->transforms[0].header.frame_id, "socket");
  EXPECT_EQ(message->transforms[0].child_frame_id, "fsr_matrix");
  EXPECT_EQ(message->transforms[0].transform.translation.x, 0.05);
}

TEST_F(ScannedSurface, StillGivesItsCurvatureWhereTheScanIsMissing) {
  std::filesystem::remove(folder_ / "limb.stl");
  EXPECT_EQ(setSurface((folder_ / "limb.yaml").string(), 1).surface, "limb");
  EXPECT_EQ(meshNow().action, visualization_msgs::Marker::DELETE);
}

TEST(CurvatureNode, RepeatsItselfForRecorders) {
  const SurfaceCurvature first = setSurface("flat", 1);
  const test_support::Listener<SurfaceCurvature> surfaces("curvature");
  EXPECT_TRUE(test_support::await([&] {
    return !surfaces.messages.empty() && surfaces.messages.back()->header.stamp > first.header.stamp;
  }));
}

TEST(SessionNode, PublishesTheDescriptionOfARecording) {
  const auto session = ros::topic::waitForMessage<fsr_pressure_map::Session>("session", ros::Duration(30));
  ASSERT_TRUE(session);
  EXPECT_EQ(session->subject_code, "S012");
  EXPECT_EQ(session->trial, "3");
  EXPECT_EQ(session->use, "chamber");
}

TEST(SessionNode, MarksAKnownKindAndRefusesAnother) {
  const test_support::Listener<fsr_pressure_map::Event> events("events");
  ASSERT_TRUE(events.connected());
  fsr_pressure_map::Mark::Request request;
  request.kind = "don";
  request.label = "liner 3 mm";
  EXPECT_TRUE(test_support::call<fsr_pressure_map::Mark>("session/mark", request).success);
  ASSERT_TRUE(events.has(1));
  EXPECT_EQ(events.messages.back()->kind, "don");
  EXPECT_EQ(events.messages.back()->label, "liner 3 mm");

  request.kind = "lunch";
  const auto refused = test_support::call<fsr_pressure_map::Mark>("session/mark", request);
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("conditioning"), std::string::npos) << refused.message;
}

}  // namespace
