#include "ros/recording/bag_sink.h"

#include <gtest/gtest.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/file_size_limit.h"
#include "support/pty.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

class BagSinkTest : public testing::Test {
 protected:
  BagSinkOptions options() const {
    BagSinkOptions options;
    options.bag = folder_.path("run");
    options.least_space = 0;
    return options;
  }
  BagSink::Write text(const std::string& content) const {
    return [content](rosbag::Bag& bag) {
      std_msgs::String message;
      message.data = content;
      bag.write("/text", ros::Time(1), message);
    };
  }
  std::vector<std::string> content() const {
    rosbag::Bag bag(folder_.path("run.bag"), rosbag::bagmode::Read);
    rosbag::View view(bag);
    std::vector<std::string> texts;
    for (const rosbag::MessageInstance& instance : view) {
      texts.push_back(instance.instantiate<std_msgs::String>()->data);
    }
    return texts;
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(BagSinkTest, WritesItsQueueBeforeItCloses) {
  std::vector<std::string> sent;
  {
    BagSink sink(options(), nullptr);
    EXPECT_TRUE(fs::exists(folder_.path("run.bag.active")));
    for (int i = 0; i < 3000; ++i) {
      sent.push_back(std::to_string(i));
      EXPECT_TRUE(sink.add(1, text(sent.back())));
    }
  }
  EXPECT_EQ(content(), sent);
  EXPECT_FALSE(fs::exists(folder_.path("run.bag.active")));
}

TEST_F(BagSinkTest, CountsMessagesThatDoNotFitItsQueueAndDoesNotBlock) {
  BagSinkOptions small = options();
  small.buffer = 100;
  std::promise<void> disk;  // blocks until its value is set
  auto wait = std::make_shared<std::shared_future<void>>(disk.get_future().share());
  BagSink sink(small, nullptr);
  EXPECT_TRUE(sink.add(60, [wait](rosbag::Bag&) { wait->get(); }));
  EXPECT_TRUE(sink.add(40, text("second")));
  EXPECT_FALSE(sink.add(1, text("third")));
  EXPECT_EQ(sink.report().lost, 1u);
  EXPECT_EQ(sink.report().waiting, 100u);
  disk.set_value();
}

TEST_F(BagSinkTest, ClosesTheBagWhenTheDiskIsNearlyFull) {
  std::promise<std::string> ended;
  BagSinkOptions other = options();
  other.bag = folder_.path("full.bag");
  other.least_space = UINT64_MAX;  // more than any disk has
  BagSink full(other, [&](const std::string& complaint) { ended.set_value(complaint); });
  full.add(1, text("never"));
  const std::string complaint = ended.get_future().get();
  EXPECT_NE(complaint.find("RECORDING STOPPED"), std::string::npos) << complaint;
  EXPECT_EQ(full.report().file, other.bag);
  EXPECT_NO_THROW(rosbag::Bag(other.bag, rosbag::bagmode::Read)) << "closed, with its index";
  EXPECT_EQ(full.report().lost, 1u) << "the message that was taken off the queue, but not written";
  EXPECT_FALSE(full.add(1, text("late")));
  EXPECT_EQ(full.report().lost, 2u);
}

TEST_F(BagSinkTest, CountsTheRestOfABatchAsLostWhenAWriteFails) {
  std::promise<void> queued;
  auto wait = std::make_shared<std::shared_future<void>>(queued.get_future().share());
  std::promise<void> ended;
  BagSink sink(options(), [&](const std::string&) { ended.set_value(); });
  const auto first = text("first");
  sink.add(1, [wait, first](rosbag::Bag& bag) {  // the next three messages form one batch
    wait->get();
    first(bag);
  });
  sink.add(1, text("written"));
  sink.add(1, [](rosbag::Bag&) { throw rosbag::BagIOException("disk full"); });
  sink.add(1, text("behind the failure"));
  queued.set_value();
  ended.get_future().wait();
  EXPECT_EQ(sink.report().messages, 2u);
  EXPECT_EQ(sink.report().lost, 2u);
  EXPECT_EQ(sink.report().waiting, 0u);
}

TEST_F(BagSinkTest, KeepsWhatWasWrittenWhenAWriteFails) {
  std::promise<std::string> ended;
  const test_support::FileSizeLimit disk(20'000);
  BagSink sink(options(), [&](const std::string& complaint) { ended.set_value(complaint); });
  for (int i = 0; i < 1000; ++i) sink.add(100, text(std::string(100, 'x')));
  const std::string complaint = ended.get_future().get();
  EXPECT_NE(complaint.find("cannot be written"), std::string::npos) << complaint;
  EXPECT_GT(fs::file_size(folder_.path("run.bag.active")), 10'000u);
  EXPECT_FALSE(fs::exists(folder_.path("run.bag")));
  const BagSinkReport report = sink.report();
  EXPECT_GT(report.lost, 0u);
  EXPECT_EQ(report.messages + report.lost, 1000u);
}

TEST_F(BagSinkTest, OverwritesNoRecording) {
  { const BagSink sink(options(), nullptr); }
  EXPECT_THROW(BagSink(options(), nullptr), fsr::settings::InputError);
  BagSinkOptions nowhere = options();
  nowhere.bag = folder_.path("none/run");
  EXPECT_THROW(BagSink(nowhere, nullptr), fsr::settings::InputError);
}

TEST_F(BagSinkTest, LeavesABagAloneThatTookItsNameMeanwhile) {
  BagSink sink(options(), nullptr);
  sink.add(1, text("kept"));
  std::ofstream(folder_.path("run.bag")) << "precious";
  std::ofstream(folder_.path("run_2.bag")) << "precious";
  EXPECT_THROW(BagSink(options(), nullptr), fsr::settings::InputError);
  sink.finish();
  EXPECT_EQ(fs::file_size(folder_.path("run.bag")), 8u);
  EXPECT_EQ(fs::file_size(folder_.path("run_2.bag")), 8u);
  EXPECT_EQ(sink.report().file, folder_.path("run_3.bag"));
  EXPECT_NE(sink.report().remark.find("this recording is " + folder_.path("run_3.bag")), std::string::npos);
  rosbag::Bag bag(folder_.path("run_3.bag"));
  EXPECT_EQ(rosbag::View(bag).size(), 1u);
}

// rosbag's destructor throws where the disk is full, which would end the process.
TEST_F(BagSinkTest, RefusesToBeginOnAFullDisk) {
  const test_support::FileSizeLimit disk(10);
  EXPECT_THROW(BagSink(options(), nullptr), fsr::settings::InputError);
  EXPECT_FALSE(fs::exists(folder_.path("run.bag.active")));
}

TEST_F(BagSinkTest, SaysThatItCouldNotCloseTheBag) {
  std::string complaint;
  BagSinkOptions large = options();
  large.chunk_size = 1 << 20;  // nothing is written before the end
  BagSink sink(large, [&](const std::string& why) { complaint = why; });
  for (int i = 0; i < 100; ++i) sink.add(100, text(std::string(100, 'x')));
  while (sink.report().messages < 100) std::this_thread::yield();
  const test_support::FileSizeLimit disk(5000);
  sink.finish();
  EXPECT_NE(complaint.find("NOT CLOSED"), std::string::npos) << complaint;
  EXPECT_EQ(sink.report().complaint, complaint);
  EXPECT_FALSE(fs::exists(folder_.path("run.bag")));
}

}  // namespace
}  // namespace fsr_ros
