#include "protocol/wire_decoder.h"

#include <algorithm>
#include <cstring>

namespace fsr::protocol {
namespace {

static_assert(matrix::kMaxMatrixSide == FSR_WIRE_MAX_SIDE,
              "the wire format carries every matrix of the package");

std::uint16_t get16(const std::uint8_t* at) {
  return static_cast<std::uint16_t>(at[0] | (at[1] << 8));
}

std::uint32_t get32(const std::uint8_t* at) {
  return get16(at) | (static_cast<std::uint32_t>(get16(at + 2)) << 16);
}

// A text field ends at its first zero, or where the field does.
std::string_view getText(const std::uint8_t* at) {
  const auto* text = reinterpret_cast<const char*>(at);
  return {text, strnlen(text, FSR_WIRE_TEXT_SIZE)};
}

static_assert(FSR_WIRE_TRIGGER - FSR_WIRE_SCAN + 1 == kPacketTypes &&
                  FSR_WIRE_TRANSDUCER - FSR_WIRE_SCAN == static_cast<unsigned>(PacketType::kTransducer) &&
                  FSR_WIRE_TEMPERATURE - FSR_WIRE_SCAN == static_cast<unsigned>(PacketType::kTemperature),
              "the wire format numbers the packet types in the order of PacketType");

bool typeIsKnown(unsigned type) {
  return type >= FSR_WIRE_SCAN && type <= FSR_WIRE_TRIGGER;
}

PacketType typeOf(const std::uint8_t* packet) {
  return static_cast<PacketType>(packet[3] - FSR_WIRE_SCAN);
}

bool lengthFits(unsigned type, std::size_t length) {
  switch (type) {
    case FSR_WIRE_SCAN:
      return length % 2 == 0 && length > FSR_WIRE_SCAN_HEAD_SIZE && length <= FSR_WIRE_MAX_PAYLOAD;
    case FSR_WIRE_IDENTITY:
      return length == FSR_WIRE_IDENTITY_PAYLOAD;
    case FSR_WIRE_TRIGGER:
      return length == FSR_WIRE_TRIGGER_PAYLOAD;
    default:
      return length == FSR_WIRE_TRANSDUCER_PAYLOAD;  // as long as a temperature's
  }
}

bool sizeIsPossible(matrix::MatrixSize size, std::uint16_t full_scale) {
  return size.rows >= 1 && size.rows <= matrix::kMaxMatrixSide && size.columns >= 1 &&
         size.columns <= matrix::kMaxMatrixSide && full_scale >= 1;
}

}  // namespace

void WireDecoder::feed(const std::uint8_t* bytes, std::size_t size) {
  counts_.bytes += size;
  while (size > 0) {
    const std::size_t taken = std::min(size, buffer_.size() - end_);
    std::memcpy(buffer_.data() + end_, bytes, taken);
    end_ += taken;
    bytes += taken;
    size -= taken;
    while (step()) {
    }
    compact();
  }
}

void WireDecoder::finish() {
  while (available() > 0) {
    if (!step() && available() > 0) skip(1);
  }
  begin_ = end_ = 0;
  last_ = {};
}

// Consumes one packet or one place that is none; false where more bytes are needed to decide.
bool WireDecoder::step() {
  skipToSync();
  if (available() < FSR_WIRE_HEADER_SIZE) return false;
  if (!headerIsSound()) {
    skip(1);
    return true;
  }
  const std::size_t payload = get16(front() + 4);
  if (available() < FSR_WIRE_OVERHEAD + payload) return false;
  const std::size_t checked = FSR_WIRE_HEADER_SIZE - 2 + payload;
  if (fsr_wire_crc32(front() + 2, checked) != get32(front() + 2 + checked)) {
    ++counts_.bad_packet_check;
    skip(1);
    return true;
  }
  deliver(payload);
  begin_ += FSR_WIRE_OVERHEAD + payload;
  return true;
}

void WireDecoder::skip(std::size_t size) {
  begin_ += size;
  counts_.skipped_bytes += size;
}

// Stops at a sync word, or at a last byte that may be its first half.
void WireDecoder::skipToSync() {
  while (available() > 0) {
    const void* found = std::memchr(front(), FSR_WIRE_SYNC_0, available());
    if (found == nullptr) return skip(available());
    skip(static_cast<const std::uint8_t*>(found) - front());
    if (available() == 1 || front()[1] == FSR_WIRE_SYNC_1) return;
    skip(1);
  }
}

void WireDecoder::compact() {
  if (begin_ == 0) return;
  std::memmove(buffer_.data(), front(), available());
  end_ -= begin_;
  begin_ = 0;
}

bool WireDecoder::headerIsSound() {
  const std::uint8_t* header = front();
  std::uint64_t* cause = nullptr;
  if (fsr_wire_crc16(header + 2, 12) != get16(header + 14)) {
    cause = &counts_.bad_header_check;
  } else if (header[2] != FSR_WIRE_VERSION) {
    cause = &counts_.unknown_version;
  } else if (!typeIsKnown(header[3])) {
    cause = &counts_.unknown_type;
  } else if (!lengthFits(header[3], get16(header + 4))) {
    cause = &counts_.bad_length;
  }
  if (cause != nullptr) ++*cause;
  return cause == nullptr;
}

void WireDecoder::deliver(std::size_t payload_size) {
  const std::uint8_t* packet = front();
  const PacketType type = typeOf(packet);
  const PacketHeader header = {get32(packet + 6), get32(packet + 10), FSR_WIRE_OVERHEAD + payload_size};
  if (!isNew(type, header)) return;
  if (deliverContent(type, header, packet + FSR_WIRE_HEADER_SIZE, payload_size)) {
    ++counts_.of(type).packets;
  } else {
    ++counts_.bad_content;
  }
}

// Counts gaps and restarts of the board's counter; false for a duplicate packet.
bool WireDecoder::isNew(PacketType type, const PacketHeader& header) {
  Last& last = last_[static_cast<std::size_t>(type)];
  SequenceCounts& counts = counts_.of(type);
  const std::uint32_t step = header.sequence - last.sequence;
  const bool twice = last.known && step == 0 && header.device_time == last.device_time;
  if (twice) {
    ++counts.duplicates;
  } else if (last.known && step >= 0x80000000U) {
    ++counts.restarts;
  } else if (last.known && step > 1) {
    ++counts.gaps;
    counts.lost += step - 1;
  }
  last = {true, header.sequence, header.device_time};
  return !twice;
}

bool WireDecoder::deliverContent(PacketType type, const PacketHeader& header, const std::uint8_t* payload,
                                 std::size_t size) {
  if (type == PacketType::kScan) return deliverScan(header, payload, size);
  if (type == PacketType::kIdentity) return deliverIdentity(header, payload);
  if (type == PacketType::kTrigger) {
    if (payload[0] > 1) return false;
    handler_.onTrigger(header, {payload[0] == 1, get32(payload + 1)});
    return true;
  }
  const auto value = static_cast<std::int32_t>(get32(payload));
  if (type == PacketType::kTransducer) {
    handler_.onTransducer(header, value);
  } else {
    handler_.onTemperature(header, value);
  }
  return true;
}

bool WireDecoder::deliverScan(const PacketHeader& header, const std::uint8_t* payload, std::size_t size) {
  const ScanPacket scan = {
      {payload[0], payload[1]}, get16(payload + 2), get32(payload + 4), scan_counts_.data()};
  const std::size_t taxels = scan.size.taxels();
  if (!sizeIsPossible(scan.size, scan.full_scale)) return false;
  if (size != FSR_WIRE_SCAN_HEAD_SIZE + 2 * taxels) return false;
  for (std::size_t i = 0; i < taxels; ++i) {
    scan_counts_[i] = get16(payload + FSR_WIRE_SCAN_HEAD_SIZE + 2 * i);
    if (scan_counts_[i] > scan.full_scale) return false;
  }
  handler_.onScan(header, scan);
  return true;
}

bool WireDecoder::deliverIdentity(const PacketHeader& header, const std::uint8_t* payload) {
  const std::uint8_t* numbers = payload + 3 * FSR_WIRE_TEXT_SIZE;
  IdentityPacket identity;
  identity.serial = getText(payload);
  identity.firmware = getText(payload + FSR_WIRE_TEXT_SIZE);
  identity.model = getText(payload + 2 * FSR_WIRE_TEXT_SIZE);
  identity.size = {numbers[0], numbers[1]};
  identity.full_scale = get16(numbers + 2);
  identity.scan_period = get32(numbers + 4);
  if (!sizeIsPossible(identity.size, identity.full_scale)) return false;
  handler_.onIdentity(header, identity);
  return true;
}

}  // namespace fsr::protocol
