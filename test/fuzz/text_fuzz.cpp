// The line may deliver any bytes to the decoder of text. Every division of them into reads must give the same
// packets, and each scan is within its bounds. The first byte chooses what the parameters say.
#include <memory>
#include <string>
#include <vector>

#include "fuzz/fuzz_file.h"
#include "protocol/device_clock.h"
#include "protocol/text_decoder.h"
#include "support/packet_recorder.h"

namespace {

class Checker : public test_support::PacketRecorder {
 public:
  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    PacketRecorder::onScan(header, scan);
    stamper_.setArrival(arrival_ += 1'000'000);
    stamper_.scan(header, scan.duration);
    for (std::size_t i = 0; i < scan.size.taxels(); ++i) fuzz::require(scan.counts[i] <= scan.full_scale);
  }

 private:
  fsr::protocol::PacketStamper stamper_;
  std::int64_t arrival_ = 1'000'000'000;
};

std::vector<std::string> packets(const fsr::protocol::DecoderOptions& options, const std::uint8_t* bytes,
                                 std::size_t size, std::size_t step) {
  Checker checker;
  fsr::protocol::TextDecoder decoder(checker, options);
  for (std::size_t i = 0; i < size; i += step) decoder.feed(bytes + i, std::min(step, size - i));
  decoder.finish();
  const fsr::protocol::DecoderCounts& counts = decoder.counts();
  const std::size_t each = options.transducer ? 2 : 1;
  fuzz::require(counts.bytes == size && counts.skipped_bytes <= size);
  fuzz::require(checker.lines.size() == each * counts.of(fsr::protocol::PacketType::kScan).packets +
                                            counts.of(fsr::protocol::PacketType::kTrigger).packets);
  return checker.lines;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  const bool wide = (bytes[0] & 1U) != 0;
  const fsr::protocol::DecoderOptions options = {
      wide ? fsr::matrix::MatrixSize{7, 10} : fsr::matrix::MatrixSize{1, 3},
      static_cast<std::uint16_t>(wide ? 4095 : 1023), wide ? 1U : 1000U, (bytes[0] & 2U) != 0};
  fuzz::require(packets(options, bytes + 1, size - 1, size) ==
                packets(options, bytes + 1, size - 1, 1 + size % 7));
  return 0;
}
