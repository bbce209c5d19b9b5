#include "protocol/device_clock.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace fsr::protocol {

void TrimmedDelay::clear() {
  used_ = next_ = fresh_ = 0;
}

void TrimmedDelay::add(double x, double y) {
  if (used_ > 0 && x < last_x_ + kSpacing) return;
  last_x_ = x;
  delays_[next_] = y;
  next_ = (next_ + 1) % kArrivals;
  used_ = std::min(used_ + 1, kArrivals);
  // Sorts again when a tenth of the arrivals are new.
  if (++fresh_ * 10 < used_) return;
  fresh_ = 0;
  average();
}

void TrimmedDelay::average() {
  const auto trimmed = static_cast<std::ptrdiff_t>(kTrim * static_cast<double>(used_));
  std::copy_n(delays_.begin(), used_, sorted_.begin());
  const auto end = sorted_.begin() + static_cast<std::ptrdiff_t>(used_);
  const auto low = sorted_.begin() + trimmed;
  const auto high = end - trimmed;
  std::nth_element(sorted_.begin(), low, end);
  std::nth_element(low, high - 1, end);
  value_ = std::accumulate(low, high, 0.0) / static_cast<double>(high - low);
}

void DelayEnvelope::clear() {
  used_ = 0;
  slot_ = kFirstSlot;
  offset_ = 0;
  drift_ = 0;
}

void DelayEnvelope::add(double x, double y) {
  const Arrival arrival = {x, y};
  if (used_ > 0 && x < slot_end_ - slot_) return;  // older than the newest slot
  if (used_ == 0 || x >= slot_end_) {
    openSlot(x);
    lowest_[used_++] = arrival;
  } else if (height(arrival) < height(lowest_[used_ - 1])) {
    lowest_[used_ - 1] = arrival;
  } else {
    return;  // the slot has a lower arrival
  }
  fit();
}

// Makes room for one more slot, which starts at or just before `x`.
void DelayEnvelope::openSlot(double x) {
  if (used_ == kSlots && slot_ < max_slot_) mergePairs();
  if (used_ == kSlots) {
    std::copy(lowest_.begin() + 1, lowest_.end(), lowest_.begin());
    --used_;
  }
  slot_end_ = used_ == 0 || x >= slot_end_ + slot_ ? x + slot_ : slot_end_ + slot_;
}

void DelayEnvelope::mergePairs() {
  for (std::size_t i = 0; i < kSlots / 2; ++i) {
    const Arrival& a = lowest_[2 * i];
    const Arrival& b = lowest_[2 * i + 1];
    lowest_[i] = height(a) <= height(b) ? a : b;
  }
  used_ = kSlots / 2;
  slot_ = std::min(2 * slot_, max_slot_);
}

// Andrew's monotone chain, lower half; returns the number of corners.
std::size_t DelayEnvelope::lowerHull(std::array<Arrival, kSlots>& hull) const {
  std::size_t corners = 0;
  const auto turnsUp = [](const Arrival& a, const Arrival& b, const Arrival& c) {
    return (b.x - a.x) * (c.y - a.y) > (b.y - a.y) * (c.x - a.x);
  };
  for (std::size_t i = 0; i < used_; ++i) {
    while (corners >= 2 && !turnsUp(hull[corners - 2], hull[corners - 1], lowest_[i])) --corners;
    hull[corners++] = lowest_[i];
  }
  return corners;
}

double DelayEnvelope::slopeInTheMiddle() const {
  std::array<Arrival, kSlots> hull;
  const std::size_t corners = lowerHull(hull);
  const double middle = (lowest_[0].x + lowest_[used_ - 1].x) / 2;
  for (std::size_t i = 1; i < corners; ++i) {
    if (hull[i].x < middle && i + 1 < corners) continue;
    const double length = hull[i].x - hull[i - 1].x;
    return length > 0 ? (hull[i].y - hull[i - 1].y) / length : 0;
  }
  return 0;
}

void DelayEnvelope::fit() {
  drift_ = std::clamp(slopeInTheMiddle(), -max_drift_, max_drift_);
  offset_ = height(lowest_[0]);
  for (std::size_t i = 1; i < used_; ++i) offset_ = std::min(offset_, height(lowest_[i]));
}

namespace {

constexpr double kSecond = 1e9;  // [ns]

// Signed difference of two counters.
std::int64_t difference(std::uint64_t a, std::uint64_t b) {
  return static_cast<std::int64_t>(a - b);
}

}  // namespace

DeviceClock::DeviceClock(const DeviceClockOptions& options)
    : options_(options), envelope_(options.max_slot, options.max_drift) {}

std::uint64_t DeviceClock::observe(std::uint32_t device_time, std::int64_t receive_time,
                                   std::int64_t known_delay) {
  const std::int64_t arrival = receive_time - known_delay;
  std::uint64_t wide = widen(device_time);
  if (!started_) {
    start(wide, arrival);
  } else if (jumped(wide, arrival)) {
    wide = device_time;
    start(wide, arrival);
  }
  newest_ = std::max(newest_, wide);
  const double x = secondsSinceStart(wide);
  if (!late_) learn(x, static_cast<double>(arrival - start_host_) / kSecond - x);
  return wide;
}

void DeviceClock::learn(double x, double y) {
  if (options_.host_ticks) {
    trimmed_.add(x, y);
  } else {
    envelope_.add(x, y);
  }
}

std::int64_t DeviceClock::hostTime(std::uint64_t device_time) const {
  const double x = secondsSinceStart(device_time);
  const double delay = options_.host_ticks ? trimmed_.value() : envelope_.at(x);
  // The large parts are added as integers, because a double resolves 1e9 s to a tenth of a microsecond only.
  return start_host_ + difference(device_time, start_device_) * 1000 + std::llround(delay * kSecond);
}

void DeviceClock::forget() {
  started_ = false;
}

double DeviceClock::secondsSinceStart(std::uint64_t device_time) const {
  return static_cast<double>(difference(device_time, start_device_)) * 1e-6;
}

std::uint64_t DeviceClock::widen(std::uint32_t device_time) const {
  if (!started_) return device_time;
  const auto step = static_cast<std::int32_t>(device_time - static_cast<std::uint32_t>(newest_));
  const std::int64_t wide = static_cast<std::int64_t>(newest_) + step;
  return wide >= 0 ? static_cast<std::uint64_t>(wide) : device_time;
}

// How much later the packet is than the estimate for an undelayed one [s].
double DeviceClock::lateness(std::uint64_t device_time, std::int64_t arrival) const {
  return static_cast<double>(arrival - hostTime(device_time)) / kSecond;
}

bool DeviceClock::jumped(std::uint64_t device_time, std::int64_t arrival) {
  const double back = static_cast<double>(difference(newest_, device_time)) * 1e-6;
  if (back > options_.backward_limit) {
    noteJump(back, 0);
    ++jumps_;
    return true;
  }
  const double late = lateness(device_time, arrival);
  const bool settled = !options_.host_ticks && secondsSinceStart(device_time) > options_.settling;
  if (late < -(settled ? options_.small_limit : options_.early_limit)) {
    noteJump(late, 0);
    ++(late < -options_.early_limit ? jumps_ : small_jumps_);
    return true;
  }
  if (!isLate(late, arrival)) return false;
  noteJump(late, late_packets_);
  ++(late > options_.late_limit ? jumps_ : small_jumps_);
  return true;
}

// Whether all packets have been late for so long that a clock must have jumped.
bool DeviceClock::isLate(double late, std::int64_t arrival) {
  const double limit = options_.host_ticks ? options_.late_limit : options_.small_limit;
  const bool was_late = std::exchange(late_, late > limit);
  if (!late_) return false;
  if (!was_late) {
    late_since_ = arrival;
    late_packets_ = 0;
  }
  if (static_cast<double>(arrival - late_since_) / kSecond > options_.late_patience) return true;
  ++late_packets_;
  return false;
}

void DeviceClock::noteJump(double seconds, std::uint64_t packets) {
  last_jump_ = {seconds, packets};
  doubtful_ += packets;
}

void DeviceClock::start(std::uint64_t device_time, std::int64_t arrival) {
  started_ = true;
  late_ = false;
  newest_ = device_time;
  start_device_ = device_time;
  start_host_ = arrival;
  envelope_.clear();
  trimmed_.clear();
}

std::int64_t StampSequence::next(std::int64_t host_time, std::uint64_t device_time) {
  constexpr std::int64_t kTimeWentBack = 1'000'000'000;  // [ns]
  constexpr std::int64_t kLeastStep = 1'000;             // [ns]: every reader of a bag can resolve it
  if (started_ && host_time > stamp_ - kTimeWentBack) {
    const std::int64_t elapsed = difference(device_time, device_time_) * 1000;
    // After a pause or a reset of the board the spacing is not kept.
    const std::int64_t spacing = elapsed > 0 && elapsed < kTimeWentBack ? elapsed / 2 : 0;
    host_time = std::max(host_time, stamp_ + std::max(spacing, kLeastStep));
  }
  started_ = true;
  stamp_ = host_time;
  device_time_ = device_time;
  return host_time;
}

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
