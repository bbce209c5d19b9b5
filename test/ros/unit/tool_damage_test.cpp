// The tools on damaged bags: each is read or refused with one sentence. Any other exception would be an abort
// of the program if runTool() did not catch it, and fails these tests.
#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/Session.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_writer.h"
#include "ros/tools/tools.h"
#include "support/content_of.h"
#include "support/holds.h"
#include "support/pty.h"
#include "support/source_dir.h"
#include "support/synthetic_recording.h"
#include "support/tool_run.h"

namespace fsr_ros {
namespace {

namespace fs = std::filesystem;

int exportAll(int argc, const char* const* argv, std::ostream& out) {
  return exportTool(argc, argv, out, fsr::exports::scanFormats());
}

using Tool = int (*)(int, const char* const*, std::ostream&);

class ToolDamage : public testing::Test {
 protected:
  void SetUp() override {
    test_support::SyntheticRig rig;
    rig.size = {1, 2};
    rig.surfaces = {{"flat", 0.0}};
    rig.scans_per_cycle = 20;
    fsr::dataset::Recording recording = test_support::syntheticRecording(rig);
    recording.start_ns = 1500000000000000000;
    recording.temperature.assign(recording.scans(), 23.5);
    BagOptions options;
    options.session.session_id = "s1";
    writeBag(bag_, recording, options);
    rosbag::Bag bag(bag_, rosbag::bagmode::Append);
    fsr_pressure_map::Event event;
    event.header.stamp = ros::Time(1500000001);
    event.kind = "don";
    for (int i = 0; i < 20; ++i) bag.write("/fsr/events", event.header.stamp, event);
    bag.close();
    sound_ = test_support::contentOf(bag_);
  }

  void write(const std::string& bytes) const {
    std::ofstream(bag_, std::ios::binary | std::ios::trunc) << bytes;
  }

  // Runs a tool on the bag. Returns its sentence, or "" if it read the bag.
  std::string said(Tool tool, const std::vector<std::string>& words) const {
    try {
      return test_support::runTool(tool, "tool", words).error;
    } catch (const std::exception& error) {
      ADD_FAILURE() << words.front() << " " << words.back() << ": " << error.what();
      return error.what();
    }
  }

  // Runs every tool that reads bags. Returns how many refused it.
  int refusals() const {
    int refused = 0;
    refused += !said(checkBagTool, {bag_}).empty();
    refused += !said(checkBagTool, {"--use", "socket", bag_}).empty();
    refused += !said(scrubTool, {bag_, "--output", folder_.path("out.bag")}).empty();
    refused += !said(exportAll, {bag_, "--to", "csv", "--output", folder_.path("out.csv")}).empty();
    refused += !said(exportAll, {bag_, "--to", "hdf5", "--output", folder_.path("out.h5")}).empty();
    return refused;
  }

  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  test_support::TemporaryFolder folder_;
  std::string bag_ = folder_.path("in.bag");
  std::string sound_;
};

TEST_F(ToolDamage, ABagWithOneBitFlippedIsReadOrRefused) {
  constexpr std::size_t kMutants = 50;
  EXPECT_EQ(refusals(), 0);
  int refused = 0;
  for (std::size_t i = 0; i < kMutants; ++i) {
    std::string changed = sound_;
    char& byte = changed[i * 2654435761U % changed.size()];
    byte = static_cast<char>(byte ^ (1 << (i % 8)));
    write(changed);
    refused += refusals();
    if (HasFailure()) return;
  }
  EXPECT_GT(refused, 40);
  EXPECT_LT(refused, 240) << "flips within messages are read";
  EXPECT_EQ(files(), 4u) << "the bag and three outputs; no temporary file stays";
}

TEST_F(ToolDamage, ABagThatIsCutOffIsRefused) {
  for (const std::size_t size : {0u, 5u, 13u, 100u, 4117u, 9000u}) {
    write(sound_.substr(0, size));
    EXPECT_EQ(refusals(), 5) << size;
  }
}

// A small file that says that an array has 2^31 values: ROS would allocate as much before it notices the end.
TEST_F(ToolDamage, AMessageThatLiesAboutItsLengthTakesNoMemory) {
  const std::uint16_t counts[] = {1, 2};
  {
    BagWriter bag(bag_);
    for (std::uint32_t i = 1; i < 50; ++i) bag.addScan(i * 100000000LL, i, {{1, 2}, 0x5555, counts, 2});
    bag.close();
  }
  std::string bytes = test_support::contentOf(bag_);
  const std::string length("\2\0\0\0\1\0\2\0", 8);  // the counts of a scan
  ASSERT_NE(bytes.rfind(length), std::string::npos);
  bytes.replace(bytes.rfind(length), 4, std::string("\0\0\0\x7f", 4));
  write(bytes);
  const std::string sentence = said(scrubTool, {bag_, "--output", folder_.path("out.bag")});
  EXPECT_NE(sentence.find("a message in it is cut short"), std::string::npos) << sentence;
  EXPECT_EQ(files(), 1u);
}

TEST_F(ToolDamage, ASurfaceOfAnotherSizeIsRefusedByEveryExport) {
  const std::uint16_t counts[] = {1, 2, 3, 4};
  {
    BagWriter bag(bag_);
    bag.addSurface(100000000, {"limb", 1, std::vector<fsr::matrix::Curvature>(3), {}});
    for (std::uint32_t i = 1; i < 50; ++i) bag.addScan(i * 100000000LL, i, {{2, 2}, 4095, counts, 4});
    bag.close();
  }
  EXPECT_TRUE(test_support::holds(said(exportAll, {bag_, "--to", "csv", "--output", folder_.path("out.csv")}),
                                  {bag_, "\"limb\"", "3 values", "4 taxels", "2 x 2"}));
  EXPECT_EQ(files(), 1u);
}

// A recording must survive every spelling of a wrong command.
TEST_F(ToolDamage, NoToolWritesOverItsInput) {
  fs::create_symlink("in.bag", folder_.path("link"));
  const std::string table = folder_.path("table.csv");
  std::ofstream(table) << "0,1\n0.1,2\n";
  const std::string bench = test_support::sourceDir() + "/config/simulation/bench.yaml";
  fs::copy_file(bench, folder_.path("truth.yaml"));
  for (const std::string& output : {bag_, folder_.path("link"), folder_.path("./in.bag")}) {
    for (const std::string& sentence :
         {said(trainTool, {bag_, "--output", output}),
          said(trainTool, {bag_, "--output", folder_.path("c.h5"), "--report", output}),
          said(scrubTool, {bag_, "--output", output}),
          said(exportAll, {bag_, "--to", "csv", "--output", output}),
          said(exportAll, {"--calibration", bag_, bag_, "--to", "csv", "--output", output})}) {
      EXPECT_NE(sentence.find("would be overwritten"), std::string::npos) << sentence;
    }
  }
  const std::string columns = "time=1,reading=2:V";
  EXPECT_NE(said(csvToBagTool, {table, "--columns", columns, "--output", table}).find("would be overwritten"),
            std::string::npos);
  EXPECT_NE(said(simulateTool, {"--simulation", folder_.path("truth.yaml"), "--output", folder_.path()}), "");
  EXPECT_TRUE(sound_ == test_support::contentOf(bag_));
  EXPECT_EQ(fs::file_size(table), 10u);
  EXPECT_EQ(fs::file_size(folder_.path("truth.yaml")), fs::file_size(bench));
}

// What an output would replace is often a recording under a wrong name.
TEST_F(ToolDamage, NoToolReplacesAFileOfAnotherKind) {
  const std::string table = folder_.path("table.csv"), results = folder_.path("results"),
                    c = folder_.path("c.h5");
  std::ofstream(table) << "0,1\n0.1,2\n";
  const std::string bench = test_support::sourceDir() + "/config/simulation/bench.yaml";
  fs::create_directory(results);
  const std::string kPlan = "a YAML file of the kind plan", kCalibration = "a calibration",
                    kJson = "a JSON file";
  struct Case {
    Tool tool;
    std::vector<std::string> words;  // before the output
    std::string writes;
    std::string in_folder;  // file that is replaced where the output is a folder
  };
  const std::vector<Case> cases = {
      {trainTool, {bag_, "--output"}, kCalibration, ""},
      {trainTool, {bag_, "--output", c, "--report"}, kJson, ""},
      {trainTool, {"--merge", bag_, "--output"}, kCalibration, ""},
      {checkCalibrationTool, {c, bag_, "--correct", "--output"}, kCalibration, ""},
      {scrubTool, {bag_, "--output"}, "a bag", ""},
      {exportAll, {bag_, "--to", "csv", "--output"}, "a table of values", ""},
      {exportAll, {bag_, "--to", "tekscan", "--output"}, "a Tekscan file", ""},
      {csvToBagTool, {table, "--columns", "time=1,reading=2", "--output"}, "a bag", ""},
      {planSessionTool, {"--for", "field_check", "--minutes", "20", "--output"}, kPlan, ""},
      {simulateTool,
       {"--simulation", bench, "--output", folder_.path("new"), "--save-state"},
       "a YAML file of the kind rig_state",
       ""},
      {simulateTool, {"--simulation", bench, "--output"}, "a YAML file of the kind simulation", "truth.yaml"},
      {studyTool, {bag_, "--output"}, kJson, "results.json"},
      {discrepancyTool, {bag_, "--output"}, "a YAML file of the kind verdict", "verdict.yaml"},
      {checkCalibrationTool, {folder_.path(), "--output"}, kJson, "life.json"},
  };
  const std::map<std::string, std::string> precious = {
      {"a bag", sound_},
      {kCalibration, "fsr_pressure_map calibration schema=8 sha256=0\n"},
      {"a YAML file of the kind notes", "notes: of the day\n"},
      {"a table of values", "time,mine\n1,2\n"},
      {"a text", "Dear diary\n"}};
  for (const Case& one : cases) {
    for (const auto& [kind, content] : precious) {
      if (kind == one.writes) continue;
      const std::string target =
          one.in_folder.empty() ? folder_.path("target") : results + "/" + one.in_folder;
      std::ofstream(target, std::ios::binary | std::ios::trunc) << content;
      std::vector<std::string> words = one.words;
      words.push_back(one.in_folder.empty() ? target : results);
      const std::string sentence = said(one.tool, words);
      EXPECT_NE(sentence.find(target + ": is " + kind + ", which is not replaced by " + one.writes),
                std::string::npos)
          << one.words[1] << ": " << sentence;
      EXPECT_TRUE(test_support::contentOf(target) == content) << target;
      fs::remove(target);
    }
  }
}

// A pipe without a writer would block them for ever.
TEST_F(ToolDamage, APipeIsRefusedAsAnyInput) {
  const std::string pipe = folder_.path("pipe"), out = folder_.path("out");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& sentence :
       {said(checkBagTool, {pipe}), said(scrubTool, {pipe, "--output", out}),
        said(trainTool, {pipe, "--output", out}), said(checkCalibrationTool, {pipe, bag_}),
        said(trainTool, {"--merge", pipe, "--output", out}),
        said(exportAll, {pipe, "--to", "hdf5", "--output", out}),
        said(exportAll, {bag_, "--calibration", pipe, "--to", "csv", "--output", out}),
        said(csvToBagTool, {pipe, "--columns", "time=1,reading=2", "--output", out}),
        said(simulateTool, {"--simulation", pipe, "--output", out}),
        said(trainTool, {bag_, "--output", pipe}), said(scrubTool, {bag_, "--output", pipe})}) {
    EXPECT_NE(sentence.find(pipe + ": "), std::string::npos) << sentence;
  }
  EXPECT_TRUE(fs::is_fifo(pipe));
}

}  // namespace
}  // namespace fsr_ros
