#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fsr_pressure_map/protocol/decoder.h"

namespace test_support {

/// A protocol that only tests speak. Each frame is one scan of 1 x 1 taxel in five bytes:
///
///     0xC0, sequence, count high byte, count low byte, check (exclusive or of the three before it)
class DummyDecoder final : public fsr::protocol::Decoder {
 public:
  explicit DummyDecoder(fsr::protocol::PacketHandler& handler) : handler_(handler) {}

  static std::unique_ptr<fsr::protocol::Decoder> make(fsr::protocol::PacketHandler& handler,
                                                      const fsr::protocol::DecoderOptions& /*options*/) {
    return std::make_unique<DummyDecoder>(handler);
  }

  static std::vector<std::uint8_t> frame(std::uint8_t sequence, std::uint16_t count) {
    const auto high = static_cast<std::uint8_t>(count >> 8), low = static_cast<std::uint8_t>(count & 0xFF);
    return {kStart, sequence, high, low, static_cast<std::uint8_t>(sequence ^ high ^ low)};
  }

  void feed(const std::uint8_t* bytes, std::size_t size) override {
    counts_.bytes += size;
    for (std::size_t i = 0; i < size; ++i) take(bytes[i]);
  }

  void finish() override {
    counts_.skipped_bytes += used_;
    used_ = 0;
    started_ = false;
  }

  const fsr::protocol::DecoderCounts& counts() const override { return counts_; }

 private:
  static constexpr std::uint8_t kStart = 0xC0;
  static constexpr std::size_t kFrame = 5;

  void take(std::uint8_t byte) {
    if (used_ == 0 && byte != kStart) {
      ++counts_.skipped_bytes;
      return;
    }
    frame_[used_++] = byte;
    if (used_ < kFrame) return;
    used_ = 0;
    if ((frame_[1] ^ frame_[2] ^ frame_[3]) == frame_[4]) {
      deliver();
    } else {
      ++counts_.bad_packet_check;
      counts_.skipped_bytes += kFrame;
    }
  }

  void deliver() {
    fsr::protocol::SequenceCounts& scans = counts_.of(fsr::protocol::PacketType::kScan);
    const auto step = static_cast<std::uint8_t>(frame_[1] - last_);
    if (started_ && step > 1) {
      ++scans.gaps;
      scans.lost += step - 1U;
    }
    started_ = true;
    last_ = frame_[1];
    ++scans.packets;
    const auto count = static_cast<std::uint16_t>(frame_[2] << 8 | frame_[3]);
    handler_.onScan({frame_[1], frame_[1] * 1000U, kFrame}, {{1, 1}, 0xFFFF, 0, &count});
  }

  fsr::protocol::PacketHandler& handler_;
  fsr::protocol::DecoderCounts counts_;
  std::uint8_t frame_[kFrame] = {};
  std::size_t used_ = 0;  // of frame_
  bool started_ = false;  // last_ holds
  std::uint8_t last_ = 0;
};

}  // namespace test_support
