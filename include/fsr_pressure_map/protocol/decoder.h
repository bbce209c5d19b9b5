#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "fsr_pressure_map/matrix/layout.h"

namespace fsr::protocol {

/// What a packet tells.
enum class PacketType : unsigned { kScan, kTransducer, kTemperature, kIdentity, kTrigger };
constexpr std::size_t kPacketTypes = 5;

/// What every packet carries.
struct PacketHeader {
  std::uint32_t sequence = 0;     ///< counts the packets of one type, wraps
  std::uint32_t device_time = 0;  ///< the board's clock [us], wraps after 71.6 minutes
  std::size_t size = 0;           ///< of the whole packet [bytes]
};

/// One scan. The counts are in the decoder's memory and valid during the call only.
struct ScanPacket {
  matrix::MatrixSize size;
  std::uint16_t full_scale = 0;           ///< largest count that the converter can give
  std::uint32_t duration = 0;             ///< from the first to the last taxel [us]; 0 = unknown
  const std::uint16_t* counts = nullptr;  ///< [rows x columns], row-major, none above full_scale
};

/// Who the board is. The texts are in the decoder's memory and valid during the call only. They are as the
/// board sent them: a caller that prints them must expect any byte but zero.
struct IdentityPacket {
  std::string_view serial;
  std::string_view firmware;
  std::string_view model;
  matrix::MatrixSize size;
  std::uint16_t full_scale = 0;
  std::uint32_t scan_period = 0;  ///< [us]; 0 = unknown
};

/// An edge at the board's trigger input; the device time of its packet is the moment of the edge.
struct TriggerPacket {
  bool high = false;            ///< level behind the edge
  std::uint32_t deviation = 0;  ///< the edge lies at most this far from the device time [us]
};

/// Receives the packets that a decoder finds.
class PacketHandler {
 public:
  virtual ~PacketHandler() = default;

  virtual void onScan(const PacketHeader& header, const ScanPacket& scan) = 0;
  /// `counts`: raw reading of the pressure transducer.
  virtual void onTransducer(const PacketHeader& header, std::int32_t counts) = 0;
  /// `millidegrees`: [0.001 degree Celsius].
  virtual void onTemperature(const PacketHeader& header, std::int32_t millidegrees) = 0;
  virtual void onIdentity(const PacketHeader& header, const IdentityPacket& identity) = 0;
  virtual void onTrigger(const PacketHeader& /*header*/, const TriggerPacket& /*trigger*/) {}
};

/// How the packets of one type followed each other.
struct SequenceCounts {
  std::uint64_t packets = 0;     ///< delivered to the handler
  std::uint64_t gaps = 0;        ///< places where the board's counter jumped forward
  std::uint64_t lost = 0;        ///< packets that those jumps skipped
  std::uint64_t duplicates = 0;  ///< same number and device time as the previous packet: not delivered
  std::uint64_t restarts = 0;    ///< the counter went backwards: the board started again
};

/// Lines of a protocol of text lines that gave no scan, by cause.
struct LineCounts {
  std::uint64_t cut = 0;               ///< the start or the end of the stream cut them
  std::uint64_t without_numbers = 0;   ///< comments, headers and empty lines: no damage
  std::uint64_t too_long = 0;          ///< longer than a line of this matrix can be
  std::uint64_t not_ascii = 0;         ///< with a byte that is no printable ASCII
  std::uint64_t not_numbers = 0;       ///< with a field that is no whole number, or two separators
  std::uint64_t wrong_number = 0;      ///< whole numbers, but not as many as the matrix has
  std::uint64_t above_full_scale = 0;  ///< with a count above the full scale
  std::uint64_t last_number = 0;       ///< behind the time, in the last line with a wrong number of them
  std::uint64_t highest_count = 0;     ///< highest one above the full scale
};

/// What a decoder has met since it was made. Each cause counts the places where it occurred; a cause that a
/// protocol does not have stays 0.
struct DecoderCounts {
  std::uint64_t bytes = 0;             ///< all bytes that were fed
  std::uint64_t skipped_bytes = 0;     ///< bytes that belong to no valid packet
  std::uint64_t bad_header_check = 0;  ///< the start of a packet without a valid header behind it
  std::uint64_t unknown_version = 0;   ///< valid header of another version of the format
  std::uint64_t unknown_type = 0;      ///< valid header of an unknown type
  std::uint64_t bad_length = 0;        ///< valid header with a length that its type cannot have
  std::uint64_t bad_packet_check = 0;  ///< valid header, but the check of the whole packet is wrong
  std::uint64_t bad_content = 0;  ///< valid packet with impossible content (0 rows, count above full scale)
  LineCounts lines;               ///< of a protocol of text lines
  std::array<SequenceCounts, kPacketTypes> sequences;  ///< by PacketType

  const SequenceCounts& of(PacketType type) const { return sequences.at(static_cast<std::size_t>(type)); }
  SequenceCounts& of(PacketType type) { return sequences.at(static_cast<std::size_t>(type)); }
};

/// Finds the packets of one protocol in a stream of bytes and delivers them to a PacketHandler. The stream
/// may start anywhere, come in chunks of any size and be damaged in any way. Damage is counted; neither
/// feed() nor finish() throws or allocates.
class Decoder {
 public:
  Decoder() = default;
  virtual ~Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  /// Delivers every packet that these bytes complete, in order, before it returns.
  virtual void feed(const std::uint8_t* bytes, std::size_t size) = 0;

  /// The stream has ended: delivers the packets that an incomplete one may hide and drops the rest. What is
  /// fed next is a new stream, so no gap is counted across the end.
  virtual void finish() = 0;

  virtual const DecoderCounts& counts() const = 0;
};

/// What the user says about a board, for protocols whose bytes do not say it.
struct DecoderOptions {
  matrix::MatrixSize size;          ///< 0 x 0 = unknown
  std::uint16_t full_scale = 1023;  ///< largest count that the converter can give, 1 or more
  std::uint32_t tick = 1000;        ///< unit of the board's times [us]
  bool transducer = false;          ///< a reading of the pressure transducer follows the counts of each scan
};

/// Makes a decoder. `handler` must outlive it. Throws InputError where the protocol needs an option that is
/// not set.
using DecoderMaker = std::unique_ptr<Decoder> (*)(PacketHandler& handler, const DecoderOptions& options);

/// A protocol that boards may speak.
struct Protocol {
  std::string name;
  std::string summary;  ///< one line
  DecoderMaker make;
  bool tells_size = true;  ///< the bytes say how many rows and columns the matrix has
};

/// All protocols. The first one is the default.
const std::vector<Protocol>& protocols();

/// The protocol called `name`. Throws InputError, which lists the names, where there is none.
const Protocol& protocolNamed(const std::string& name);

}  // namespace fsr::protocol
