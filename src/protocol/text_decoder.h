#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "fsr_pressure_map/protocol/decoder.h"

namespace fsr::protocol {

/// Decoder of lines `time,count,count,...`, one for each scan (docs/text_format.md).
///
/// A line has no checksum, so only its form can be checked: a scan is delivered where a whole line has the
/// right number of whole numbers and no count above the full scale. A comment may be an edge of the trigger.
/// The search for the next line begins behind the next newline. The first line of a stream may have lost its
/// start and is dropped.
///
/// The scans are numbered here. A damaged line takes a number, too, so that the gap is seen behind it; a line
/// that is lost without a trace takes none.
class TextDecoder final : public Decoder {
 public:
  /// `handler` must outlive the decoder. Throws InputError where the options do not say the matrix.
  TextDecoder(PacketHandler& handler, const DecoderOptions& options);

  void feed(const std::uint8_t* bytes, std::size_t size) override;
  void finish() override;
  const DecoderCounts& counts() const override { return counts_; }

 private:
  enum class State {
    kCut,      ///< the line may have lost its start
    kReading,  ///< all of the line is in line_
    kDropped,  ///< the line is damaged, and its cause is counted
    kComment,  ///< as much as fits is in line_
  };

  void take(std::uint8_t byte);
  void endLine();
  void read(std::string_view line);
  bool isScan(std::size_t numbers, bool sign);
  void deliver();
  void readComment(std::string_view line);
  bool drop(std::uint64_t& cause);
  bool refuse(std::uint64_t& cause);

  PacketHandler& handler_;
  DecoderOptions options_;
  DecoderCounts counts_;
  State state_ = State::kCut;
  std::size_t length_ = 0;  // bytes of this line so far
  std::vector<char> line_;  // as long as a line may be
  std::vector<std::int64_t>
      numbers_;  // of a line: time, counts and, if there is one, the transducer's reading
  std::vector<std::uint16_t> scan_counts_;
  std::uint32_t sequence_ = 0;  // of the last scan
  std::uint32_t damaged_ = 0;   // lines since then
  std::uint32_t triggers_ = 0;
};

}  // namespace fsr::protocol
