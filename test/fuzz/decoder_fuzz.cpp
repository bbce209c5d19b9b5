// The line may deliver any bytes. Every division of them into reads must give the same packets. Each scan is
// within its bounds, and each taxel of its map has a pressure or a flag.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibrator.h"
#include "fuzz/fuzz_file.h"
#include "protocol/device_clock.h"
#include "protocol/wire_decoder.h"
#include "support/packet_recorder.h"
#include "support/small_tables.h"

namespace {

class Checker : public test_support::PacketRecorder {
 public:
  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    PacketRecorder::onScan(header, scan);
    stamper_.setArrival(arrival_ += 1'000'000);
    const fsr::protocol::PacketTime time = stamper_.scan(header, scan.duration);
    for (std::size_t i = 0; i < scan.size.taxels(); ++i) fuzz::require(scan.counts[i] <= scan.full_scale);
    calibrator().calibrate({scan.size, scan.full_scale, scan.counts, scan.size.taxels()},
                           static_cast<double>(time.stamp) * 1e-9, map_);
    for (std::size_t i = 0; i < map_.pressure.size(); ++i) {
      const bool silent = map_.state == fsr::map::MapState::kSizeMismatch || map_.flags[i] != 0;
      fuzz::require(!std::isinf(map_.pressure[i]) && (silent || !std::isnan(map_.pressure[i])));
    }
  }

 private:
  static fsr::calibration::Calibrator& calibrator() {
    static fsr::calibration::Calibrator instance(test_support::smallTables({2, 3}, {0.0}, 4095),
                                                 fsr::matrix::Layout{{2, 3}});
    return instance;
  }
  fsr::protocol::PacketStamper stamper_;
  fsr::map::PressureMap map_;
  std::int64_t arrival_ = 1'000'000'000;
};

std::vector<std::string> packets(const std::uint8_t* bytes, std::size_t size, std::size_t step) {
  Checker checker;
  const auto decoder = std::make_unique<fsr::protocol::WireDecoder>(checker);
  for (std::size_t i = 0; i < size; i += step) decoder->feed(bytes + i, std::min(step, size - i));
  decoder->finish();
  fuzz::require(decoder->counts().bytes == size && decoder->counts().skipped_bytes <= size);
  return checker.lines;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  fuzz::require(packets(bytes, size, size + 1) == packets(bytes, size, 1 + size % 7));
  return 0;
}
