#include "protocol/capture.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "support/content_of.h"
#include "support/file_size_limit.h"
#include "support/holds.h"
#include "support/pty.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
using std::chrono::milliseconds;

struct Piece {
  std::int64_t time;  // [ns]
  Bytes bytes;
};
bool operator==(const Piece& a, const Piece& b) {
  return a.time == b.time && a.bytes == b.bytes;
}
using Pieces = std::vector<Piece>;

const Pieces kPieces = {{-5, {1, 2, 3}}, {1700000000123456789, {4}}, {1700000000223456789, {5, 6, 7, 8, 9}}};

void write(const std::string& path, const Pieces& pieces) {
  fsr::protocol::CaptureWriter writer(path);
  writer.noteBaud(115200);
  for (const Piece& piece : pieces) writer.write(piece.bytes.data(), piece.bytes.size(), piece.time);
}

Pieces readAll(fsr::protocol::ByteSource& source, std::size_t capacity = 4096) {
  Pieces pieces;
  Bytes buffer(capacity);
  while (!source.ended()) {
    const fsr::protocol::Chunk chunk = source.read(buffer.data(), buffer.size(), milliseconds(1000));
    if (chunk.size > 0) pieces.push_back({chunk.receive_time, {buffer.begin(), buffer.begin() + chunk.size}});
  }
  return pieces;
}

template <typename Do>
std::string complaintOf(Do action) {
  return test_support::refusal([&] { action(); });
}

class Capture : public testing::Test {
 protected:
  test_support::TemporaryFolder folder_;
  std::string path_ = folder_.path("run.fsrcap");
};

TEST_F(Capture, ReturnsTheBytesAndTimesThatWereWritten) {
  write(path_, kPieces);
  fsr::protocol::CaptureReader reader(path_);
  EXPECT_EQ(reader.baud(), 115200U);
  EXPECT_EQ(readAll(reader), kPieces);
  EXPECT_EQ(reader.remark(), "");
}

TEST_F(Capture, HasTheDocumentedBytes) {
  write(path_, {{0x0102030405060708, {0xAA, 0xBB}}});
  const std::string bytes = test_support::contentOf(path_);
  const std::string expected(
      "FSRCAP01"
      "\x00\xC2\x01\x00\x00\x00\x00\x00"
      "\x08\x07\x06\x05\x04\x03\x02\x01"
      "\x02\x00\x00\x00"
      "\xAA\xBB",
      30);
  EXPECT_EQ(bytes, expected);
}

TEST_F(Capture, ReplaysATruncatedFileUpToTheCut) {
  write(path_, kPieces);
  Bytes whole;
  for (const Piece& piece : kPieces) whole.insert(whole.end(), piece.bytes.begin(), piece.bytes.end());
  const std::size_t file_size = std::filesystem::file_size(path_);
  // Bytes of the file before the content of each chunk: header 16, then 12 + content for each.
  for (std::size_t size = file_size; size-- > fsr::protocol::capture::kFileHeader;) {
    std::filesystem::resize_file(path_, size);
    fsr::protocol::CaptureReader reader(path_);
    Bytes bytes;
    for (const Piece& piece : readAll(reader))
      bytes.insert(bytes.end(), piece.bytes.begin(), piece.bytes.end());
    ASSERT_LE(bytes.size(), whole.size());
    ASSERT_TRUE(std::equal(bytes.begin(), bytes.end(), whole.begin())) << "cut to " << size;
    const bool between_pieces = size == 16 || size == 31 || size == 44;
    ASSERT_EQ(reader.remark().empty(), between_pieces) << "cut to " << size << ": " << reader.remark();
    ASSERT_GE(bytes.size() + 16 + 3 * 12, size) << "bytes before the cut were dropped";
  }
}

TEST_F(Capture, StopsAtAnImpossibleLengthAndNamesThePlace) {
  write(path_, kPieces);
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(31 + 8 + 3);  // highest byte of the second chunk's length
  file.put('\x7F');
  file.close();
  fsr::protocol::CaptureReader reader(path_);
  EXPECT_EQ(readAll(reader), Pieces{kPieces.front()});
  EXPECT_EQ(reader.remark(), "capture " + path_ + " is damaged at byte 31: replayed up to there");
}

TEST_F(Capture, NeverOverwritesAFile) {
  write(path_, kPieces);
  const auto size = std::filesystem::file_size(path_);
  const std::string complaint = complaintOf([&] { fsr::protocol::CaptureWriter writer(path_); });
  EXPECT_EQ(complaint, "capture " + path_ + " exists already and is not overwritten: name another file");
  EXPECT_EQ(std::filesystem::file_size(path_), size);
}

TEST_F(Capture, NamesAFileThatCannotBeWrittenOrRead) {
  const std::string lost = folder_.path("nowhere/run.fsrcap");
  EXPECT_TRUE(test_support::holds(complaintOf([&] { fsr::protocol::CaptureWriter writer(lost); }),
                                  {lost + " cannot be written (No such file"}));
  EXPECT_TRUE(test_support::holds(complaintOf([&] { fsr::protocol::CaptureReader reader(lost); }),
                                  {lost + ": there is no such file"}));
}

TEST_F(Capture, RefusesAFileThatIsNotACapture) {
  for (const std::string content : {"", "FSRCAP01", "#ROSBAG V2.0\n and much more"}) {
    std::ofstream(path_, std::ios::trunc) << content;
    EXPECT_EQ(complaintOf([&] { fsr::protocol::CaptureReader reader(path_); }),
              "capture " + path_ +
                  " does not start with FSRCAP01: name a file that the driver's capture_file wrote");
  }
}

TEST_F(Capture, ReportsAFullDiskAndKeepsWhatWasWritten) {
  const Bytes bytes = {1, 2, 3};
  {
    const test_support::FileSizeLimit limit(40);
    fsr::protocol::CaptureWriter writer(path_);
    writer.write(bytes.data(), bytes.size(), 1);
    EXPECT_THROW(writer.write(bytes.data(), bytes.size(), 2), fsr::protocol::LinkError);
  }
  fsr::protocol::CaptureReader reader(path_);
  EXPECT_EQ(readAll(reader), (Pieces{{1, bytes}}));
}

// A clock that advances by one step at each call.
struct SteppingClock {
  std::int64_t now = 1000000000;  // [ns]
  std::int64_t step = 0;
  std::int64_t operator()() { return now += step; }
};

TEST_F(Capture, PacesAReplayByItsClockAndShiftsItsTimesToNow) {
  write(path_, {{5000, {1}}, {5000, {2}}, {2005000, {3}}});
  SteppingClock clock;
  fsr::protocol::PacedSource paced(std::make_unique<fsr::protocol::CaptureReader>(path_),
                                   [&clock] { return clock(); });
  Bytes buffer(16);
  const auto next = [&] { return paced.read(buffer.data(), buffer.size(), milliseconds(0)); };
  EXPECT_EQ(next().receive_time, 1000000000);
  EXPECT_EQ(next().receive_time, 1000000000);
  EXPECT_EQ(next().size, 0U) << "2 ms too early";
  clock.now += 1999999;
  EXPECT_EQ(next().size, 0U) << "1 ns too early";
  clock.now += 1;
  EXPECT_EQ(next().receive_time, 1002000000);
  EXPECT_EQ(buffer[0], 3);
  EXPECT_EQ(next().size, 0U);
  EXPECT_TRUE(paced.ended());
}

TEST_F(Capture, PacedReplayDeliversEveryByteThroughASmallBuffer) {
  write(path_, {{0, {1, 2, 3}}, {10, {4}}});
  SteppingClock clock;
  clock.step = 1;
  fsr::protocol::PacedSource paced(std::make_unique<fsr::protocol::CaptureReader>(path_),
                                   [&clock] { return clock(); });
  Bytes bytes;
  for (const Piece& piece : readAll(paced, 2))
    bytes.insert(bytes.end(), piece.bytes.begin(), piece.bytes.end());
  EXPECT_EQ(bytes, (Bytes{1, 2, 3, 4}));
}

}  // namespace
