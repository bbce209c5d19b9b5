// Share of scans received through a line with bit errors, beside the best possible share without
// retransmission: a packet with an error is lost, its neighbours are not. The table is in
// docs/reliability.md.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "emulator/line_damage.h"
#include "protocol/wire_decoder.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kTaxels = 70;

// Content of scan `number`, so that a receiver can recognise a scan that was never sent.
std::uint16_t countOf(std::uint32_t number, std::size_t taxel) {
  return static_cast<std::uint16_t>((number * 2654435761U + static_cast<std::uint32_t>(taxel) * 40503U) >>
                                    20);
}

class Receiver : public fsr::protocol::PacketHandler {
 public:
  std::uint64_t scans = 0;
  std::uint64_t wrong = 0;

  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    ++scans;
    bool right = scan.size.taxels() == kTaxels && header.device_time == header.sequence * 10000;
    for (std::size_t i = 0; right && i < kTaxels; ++i) right = scan.counts[i] == countOf(header.sequence, i);
    if (!right) ++wrong;
  }
  void onTransducer(const fsr::protocol::PacketHeader&, std::int32_t) override {}
  void onTemperature(const fsr::protocol::PacketHeader&, std::int32_t) override {}
  void onIdentity(const fsr::protocol::PacketHeader&, const fsr::protocol::IdentityPacket&) override {}
};

Bytes packet(std::uint32_t number) {
  std::uint16_t counts[kTaxels];
  for (std::size_t i = 0; i < kTaxels; ++i) counts[i] = countOf(number, i);
  const fsr_wire_scan scan = {7, 10, 4095, 5000, counts};
  Bytes bytes(FSR_WIRE_MAX_PACKET);
  bytes.resize(fsr_wire_encode_scan(bytes.data(), bytes.size(), number, number * 10000, &scan));
  return bytes;
}

void scansAgainstBitErrors(benchmark::State& state) {
  fsr::emulator::LineDamage damage;
  damage.flipped_bits = std::pow(10.0, -static_cast<double>(state.range(0)) / 2);
  fsr::emulator::LossyLine line(1);
  Receiver receiver;
  fsr::protocol::WireDecoder decoder(receiver);
  std::uint32_t sent = 0;
  const std::size_t size = packet(0).size();
  for (auto _ : state) {
    Bytes bytes = packet(sent++);
    line.pass(damage, bytes);
    decoder.feed(bytes.data(), bytes.size());
  }
  const double best = std::pow(1 - damage.flipped_bits, 8.0 * static_cast<double>(size));
  state.counters["ber"] = damage.flipped_bits;
  state.counters["got_%"] = 100.0 * static_cast<double>(receiver.scans) / sent;
  state.counters["best_%"] = 100 * best;
  state.counters["sd_%"] = 100 * std::sqrt(best * (1 - best) / sent);  // of the share, by chance
  state.counters["wrong"] = static_cast<double>(receiver.wrong);
}
// 1e-6, 3e-6, ... 1e-2.
BENCHMARK(scansAgainstBitErrors)->DenseRange(4, 12, 1)->Iterations(400000)->Unit(benchmark::kMicrosecond);

}  // namespace
