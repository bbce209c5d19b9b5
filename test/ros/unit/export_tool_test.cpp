#include "ros/tools/export_tool.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/PressureMap.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Duration.h>
#include <std_msgs/Empty.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Header.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt8MultiArray.h>

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
#include "ros/bags/bag_archive.h"
#include "ros/bags/bag_writer.h"
#include "settings/sha256.h"
#include "support/file_size_limit.h"
#include "support/line_format.h"
#include "support/program_output.h"
#include "support/pty.h"
#include "support/small_calibration.h"
#include "support/source_dir.h"
#include "support/synthetic_recording.h"

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
    std::vector<const char*> arguments = {"export"};
    for (const std::string& word : words) arguments.push_back(word.c_str());
    std::ostringstream out;
    try {
      EXPECT_EQ(fsr_ros::exportTool(static_cast<int>(arguments.size()), arguments.data(), out, formats), 0);
      return out.str();
    } catch (const fsr::settings::InputError& error) {
      return error.what();
    }
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
  std::ifstream file(folder_.path("a.asf"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("\nEND_FRAME 1000 "), std::string::npos);
  EXPECT_NE(text.find("SECONDS_PER_FRAME 0.1000"), std::string::npos);
}

TEST_F(ExportTool, DrawsMapsAtTheGivenRate) {
  const std::string bag = withMaps(), pictures = folder_.path("pictures");
  EXPECT_EQ(run({bag, "--to", "png", "--output", pictures, "--rate", "2", "--until", "3"}),
            "7 scans written to " + pictures + "\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(pictures), {}), 7);
  EXPECT_NE(run({bag, "--to", "png", "--output", pictures}).find("exists already"), std::string::npos);
  run({bag, "--to", "movie", "--output", folder_.path("maps.png"), "--until", "2", "--unit", "mmHg"});
  EXPECT_GT(fs::file_size(folder_.path("maps.png")), 20000u);
  EXPECT_NE(run({bag_, "--to", "png", "--output", folder_.path("none")})
                .find("compute the maps with --calibration"),
            std::string::npos);
  EXPECT_NE(
      run({bag, "--to", "png", "--output", folder_.path("none"), "--range", "5"}).find("--range is \"5\""),
      std::string::npos);
  EXPECT_NE(run({bag, "--to", "csv", "--output", csv_, "--unit", "kPa"})
                .find("--unit cannot be used with --to csv"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder_.path("none")));
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

void expectSame(const std::vector<Held>& after, const std::vector<Held>& before) {
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_TRUE(after[i] == before[i]) << "message " << i << " of " << std::get<0>(before[i]) << " at "
                                       << std::get<2>(before[i]) << " ns, now " << std::get<0>(after[i]);
  }
}

// Two publishers of one topic, types of other packages, texts and times that columns cannot hold, and arrays
// of all sizes.
void addOddMessages(const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Append);
  const auto header = [](const char* caller) {
    return boost::make_shared<ros::M_string>(
        ros::M_string{{"callerid", caller},
                      {"latching", "1"},
                      {"topic", "/twice"},
                      {"type", ros::message_traits::datatype<std_msgs::String>()},
                      {"md5sum", ros::message_traits::md5sum<std_msgs::String>()},
                      {"message_definition", ros::message_traits::definition<std_msgs::String>()}});
  };
  for (int i = 0; i < 40; ++i) {
    const ros::Time time(1500000001, 1000 * (i / 4));  // ten times, four messages each
    std_msgs::String text;
    text.data = i % 7 == 3 ? std::string("a\0b", 3) : "text " + std::to_string(i);
    bag.write("/twice", time, text, header(i % 2 == 0 ? "/one" : "/two"));
    diagnostic_msgs::DiagnosticArray diagnostics;
    diagnostics.header.stamp = time;
    diagnostics.status.resize(static_cast<std::size_t>(i % 3));
    for (auto& status : diagnostics.status) status.values.resize(static_cast<std::size_t>(i % 4));
    if (i % 3 == 2) diagnostics.status[1].values.resize(9);
    bag.write("/diagnostics", time, diagnostics);
    std_msgs::Duration duration;
    duration.data = ros::Duration(-3, 7 + i);
    bag.write("/fsr", time, duration);  // also the beginning of other topics' names
    std_msgs::UInt8MultiArray array;
    array.data.assign(static_cast<std::size_t>(i % 5), 7);
    bag.write("/odd name", time, array);
    std_msgs::Header unusual;
    unusual.stamp.nsec = 2000000000;  // more than one second
    bag.write("/unusual", time, unusual);
    bag.write("/empty", time, std_msgs::Empty());
  }
}

TEST_F(ExportTool, AnArchiveTurnsBackIntoTheBagByteForByte) {
  const std::string bag = withMaps(), archive = folder_.path("all.h5"), back = folder_.path("back.bag");
  addOddMessages(bag);
  const std::vector<Held> before = messagesOf(bag);
  EXPECT_EQ(run({bag, "--to", "hdf5", "--output", archive}),
            std::to_string(before.size()) + " messages written to " + archive + "\n");
  run({archive, "--to", "bag", "--output", back});
  expectSame(messagesOf(back), before);
}

TEST_F(ExportTool, TellsHowFarTheRestoredBagIs) {
  const std::string archive = folder_.path("all.h5"), back = folder_.path("back.bag");
  run({bag_, "--to", "hdf5", "--output", archive});
  std::vector<std::pair<std::string, std::vector<double>>> steps;
  const std::uint64_t messages =
      fsr_ros::restoreBag(archive, back, [&](const std::string& step, double share) {
        if (steps.empty() || steps.back().first != step) steps.push_back({step, {}});
        steps.back().second.push_back(share);
      });
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].first, "checking " + archive);
  EXPECT_EQ(steps[0].second.back(), 1);
  EXPECT_EQ(steps[1].first, "writing " + back);
  const std::vector<double>& written = steps[1].second;
  ASSERT_EQ(written.size(), messages);
  for (std::size_t i = 0; i < written.size(); ++i)
    EXPECT_EQ(written[i], static_cast<double>(i) / static_cast<double>(messages));
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

  const std::string archive = folder_.path("old.h5"), back = folder_.path("back.bag");
  const std::string said = run({old, "--to", "hdf5", "--output", archive});
  EXPECT_EQ(said.find("incomplete"), std::string::npos) << said;
  run({archive, "--to", "bag", "--output", back});
  expectSame(messagesOf(back), messagesOf(old));
}

TEST_F(ExportTool, AnArchiveIsReadPlainlyByH5py) {
  if (test_support::outputOf("/usr/bin/python3 -c 'import h5py' 2>&1").status != 0) {
    GTEST_SKIP() << "h5py is not installed (Debian package python3-h5py): it was NOT tried";
  }
  const std::string archive = folder_.path("all.h5");
  run({withMaps(), "--to", "hdf5", "--output", archive});
  const auto python = test_support::outputOf(
      "/usr/bin/python3 -c 'import h5py; f = h5py.File(\"" + archive +
      "\"); c = f[\"fsr/raw/counts\"]; p = f[\"fsr/pressure_map/pressure\"];"
      "print(c.shape, c[500, 1, 2], p.shape, p.attrs[\"unit\"].decode(), p.compression,"
      " f[\"fsr/session/session_id\"][0].decode(), f[\"fsr/raw/header.stamp\"][0],"
      " f[\"archive\"].attrs[\"sha256\"].decode())'");
  EXPECT_EQ(python.text, "(1000, 2, 3) " + std::to_string(recording_.scan(500)[5]) +
                             " (1000, 2, 3) Pa gzip s1 " + std::to_string(kStart) + " " +
                             fsr::settings::sha256OfFile(folder_.path("maps.bag")) + "\n");
}

// The joined scans are equal to those of the table.
TEST_F(ExportTool, AnArchiveHoldsTheJoinedScans) {
  if (test_support::outputOf("/usr/bin/python3 -c 'import h5py' 2>&1").status != 0) {
    GTEST_SKIP() << "h5py is not installed (Debian package python3-h5py): it was NOT tried";
  }
  const std::string archive = folder_.path("all.h5"), maps = withMaps();
  run({maps, "--to", "hdf5", "--output", archive});
  run({maps, "--to", "csv", "--output", csv_});
  std::ofstream(folder_.path("compare.py")) << R"(
import csv, sys, h5py
f, rows = h5py.File(sys.argv[1]), list(csv.DictReader(open(sys.argv[2])))
s = {name: f['scans'][name][:] for name in f['scans']}
counts, pressure = f['fsr/raw/counts'][:], f['fsr/pressure_map/pressure'][:]
raw_stamp, map_stamp = f['fsr/raw/header.stamp'][:], f['fsr/pressure_map/header.stamp'][:]
for i in range(0, len(s['stamp']), 7):
    row, raw, map_ = rows[6 * i + 4], s['raw'][i], s['pressure_map'][i]
    assert raw_stamp[raw] == map_stamp[map_] == s['stamp'][i]
    assert counts[raw, 1, 1] == int(row['counts'])
    assert str(pressure[map_, 1, 1]) == str(pressure.dtype.type(row['pressure_Pa']))
    assert s['chamber_pressure'][i] == float(row['chamber_pressure_gauge_Pa'])
    assert s['cycle'][i] == int(row['cycle'])
    assert s['mount'][i] == (0 if row['mount'] == 'NA' else int(row['mount']))
    for label in ('surface', 'session', 'event'):
        assert (s[label + '_names'][s[label][i]].decode() or 'NA') == row[label], label
print(len(s['stamp']), len(rows))
)";
  const auto python = test_support::outputOf("/usr/bin/python3 " + folder_.path("compare.py") + " " +
                                             archive + " " + csv_ + " 2>&1");
  EXPECT_EQ(python.text, "1000 6000\n");
}

TEST_F(ExportTool, ArchivesABagWithAMalformedScanAllTheSame) {
  fsr_pressure_map::MatrixFrame malformed;
  malformed.header.stamp.fromNSec(kStart + 3050000000);  // between two scans
  malformed.rows = 2;
  malformed.columns = 3;
  malformed.counts = {1, 2};
  {
    rosbag::Bag bag(bag_, rosbag::bagmode::Append);
    bag.write("/fsr/raw", malformed.header.stamp, malformed);
  }
  const std::string archive = folder_.path("all.h5"), back = folder_.path("back.bag");
  const std::string said = run({bag_, "--to", "hdf5", "--output", archive});
  EXPECT_NE(said.find("Warning: the group /scans is incomplete: " + bag_), std::string::npos) << said;
  run({archive, "--to", "bag", "--output", back});
  // Appending created a second connection like the first one. The new bag has one, so messages with the same
  // time are in another order.
  std::vector<Held> before = messagesOf(bag_), after = messagesOf(back);
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  expectSame(after, before);
}

TEST_F(ExportTool, ArchivesATopicAndATimeRange) {
  const std::string archive = folder_.path("part.h5"), back = folder_.path("back.bag");
  run({bag_, "--to", "hdf5", "--output", archive, "--topics", "raw,/fsr/temperature", "--from", "1",
       "--until", "2"});
  run({archive, "--to", "bag", "--output", back});
  EXPECT_EQ(messagesOf(back).size(), 2u * 11);
  EXPECT_NE(
      run({bag_, "--to", "hdf5", "--output", archive, "--topics", "no"}).find("holds no topic no, but /fsr/"),
      std::string::npos);
}

TEST_F(ExportTool, RefusesADamagedArchive) {
  const std::string archive = folder_.path("all.h5"), back = folder_.path("back.bag");
  run({bag_, "--to", "hdf5", "--output", archive});
  {
    std::fstream file(archive, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(5000);
    file.put('x');
  }
  EXPECT_NE(run({archive, "--to", "bag", "--output", back}).find("is damaged or cut short"),
            std::string::npos);
  fs::resize_file(archive, 700);
  EXPECT_NE(run({archive, "--to", "bag", "--output", back}).find("is damaged or cut short"),
            std::string::npos);
  EXPECT_EQ(run({bag_, "--to", "bag", "--output", back}),
            bag_ + ": is not an archive; give one that export --to hdf5 has written");
  EXPECT_FALSE(fs::exists(back));
}

// Changes a dataset of an archive and updates its hash.
constexpr char kForge[] = R"(
import hashlib, sys, h5py
path, name, what = sys.argv[1:]
with h5py.File(path, 'r+') as f:
    if what == 'delete': del f[name]
    elif what == 'long': f[name].resize(2**40, axis=0)
    elif what == 'flat': del f[name]; f.create_dataset(name, shape=(5, 0), dtype='u2')
    elif what == 'wide': del f[name]; f.create_dataset(name, shape=(5, 2**40), dtype='u2', chunks=(1, 1024))
    else: f[name][1] = int(what)
data = bytearray(open(path, 'rb').read())
line = f'fsr_pressure_map archive schema=1 sha256={hashlib.sha256(data[512:]).hexdigest()}\n'.encode()
data[:512] = line.ljust(512, b'\0')
open(path, 'wb').write(data)
)";

TEST_F(ExportTool, RefusesAChangedArchiveWithAnUpdatedHash) {
  if (test_support::outputOf("/usr/bin/python3 -c 'import h5py' 2>&1").status != 0) {
    GTEST_SKIP() << "h5py is not installed (Debian package python3-h5py): it was NOT tried";
  }
  const std::string good = folder_.path("good.h5"), archive = folder_.path("a.h5"),
                    back = folder_.path("b.bag");
  run({bag_, "--to", "hdf5", "--output", good});
  std::ofstream(folder_.path("forge.py")) << kForge;
  const auto refusal = [&](const std::string& dataset, const std::string& change) {
    fs::copy_file(good, archive, fs::copy_options::overwrite_existing);
    const auto python = test_support::outputOf("/usr/bin/python3 " + folder_.path("forge.py") + " " +
                                               archive + " " + dataset + " " + change + " 2>&1");
    EXPECT_EQ(python.text, "");
    return run({archive, "--to", "bag", "--output", back});
  };
  EXPECT_NE(refusal("fsr/raw/sequence", "77").find("the messages of /fsr/raw differ from those of the bag"),
            std::string::npos);
  EXPECT_NE(refusal("archive/message/time", "-5").find("received at -5 ns"), std::string::npos);
  EXPECT_NE(refusal("archive/message/connection", "99").find("has a row that does not exist"),
            std::string::npos);
  EXPECT_NE(refusal("fsr/raw/counts", "delete").find("differ from those of the bag"), std::string::npos);
  EXPECT_NE(refusal("fsr/raw/counts", "flat").find("no usable size"), std::string::npos);
  EXPECT_NE(refusal("fsr/raw/counts", "wide").find("no usable size"), std::string::npos);
  EXPECT_NE(refusal("archive/message/time", "long").find("has too few entries"), std::string::npos);
  EXPECT_FALSE(fs::exists(back));
}

TEST_F(ExportTool, LeavesNoFileWhenTheDiskIsFull) {
  const std::string maps = withMaps(), archive = folder_.path("all.h5");
  run({maps, "--to", "hdf5", "--output", archive});
  const std::size_t before = files();
  const test_support::FileSizeLimit limit(20000);
  for (const char* format : {"hdf5", "csv", "tekscan"}) {
    const std::string path = folder_.path("full");
    EXPECT_NE(
        run({maps, "--to", format, "--output", path}).find(path + ": cannot be written (File too large)"),
        std::string::npos)
        << format;
    EXPECT_EQ(files(), before) << format;
  }
  EXPECT_NE(run({archive, "--to", "bag", "--output", folder_.path("b.bag")}).find("cannot be written"),
            std::string::npos);
  EXPECT_EQ(files(), before);
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

  EXPECT_NE(run({"--help"}, formats).find("lines    one line for each scan"), std::string::npos);
  EXPECT_NE(run({bag_, "--to", "pdf", "--output", output}, formats).find("lines"), std::string::npos);
  EXPECT_EQ(run({bag_, "--to", "lines", "--output", output, "--unit", "kPa"}, formats),
            "--unit cannot be used with --to lines");
  EXPECT_NE(run({bag_, "--to", "lines", "--output", output}).find("must be one of"), std::string::npos);
}

TEST_F(ExportTool, RefusesUnusableInputInOneSentenceAndLeavesNothing) {
  const auto refusal = [&](const std::vector<std::string>& more, const std::string& to = "csv") {
    std::vector<std::string> words = {"--to", to, "--output", csv_};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  EXPECT_EQ(refusal({folder_.path("none.bag")}), folder_.path("none.bag") + ": there is no such file");
  EXPECT_EQ(refusal({bag_}, "pdf"),
            "--to is \"pdf\", but must be one of csv, tekscan, png, movie, hdf5, bag");
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
  EXPECT_EQ(run({bag_, "--to", "csv", "--output", bag_}),
            bag_ + ": would be overwritten, but is one of the inputs; give another name for the output");
  EXPECT_NE(run({bag_, "--to", "csv", "--output", folder_.path("no/a.csv")}).find("cannot be written"),
            std::string::npos);
}

}  // namespace
