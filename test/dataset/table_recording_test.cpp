#include "dataset/table_recording.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/folder_test.h"
#include "support/holds.h"

namespace fsr::dataset {
namespace {

namespace fs = std::filesystem;

class Table : public test_support::FolderTest {
 protected:
  TableRecording read(const std::string& text, const std::string& columns, TablePlan plan = {}) const {
    std::ofstream(path_) << text;
    plan.columns = parseColumns(columns);
    return readTable(path_, plan);
  }
  std::string complaint(const std::string& text, const std::string& columns,
                        const TablePlan& plan = {}) const {
    return test_support::refusal([&] { read(text, columns, plan); });
  }
  void expectComplaint(const std::string& text, const std::string& columns,
                       const std::vector<std::string>& parts, const TablePlan& plan = {}) const {
    for (const std::string& part : parts)
      EXPECT_TRUE(test_support::holds(complaint(text, columns, plan), {part}));
  }

  const std::string path_ = path("table.csv");
};

constexpr const char* kPlain = "t,force,left,right\n0,10,1.0,2.0\n0.5,20,1.5,3.0\n1,30,2.5,4.0\n";

TEST_F(Table, BecomesARecordingInSiUnits) {
  TablePlan plan;
  plan.area = 2e-4;
  plan.curvature = 12.5;
  plan.surface = "cylinder_8cm";
  const TableRecording table = read(kPlain, "time=t,reference=force:N,reading=left:V,reading=right:V", plan);
  const Recording& recording = table.recording;
  EXPECT_EQ(recording.layout.size, (matrix::MatrixSize{1, 2}));
  EXPECT_EQ(recording.time, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(recording.pressure, (std::vector<double>{50e3, 100e3, 150e3}));  // 10 N on 2 cm^2
  EXPECT_EQ(table.scale.high, 5);
  EXPECT_EQ(table.scale.text(), "65535 counts = 5 V");
  EXPECT_EQ(recording.full_scale, 65535);
  EXPECT_EQ(recording.counts, (std::vector<std::uint16_t>{13107, 26214, 19661, 39321, 32768, 52428}));
  EXPECT_EQ(recording.conditions.size(), 1u);
  EXPECT_EQ(recording.conditions[0].curvature[0].x, 12.5);
}

TEST_F(Table, IsTheSameInEveryFormat) {
  const TableRecording plain = read(kPlain, "time=1,reading=3:V,reference=2:kPa");
  const std::vector<std::string> others = {
      "0 10 1.0 2.0\r\n0.5 20 1.5 3.0\r\n1 30 2.5 4.0\r\n",
      "\n# by hand\n0\t10\t1.0\t2.0\n0.5\t20\t1.5\t3.0\n\n1\t30\t2.5\t4.0",
      "\"t\";\"force\";\"left\";\"right\"\n0;10;1.0;2.0\n0.5;20;1.5;3.0\n1;30;2.5;4.0\n"};
  for (const std::string& text : others) {
    const TableRecording other = read(text, "time=1,reading=3:V,reference=2:kPa");
    EXPECT_EQ(other.recording.counts, plain.recording.counts) << text;
    EXPECT_EQ(other.recording.pressure, plain.recording.pressure) << text;
  }
  TablePlan labview;
  labview.format.decimal_comma = true;
  labview.format.skip_lines = 2;
  const std::string text = "LabVIEW Measurement\n12,5\n0\t10\t1,0\t2,0\n0,5\t20\t1,5\t3,0\n1\t30\t2,5\t4,0\n";
  EXPECT_EQ(read(text, "time=1,reading=3:V,reference=2:kPa", labview).recording.counts,
            plain.recording.counts);
}

TEST_F(Table, MayBeGzipped) {
  const TableRecording plain = read(kPlain, "time=t,reading=left:V");
  gzFile file = gzopen(path_.c_str(), "wb");
  gzputs(file, kPlain);
  gzclose(file);
  TablePlan plan;
  plan.columns = parseColumns("time=t,reading=left:V");
  EXPECT_EQ(readTable(path_, plan).recording.counts, plain.recording.counts);
  fs::resize_file(path_, fs::file_size(path_) - 12);  // truncated
  EXPECT_THROW(readTable(path_, plan), settings::InputError);
}

TEST_F(Table, ConvertsEveryUnit) {
  const char* const two = "0,100,2\n1,200,4\n";
  EXPECT_NEAR(read(two, "time=1:ms,reading=3:V,reference=2:psi").recording.pressure[0], 689475.7293, 1e-3);
  EXPECT_NEAR(read(two, "time=1,reading=3:V,reference=2:mmHg").recording.pressure[1], 26664.4774830, 1e-6);
  EXPECT_NEAR(read(two, "time=1,reading=3:V,reference=2:bar").recording.pressure[0], 1e7, 1e-6);
  EXPECT_NEAR(read(two, "time=1,reading=3:V,reference=2:2500Pa").recording.pressure[0], 250e3, 1e-6);
  EXPECT_NEAR(read(two, "time=1:ms,reading=3:V").recording.time[1], 1e-3, 1e-15);
  EXPECT_NEAR(read(two, "time=1:min,reading=3:V").recording.time[1], 60, 1e-12);
  EXPECT_NEAR(read(two, "time=1,reading=3:V,temperature=2:F").recording.temperature[0], 37.7778, 1e-4);
  EXPECT_NEAR(read(two, "time=1,reading=3:V,temperature=2:K").recording.temperature[0], -173.15, 1e-9);
  EXPECT_NEAR(read(two, "time=1,reading=2:V,curvature=3:1/cm").recording.conditions[0].curvature[0].x, 200,
              1e-9);
}

TEST_F(Table, ConvertsResistancesToConductances) {
  // 1 kohm = 1 mS, 500 ohm = 2 mS; no contact = no conductance
  const TableRecording table = read("0,1\n1,0.5\n2,inf\n", "time=1,reading=2:kohm");
  EXPECT_EQ(table.scale.unit, "S");
  EXPECT_NEAR(table.scale.high, 2e-3, 1e-15);
  EXPECT_EQ(table.recording.counts, (std::vector<std::uint16_t>{32768, 65535, 0}));
  expectComplaint("0,1\n1,0\n", "time=1,reading=2:ohm", {"line 2, column 2", "more than 0"});
}

TEST_F(Table, KeepsCountsUnchanged) {
  EXPECT_EQ(read("0,7\n1,4095\n", "time=1,reading=2:counts").recording.full_scale, 4095);
  const TableRecording wide = read("0,7\n1,5000\n", "time=1,reading=2:counts");
  EXPECT_EQ(wide.recording.full_scale, 65535);
  EXPECT_EQ(wide.recording.counts, (std::vector<std::uint16_t>{7, 5000}));
  TablePlan plan;
  plan.full_scale = 1023;
  expectComplaint("0,7\n1,2000\n", "time=1,reading=2", {"line 2", "2000", "--full-scale"}, plan);
}

TEST_F(Table, ConvertsAnAbsoluteReferenceByTheAmbientPressure) {
  TablePlan plan;
  plan.ambient_pressure = 100e3;
  EXPECT_EQ(read("0,150,1\n1,160,1\n", "time=1,reference=2:kPa,reading=3:V", plan).recording.pressure,
            (std::vector<double>{50e3, 60e3}));
}

TEST_F(Table, MakesAConditionOfEverySurfaceAndMount) {
  const std::string text = "0,1,flat,1\n1,1,flat,1\n2,1,bent,2\n3,1,flat,3\n4,1,flat,1\n";
  const Recording recording = read(text, "time=1,reading=2:V,surface=3,mount=4").recording;
  EXPECT_EQ(recording.condition, (std::vector<std::uint32_t>{0, 0, 1, 2, 0}));
  EXPECT_EQ(recording.conditions[1].name, "bent");
  EXPECT_EQ(recording.conditions[2].mount, 3u);
}

TEST_F(Table, CountsItsTimeFromTheFirstRow) {
  TablePlan plan;
  plan.start_ns = 0;
  const Recording recording = read("1600000000.5,1\n1600000001.5,1\n", "time=1,reading=2:V", plan).recording;
  EXPECT_EQ(recording.start_ns, 1600000000500000000);
  EXPECT_EQ(recording.time, (std::vector<double>{0, 1}));
}

TEST_F(Table, TakesALateTimeAsUnixTime) {
  const TableRecording table = read("t,u\n1700000000,1\n1700000001,2\n", "time=t,reading=u");
  EXPECT_TRUE(table.unix_time);
  EXPECT_EQ(table.recording.start_ns, 1700000000000000000);
  TablePlan plan;
  plan.start_ns = 1000000000;  // the user's word goes first
  const TableRecording told = read("t,u\n1700000000,1\n1700000001,2\n", "time=t,reading=u", plan);
  EXPECT_FALSE(told.unix_time);
  EXPECT_EQ(told.recording.start_ns, 1700000001000000000);
}

TEST_F(Table, TurnsFallingCountsRound) {
  TablePlan plan;
  plan.range = {{4095, 0}};
  const TableRecording table = read("t,u\n0,4095\n1,4000\n2,95\n", "time=t,reading=u", plan);
  EXPECT_EQ(table.recording.full_scale, 4095);
  EXPECT_EQ(table.recording.counts, (std::vector<std::uint16_t>{0, 95, 4000}));
  EXPECT_EQ(table.scale.text(), "0 counts = 4095 and 4095 counts = 0 of the table");
  plan.range = {{1000, 2000}};
  EXPECT_EQ(read("t,u\n0,1000\n1,1500\n", "time=t,reading=u", plan).recording.counts,
            (std::vector<std::uint16_t>{0, 500}));
  expectComplaint("t,u\n0,1000\n1,999\n", "time=t,reading=u", {"line 3", "widen --range"}, plan);
}

// The reference was recorded by itself, twice as often as the readings and for a shorter time.
TEST_F(Table, InterpolatesAReferenceWithTimesOfItsOwn) {
  const std::string text = "t,u,tp,p\n0,1,0.25,10\n0.5,2,0.5,20\n1.0,3,1.0,40\n1.5,4,,\n,,,\n";
  const std::string columns = "time=t,reading=u,reference=p:kPa,reference_time=tp";
  const TableRecording table = read(text, columns);
  EXPECT_EQ(table.recording.time, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(table.recording.pressure, (std::vector<double>{20e3, 40e3}));
  EXPECT_EQ(table.no_reference, 2u);
  EXPECT_EQ(table.recording.counts.size(), 2u);
  TablePlan plan;
  plan.reference_offset = -0.25;
  EXPECT_EQ(read(text, columns, plan).recording.pressure.front(), 10e3);
  expectComplaint("t,u,tp\n0,1,0\n1,2,1\n", "time=t,reading=u,reference_time=tp", {"names no reference"});
  expectComplaint("t,u,tp,p\n0,1,1,0\n1,2,1,1\n", columns, {"line 3", "not later"});
}

TEST_F(Table, InterpolatesAReferenceWithoutTimesByItsRate) {
  TablePlan plan;
  plan.reference_rate = 4;
  const TableRecording table =
      read("t,u,p\n10,1,0\n10.5,2,10\n11,3,20\n,,30\n,,40\n", "time=t,reading=u,reference=p:kPa", plan);
  EXPECT_EQ(table.recording.pressure, (std::vector<double>{0, 20e3, 40e3}));
  EXPECT_EQ(table.no_reference, 0u);
}

TEST_F(Table, ReadsUtf8WithAByteOrderMarkAndRefusesUtf16) {
  EXPECT_EQ(read("\xEF\xBB\xBFt,u\n0,1\n1,2\n", "time=t,reading=u").recording.scans(), 2u);
  expectComplaint(std::string("\xFF\xFEt\0,\0u\0\n\0", 10), "time=t,reading=u", {"UTF-16", "UTF-8"});
}

TEST_F(Table, RefusesASpreadsheetInOneSentenceOfItsOwn) {
  for (const std::string begin : {"PK\x03\x04", "\xD0\xCF\x11\xE0"}) {  // .xlsx and .ods; .xls
    const std::string said = complaint(begin + std::string("\x14\0\x1B[31m\xB1,", 9), "time=t,reading=u");
    EXPECT_TRUE(test_support::holds(said, {path_, "CSV"}));
  }
}

TEST_F(Table, TakesARangeOfColumnsInTheOrderOfTheTable) {
  const std::string text = "t,c1,c2,a-b,c\n0,1,2,3,4\n1,5,6,7,8\n";
  const auto counts = [&](const std::string& columns) {
    return read(text, "time=t," + columns).recording.counts;
  };
  using Counts = std::vector<std::uint16_t>;
  EXPECT_EQ(counts("reading=c1-a-b:counts"), (Counts{1, 2, 3, 5, 6, 7}));
  EXPECT_EQ(counts("reading=3-4,reading=c1-c1"), (Counts{2, 3, 1, 6, 7, 5}));
  EXPECT_EQ(counts("reading=a-b"), (Counts{3, 7})) << "a column of this name";
  std::string wide = "0";
  for (int i = 0; i < 80; ++i) wide += ",1";
  expectComplaint(wide + "\n", "time=1,reading=2-81", {"names 80 readings", "give --matrix ROWSxCOLUMNS"});
  expectComplaint(text, "time=t,reading=c2-c1", {"\"c2-c1\"", "ends before it begins"});
  expectComplaint(text, "time=t,reading=c1-c9", {"no column \"c1-c9\"", "c2"});
  expectComplaint(text, "time=t,reading=c1,reference=c1-c2", {"no column \"c1-c2\""});
}

TEST_F(Table, RefusesAPointAmongDecimalCommas) {
  TablePlan plan;
  plan.format.decimal_comma = true;
  expectComplaint("t;u\n0;1.234\n1;2,5\n", "time=t,reading=u", {"line 2", "1.234", "without a point"}, plan);
}

TEST_F(Table, NamesLineAndColumnOfACellThatIsNotANumber) {
  const std::string head = "t,x\n0,1\n1,2\n";
  expectComplaint(head + "2,nan\n", "time=t,reading=x:V", {path_, "line 4, column x", "nan"});
  expectComplaint(head + "2,\n", "time=t,reading=x:V", {"line 4, column x", "empty"});
  expectComplaint(head + "2,1.5V\n", "time=t,reading=x:V", {"line 4, column x", "1.5V"});
  expectComplaint(head + "2,inf\n", "time=t,reading=x:V", {"line 4, column x", "inf"});
  expectComplaint(head + "2\n", "time=t,reading=x:V", {"line 4", "1 columns"});
}

TEST_F(Table, RefusesATimeThatDoesNotIncrease) {
  expectComplaint("0,1\n1,1\n0.5,1\n", "time=1,reading=2:V", {"line 3, column 1", "0.5", "move on"});
  expectComplaint("0,1\n1,1\n1,1\n", "time=1,reading=2:V", {"line 3, column 1", "move on"});
}

TEST_F(Table, SkipsBadRowsOnRequest) {
  TablePlan plan;
  plan.skip_bad_rows = true;
  const TableRecording table = read("0,1\n1,nan\n2,1\n1.5,1\n3\n4,1\n", "time=1,reading=2:V", plan);
  EXPECT_EQ(table.recording.time, (std::vector<double>{0, 2, 4}));
  EXPECT_EQ(table.skipped, 3u);
}

TEST_F(Table, RefusesReadingsOutsideTheRange) {
  TablePlan plan;
  plan.range = {{0, 2}};
  expectComplaint(
      kPlain, "time=t,reading=right:V",
      {"line 4: a reading of 4 V is outside 0 to 2 V; all readings are from 2 to 4; widen --range"}, plan);
  plan.range = {{3, 2.5}};
  expectComplaint(kPlain, "time=t,reading=left:V", {"line 2: a reading of 1 V", "from 1 to 2.5;"}, plan);
  plan.range = {{-5, 5}};
  const TableRecording table = read(kPlain, "time=t,reading=right:V", plan);
  EXPECT_EQ(table.scale.text(), "0 counts = -5 V, 65535 counts = 5 V");
  EXPECT_EQ(table.recording.counts[0], 45875);  // 7/10 of 65535
  plan.range = {{5, -5}};                       // decreases with the pressure
  EXPECT_EQ(read(kPlain, "time=t,reading=right:V", plan).recording.counts[0], 19661);  // 3/10
}

TEST_F(Table, RefusesAPlanThatDoesNotFit) {
  expectComplaint(kPlain, "time=t,reading=middle", {"middle", "left"});
  expectComplaint(kPlain, "time=t,reading=9", {"\"9\"", "1 to 4"});
  expectComplaint(kPlain, "time=t,reading=left:V,reading=right:ohm", {"of one kind"});
  TablePlan plan;
  plan.matrix = {2, 2};
  expectComplaint(kPlain, "time=t,reading=left:V", {"2 x 2"}, plan);
  expectComplaint("", "time=1,reading=2", {"has no row"});
  expectComplaint("t,x\n0,1\n", "time=t,reading=x", {"fewer than two"});
  TablePlan none;
  none.columns = parseColumns("time=1,reading=2");
  EXPECT_THROW(readTable("/no/such/table.csv", none), settings::InputError);
}

TEST(TableColumns, AreRefusedWithTheListOfPermittedValues) {
  const auto complaint = [](const std::string& text) -> std::string {
    return test_support::refusal([&] { parseColumns(text); });
  };
  EXPECT_NE(complaint("time=1,reeding=2").find("reeding"), std::string::npos);
  EXPECT_NE(complaint("time=1,reading=2:kg").find("Mohm"), std::string::npos);
  EXPECT_NE(complaint("time=1,time=2,reading=3").find("time twice"), std::string::npos);
  EXPECT_NE(complaint("reading=2").find("no time"), std::string::npos);
  EXPECT_NE(complaint("time=1").find("no reading"), std::string::npos);
  EXPECT_NE(complaint("time=1,reading=").find("has no column"), std::string::npos);
  EXPECT_NE(complaint("time=1,reading=2,reference=3:-5Pa").find("-5Pa"), std::string::npos);
  EXPECT_EQ(parseColumns("time=1:ms,reading=a:b:V")[1].column, "a:b");  // a name with a colon, unit given
}

TEST_F(Table, RefusesValuesOutsideTheRangeOfTheirUnit) {
  expectComplaint("0,1,1e-320\n1,2,5\n", "time=1,reference=2,reading=3:ohm",
                  {"line 1, column 3: is 1e-320, but in SI units must be 1e+15 at most"});
  expectComplaint("0,1e308,1\n1,2,5\n", "time=1,reference=2:psi,reading=3:V", {"column 2: is 1e308, but"});
  expectComplaint("1e300,1,1\n2e300,2,5\n", "time=1,reference=2,reading=3:V", {"must be 4e+09 at most"});
  expectComplaint("0,1,1,5e9\n1,2,5,5e9\n", "time=1,reference=2,reading=3:V,mount=4",
                  {"column 4: must be a whole number, 0 to 4294967295"});
}

TEST_F(Table, SkipsALineOfOtherWhiteSpace) {
  expectComplaint("\v\n", "time=1,reading=2:V", {"has no row"});
}

// As spreadsheets write it. It is no part of the first column's name.
TEST_F(Table, IgnoresAByteOrderMark) {
  const TableRecording table = read(std::string("\xEF\xBB\xBF") + kPlain, "time=t,reading=left:V");
  EXPECT_EQ(table.recording.scans(), 3u);
}

TEST_F(Table, RefusesADecimalPointWhereACommaIsTold) {
  TablePlan plan;
  plan.format.decimal_comma = true;
  expectComplaint("0;1.234\n1;2.345\n", "time=1,reading=2:V",
                  {"line 1, column 2", "\"1.234\"", "because of --decimal-comma"}, plan);
}

// A hundred kilobytes of gzip can hold a hundred megabytes of them.
TEST_F(Table, RefusesPackedEmptyLinesEarly) {
  gzFile file = gzopen(path_.c_str(), "wb");
  const std::string lines(1 << 20, '\n');
  for (int i = 0; i < 40; ++i) gzwrite(file, lines.data(), static_cast<unsigned>(lines.size()));
  gzclose(file);
  TablePlan plan;
  plan.columns = parseColumns("time=1,reading=2:V");
  EXPECT_TRUE(
      test_support::holds(test_support::refusal([&] { readTable(path_, plan); }), {"16 MiB of empty lines"}));
}

TEST_F(Table, RefusesALineThatBeginsWithAZeroByte) {
  expectComplaint(std::string("\0,1\n", 4), "time=1,reading=2:V", {"has a zero byte"});
}

}  // namespace
}  // namespace fsr::dataset
