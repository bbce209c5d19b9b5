#include "ros/bags/rescue_bag.h"

#include <gtest/gtest.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_walk.h"
#include "ros/recording/bag_sink.h"
#include "ros/tools/tools.h"
#include "support/content_of.h"
#include "support/holds.h"
#include "support/pty.h"
#include "support/small_disk.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

constexpr int kMessages = 3500;
constexpr std::uint64_t kPage = 4096;  // tmpfs gives space in pages [bytes]

std::string content(int number) {
  return "begin " + std::to_string(number) + std::string(static_cast<std::size_t>(number % 97), '.') + " end";
}

BagSink::Write text(int number) {
  return [number](rosbag::Bag& bag) {
    std_msgs::String message;
    message.data = content(number);
    bag.write(number % 3 == 0 ? "/third" : "/other", ros::Time(1 + static_cast<unsigned>(number)), message);
  };
}

// Adds all messages and waits until they are counted as written, or the disk is full.
std::uint64_t fill(BagSink& sink) {
  for (int i = 0; i < kMessages; ++i) sink.add(1, text(i));
  for (BagSinkReport now = sink.report();; now = sink.report()) {
    if (now.messages + now.lost == kMessages) return now.messages;
    std::this_thread::yield();
  }
}

BagSinkOptions optionsFor(const std::string& bag) {
  BagSinkOptions options;
  options.bag = bag;
  options.least_space = 0;
  return options;
}

// The messages of a bag, which must be the first that were added.
std::uint64_t soundMessages(const std::string& path) {
  requireSoundBag(path);
  rosbag::Bag bag(path);
  rosbag::View view(bag);
  int number = 0;
  for (const rosbag::MessageInstance& instance : view) {
    EXPECT_EQ(instance.instantiate<std_msgs::String>()->data, content(number)) << path;
    ++number;
  }
  return static_cast<std::uint64_t>(number);
}

std::string refusal(const std::string& path) {
  return test_support::refusal([&] { rescueBag(path); });
}

class RescueBag : public testing::Test {
 protected:
  // A bag as rosbag leaves it while it records, and as it is after it was closed.
  void record(rosbag::CompressionType compression = rosbag::compression::Uncompressed) {
    rosbag::Bag bag(folder_.path("whole.bag"), rosbag::bagmode::Write);
    bag.setCompression(compression);
    bag.setChunkThreshold(1024);
    for (int i = 0; i < 300; ++i) text(i)(bag);
    bag.close();
    whole_ = test_support::contentOf(folder_.path("whole.bag"));
  }
  std::string cut(std::size_t size) const {
    std::ofstream(active_, std::ios::binary | std::ios::trunc) << whole_.substr(0, size);
    return active_;
  }
  // How many messages are whole within that many bytes.
  std::uint64_t wholeWithin(std::size_t size) const {
    std::uint64_t number = 0;
    const std::string_view kept = std::string_view(whole_).substr(0, size);
    while (kept.find(content(static_cast<int>(number))) != std::string_view::npos) ++number;
    return number;
  }

  test_support::TemporaryFolder folder_;
  const std::string active_ = folder_.path("run.bag.active");
  const std::string closed_ = folder_.path("run.bag");
  std::string whole_;
};

TEST_F(RescueBag, KeepsEveryWholeMessageWhereverAFileWasCut) {
  record();
  for (std::size_t size = 6000; size < whole_.size(); size += 251) {
    const RescuedBag rescued = rescueBag(cut(size));
    EXPECT_EQ(rescued.complaint, "");
    EXPECT_EQ(rescued.file, closed_);
    EXPECT_EQ(rescued.messages, wholeWithin(size)) << size;
    EXPECT_EQ(soundMessages(closed_), rescued.messages) << size;
    fs::remove(closed_);
  }
}

TEST_F(RescueBag, KeepsWholeCompressedChunks) {
  record(rosbag::compression::LZ4);
  const RescuedBag rescued = rescueBag(cut(whole_.size() / 2));
  EXPECT_GT(rescued.messages, 0u);
  EXPECT_EQ(soundMessages(closed_), rescued.messages);
}

// After a power cut the end of a file may be zeros.
TEST_F(RescueBag, CutsZerosOffTheEnd) {
  record();
  const std::size_t half = whole_.find(content(150)) + content(150).size();
  std::fill(whole_.begin() + static_cast<std::ptrdiff_t>(half), whole_.end(), '\0');
  EXPECT_EQ(rescueBag(cut(half + 3000)).messages, wholeWithin(half));
  EXPECT_EQ(soundMessages(closed_), wholeWithin(half));
}

TEST_F(RescueBag, OnlyRenamesABagThatIsComplete) {
  record();
  EXPECT_EQ(rescueBag(cut(whole_.size())).messages, 300u);
  EXPECT_EQ(test_support::contentOf(closed_), whole_);
}

TEST_F(RescueBag, OverwritesNoBagOfTheSameName) {
  record();
  std::ofstream(closed_) << "precious";
  EXPECT_EQ(rescueBag(cut(whole_.size() / 2)).file, folder_.path("run_2.bag"));
  EXPECT_EQ(fs::file_size(closed_), 8u);
}

TEST_F(RescueBag, LeavesARecordingThatGoesOn) {
  BagSink sink(optionsFor(closed_), nullptr);
  fill(sink);
  const std::uintmax_t size = fs::file_size(active_);
  EXPECT_NE(refusal(active_).find("a program has this recording open"), std::string::npos);
  EXPECT_THROW(BagSink(optionsFor(closed_), nullptr), fsr::settings::InputError);
  EXPECT_EQ(fs::file_size(active_), size);
  sink.finish();
  EXPECT_EQ(soundMessages(closed_), static_cast<std::uint64_t>(kMessages));

  rosbag::Bag other(active_, rosbag::bagmode::Write);  // as `rosbag record`, which locks nothing
  EXPECT_NE(refusal(active_).find("a program has this recording open"), std::string::npos);
}

TEST_F(RescueBag, ChangesNothingWhereItWouldLoseMessages) {
  record();
  whole_.replace(whole_.size() / 4, 200, 200, '\0');
  EXPECT_NE(refusal(cut(whole_.size() - 100)).find("and more follows"), std::string::npos);
  EXPECT_EQ(test_support::contentOf(active_), whole_.substr(0, whole_.size() - 100));
  for (const std::size_t size : {0u, 20u, 4117u, 4200u})
    EXPECT_NE(refusal(cut(size)).find("holds no whole message; remove it"), std::string::npos) << size;
  std::ofstream(active_, std::ios::trunc) << std::string(10000, 'x');
  EXPECT_NE(refusal(active_).find("does not begin with #ROSBAG"), std::string::npos);
  EXPECT_EQ(fs::file_size(active_), 10000u);
}

// The disk fills at each page between the last message and the end of the index.
TEST_F(RescueBag, ADiskThatFillsWhileTheBagIsClosedLosesNoMessage) {
  std::uint64_t open = 0, closed = 0;  // size of the file [bytes]
  {
    BagSink sink(optionsFor(closed_), nullptr);
    fill(sink);
    open = fs::file_size(active_);
    sink.finish();
    closed = fs::file_size(closed_);
  }
  const std::uint64_t first = (open + kPage - 1) / kPage, last = (closed + kPage - 1) / kPage;
  ASSERT_GE(last - first, 9u) << "ten sizes";
  std::uint64_t left_open = 0;
  for (std::uint64_t pages = first; pages <= last; ++pages) {
    test_support::SmallDisk disk(std::to_string(pages * kPage));
    if (!disk.ready()) GTEST_SKIP() << "a small file system can be mounted by root alone";
    std::string complaint;
    BagSink sink(optionsFor(disk.path("run")), [&](const std::string& why) { complaint = why; });
    EXPECT_EQ(fill(sink), static_cast<std::uint64_t>(kMessages)) << complaint;
    sink.finish();
    EXPECT_EQ(sink.report().messages, static_cast<std::uint64_t>(kMessages)) << complaint;
    const std::string file = sink.report().file;
    if (file != disk.path("run.bag")) {
      ++left_open;
      EXPECT_TRUE(
          test_support::holds(complaint, {"NOT CLOSED", "run: rosrun fsr_pressure_map close_bag " + file}));
      std::ostringstream out;
      const char* const command[] = {"close_bag", file.c_str()};
      EXPECT_EQ(closeBagTool(2, command, out), 1) << "there is still no room";
      disk.resize(std::to_string(2 * closed));
      EXPECT_EQ(closeBagTool(2, command, out), 0) << out.str();
    }
    EXPECT_EQ(soundMessages(disk.path("run.bag")), static_cast<std::uint64_t>(kMessages)) << pages;
  }
  EXPECT_GE(left_open, 5u);
}

// From the first message to the last.
TEST_F(RescueBag, ADiskThatFillsWhileItIsRecordedLosesNoMessageThatWasWritten) {
  for (std::uint64_t pages = 4; pages < 60; pages += 5) {
    test_support::SmallDisk disk(std::to_string(pages * kPage));
    if (!disk.ready()) GTEST_SKIP() << "a small file system can be mounted by root alone";
    BagSink sink(optionsFor(disk.path("run")), nullptr);
    const std::uint64_t written = fill(sink);
    sink.finish();
    EXPECT_LT(written, static_cast<std::uint64_t>(kMessages));
    disk.resize("1m");
    const std::string file = sink.report().file;
    if (file != disk.path("run.bag")) rescueBag(file);
    EXPECT_EQ(soundMessages(disk.path("run.bag")), written) << pages;
  }
}

TEST_F(RescueBag, ARecorderClosesWhatAnEarlierOneLeft) {
  record();
  cut(whole_.size() / 2);
  EXPECT_TRUE(
      test_support::holds(test_support::refusal([&] { const BagSink sink(optionsFor(closed_), nullptr); }),
                          {"was closed as " + closed_ + ", which holds " +
                           std::to_string(wholeWithin(whole_.size() / 2)) + " messages"}));
  EXPECT_EQ(soundMessages(closed_), wholeWithin(whole_.size() / 2));
}

}  // namespace
}  // namespace fsr_ros
