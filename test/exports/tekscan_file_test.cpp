#include "exports/scan_formats.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "exports/scan_examples.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/content_of.h"
#include "support/holds.h"
#include "support/program_output.h"
#include "support/pty.h"

namespace {

using export_test::bareScan;
using export_test::exampleScan;

class TekscanFile : public testing::Test {
 protected:
  std::string write(const std::vector<fsr::exports::ScanRecord>& scans, bool maps) {
    export_test::write("tekscan", path_, scans, {}, maps);
    return test_support::contentOf(path_);
  }

  test_support::TemporaryFolder folder_;
  std::string path_ = folder_.path("frames.asf");
};

TEST_F(TekscanFile, HasTheHeaderThatItsReadersNeed) {
  fsr::exports::ScanRecord later = exampleScan();
  later.since_ns += 100000000;
  const std::string text = write({exampleScan(), later}, true);
  for (const char* line :
       {"DATA_TYPE MOVIE\r\n", "ROWS 2\r\n", "COLS 3\r\n", "ROW_SPACING 8.0000 mm\r\n",
        "COL_SPACING 10.0000 mm\r\n", "SENSEL_AREA 80.0000 mm2\r\n", "SECONDS_PER_FRAME 0.100000000 ",
        "TIME 11/14/2023 22:13:20.123\r\n", "SATURATION_PRESSURE 620 kPa\r\n",
        "CALIBRATION_POINT_1 0 kPa\r\n", "CALIBRATION_POINT_2 620 kPa\r\n",
        "CALIBRATION_INFO 0123456789ab interpolated\r\n", "UNITS kPa\r\n", "START_FRAME 1\r\n",
        "END_FRAME 2  ", "\r\nASCII_DATA @@\r\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << " in\n" << text;
  }
}

TEST_F(TekscanFile, WritesFramesInKilopascalWithBForNoReading) {
  const std::string text = write({exampleScan()}, true);
  EXPECT_TRUE(
      test_support::holds(text, {"\r\nFrame 1\r\n0.000100000001,-0.0148925781,1e-33\r\n",
                                 "\r\n123.456789,B,600.000063\r\n\r\n@@\r\nFRAME_TIME 1 0.050000001\r\n"}));
}

TEST_F(TekscanFile, WritesCountsIfThereAreNoMaps) {
  const std::string text = write({bareScan()}, false);
  EXPECT_TRUE(test_support::holds(
      text, {"UNITS RAW\r\n", "SATURATION_PRESSURE 4095 RAW\r\n", "Frame 1\r\n9,8,7\r\n6,5,4\r\n"}));
}

// Reads the file as readers of the format do: header up to ASCII_DATA, then rows after each line that starts
// with Frame.
TEST_F(TekscanFile, IsReadByAReaderOfTekscanFiles) {
  write({exampleScan(), exampleScan()}, true);
  std::ofstream(folder_.path("read.py")) << R"(
import sys
lines = open(sys.argv[1], newline='').read().split('\r\n')
start = lines.index('ASCII_DATA @@')
header = dict(line.split(' ', 1) for line in lines[:start])
rows, frames = int(header['ROWS']), []
for i, line in enumerate(lines[start:]):
    if line.startswith('Frame'):
        frames.append([row.split(',') for row in lines[start + i + 1:start + i + 1 + rows]])
assert len(frames) == int(header['END_FRAME']) - int(header['START_FRAME']) + 1
assert all(len(row) == int(header['COLS']) for frame in frames for row in frame)
print(float(header['ROW_SPACING'].split()[0]), frames[1][1])
)";
  const auto python = test_support::outputOf("/usr/bin/python3 " + folder_.path("read.py") + " " + path_);
  EXPECT_EQ(python.text, "8.0 ['123.456789', 'B', '600.000063']\n");
}

TEST_F(TekscanFile, RefusesAMatrixThatChangesItsSize) {
  fsr::exports::ScanRecord other = bareScan();
  other.layout.size = {3, 2};
  EXPECT_THROW(write({bareScan(), other}, false), fsr::settings::InputError);
}

}  // namespace
