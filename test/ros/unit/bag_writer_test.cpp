#include "ros/bags/bag_writer.h"

#include <fsr_pressure_map/SurfaceCurvature.h>
#include <gtest/gtest.h>
#include <rosbag/view.h>

#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/file_size_limit.h"
#include "support/folder_test.h"
#include "support/holds.h"
#include "support/synthetic_recording.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

class BagFile : public test_support::FolderTest {
 protected:
  void SetUp() override { path_ = (folder_ / "1_flat.bag").string(); }

  std::size_t filesLeft() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  std::string path_;
};

fsr::dataset::Recording oddCycles() {
  test_support::SyntheticRig rig;
  rig.surfaces = {{"flat", 0.0}, {"cylinder_7cm", 14.25}};
  rig.cycles = 2;
  rig.scans_per_cycle = 103;  // the surface changes between two whole seconds, at 20.6 s
  fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
  recording.start_ns = 1500000000123456789;
  recording.temperature.assign(recording.scans(), 23.5);
  recording.mask = {0, 0, 1, 0, 0, 0};
  return recording;
}

template <typename Message>
std::vector<Message> messages(const rosbag::Bag& bag, const std::string& topic) {
  std::vector<Message> all;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    all.push_back(*instance.instantiate<Message>());
    EXPECT_EQ(instance.getTime(), all.back().header.stamp);
  }
  return all;
}

TEST_F(BagFile, SaysOnceASecondWhatTheMatrixIsAndLiesOn) {
  const fsr::dataset::Recording recording = oddCycles();  // 412 scans at 10 Hz
  BagOptions options;
  options.session.session_id = "s1";
  options.reference_voltage = 2.5;
  writeBag(path_, recording, options);

  const rosbag::Bag bag(path_);
  const auto infos = messages<fsr_pressure_map::MatrixInfo>(bag, "/fsr/matrix_info");
  EXPECT_EQ(infos.size(), 42u);
  EXPECT_EQ(infos.back().rows, 2);
  EXPECT_EQ(infos.back().mask, recording.mask);
  EXPECT_EQ(infos.back().ambient_pressure, 101325);
  EXPECT_EQ(infos.back().reference_voltage, 2.5f);
  EXPECT_EQ(messages<fsr_pressure_map::Session>(bag, "/fsr/session").size(), 42u);
  const auto surfaces = messages<fsr_pressure_map::SurfaceCurvature>(bag, "/fsr/curvature");
  const auto bent = std::find_if(surfaces.begin(), surfaces.end(), [](const auto& s) { return s.x[0] != 0; });
  ASSERT_NE(bent, surfaces.end());
  EXPECT_NEAR((bent->header.stamp - surfaces[0].header.stamp).toSec(), 20.6,
              1e-6);  // at the time of the change
  EXPECT_EQ(bent->surface, "cylinder_7cm");
}

TEST_F(BagFile, LeavesNothingBehindWithoutClose) {
  {
    BagWriter bag(path_);
    EXPECT_EQ(filesLeft(), 1u);  // a temporary name
    EXPECT_FALSE(fs::exists(path_));
  }
  EXPECT_EQ(filesLeft(), 0u);
}

TEST_F(BagFile, CannotHoldTheYear1970AndSaysSo) {
  fsr::dataset::Recording recording = oddCycles();
  recording.start_ns = 0;
  EXPECT_TRUE(
      test_support::holds(test_support::refusal([&] { writeBag(path_, recording); }), {"1_flat.bag"}));
  EXPECT_EQ(filesLeft(), 0u);
}

// The destructor of such a rosbag::Bag throws again, which would end the process.
TEST_F(BagFile, SaysThatTheDiskIsFullAndLeavesNothingBehind) {
  const test_support::FileSizeLimit limit(6000);
  EXPECT_THROW(writeBag(path_, oddCycles()), fsr::settings::InputError);
  EXPECT_EQ(filesLeft(), 0u);
}

TEST_F(BagFile, CannotBeMadeInAFolderThatIsNotThere) {
  EXPECT_THROW(writeBag((folder_ / "no/1.bag").string(), oddCycles()), fsr::settings::InputError);
}

}  // namespace
}  // namespace fsr_ros
