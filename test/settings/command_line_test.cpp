#include "settings/command_line.h"

#include <unistd.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/holds.h"

namespace fsr::settings {
namespace {

CommandLine tool() {
  CommandLine line("train", "BAG... --output FILE", "Trains a calibration.");
  line.option("output", "FILE", "where to")
      .option("ambient", "PA", "ambient pressure")
      .flag("no-scores", "fast");
  return line;
}

bool parse(CommandLine& line, std::vector<const char*> words) {
  words.insert(words.begin(), "train");
  return line.parse(static_cast<int>(words.size()), words.data(), std::cout);
}

std::string complaint(const std::vector<const char*>& words) {
  CommandLine line = tool();
  return test_support::refusal(
      [&] {
        parse(line, words);
        line.requiredText("output");
        line.number("ambient", 0, Range{0, 120e3, "Pa"});
        line.integer("ambient", 0, Range{0, 120e3, "Pa"});
      },
      "accepted");
}

TEST(CommandLine, TakesFilesAndOptionsInAnyOrder) {
  CommandLine line = tool();
  EXPECT_TRUE(parse(line, {"a.bag", "--output", "c.h5", "--no-scores", "b.bag", "--ambient=98000"}));
  EXPECT_EQ(line.files(), (std::vector<std::string>{"a.bag", "b.bag"}));
  EXPECT_EQ(line.requiredText("output"), "c.h5");
  EXPECT_TRUE(line.has("no-scores"));
  EXPECT_EQ(line.number("ambient", 0, Range{0, 120e3, "Pa"}), 98e3);
}

TEST(CommandLine, UsesTheFallbackWhereAnOptionIsMissing) {
  CommandLine line = tool();
  EXPECT_TRUE(parse(line, {}));
  EXPECT_EQ(line.number("ambient", 7.5, Range{0, 1, ""}), 7.5);
  EXPECT_EQ(line.integer("ambient", 7, Range{0, 1, ""}), 7);
  EXPECT_EQ(line.text("output", "x"), "x");
  EXPECT_FALSE(line.has("no-scores"));
}

TEST(CommandLine, TakesEverythingAfterTwoDashesAsFiles) {
  CommandLine line = tool();
  EXPECT_TRUE(parse(line, {"--", "--odd.bag"}));
  EXPECT_EQ(line.files(), std::vector<std::string>{"--odd.bag"});
}

TEST(CommandLine, RefusesBadInputWithOneSentence) {
  const std::vector<std::pair<std::vector<const char*>, std::string>> wrong = {
      {{"--outptu", "x"}, "--outptu"},
      {{"--output"}, "--output"},
      {{"--output", "a", "--output", "b"}, "--output"},
      {{"--no-scores=1"}, "no-scores"},
      {{"--no-scores", "--no-scores"}, "--no-scores"}};
  for (const auto& [words, named] : wrong) {
    EXPECT_TRUE(test_support::holds(complaint(words), {named, "; see train --help"}));
  }
  EXPECT_TRUE(test_support::holds(complaint({}), {"--output FILE", "--help"}));
  EXPECT_TRUE(test_support::holds(complaint({"--output", "a", "--ambient", "high"}),
                                  {"--ambient", "\"high\"", "0 to 120000 Pa"}));
  EXPECT_TRUE(test_support::holds(complaint({"--output", "a", "--ambient", "2e5"}),
                                  {"--ambient", "\"2e5\"", "0 to 120000 Pa"}));
  EXPECT_TRUE(test_support::holds(complaint({"--output", "a", "--ambient", "1.5"}),
                                  {"--ambient", "\"1.5\"", "0 to 120000 Pa"}));
}

TEST(CommandLine, HelpListsEveryOption) {
  CommandLine line = tool();
  EXPECT_FALSE(parse(line, {"--help", "x.bag"}));
  EXPECT_EQ(line.help(),
            "train BAG... --output FILE\n\nTrains a calibration.\n\n"
            "  --help         print this help and exit\n"
            "  --output FILE  where to\n"
            "  --ambient PA   ambient pressure\n"
            "  --no-scores    fast\n");
}

TEST(RunTool, ReturnsStatusTwoForUnusableInput) {
  EXPECT_EQ(runTool("train", [] { return 3; }), 3);
  testing::internal::CaptureStderr();
  EXPECT_EQ(runTool("train", []() -> int { throw InputError("a.bag: is empty"); }), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "train: a.bag: is empty\n");
}

// Every way of giving an output that is an input, or two outputs of one name.
TEST(CommandLine, RefusesAnOutputThatIsAnInputHoweverItIsSpelled) {
  const std::string folder = testing::TempDir() + "command_line_losses_" + std::to_string(::getpid());
  const std::string name = std::filesystem::path(folder).filename();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directory(folder);
  const std::string bag = folder + "/a.bag", link = folder + "/link", hard = folder + "/hard";
  std::ofstream(bag) << "precious";
  std::filesystem::create_symlink("a.bag", link);
  std::filesystem::create_hard_link(bag, hard);
  const auto complaint = [](const std::vector<std::string>& words) -> std::string {
    CommandLine line("train", "BAG...", "Trains.");
    line.output("output", "FILE", "").output("report", "FILE", "").input("calibration", "FILE", "");
    std::vector<const char*> arguments = {"train"};
    for (const std::string& word : words) arguments.push_back(word.c_str());
    return test_support::refusal(
        [&] { line.parse(static_cast<int>(arguments.size()), arguments.data(), std::cout); }, "accepted");
  };
  EXPECT_TRUE(test_support::holds(complaint({bag, "--output", bag}), {bag, "would be overwritten"}));
  for (const std::string& other : {link, hard, folder + "/../" + name + "/./a.bag"}) {
    EXPECT_TRUE(
        test_support::holds(complaint({bag, "--output", other}), {other, bag, "would be overwritten"}));
    EXPECT_NE(complaint({bag, "--report", other}), "accepted");
    EXPECT_NE(complaint({"--calibration", other, "--output=" + bag}), "accepted");
  }
  EXPECT_TRUE(test_support::holds(complaint({bag, "--output", "b", "--report", "./b"}),
                                  {"./b", "is given for two outputs"}));
  EXPECT_TRUE(test_support::holds(complaint({bag, "--output", ""}), {"--output", "--output is empty"}));
  EXPECT_EQ(complaint({bag, "--calibration", bag, "--output", folder + "/new"}), "accepted");
  std::filesystem::remove_all(folder);
}

// Exit status 2 and a sentence, never an abort.
TEST(RunTool, TurnsEveryExceptionIntoASentence) {
  const auto said = [](const std::function<int()>& run) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(runTool("train", run), 2);
    return testing::internal::GetCapturedStderr();
  };
  const std::string name(300, 'x');
  EXPECT_EQ(
      said([&] { return std::filesystem::exists(name) ? 0 : 1; }),
      "train: " + name +
          ": cannot be used (File name too long); give the path of a file that exists and may be read\n");
  EXPECT_EQ(said([]() -> int { throw std::bad_alloc(); }),
            "train: this input needs more memory than the system gives; use a part of it\n");
  EXPECT_EQ(said([]() -> int { throw std::runtime_error("Time is out of\nrange."); }),
            "train: this input cannot be used (Time is out of range)\n");
}

}  // namespace
}  // namespace fsr::settings
