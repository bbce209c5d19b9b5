#include "exports/map_pictures.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "exports/animated_png.h"
#include "exports/picture_folder.h"
#include "exports/scan_examples.h"
#include "exports/video_file.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "support/program_output.h"
#include "support/pty.h"

namespace {

namespace fs = std::filesystem;
using test_support::outputOf;

// Keeps the pictures.
class Album : public fsr::exports::PictureSink {
 public:
  using PictureSink::PictureSink;
  void finish() override {}
  std::vector<fsr::view::Image> pictures;

 private:
  void picture(std::int64_t, const fsr::view::Image& image) override { pictures.push_back(image); }
};

fsr::exports::ScanRecord evenScan(float pressure, double time) {
  fsr::exports::ScanRecord scan = export_test::exampleScan();
  scan.since_ns = std::llround(time * 1e9);
  scan.map->pressure.assign(6, pressure);
  scan.map->flags.assign(6, 0);
  return scan;
}

std::vector<fsr::view::Image> drawn(const std::vector<fsr::exports::ScanRecord>& scans,
                                    const fsr::exports::PictureOptions& options = {}) {
  Album album(options);
  album.begin(export_test::exampleSubject());
  for (const fsr::exports::ScanRecord& scan : scans) album.add(scan);
  return album.pictures;
}

template <typename Sink>
void write(Sink& sink, const std::vector<fsr::exports::ScanRecord>& scans) {
  sink.begin(export_test::exampleSubject());
  for (const fsr::exports::ScanRecord& scan : scans) sink.add(scan);
  sink.finish();
}

fsr::view::Pixel middle(const fsr::exports::ScanRecord& scan) {
  return fsr::view::HeatMap(fsr::view::HeatMapStyle{}).centre(scan.layout, {4}, 4);
}

TEST(MapPictures, ShowTheMapsColoursOnTheRangeOfTheCalibration) {
  const auto pictures = drawn({evenScan(310e3f, 0), evenScan(0, 1)});
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_TRUE(pictures[0].at(middle(evenScan(0, 0))) ==
              fsr::view::colourAt(fsr::view::ColourMap::kViridis, 0.5));
  EXPECT_TRUE(pictures[1].at(middle(evenScan(0, 0))) ==
              fsr::view::colourAt(fsr::view::ColourMap::kViridis, 0));
  fsr::exports::PictureOptions options;
  options.range = {0, 310e3};
  EXPECT_TRUE(drawn({evenScan(310e3f, 0)}, options)[0].at(middle(evenScan(0, 0))) ==
              fsr::view::colourAt(fsr::view::ColourMap::kViridis, 1));
}

TEST(MapPictures, SayThatTheHistoryIsNotSettled) {
  fsr::exports::ScanRecord first = evenScan(1e5f, 1), settling = first;
  settling.map->flags.assign(6, fsr::map::taxel_flag::kHistoryShort);
  const auto pictures = drawn({first, settling});
  EXPECT_NE(pictures[0].bytes(), pictures[1].bytes());
}

TEST(MapPictures, ShowTimeAndChamberPressure) {
  fsr::exports::ScanRecord first = evenScan(1e5f, 1), later = first, higher = first;
  later.since_ns += 1000000000;
  higher.chamber_pressure = 200e3;
  const auto pictures = drawn({first, later, higher, first});
  EXPECT_NE(pictures[0].bytes(), pictures[1].bytes());
  EXPECT_NE(pictures[0].bytes(), pictures[2].bytes());
  EXPECT_EQ(pictures[0].bytes(), pictures[3].bytes());
}

TEST(MapPictures, HaveOneSizeForNamesOfAnyLength) {
  fsr::exports::ScanRecord scan = evenScan(1e5f, 0);
  fsr::matrix::Surface surface = *scan.surface;
  surface.name.assign(500, 'x');
  scan.surface = std::make_shared<fsr::matrix::Surface>(surface);
  const auto pictures = drawn({evenScan(1e5f, 0), scan});
  EXPECT_EQ(pictures[0].width(), pictures[1].width());
  // No text reaches the edge: the last column of pixels has the background colour.
  for (int y = 0; y < pictures[1].height(); ++y) {
    ASSERT_TRUE(pictures[1].at({pictures[1].width() - 2, y}) == pictures[1].at({0, 0})) << y;
  }
}

TEST(MapPictures, AreRefusedForARecordingWithoutMaps) {
  Album album{fsr::exports::PictureOptions{}};
  fsr::exports::ExportSubject subject = export_test::exampleSubject();
  subject.maps = false;
  EXPECT_THROW(album.begin(subject), fsr::settings::InputError);
}

TEST(PictureFolder, HasAPngForEachMapAndRefusesAnExistingFolder) {
  const test_support::TemporaryFolder folder;
  fsr::exports::PictureFolder pictures(folder.path("maps"), {});
  write(pictures, {evenScan(1e5f, 0), export_test::bareScan(), evenScan(2e5f, 1)});
  EXPECT_TRUE(fs::exists(folder.path("maps/map_000001.png")));
  EXPECT_TRUE(fs::exists(folder.path("maps/map_000002.png")));
  EXPECT_FALSE(fs::exists(folder.path("maps/map_000003.png")));
  EXPECT_THROW(fsr::exports::PictureFolder(folder.path("maps"), {}), fsr::settings::InputError);
  EXPECT_TRUE(fs::exists(folder.path("maps/map_000001.png")));
}

// Checks chunks, checksums and sequence numbers by the PNG specification, third edition.
constexpr char kReadApng[] = R"(
import struct, sys, zlib
data, at, delays, sequence, pictures = open(sys.argv[1], 'rb').read(), 8, [], [], []
assert data[:8] == b'\x89PNG\r\n\x1a\n'
while at < len(data):
    size, kind = struct.unpack('>I4s', data[at:at + 8])
    body = data[at + 8:at + 8 + size]
    assert struct.unpack('>I', data[at + 8 + size:at + 12 + size])[0] == zlib.crc32(kind + body), kind
    if kind == b'IHDR': width, height = struct.unpack('>II', body[:8])
    if kind == b'acTL': frames = struct.unpack('>I', body[:4])[0]
    if kind == b'fcTL':
        sequence.append(struct.unpack('>I', body[:4])[0])
        n, d = struct.unpack('>HH', body[20:24]); delays.append(n / d); pictures.append(b'')
        assert struct.unpack('>II', body[4:12]) == (width, height)
    if kind == b'fdAT': sequence.append(struct.unpack('>I', body[:4])[0]); pictures[-1] += body[4:]
    if kind == b'IDAT': pictures[-1] += body
    at += size + 12
assert kind == b'IEND' and sequence == list(range(len(sequence)))
print(frames, delays, all(len(zlib.decompress(p)) == height * (3 * width + 1) for p in pictures))
)";

TEST(AnimatedPng, RunsInRealTime) {
  const test_support::TemporaryFolder folder;
  fsr::exports::AnimatedPng movie(folder.path("maps.png"), {});
  write(movie, {evenScan(1e5f, 0), evenScan(2e5f, 0.1), evenScan(3e5f, 1.6)});
  std::ofstream(folder.path("read.py")) << kReadApng;
  const auto python = outputOf("/usr/bin/python3 " + folder.path("read.py") + " " + folder.path("maps.png"));
  EXPECT_EQ(python.text, "3 [0.1, 1.5, 0.1] True\n");
}

TEST(VideoFile, RunsInRealTime) {
  if (!test_support::hasProgram("ffmpeg")) {
    GTEST_SKIP() << "ffmpeg is not installed (Debian package ffmpeg): no movie was encoded";
  }
  const test_support::TemporaryFolder folder;
  fsr::exports::VideoFile movie(folder.path("maps.avi"), {});
  write(movie, {evenScan(1e5f, 0), evenScan(2e5f, 0.1), evenScan(3e5f, 1.6)});
  const auto probe = outputOf(
      "ffprobe -v error -count_frames -show_entries stream=nb_read_frames,avg_frame_rate -of csv=p=0 " +
      folder.path("maps.avi"));
  EXPECT_EQ(probe.text, "10/1,17\n");
}

TEST(VideoFile, NamesTheMissingPackage) {
  const test_support::TemporaryFolder folder;
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder.path().c_str(), 1);
  try {
    fsr::exports::VideoFile movie(folder.path("maps.mp4"), {});
    write(movie, {evenScan(1e5f, 0)});
    ADD_FAILURE() << "a movie without ffmpeg";
  } catch (const fsr::settings::InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "ffmpeg is not installed (Debian package ffmpeg); give --output NAME.png for an animated PNG, "
              "which needs no other program");
  }
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(VideoFile, ReportsTheFailureOfFfmpegAndLeavesNoFile) {
  const test_support::TemporaryFolder folder;
  fs::create_directory(folder.path("bin"));
  std::ofstream(folder.path("bin/ffmpeg"))
      << "#!/bin/sh\nhead -c 10 > /dev/null; echo no such encoder >&2; exit 1\n";
  fs::permissions(folder.path("bin/ffmpeg"), fs::perms::owner_all);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (folder.path("bin") + ":" + path).c_str(), 1);
  try {
    fsr::exports::VideoFile movie(folder.path("maps.mp4"), {});
    write(movie, {evenScan(1e5f, 0), evenScan(1e5f, 5)});
    ADD_FAILURE() << "a movie that ffmpeg did not make";
  } catch (const fsr::settings::InputError& error) {
    EXPECT_EQ(std::string(error.what()), folder.path("maps.mp4") + ": ffmpeg: no such encoder");
  }
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_THROW(fsr::exports::VideoFile(folder.path("maps.txt"), {}), fsr::settings::InputError);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
