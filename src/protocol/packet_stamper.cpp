#include "protocol/packet_stamper.h"

namespace fsr::protocol {

void PacketStamper::startLine(std::uint32_t baud) {
  baud_ = baud;
  clock_.forget();
}

PacketTime PacketStamper::scan(const PacketHeader& header, std::uint32_t duration) {
  const std::int64_t known_delay = timeOnTheLine(header.size) + std::int64_t{duration} * 500;
  return finish(PacketType::kScan, clock_.observe(header.device_time, receive_time_, known_delay));
}

PacketTime PacketStamper::transducer(const PacketHeader& header) {
  return finish(PacketType::kTransducer,
                clock_.observe(header.device_time, receive_time_, timeOnTheLine(header.size)));
}

PacketTime PacketStamper::temperature(const PacketHeader& header) {
  if (!clock_.started()) return {receive_time_ - timeOnTheLine(header.size), header.device_time};
  return finish(PacketType::kTemperature, clock_.widen(header.device_time));
}

// [ns] at ten bits a byte.
std::int64_t PacketStamper::timeOnTheLine(std::size_t bytes) const {
  return baud_ == 0 ? 0 : static_cast<std::int64_t>(bytes) * 10'000'000'000 / baud_;
}

PacketTime PacketStamper::finish(PacketType type, std::uint64_t device_time) {
  const std::int64_t host_time = clock_.hostTime(device_time);
  return {sequences_.at(static_cast<std::size_t>(type)).next(host_time, device_time), device_time};
}

}  // namespace fsr::protocol
