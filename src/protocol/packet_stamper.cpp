#include "protocol/packet_stamper.h"

#include <algorithm>

namespace fsr::protocol {

namespace {

constexpr double kLongestFirstScan = 1e6;         // of the first scan, when the period is not known yet [us]
constexpr double kUnevenness = 1.1;               // a board's timer may be this uneven (ratio)
constexpr double kSlowestPeriod = 60e6;           // a longer time between scans is a pause or a reset [us]
constexpr std::uint32_t kCounterBack = 1u << 31;  // from such a step on, the counter started again

}  // namespace

void PacketStamper::startLine(std::uint32_t baud) {
  baud_ = baud;
  clock_.forget();
  scanned_ = false;
  period_.reset();
}

// Time from scan to scan [us]; none if the last header and this one do not tell it.
std::optional<double> PacketStamper::periodBefore(const PacketHeader& header) const {
  if (!scanned_) return std::nullopt;
  const std::uint32_t elapsed = header.device_time - last_scan_.device_time;  // wraps as the counters do
  const std::uint32_t scans = header.sequence - last_scan_.sequence;
  if (elapsed > kSlowestPeriod || scans >= kCounterBack) return std::nullopt;
  return elapsed / std::max(1.0, static_cast<double>(scans));
}

// Whether a scan can take so long that comes `period` after the one before. Behind a pause of the board, the
// period before the pause tells.
bool PacketStamper::isPossible(std::uint32_t duration, std::optional<double> period) const {
  if (!period && !period_) return duration <= kLongestFirstScan;
  return duration <=
         kUnevenness * std::min(period.value_or(kSlowestPeriod), period_.value_or(kSlowestPeriod));
}

std::uint32_t PacketStamper::possibleDuration(const PacketHeader& header, std::uint32_t duration) {
  const std::optional<double> period = periodBefore(header);
  if (period && !period_ &&
      !isPossible(last_duration_, period)) {  // the clock has learned from the first scan
    ++impossible_durations_;
    last_duration_ = 0;
    clock_.forget();
  }
  const bool possible = isPossible(duration, period);
  const bool last_possible = isPossible(last_duration_, period);
  if (period) period_ = period;
  scanned_ = true;
  last_scan_ = header;
  if (possible) return last_duration_ = duration;
  ++impossible_durations_;
  return last_possible ? last_duration_ : 0;
}

PacketTime PacketStamper::scan(const PacketHeader& header, std::uint32_t duration) {
  const std::int64_t known_delay =
      timeOnTheLine(header.size) + std::int64_t{possibleDuration(header, duration)} * 500;
  return finish(PacketType::kScan, clock_.observe(header.device_time, receive_time_, known_delay));
}

// Of a packet that is sent soon after its device time.
PacketTime PacketStamper::soon(PacketType type, const PacketHeader& header) {
  return finish(type, clock_.observe(header.device_time, receive_time_, timeOnTheLine(header.size)));
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
