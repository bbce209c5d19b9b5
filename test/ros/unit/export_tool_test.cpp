#include "ros/tools/tools.h"

#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Float64.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_writer.h"
#include "support/content_of.h"
#include "support/file_size_limit.h"
#include "support/holds.h"
#include "support/line_format.h"
#include "support/program_output.h"
#include "support/pty.h"
#include "support/small_calibration.h"
#include "support/source_dir.h"
#include "support/synthetic_recording.h"
#include "support/tool_run.h"

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kStart = 1500000000123456789;  // [ns]

/// A bag of two surfaces and ten cycles, 1,000 scans of 2 x 3 taxels at 10 Hz, two minutes long.
class ExportTool : public testing::Test {
 protected:
  void SetUp() override {
    test_support::SyntheticRig rig;
    rig.surfaces = {{"flat", 0.0}, {"cylinder_7cm", 14.25}};
    rig.full_scale = 1023;
    recording_ = test_support::syntheticRecording(rig);
    recording_.start_ns = kStart;
    recording_.temperature.assign(recording_.scans(), 23.5);
    recording_.sensor.serial = "board-1";
    fsr_ros::BagOptions options;
    options.session.session_id = "s1";
    fsr_ros::writeBag(bag_, recording_, options);
  }

  std::string run(const std::vector<std::string>& words,
                  const std::vector<fsr::exports::ScanFormat>& formats = fsr::exports::scanFormats()) {
    const auto tool = [&](int argc, const char* const* argv, std::ostream& out) {
      return fsr_ros::exportTool(argc, argv, out, formats);
    };
    return test_support::runTool(tool, "export", words).said();
  }

  // The columns of the table by name.
  static std::map<std::string, std::vector<std::string>> table(const std::string& path) {
    std::ifstream file(path);
    std::vector<std::string> names;
    std::map<std::string, std::vector<std::string>> columns;
    for (std::string line; std::getline(file, line);) {
      std::istringstream cells(line);
      std::size_t i = 0;
      const bool head = names.empty();
      for (std::string cell; std::getline(cells, cell, ',');) {
        if (head) {
          names.push_back(cell);
        } else {
          columns[names.at(i++)].push_back(cell);
        }
      }
    }
    return columns;
  }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), {}));
  }

  // The bag with a map for each scan, and an event 5 s after the start.
  std::string withMaps() {
    const std::string path = folder_.path("maps.bag");
    rosbag::Bag from(bag_), to(path, rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& instance : rosbag::View(from)) {
      to.write(instance.getTopic(), instance.getTime(), instance, instance.getConnectionHeader());
      const auto frame = instance.instantiate<fsr_pressure_map::MatrixFrame>();
      if (frame == nullptr) continue;
      fsr_pressure_map::PressureMap map;
      map.header = frame->header;
      map.calibration = "0123456789ab";
      map.scheme = "interpolated";
      map.rows = 2;
      map.columns = 3;
      map.pitch_x = map.pitch_y = 0.01f;
      for (const std::uint16_t counts : frame->counts)
        map.pressure.push_back(static_cast<float>(counts) * 100.1f);
      map.deviation.assign(6, 1000);
      map.flags.assign(6, 0);
      to.write("/fsr/pressure_map", instance.getTime() + ros::Duration(0.25), map);  // after the next scans
    }
    fsr_pressure_map::Event event;
    event.header.stamp.fromNSec(kStart + 5000000000);
    event.kind = "note";
    event.label = "wet";
    to.write("/fsr/events", event.header.stamp, event);
    event.header.stamp.fromNSec(kStart + 6000000000);
    event.kind = "sync";  // an edge of the trigger hides no mark
    event.label = "trigger rising +- 0.002 ms";
    to.write("/fsr/events", event.header.stamp, event);
    to.close();
    return path;
  }

  test_support::TemporaryFolder folder_;
  std::string bag_ = folder_.path("1_flat.bag");
  std::string csv_ = folder_.path("out.csv");
  fsr::dataset::Recording recording_;
};

TEST_F(ExportTool, WritesEveryScanOfABagWithoutMaps) {
  const std::string said = run({bag_, "--to", "csv", "--output", csv_});
  EXPECT_EQ(said, "1000 scans written to " + csv_ + "\n");
  const auto columns = table(csv_);
  ASSERT_EQ(columns.at("counts").size(), 6000u);
  for (std::size_t scan = 0; scan < 1000; scan += 37) {
    for (std::size_t taxel = 0; taxel < 6; ++taxel) {
      const std::size_t row = scan * 6 + taxel;
      EXPECT_EQ(columns.at("counts")[row], std::to_string(recording_.scan(scan)[taxel]));
      EXPECT_NEAR(std::stod(columns.at("chamber_pressure_gauge_Pa")[row]), recording_.pressure[scan], 1e-6);
      EXPECT_NEAR(std::stod(columns.at("time_s")[row]), recording_.time[scan] - recording_.time[0], 1e-6);
      EXPECT_EQ(columns.at("surface")[row], recording_.conditions[recording_.condition[scan]].name);
      EXPECT_EQ(columns.at("pressure_Pa")[row], "NA");
      EXPECT_EQ(columns.at("session")[row], "s1");
    }
  }
  const std::set<std::string> cycles(columns.at("cycle").begin(), columns.at("cycle").end());
  EXPECT_EQ(cycles.size(), 10u);
}

TEST_F(ExportTool, JoinsScansWithTheirMapsAndEvents) {
  run({withMaps(), "--to", "csv", "--output", csv_});
  const auto columns = table(csv_);
  ASSERT_EQ(columns.at("counts").size(), 6000u);
  for (std::size_t row = 0; row < 6000; ++row) {
    const float expected = static_cast<float>(std::stoi(columns.at("counts")[row])) * 100.1f;
    ASSERT_EQ(std::stof(columns.at("pressure_Pa")[row]), expected) << row;
    ASSERT_EQ(columns.at("event")[row], std::stod(columns.at("time_s")[row]) < 5 ? "NA" : "note:wet") << row;
  }
}

TEST_F(ExportTool, ComputesMapsWithACalibration) {
  const std::string calibration = folder_.path("calibration.h5");
  fsr::calibration::saveCalibration(test_support::smallCalibration({2, 3}, {0.0, 14.25}), calibration);
  run({bag_, "--to", "csv", "--output", csv_, "--calibration", calibration});
  const auto columns = table(csv_);
  ASSERT_EQ(columns.at("pressure_Pa").size(), 6000u);
  EXPECT_EQ(columns.at("state").front(), "OK");
  EXPECT_NE(columns.at("pressure_Pa").front(), "NA");
}

TEST_F(ExportTool, TakesATimeRangeARateAndSeveralBags) {
  run({bag_, bag_, "--to", "csv", "--output", csv_, "--from", "1", "--until", "3", "--rate", "2"});
  const auto columns = table(csv_);
  EXPECT_EQ(columns.at("time_s").size(), 2u * 5 * 6);
  EXPECT_EQ(columns.at("time_s").front(), "1.000000000");
  EXPECT_EQ(columns.at("time_s").back(), "3.000000000");
}

TEST_F(ExportTool, WritesTekscanFrames) {
  run({bag_, "--to", "tekscan", "--output", folder_.path("a.asf")});
  const std::string text = test_support::contentOf(folder_.path("a.asf"));
  EXPECT_NE(text.find("\nEND_FRAME 1000 "), std::string::npos);
  EXPECT_NE(text.find("SECONDS_PER_FRAME 0.1000"), std::string::npos);
}

TEST_F(ExportTool, RefusesACalibrationOfAnotherMatrix) {
  const std::string calibration = folder_.path("calibration.h5");
  fsr::calibration::saveCalibration(test_support::smallCalibration({3, 3}, {0.0}), calibration);
  EXPECT_NE(run({bag_, "--to", "csv", "--output", csv_, "--calibration", calibration})
                .find("the scans have 2 x 3 taxels and up to 1023 counts, but the calibration is for 3 x 3"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(csv_));
}

// A message as stored in a bag.
using Held = std::tuple<std::string, std::string, std::uint64_t, std::string, ros::M_string>;

std::vector<Held> messagesOf(const std::string& path) {
  std::vector<Held> messages;
  const rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& instance : rosbag::View(bag)) {
    std::string bytes(instance.size(), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), instance.size());
    instance.write(stream);
    messages.emplace_back(instance.getTopic(), instance.getDataType(), instance.getTime().toNSec(), bytes,
                          *instance.getConnectionHeader());
  }
  return messages;
}

// The bag was recorded before the PressureMap had FLAG_HISTORY_SHORT.
TEST_F(ExportTool, ReadsMapsOfTheEarlierDefinition) {
  const std::string old = test_support::sourceDir() + "/test/data/indenter_map.bag";
  rosbag::Bag bag(old);
  rosbag::View view(bag, rosbag::TopicQuery("/fsr/pressure_map"));
  ASSERT_EQ(view.begin()->getMD5Sum(), "50c65025fc4b01118cf4b0ef3469834e");
  ASSERT_NE(view.begin()->getMD5Sum(), ros::message_traits::md5sum<fsr_pressure_map::PressureMap>());
  run({old, "--to", "csv", "--output", csv_});
  const auto columns = table(csv_);
  EXPECT_EQ(columns.at("state").front(), "OK");
  std::vector<float> exported, recorded;
  for (const std::string& pressure : columns.at("pressure_Pa")) exported.push_back(std::stof(pressure));
  for (Held& held : messagesOf(old)) {
    if (std::get<1>(held) != ros::message_traits::datatype<fsr_pressure_map::PressureMap>()) continue;
    std::string& bytes = std::get<3>(held);
    ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                       static_cast<std::uint32_t>(bytes.size()));
    fsr_pressure_map::PressureMap map;
    ros::serialization::deserialize(stream, map);
    recorded.insert(recorded.end(), map.pressure.begin(), map.pressure.end());
  }
  EXPECT_EQ(exported, recorded);
}

// The datasets are equal to the columns of the table.
TEST_F(ExportTool, H5pyReadsTheScansOfTheTable) {
  if (test_support::outputOf("/usr/bin/python3 -c 'import h5py' 2>&1").status != 0) {
    GTEST_SKIP() << "h5py is not installed (Debian package python3-h5py): it was NOT tried";
  }
  const std::string file = folder_.path("all.h5"), maps = withMaps();
  EXPECT_EQ(run({maps, "--to", "hdf5", "--output", file}), "1000 scans written to " + file + "\n");
  run({maps, "--to", "csv", "--output", csv_});
  std::ofstream(folder_.path("compare.py")) << R"(
import csv, math, sys, h5py
f, rows = h5py.File(sys.argv[1]), list(csv.DictReader(open(sys.argv[2])))
s = {name: f['scans'][name][:] for name in f['scans']}
def same(value, text): return math.isnan(value) if text == 'NA' else type(value)(text) == value
for i in range(0, len(s['stamp']), 7):
    row = rows[6 * i + 4]
    assert f'{s["stamp"][i] // 10**9}.{s["stamp"][i] % 10**9:09d}' == row['stamp_s']
    assert s['sequence'][i] == int(row['sequence'])
    assert s['counts'][i, 1, 1] == int(row['counts'])
    assert s['flags'][i, 1, 1] == 0 and row['flags'] == 'none' and row['state'] == ('OK' if s['state'][i] == 0 else '')
    for name, column in (('pressure', 'pressure_Pa'), ('deviation', 'deviation_Pa'), ('curvature', 'curvature_per_m')):
        assert same(s[name][i, 1, 1], row[column]), name
    for name, column in (('chamber_pressure', 'chamber_pressure_gauge_Pa'), ('temperature', 'temperature_degC')):
        assert same(s[name][i], row[column]), name
    assert s['cycle'][i] == int(row['cycle'])
    assert s['mount'][i] == (0 if row['mount'] == 'NA' else int(row['mount']))
    for label in ('surface', 'session', 'event'):
        assert (s[label + '_names'][s[label][i]].decode() or 'NA') == row[label], label
scans = f['scans']
print(s['counts'].shape, scans['pressure'].attrs['unit'].decode(), scans['pressure'].compression,
      scans.attrs['bag'].decode(), scans.attrs['pitch_x'].round(6), len(rows))
)";
  const auto python = test_support::outputOf("/usr/bin/python3 " + folder_.path("compare.py") + " " + file +
                                             " " + csv_ + " 2>&1");
  EXPECT_EQ(python.text, "(1000, 2, 3) Pa gzip maps.bag 0.01 6000\n");
}

TEST_F(ExportTool, WritesHdf5OfABagWithoutMapsAndWithACalibration) {
  const std::string calibration = folder_.path("calibration.h5"), file = folder_.path("a.h5");
  fsr::calibration::saveCalibration(test_support::smallCalibration({2, 3}, {0.0, 14.25}), calibration);
  EXPECT_EQ(run({bag_, "--to", "hdf5", "--output", file}), "1000 scans written to " + file + "\n");
  EXPECT_EQ(run({bag_, "--to", "hdf5", "--output", file, "--calibration", calibration, "--rate", "1"}),
            "100 scans written to " + file + "\n");
}

// Statistics by region, computed again by numpy from the table of taxels. A taxel has 1 cm2, 1e-5 less on the
// cylinder.
TEST_F(ExportTool, NumpyFindsTheStatisticsOfTheRegions) {
  const std::string maps = withMaps(), regions = folder_.path("regions.yaml");
  std::ofstream(regions) << "regions:\n  - {name: left, rows: [0, 1], columns: [0, 1]}\n";
  run({maps, "--to", "csv", "--output", csv_});
  const std::string statistics = folder_.path("statistics.csv"), trial = folder_.path("trial.csv");
  EXPECT_EQ(
      run({maps, "--to", "statistics", "--regions", regions, "--contact", "30", "--output", statistics}),
      "1000 scans written to " + statistics + "\n");
  EXPECT_EQ(run({maps, "--to", "trial", "--regions", regions, "--contact", "30", "--above", "50", "--output",
                 trial}),
            "1000 scans written to " + trial + "\n");
  EXPECT_EQ(run({maps, "--to", "statistics", "--unit", "mmHg", "--output", folder_.path("all.h5")}),
            "1000 scans written to " + folder_.path("all.h5") + "\n");
  std::ofstream(folder_.path("compare.py")) << R"(
import csv, importlib.util, sys
import numpy as np
taxels, statistics, trial = ([row for row in csv.DictReader(open(path))] for path in sys.argv[1:4])
p = np.array([float(row['pressure_Pa']) for row in taxels]).reshape(1000, 2, 3) / 1e3
t = np.array([float(row['time_s']) for row in taxels]).reshape(1000, 6)[:, 0]
step = np.diff(t) * (np.diff(t) <= 1)
def integral(y): return (step * (y[1:] + y[:-1]) / 2).sum()
for name, part in (('whole_matrix', p), ('left', p[:, :, :2])):
    part = part.reshape(1000, -1)
    rows = [row for row in statistics if row['region'] == name]
    contact = part >= 30
    force = (part * contact).sum(axis=1) / 10  # kPa cm2 = 0.1 N
    for column, values in (('peak_kPa', part.max(axis=1)), ('mean_kPa', part.mean(axis=1)), ('force_N', force),
                           ('contact_area_cm2', contact.sum(axis=1)),
                           ('force_deviation_N', np.where(contact.any(axis=1), contact.sum(axis=1) / 10, np.nan))):
        ours = np.array([np.nan if row[column] == 'NA' else float(row[column]) for row in rows])
        np.testing.assert_allclose(ours, values, rtol=3e-5, err_msg=name + column)
    np.testing.assert_allclose(float(rows[-1]['integral_kPa_s']), max(integral(part[:, k]) for k in range(part.shape[1])), rtol=3e-5)
    row = next(row for row in trial if row['region'] == name and row['step'] == '0')
    for column, value in (('peak_kPa', part.max()), ('force_N', force.max()), ('impulse_N_s', integral(force)),
                          ('peak_integral_kPa_s', integral(part.max(axis=1))),
                          ('contact_time_s', integral(contact.any(axis=1) * 1.0)),
                          ('time_above_s', integral((part.max(axis=1) >= 50) * 1.0))):
        np.testing.assert_allclose(float(row[column]), value, rtol=3e-5, err_msg=name + column)
if importlib.util.find_spec('h5py'):
    import h5py
    f = h5py.File(sys.argv[4])['statistics']
    np.testing.assert_allclose(f['peak'][:], p.reshape(1000, 6).max(axis=1) / 0.133322387415, rtol=1e-6)
    assert (f['peak'].attrs['unit'], f['region'][0], len(f)) == (b'mmHg', b'whole_matrix', 25)
print(len([row for row in trial if row['region'] == 'left' and row['step'] != '0']), 'steps')
)";
  const auto python =
      test_support::outputOf("/usr/bin/python3 " + folder_.path("compare.py") + " " + csv_ + " " +
                             statistics + " " + trial + " " + folder_.path("all.h5") + " 2>&1");
  EXPECT_EQ(python.text, "10 steps\n") << "one for each cycle";
}

TEST_F(ExportTool, StatisticsNeedMapsAndTheirOwnOptions) {
  const auto said = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {bag_, "--output", csv_, "--to"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  EXPECT_NE(said({"statistics"}).find("1_flat.bag: holds no pressure maps; give the calibration"),
            std::string::npos);
  EXPECT_NE(said({"csv", "--unit", "kPa"}).find("--unit"), std::string::npos);
  EXPECT_NE(said({"statistics", "--above", "50"}).find("--above"), std::string::npos);
  EXPECT_NE(said({"trial", "--unit", "psi"}).find("psi"), std::string::npos);
  EXPECT_FALSE(fs::exists(csv_));
}

TEST_F(ExportTool, WritesTheRowsOfAllSheetsOfABag) {
  const std::string maps = withMaps(), two = folder_.path("two.bag"), out = folder_.path("rows.csv");
  {
    rosbag::Bag from(maps), to(two, rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& instance : rosbag::View(from)) {
      const std::string base = instance.getTopic().substr(4);  // without /fsr
      to.write("/left" + base, instance.getTime(), instance);
      // One session node for both, and other maps of the right sheet, which are no third sheet.
      if (base == "/session" || base == "/events") continue;
      to.write("/right" + base, instance.getTime(), instance);
      if (base == "/pressure_map") to.write("/right/flat_only" + base, instance.getTime(), instance);
    }
  }
  EXPECT_EQ(run({two, "--to", "statistics", "--output", out}), "2000 scans written to " + out + "\n");
  const auto rows = table(out);
  ASSERT_EQ(rows.at("sheet").size(), 2000u);
  EXPECT_EQ(rows.at("sheet")[999], "left");
  EXPECT_EQ(rows.at("sheet")[1000], "right");
  EXPECT_EQ(rows.at("session")[1000], "s1");
  EXPECT_EQ(rows.at("event")[1999], "note:wet");
  run({two, maps, "--to", "trial", "--output", out});
  auto trial = table(out);
  std::map<std::pair<std::string, std::string>, int> count;
  for (std::size_t i = 0; i < trial.at("sheet").size(); ++i) ++count[{trial["bag"][i], trial["sheet"][i]}];
  EXPECT_EQ(count.size(), 3u);
  EXPECT_EQ((count[{"two.bag", "right"}]), (count[{"maps.bag", "fsr"}]));
  run({two, "--to", "trial", "--output", out, "--namespace", "right"});
  EXPECT_EQ(table(out).count("sheet"), 0u) << "a table of one sheet stays as it is";
  EXPECT_NE(run({two, "--to", "csv", "--output", csv_}).find("holds several sensors: left, right; choose"),
            std::string::npos);
}

TEST_F(ExportTool, TakesTheCalibrationOfEachSheet) {
  const std::string two = folder_.path("two.bag"), out = folder_.path("rows.csv");
  {
    rosbag::Bag from(bag_), to(two, rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& instance : rosbag::View(from)) {
      const std::string base = instance.getTopic().substr(4);
      to.write("/left" + base, instance.getTime(), instance);
      const auto info = instance.instantiate<fsr_pressure_map::MatrixInfo>();
      if (info != nullptr) info->serial = "board-2";
      if (info != nullptr) to.write("/right" + base, instance.getTime(), *info);
      if (info == nullptr) to.write("/right" + base, instance.getTime(), instance);
    }
  }
  const auto of = [&](const std::string& serial) {
    auto calibration = test_support::smallCalibration({2, 3}, {0.0, 14.25});
    calibration.sensor.serial = serial;
    fsr::calibration::saveCalibration(calibration, folder_.path(serial));
    return folder_.path(serial);
  };
  const std::string first = of("board-1"), second = of("board-2");
  EXPECT_TRUE(test_support::holds(run({two, "--to", "statistics", "--output", out, "--calibration", second}),
                                  {two, "board-1", "--calibration", second, "--namespace"}));
  EXPECT_FALSE(fs::exists(out));
  run({two, "--to", "statistics", "--output", out, "--calibration", second + "," + first});
  const auto rows = table(out);
  EXPECT_EQ(rows.at("sheet").size(), 2000u);
  for (const std::string& state : rows.at("state")) ASSERT_EQ(state, "OK");
}

TEST_F(ExportTool, LeavesNoFileWhenTheDiskIsFull) {
  const std::string maps = withMaps();
  const std::size_t before = files();
  const test_support::FileSizeLimit limit(20000);
  for (const std::string format : {"hdf5", "csv", "tekscan", "statistics", "statistics.h5"}) {
    const std::string path = folder_.path(format == "statistics.h5" ? "full.h5" : "full");
    EXPECT_NE(run({maps, "--to", format.substr(0, format.find('.')), "--output", path})
                  .find(path + ": cannot be written (File too large)"),
              std::string::npos)
        << format;
    EXPECT_EQ(files(), before) << format;
  }
}

TEST_F(ExportTool, OffersAFormatFromOutsideThePackage) {
  std::vector<fsr::exports::ScanFormat> formats = fsr::exports::scanFormats();
  formats.push_back(test_support::lineFormat());
  const std::string output = folder_.path("scans.txt");
  EXPECT_EQ(run({bag_, "--to", "lines", "--output", output, "--until", "3"}, formats),
            "31 scans written to " + output + "\n");
  std::ifstream file(output);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "# 1_flat.bag");
  std::getline(file, line);
  std::string first = "0.000000";
  for (std::size_t taxel = 0; taxel < 6; ++taxel) first += " " + std::to_string(recording_.scan(0)[taxel]);
  EXPECT_EQ(line, first);

  EXPECT_NE(run({"--help"}, formats).find("lines      one line for each scan"), std::string::npos);
  EXPECT_NE(run({bag_, "--to", "pdf", "--output", output}, formats).find("lines"), std::string::npos);
  EXPECT_NE(run({bag_, "--to", "lines", "--output", output}).find("must be one of"), std::string::npos);
}

TEST_F(ExportTool, RefusesUnusableInputInOneSentenceAndLeavesNothing) {
  const auto refusal = [&](const std::vector<std::string>& more, const std::string& to = "csv") {
    std::vector<std::string> words = {"--to", to, "--output", csv_};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  EXPECT_TRUE(test_support::holds(refusal({folder_.path("none.bag")}),
                                  {folder_.path("none.bag"), "there is no such file"}));
  EXPECT_TRUE(test_support::holds(refusal({bag_}, "pdf"), {"--to", "\"pdf\"", "hdf5"}));
  EXPECT_NE(refusal({bag_, "--namespace", "left"}).find("holds no topic /left/raw"), std::string::npos);
  EXPECT_NE(refusal({bag_, "--map", "map_b"}).find("holds no topic map_b, but /fsr/"), std::string::npos);
  EXPECT_NE(refusal({bag_, "--from", "500"}).find("holds no scan between"), std::string::npos);
  EXPECT_NE(refusal({bag_, "--from", "5", "--until", "4"}).find("--from is 5"), std::string::npos);
  EXPECT_NE(refusal({bag_, bag_}, "tekscan").find("takes one file, but 2 are given"), std::string::npos);
  const std::string foreign = folder_.path("foreign.bag");
  {
    rosbag::Bag bag(foreign, rosbag::bagmode::Write);
    bag.write("/other", ros::Time(1), std_msgs::Float64());
  }
  EXPECT_NE(refusal({foreign}).find("holds no topic raw of type"), std::string::npos);
  const std::string cut = folder_.path("cut.bag");
  fs::copy_file(bag_, cut);
  fs::resize_file(cut, fs::file_size(cut) / 2);
  EXPECT_NE(refusal({cut}).find("is not a complete bag"), std::string::npos);
  EXPECT_EQ(files(), 3u) << "the bags alone";
  EXPECT_TRUE(
      test_support::holds(run({bag_, "--to", "csv", "--output", bag_}), {bag_, "would be overwritten"}));
  EXPECT_NE(run({bag_, "--to", "csv", "--output", folder_.path("no/a.csv")}).find("cannot be written"),
            std::string::npos);
}

}  // namespace
