// From the bytes of the line to the calibrated map nothing is allocated in operation: the path of every scan
// through driver and calibration node, except for their ROS messages.

#include <gtest/gtest.h>

#include <vector>

#include "fsr_pressure_map/calibration/calibrator.h"
#include "protocol/board_reader.h"
#include "protocol/device_clock.h"
#include "protocol/wire_decoder.h"
#include "support/allocation_guard.h"
#include "support/small_tables.h"

namespace fsr::calibration {
namespace {

constexpr matrix::MatrixSize kBoardSize{16, 10};

class LivePath : public protocol::PacketHandler {
 public:
  explicit LivePath(compensation::BlendRule blend)
      : calibrator_(tables(blend), matrix::Layout{kBoardSize}, options()) {
    stamper_.startLine(921600);
  }

  std::uint64_t maps = 0, others = 0, identities = 0;
  double sum = 0;  // of the pressures [Pa]

  void arrive(std::int64_t time) { stamper_.setArrival(arrival_ = time); }
  void bend(double curvature) {
    surface_.curvature[0].x = curvature;
    calibrator_.setSurface(surface_, 0);
  }

  void onScan(const protocol::PacketHeader& header, const protocol::ScanPacket& scan) override {
    const protocol::PacketTime time = stamper_.scan(header, scan.duration);
    if (gate_.scan(arrival_) == protocol::BoardGate::Verdict::kHold) return;
    calibrator_.calibrate({scan.size, scan.full_scale, scan.counts, scan.size.taxels()},
                          1e-9 * double(time.stamp), map_);
    const bool of_this_size = map_.state == map::MapState::kOk;
    ++(of_this_size ? maps : others);
    if (of_this_size) sum += map_.pressure.back();
  }
  void onTransducer(const protocol::PacketHeader& header, std::int32_t) override {
    stamper_.transducer(header);
  }
  void onTemperature(const protocol::PacketHeader& header, std::int32_t) override {
    stamper_.temperature(header);
  }
  void onIdentity(const protocol::PacketHeader&, const protocol::IdentityPacket& identity) override {
    identities += gate_.identity(identity.serial, arrival_) == protocol::BoardGate::Board::kSame;
  }

 private:
  static compensation::CurvatureTables tables(compensation::BlendRule blend) {
    compensation::CurvatureTables tables = test_support::smallTables(kBoardSize, {0.0, 10.0, 20.0}, 1023);
    tables.rule.blend = blend;
    tables.rule.length_scale = {5.0};
    for (regression::CodeTable& table : tables.tables) table.log_weight.assign(table.pressure.size(), 0.0F);
    return tables;
  }
  static CalibratorOptions options() {
    CalibratorOptions options;
    options.fill_bad_taxels = true;
    return options;
  }

  protocol::PacketStamper stamper_;
  protocol::BoardGate gate_;
  Calibrator calibrator_;
  map::PressureMap map_;
  matrix::Surface surface_{"limb", 1, {matrix::Curvature{}}, {}};
  std::int64_t arrival_ = 0;  // [ns]
};

// The bytes that a board sends in millisecond `i`; sometimes damaged, of a smaller matrix, or after a jump of
// its clock.
class Line {
 public:
  void send(std::uint32_t i, protocol::Decoder& decoder) {
    const std::uint32_t time = i * 1000 + (i > 30'000 ? 30'000'000 : 0);  // [us]
    for (std::size_t taxel = 1; taxel < counts_.size(); ++taxel)
      counts_[taxel] = (i * 7 + taxel) % 1024;  // 0 is stuck
    const fsr_wire_scan scan = {std::uint8_t(i % 1000 == 999 ? 3 : 16), 10, 1023, 900, counts_.data()};
    std::size_t size = fsr_wire_encode_scan(bytes_.data(), bytes_.size(), i, time, &scan);
    if (i % 10 == 0)
      size += fsr_wire_encode_transducer(&bytes_[size], bytes_.size() - size, i / 10, time, 4000);
    if (i % 100 == 0)
      size += fsr_wire_encode_temperature(&bytes_[size], bytes_.size() - size, i / 100, time, 23000);
    if (i % 1000 == 0)
      size += fsr_wire_encode_identity(&bytes_[size], bytes_.size() - size, i / 1000, time, &kBoard);
    if (i % 7 == 0) bytes_[i % size] ^= 0x20U;
    decoder.feed(bytes_.data(), size);
  }

 private:
  static constexpr fsr_wire_identity kBoard = {"0123456789abcdef", "1.2.0", "", 16, 10, 1023, 1000};
  std::vector<std::uint16_t> counts_ = std::vector<std::uint16_t>(kBoardSize.taxels());
  std::vector<std::uint8_t> bytes_ = std::vector<std::uint8_t>(1024);
};

class AllocatesNothing : public testing::TestWithParam<compensation::BlendRule> {};

TEST_P(AllocatesNothing, FromBytesToMaps) {
  constexpr std::uint32_t kStart = 2000, kScans = 60'000;  // a minute at 1 kHz
  LivePath path(GetParam());
  protocol::WireDecoder decoder(path);
  Line line;
  path.bend(5.0);
  std::size_t allocated = 0;
  for (std::uint32_t i = 1; i < kScans; ++i) {
    path.arrive(1'000'000'000 + 1'000'000LL * i);
    if (i % 5000 == 0) path.bend(i % 10'000 == 0 ? 5.0 : 12.0);
    const test_support::AllocationGuard guard;
    line.send(i, decoder);
    if (i >= kStart) allocated += guard.allocations();
  }
  EXPECT_EQ(allocated, 0U) << "after the first two seconds";
  EXPECT_GT(path.maps, kScans / 2);
  EXPECT_GT(path.others, 30U) << "of another size";
  EXPECT_GT(path.identities, 30U);
  EXPECT_GT(path.sum, 0);
}

INSTANTIATE_TEST_SUITE_P(LivePath, AllocatesNothing,
                         testing::Values(compensation::BlendRule::kNearest, compensation::BlendRule::kKernel,
                                         compensation::BlendRule::kInterpolate));

}  // namespace
}  // namespace fsr::calibration
