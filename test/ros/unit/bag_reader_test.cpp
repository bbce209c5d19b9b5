#include "fsr_pressure_map/ros/bag_reader.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Float64.h>

#include <filesystem>
#include <fstream>

#include "dataset/recording_builder.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_writer.h"
#include "ros/bags/message_events.h"
#include "settings/sha256.h"
#include "support/folder_test.h"
#include "support/holds.h"
#include "support/synthetic_recording.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

class BagReader : public test_support::FolderTest {
 protected:
  void SetUp() override { path_ = (folder_ / "1_flat.bag").string(); }

  std::string complaint(const std::string& topics = "") const { return complaintOf(path_, topics); }
  static std::string complaintOf(const std::string& path, const std::string& topics = "") {
    BagReadOptions options;
    options.topics = topics;
    return test_support::refusal([&] { readBag(path, options); }, "accepted");
  }
  void keepBytes(std::uintmax_t size) const { fs::resize_file(path_, size); }

  std::string path_;
};

fsr::dataset::Recording twoSurfaces() {
  test_support::SyntheticRig rig;
  rig.surfaces = {{"flat", 0.0}, {"cylinder_7cm", 14.25}};  // exact in the message's float
  rig.peak = 512e3;
  fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
  recording.start_ns = 1500000000123456789;
  recording.temperature.assign(recording.scans(), 23.5);
  recording.layout.pitch_x = 0.015625;
  recording.mask = {0, 0, 1, 0, 0, 0};
  return recording;
}

BagOptions inNamespace(const std::string& topics) {
  BagOptions options;
  options.topics = topics;
  options.ambient_pressure = 98304;
  return options;
}

TEST_F(BagReader, GivesBackTheRecordingThatWasWritten) {
  const fsr::dataset::Recording written = twoSurfaces();
  writeBag(path_, written, inNamespace("fsr"));
  const fsr::dataset::Recording read = readBag(path_);
  EXPECT_EQ(read.name, "1_flat.bag");
  EXPECT_EQ(read.sha256, fsr::settings::sha256OfFile(path_));
  EXPECT_EQ(read.sensor.serial, written.sensor.serial);
  EXPECT_EQ(read.layout.pitch_x, 0.015625);
  EXPECT_EQ(read.mask, written.mask);
  EXPECT_EQ(read.start_ns, written.start_ns);
  EXPECT_EQ(read.warnings, std::vector<std::string>{"dropped 21 scans within 1 s of a change of surface"});
  ASSERT_EQ(read.conditions.size(), 2u);
  EXPECT_EQ(read.conditions[1].name, "cylinder_7cm");
  EXPECT_EQ(read.conditions[1].curvature.at(0).x, 14.25);
  // the scans within 1 s of the change at 50 s are dropped
  ASSERT_EQ(read.scans(), written.scans() - 21);
  EXPECT_EQ(read.losses.near_change, 21u);
  for (const std::size_t scan : {std::size_t{7}, std::size_t{489}}) {
    EXPECT_NEAR(read.pressure[scan], written.pressure[scan], 1e-9);
    EXPECT_EQ(read.scan(scan)[5], written.scan(scan)[5]);
    EXPECT_EQ(read.temperature[scan], 23.5);
  }
}

// The same bag, compressed as by rosbag record.
TEST_F(BagReader, ReadsPackedBags) {
  writeBag(path_, twoSurfaces(), inNamespace("fsr"));
  const fsr::dataset::Recording plain = readBag(path_);
  for (const auto packing : {rosbag::compression::LZ4, rosbag::compression::BZ2}) {
    const std::string packed = (folder_ / "packed.bag").string();
    {
      const rosbag::Bag from(path_);
      rosbag::Bag to(packed, rosbag::bagmode::Write);
      to.setCompression(packing);
      for (const rosbag::MessageInstance& message : rosbag::View(from)) {
        to.write(message.getTopic(), message.getTime(), message);
      }
    }
    const fsr::dataset::Recording read = readBag(packed);
    EXPECT_EQ(read.counts, plain.counts);
    EXPECT_EQ(read.pressure, plain.pressure);
    EXPECT_EQ(read.sha256, fsr::settings::sha256OfFile(packed));
    std::fstream(packed, std::ios::in | std::ios::out | std::ios::binary).seekp(6000).write("!!!!!!!!", 8);
    EXPECT_NE(complaintOf(packed).find("is not a complete bag"), std::string::npos) << complaintOf(packed);
  }
}

TEST_F(BagReader, TakesTheSensorThatIsAskedFor) {
  fsr::dataset::Recording recording = twoSurfaces();
  {
    BagWriter bag(path_, "left/fsr");
    bag.addScan(1000000000, 1, {recording.layout.size, 4095, recording.scan(0), 6});
    bag.close();
  }
  EXPECT_EQ(readBag(path_).scans(), 1u);
  rosbag::Bag bag(path_, rosbag::bagmode::Append);
  fsr_pressure_map::MatrixFrame right;
  right.rows = right.columns = 1;
  right.full_scale = 1023;
  right.counts = {5};
  bag.write("/right/raw", ros::Time(2), right);
  bag.close();
  EXPECT_TRUE(test_support::holds(complaint(), {path_, "left/fsr", "--namespace"}));
  BagReadOptions options;
  options.topics = "/right/";
  EXPECT_EQ(readBag(path_, options).layout.size, (fsr::matrix::MatrixSize{1, 1}));
  EXPECT_TRUE(test_support::holds(complaint("middle"),
                                  {path_, "/middle/raw", "/left/fsr/raw", "/right/raw", "--namespace"}));
}

TEST_F(BagReader, ABagWithoutTheMatrixSaysWhatItHolds) {
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    bag.write("/raw", ros::Time(2), std_msgs::Float64());
    bag.write("/other", ros::Time(2), std_msgs::Float64());
  }
  EXPECT_TRUE(test_support::holds(
      complaint(), {path_, "fsr_pressure_map/MatrixFrame", "/other", "/raw", "record.launch"}));
}

TEST_F(BagReader, ATopicOfAnotherTypeIsNamed) {
  writeBag(path_, twoSurfaces(), inNamespace("fsr"));
  rosbag::Bag bag(path_, rosbag::bagmode::Write);
  fsr_pressure_map::MatrixFrame scan;
  scan.rows = scan.columns = scan.full_scale = 1;
  scan.counts = {1};
  bag.write("/fsr/raw", ros::Time(2), scan);
  bag.write("/fsr/chamber_pressure", ros::Time(2), std_msgs::Float64());
  bag.close();
  EXPECT_TRUE(test_support::holds(
      complaint(), {path_, "/fsr/chamber_pressure", "std_msgs/Float64", "sensor_msgs/FluidPressure"}));
}

TEST_F(BagReader, ABagCutAnywhereIsRefusedInASentence) {
  writeBag(path_, twoSurfaces(), inNamespace("fsr"));
  const std::uintmax_t whole = fs::file_size(path_);
  for (std::uintmax_t share = 99; share > 0; --share) {
    keepBytes(whole * share / 100);
    EXPECT_NE(complaint().find("close_bag " + path_), std::string::npos) << share << " %: " << complaint();
  }
}

// Otherwise a small bag could contain a large message any number of times.
TEST_F(BagReader, AnIndexThatPointsToAMessageTwiceIsRefused) {
  writeBag(path_, twoSurfaces(), inNamespace("fsr"));
  std::string bytes(fs::file_size(path_), ' ');
  std::ifstream(path_, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  // The first index with many messages: its header ends with "ver=...", followed by the length and entries of
  // 12 bytes.
  const std::string end_of_header = std::string("ver=\1\0\0\0", 8);
  std::size_t entries = bytes.find(end_of_header);
  while (bytes[entries + 8] == 12 && bytes[entries + 9] == 0)
    entries = bytes.find(end_of_header, entries + 1);
  entries += end_of_header.size() + sizeof(std::uint32_t);
  bytes.replace(entries + 12, 12, bytes, entries, 12);
  std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
  EXPECT_NE(complaint().find("an index points to a message twice"), std::string::npos) << complaint();
}

TEST_F(BagReader, ABagThatWasNotClosedNamesTheToolThatClosesIt) {
  {
    rosbag::Bag whole(path_, rosbag::bagmode::Write);
    whole.setChunkThreshold(100);
    for (unsigned i = 1; i < 100; ++i) whole.write("/other", ros::Time(i), std_msgs::Float64());
    fs::copy_file(path_, folder_ / "open.bag");
  }
  path_ = (folder_ / "open.bag").string();
  EXPECT_TRUE(test_support::holds(complaint(), {path_, "fsr_pressure_map close_bag"}));
}

TEST_F(BagReader, WhatIsNoBagIsRefused) {
  EXPECT_TRUE(test_support::holds(complaint(), {path_, "there is no such file"}));
  std::ofstream(path_) << "";
  EXPECT_TRUE(test_support::holds(complaint(), {path_, "record.launch"}));
  std::ofstream(path_) << "pressure,count\n1,2\n";
  EXPECT_NE(complaint().find("is not a complete bag ("), std::string::npos) << complaint();
}

TEST_F(BagReader, MessagesThatDoNotFitEachOtherAreRefusedWithTheBagsName) {
  {
    BagWriter bag(path_, "fsr");
    const std::uint16_t counts[] = {1, 2, 3, 4};
    bag.addScan(1000000000, 1, {{2, 2}, 4095, counts, 4});
    bag.addSurface(1000000000, {"limb", 1, std::vector<fsr::matrix::Curvature>(6), {}});
    bag.close();
  }
  EXPECT_TRUE(test_support::holds(complaint(), {path_, "\"limb\"", "6 values", "4 taxels", "2 x 2"}));
}

TEST(MessageEvents, AMalformedDescriptionIsRefused) {
  fsr_pressure_map::MatrixInfo info;
  info.rows = info.columns = 2;
  info.pitch_x = info.pitch_y = 0.01f;
  info.mask = {1, 0};
  EXPECT_TRUE(
      test_support::holds(test_support::refusal([&] { toDescription(info); }), {"matrix_info", "2 values"}));
  info.mask.clear();
  info.pitch_y = 0;
  EXPECT_THROW(toDescription(info), fsr::settings::InputError);
}

}  // namespace
}  // namespace fsr_ros
