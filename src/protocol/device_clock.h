#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "fsr_pressure_map/protocol/decoder.h"

namespace fsr::protocol {

/// (Host time - device time) as a constant, estimated from arrivals whose host time scatters in both
/// directions. This is so under a simulated clock: its ticks are messages of their own, so a packet may seem
/// late or early. The estimate is the mean of the middle eight tenths of the last 4096 arrivals that are at
/// least 0.1 s of device time apart. A median would jump between the two values that a coarse clock gives.
/// Both clocks are assumed to be the same one, so no drift is estimated.
class TrimmedDelay {
 public:
  void clear();
  /// Adds an arrival at device time `x` [s] whose host time is `y` [s] later.
  void add(double x, double y);
  /// The delay [s]. Needs one arrival.
  double value() const { return value_; }

 private:
  static constexpr std::size_t kArrivals = 4096;
  static constexpr double kSpacing = 0.1;  // [s]
  static constexpr double kTrim = 0.1;     // of the arrivals, at either end

  void average();

  std::array<double, kArrivals> delays_{};  // [s], a ring buffer
  std::array<double, kArrivals> sorted_{};  // work space
  std::size_t used_ = 0;
  std::size_t next_ = 0;
  std::size_t fresh_ = 0;  // arrivals since the last average
  double last_x_ = 0;
  double value_ = 0;
};

/// (Host time - device time) as a linear function of device time, estimated from arrivals with unknown delays
/// of zero or more. No arrival lies below the line, and the line touches the lower convex hull of the
/// arrivals in the middle of the window. Of all lines below the points this one has the smallest sum of
/// distances to them (Moon, Skelton and Towsley, "Estimation and removal of clock skew from network delay
/// measurements", INFOCOM 1999). An average would depend on the load of the USB bus; the envelope depends on
/// the few arrivals that were not delayed.
///
/// The window contains the lowest arrival of each of 64 slots. A slot is short at first, so that the line is
/// good within a second, and doubles up to `max_slot`. Memory is bounded and nothing is allocated.
class DelayEnvelope {
 public:
  /// `max_slot` [s]: the window is 64 times as long. `max_drift`: largest accepted difference of the clocks'
  /// rates (ratio).
  DelayEnvelope(double max_slot, double max_drift) : max_slot_(max_slot), max_drift_(max_drift) {}

  void clear();

  /// Adds an arrival at device time `x` [s] whose host time is `y` [s] later. One that is older than the
  /// newest slot is ignored.
  void add(double x, double y);

  bool empty() const { return used_ == 0; }
  /// The line at device time `x` [s]. Needs one arrival.
  double at(double x) const { return offset_ + drift_ * x; }
  /// Its slope: how much faster the host's clock runs than the device's (ratio).
  double drift() const { return drift_; }

 private:
  static constexpr std::size_t kSlots = 64;
  static constexpr double kFirstSlot = 1.0 / 16;  // [s]

  struct Arrival {
    double x = 0;  // device time [s]
    double y = 0;  // host - device [s]
  };

  double height(const Arrival& arrival) const { return arrival.y - drift_ * arrival.x; }
  void openSlot(double x);
  void mergePairs();
  std::size_t lowerHull(std::array<Arrival, kSlots>& hull) const;
  double slopeInTheMiddle() const;
  void fit();

  double max_slot_;
  double max_drift_;
  std::array<Arrival, kSlots> lowest_{};  // of each slot, in order of time
  std::size_t used_ = 0;
  double slot_ = kFirstSlot;  // length of a slot [s]
  double slot_end_ = 0;       // of the last one [s]
  double offset_ = 0;         // [s]
  double drift_ = 0;
};

/// Options of the clock.
struct DeviceClockOptions {
  bool host_ticks =
      false;            ///< host times come from a simulated clock that advances in ticks, see TrimmedDelay
  double max_slot = 2;  ///< the estimate uses the last 64 of these [s]
  double max_drift = 0.02;  ///< largest of a board's oscillator: RC 2 %, ceramic 0.5 %, quartz 0.01 % (ratio)
  double early_limit =
      0.5;  ///< a packet that is earlier than possible by more than this shows that a clock jumped [s]
  double late_limit = 1.0;  ///< a packet that is later than this is late for another reason than jitter [s]
  /// Smaller jumps count, too, where host times do not tick: from this on, and for early packets once the
  /// estimate has settled [s]. A jump of 0.1 s counts also where the packet behind it is delayed by the 16 ms
  /// after which a USB adapter sends its bytes.
  double small_limit = 0.08;
  double settling = 5;        ///< after a start, buffers of the link may still be emptied [s]
  double late_patience = 5;   ///< if all packets are that late for this long, a clock jumped [s]
  double backward_limit = 1;  ///< device time may be this much smaller in a packet of another type [s]
};

/// The last jump of a clock.
struct ClockJump {
  double seconds = 0;         ///< by which packets then seemed later; negative = earlier
  std::uint64_t packets = 0;  ///< packets before it was noticed, whose host times are wrong by as much
};

/// Converts the board's clock to the host's. It extends the board's 32 bits of microseconds to 64, and
/// estimates the offset and the slow drift between the clocks from the arrivals of the packets.
///
/// USB frames, buffers and the scheduler can delay a packet but never make it early. So the estimate is the
/// lower envelope of the arrivals, see DelayEnvelope. The known part of the delay, e.g. the bytes' own time
/// on the line, is subtracted first. The smallest delay of the link, below a millisecond on USB, remains as a
/// constant error, which the host cannot observe.
///
/// Under a simulated clock that advances in ticks, arrivals seem up to a tick too early. Host times are then
/// early by about half a tick, all by the same amount, and have the even spacing of the board.
class DeviceClock {
 public:
  explicit DeviceClock(const DeviceClockOptions& options = {});

  /// Adds a packet that the board stamped `device_time` [us, 32 bit] and that arrived at `receive_time`
  /// [host, ns]. `known_delay`: known part of its delay [ns]. Returns the device time in 64 bits [us]. A
  /// reset of the board or a jump of either clock restarts the estimate.
  std::uint64_t observe(std::uint32_t device_time, std::int64_t receive_time, std::int64_t known_delay);

  bool started() const { return started_; }

  /// The 64-bit device time [us] that is closest to the newest one observed. Does not change the estimate.
  std::uint64_t widen(std::uint32_t device_time) const;

  /// Host time [ns] of a device time [us, 64 bit]. Needs one observe() before.
  std::int64_t hostTime(std::uint64_t device_time) const;

  /// Call it at a new connection: the next packet restarts the estimate, and no jump is counted.
  void forget();

  /// Resets of the board, and jumps by so much that another board may be at the port.
  std::uint64_t jumps() const { return jumps_; }
  std::uint64_t smallJumps() const { return small_jumps_; }
  const ClockJump& lastJump() const { return last_jump_; }
  std::uint64_t doubtfulPackets() const { return doubtful_; }  ///< sum of ClockJump::packets
  /// How much faster the host's clock runs than the board's (ratio, 1e-6 = 1 ppm).
  double drift() const { return options_.host_ticks ? 0 : envelope_.drift(); }

 private:
  double secondsSinceStart(std::uint64_t device_time) const;
  double lateness(std::uint64_t device_time, std::int64_t arrival) const;
  bool jumped(std::uint64_t device_time, std::int64_t arrival);
  bool isLate(double late, std::int64_t arrival);
  void noteJump(double seconds, std::uint64_t packets);
  void start(std::uint64_t device_time, std::int64_t arrival);
  void learn(double x, double y);

  DeviceClockOptions options_;
  DelayEnvelope envelope_;  // one of the two is used
  TrimmedDelay trimmed_;
  bool started_ = false;
  std::uint64_t newest_ = 0;        // device time [us]
  std::uint64_t start_device_ = 0;  // origin of the envelope's x [us]
  std::int64_t start_host_ = 0;     // approximate host time of that origin [ns]
  std::int64_t late_since_ = 0;     // arrival of the first of a run of late packets [ns]
  bool late_ = false;
  std::uint64_t late_packets_ = 0;  // of that run
  std::uint64_t jumps_ = 0;
  std::uint64_t small_jumps_ = 0;
  std::uint64_t doubtful_ = 0;
  ClockJump last_jump_;
};

/// Makes the stamps of one topic strictly increasing. Where a better estimate of the clock would make a stamp
/// earlier than the last one, the stamps advance at half the device's speed until they fit.
class StampSequence {
 public:
  /// The stamp [ns] of a packet with `host_time` [ns] and `device_time` [us, 64 bit]. It decreases only where
  /// the host's time itself went backwards by more than a second (clock set, simulation restarted).
  std::int64_t next(std::int64_t host_time, std::uint64_t device_time);

 private:
  bool started_ = false;
  std::int64_t stamp_ = 0;         // [ns]
  std::uint64_t device_time_ = 0;  // [us]
};

/// Time of a packet's content.
struct PacketTime {
  std::int64_t stamp = 0;         ///< host time [ns], strictly increasing for each type of packet
  std::uint64_t device_time = 0;  ///< the board's clock at the stamp [us]
};

/// Computes the stamps of packets from the line's speed, the arrival of the bytes and the board's clock.
class PacketStamper {
 public:
  explicit PacketStamper(const DeviceClockOptions& options = {}) : clock_(options) {}

  /// Starts a new connection over a line of `baud` [1/s]; 0 = the time of the bytes is negligible.
  void startLine(std::uint32_t baud);
  /// Sets the arrival of the packets that follow, `receive_time` [host, ns].
  void setArrival(std::int64_t receive_time) { receive_time_ = receive_time; }

  /// `duration` of the scan [us]. A board sends a scan after its last taxel at the earliest. So half of the
  /// duration lies between the middle of the scan and its arrival, in addition to the time on the line. Scans
  /// do not overlap: a duration longer than the time from scan to scan is replaced by the last good one. That
  /// of the first scan is judged with the second one; if it cannot be, the estimate of the clock restarts.
  PacketTime scan(const PacketHeader& header, std::uint32_t duration);
  PacketTime transducer(const PacketHeader& header) { return soon(PacketType::kTransducer, header); }
  PacketTime trigger(const PacketHeader& header) { return soon(PacketType::kTrigger, header); }
  /// Does not update the clock, because a temperature may be sent long after it was measured.
  PacketTime temperature(const PacketHeader& header);

  const DeviceClock& clock() const { return clock_; }
  /// Scans whose duration was longer than the time from scan to scan, and so was not used.
  std::uint64_t impossibleDurations() const { return impossible_durations_; }

 private:
  std::int64_t timeOnTheLine(std::size_t bytes) const;
  std::optional<double> periodBefore(const PacketHeader& header) const;
  bool isPossible(std::uint32_t duration, std::optional<double> period) const;
  std::uint32_t possibleDuration(const PacketHeader& header, std::uint32_t duration);
  PacketTime soon(PacketType type, const PacketHeader& header);
  PacketTime finish(PacketType type, std::uint64_t device_time);

  DeviceClock clock_;
  std::array<StampSequence, kPacketTypes> sequences_;  // by PacketType
  std::uint32_t baud_ = 0;
  std::int64_t receive_time_ = 0;
  bool scanned_ = false;  // a scan has come over this line
  PacketHeader last_scan_;
  std::uint32_t last_duration_ = 0;  // [us]
  std::optional<double> period_;     // between the last two scans between which it was known [us]
  std::uint64_t impossible_durations_ = 0;
};

}  // namespace fsr::protocol
