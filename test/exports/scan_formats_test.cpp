#include "exports/scan_formats.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "exports/scan_examples.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/content_of.h"
#include "support/holds.h"
#include "support/line_format.h"
#include "support/pty.h"

namespace {

namespace fs = std::filesystem;
using fsr::exports::ScanFormat;

void writeTwoScans(const ScanFormat& format, const std::string& output, bool finish) {
  const auto sink = format.open(output, {});
  sink->begin(export_test::exampleSubject());
  fsr::exports::ScanRecord scan = export_test::exampleScan();
  sink->add(scan);
  scan.stamp_ns += 100000000;
  scan.since_ns += 100000000;
  sink->add(scan);
  if (finish) sink->finish();
}

// The shipped formats and one from outside the package.
std::vector<ScanFormat> allFormats() {
  std::vector<ScanFormat> formats = fsr::exports::scanFormats();
  formats.push_back(test_support::lineFormat());
  return formats;
}

TEST(ScanFormats, EachWritesItsOutputWholeOrNotAtAll) {
  for (const ScanFormat& format : allFormats()) {
    SCOPED_TRACE(format.name);
    const test_support::TemporaryFolder folder;
    writeTwoScans(format, folder.path("out"), false);
    EXPECT_TRUE(fs::is_empty(folder.path())) << "without finish()";
    writeTwoScans(format, folder.path("out"), true);
    EXPECT_TRUE(fs::exists(folder.path("out")));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
  }
}

TEST(ScanFormats, EachHasANameOfItsOwnAndASummaryOfOneLine) {
  std::set<std::string> names;
  for (const ScanFormat& format : allFormats()) {
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    EXPECT_FALSE(format.summary.empty()) << format.name;
    EXPECT_EQ(format.summary.find('\n'), std::string::npos) << format.name;
  }
}

TEST(ScanFormats, AFormatFromOutsideWritesWhatItIsGiven) {
  const test_support::TemporaryFolder folder;
  writeTwoScans(test_support::lineFormat(), folder.path("a.txt"), true);
  const std::string text = test_support::contentOf(folder.path("a.txt"));
  EXPECT_EQ(text, "# 2_cylinder.bag\n0.050000 0 1 2 300 17 4095\n0.150000 0 1 2 300 17 4095\n");
}

TEST(ScanFormats, TekscanRefusesACompressedOutput) {
  const test_support::TemporaryFolder folder;
  EXPECT_TRUE(test_support::holds(
      test_support::refusal([&] { export_test::opened("tekscan", folder.path("a.asf.gz")); }),
      {"--output", folder.path("a.asf.gz")}));
}

}  // namespace
