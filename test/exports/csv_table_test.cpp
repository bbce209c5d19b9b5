#include "exports/scan_formats.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "exports/scan_examples.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/file_size_limit.h"
#include "support/holds.h"
#include "support/program_output.h"
#include "support/pty.h"

namespace {

using export_test::bareScan;
using export_test::exampleScan;
using test_support::outputOf;

class CsvTable : public testing::Test {
 protected:
  void write(const std::vector<fsr::exports::ScanRecord>& scans) { export_test::write("csv", path_, scans); }
  std::vector<std::string> lines() const {
    std::ifstream file(path_);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }

  test_support::TemporaryFolder folder_;
  std::string path_ = folder_.path("scans.csv");
};

TEST_F(CsvTable, HasARowForEachTaxelAndScan) {
  write({exampleScan(), bareScan()});
  const std::vector<std::string> rows = lines();
  ASSERT_EQ(rows.size(), 1u + 2 * 6);
  EXPECT_EQ(rows[0], fsr::exports::kCsvHeader);
  const std::string head =
      "2_cylinder.bag,2026-03-01,cylinder_7cm,3,2,\"note:wet, \"\"warm\"\"\","
      "0.050000001,7,";
  const std::string tail = ",OK,100.1,23.5,14.25,1700000000.123456789,";
  EXPECT_EQ(rows[1], head + "0,0,0,0.1,1,none" + tail + "none");
  EXPECT_EQ(rows[2], head + "0,1,1,-14.892578,2.5,TARED|BELOW_RANGE" + tail + "TARED|BELOW_RANGE");
  EXPECT_EQ(rows[5], head + "1,1,17,NA,NA,DEAD" + tail + "DEAD");
}

// Of a table, pandas gives `flags` and the like something other than the column of that name.
TEST_F(CsvTable, HasAColumnOfFlagsThatPandasDoesNotHide) {
  const std::string header = fsr::exports::kCsvHeader;
  EXPECT_EQ(header.substr(header.rfind(',')), ",taxel_flags") << "behind those of earlier versions";
}

TEST_F(CsvTable, NamesAHistoryThatIsNotSettled) {
  fsr::exports::ScanRecord scan = exampleScan();
  scan.map->flags[0] = fsr::map::taxel_flag::kSaturated | fsr::map::taxel_flag::kHistoryShort;
  write({scan});
  EXPECT_NE(lines().at(1).find(",SATURATED|HISTORY_SHORT,OK,"), std::string::npos) << lines().at(1);
}

TEST_F(CsvTable, WritesNaForUnknownValues) {
  write({bareScan()});
  EXPECT_EQ(
      lines().at(1),
      "2_cylinder.bag,NA,NA,NA,NA,NA,0.150000001,NA,0,0,9,NA,NA,NA,NA,NA,NA,NA,1700000000.223456789,NA");
}

TEST_F(CsvTable, RReadsBackTheExactNumbers) {
  if (!test_support::hasProgram("Rscript")) {
    GTEST_SKIP() << "Rscript is not installed (Debian package r-base-core): R was NOT tried";
  }
  write({exampleScan(), bareScan()});
  const auto r = outputOf("Rscript -e 'd <- read.csv(\"" + path_ +
                          "\"); cat(sprintf(\"%.9g\", d$pressure_Pa[1:6]), d$event[1], d$taxel_flags[2],"
                          " sum(is.na(d$pressure_Pa)), class(d$counts), max(d$counts), d$surface[7])'");
  ASSERT_EQ(r.status, 0) << r.text;
  std::istringstream words(r.text);
  std::string word;
  const fsr::exports::ScanRecord written = exampleScan();
  for (const float pressure : written.map->pressure) {
    words >> word;
    if (std::isnan(pressure)) {
      EXPECT_EQ(word, "NA");
    } else {
      EXPECT_EQ(std::stof(word), pressure);
    }
  }
  std::getline(words, word);
  EXPECT_EQ(word, " note:wet, \"warm\" TARED|BELOW_RANGE 7 integer 4095 NA");
}

// The command is that of docs/exports.md.
TEST_F(CsvTable, OctaveReadsBackTheExactNumbers) {
  if (!test_support::hasProgram("octave-cli")) {
    GTEST_SKIP() << "octave-cli is not installed (Debian package octave): Octave was NOT tried";
  }
  write({exampleScan(), bareScan()});
  std::ofstream(folder_.path("read.m"))
      << "f = fopen('" << path_ << "'); names = strsplit(fgetl(f), ',');\n"
      << "c = textscan(f, '%q%q%q%f%f%q%f%f%f%f%f%f%f%q%q%f%f%f%f%q', 'Delimiter', ',', "
         "'TreatAsEmpty', 'NA');\n"
      << "fclose(f); printf('%d %s %s %d ', numel(names), c{6}{1}, c{14}{2}, sum(isnan(c{12})));\n"
      << "printf('%.9g ', c{12}(1:6)); printf('%.9g %.9g', c{11}(6), c{7}(1));\n";
  const auto octave = outputOf("octave-cli --norc --no-history " + folder_.path("read.m") + " 2>/dev/null");
  EXPECT_EQ(octave.text,
            "20 note:wet, \"warm\" TARED|BELOW_RANGE 7 0.1 -14.892578 1e-30 123456.79 NaN 600000.06 4095 "
            "0.050000001");
}

TEST_F(CsvTable, IsCompressedIfItsNameEndsWithGz) {
  path_ += ".gz";
  write({bareScan()});
  EXPECT_EQ(outputOf("zcat " + path_ + " | wc -l").text, "7\n");
}

TEST_F(CsvTable, LeavesNoFileIfItIsNotFinishedOrTheDiskIsFull) {
  std::ofstream(path_) << "old,table";
  {
    const auto table = export_test::opened("csv", path_);
    table->begin(export_test::exampleSubject());
    table->add(exampleScan());
  }
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] {
                                    const test_support::FileSizeLimit limit(1000);
                                    write(std::vector<fsr::exports::ScanRecord>(2000, exampleScan()));
                                  }),
                                  {path_ + ": cannot be written"}));
  EXPECT_EQ(lines(), std::vector<std::string>{"old,table"});
  const std::filesystem::directory_iterator files(folder_.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

}  // namespace
