#pragma once

#include <cstdint>

#include "protocol/delay_envelope.h"
#include "protocol/trimmed_delay.h"

namespace fsr::protocol {

/// Every default of the clock.
struct DeviceClockOptions {
  bool host_ticks = false;    ///< host times come from a simulated clock that ticks: see TrimmedDelay
  double max_slot = 2;        ///< the estimate looks back over 64 of these [s]
  double max_drift = 0.02;    ///< of the board's oscillator: RC 2 %, ceramic 0.5 %, quartz 0.01 % (ratio)
  double early_limit = 0.5;   ///< a packet earlier than possible by more than this: a clock jumped [s]
  double late_limit = 1.0;    ///< a packet later than this is late for a reason other than jitter [s]
  double late_patience = 5;   ///< when all packets have been that late for this long, a clock jumped [s]
  double backward_limit = 1;  ///< device time may step back by this between packets of two types [s]
};

/// Maps a board's clock to the host's: widens the board's 32 bits of microseconds to 64, and estimates
/// the offset and the slow drift between the clocks from the arrivals of the packets.
///
/// What delays a packet (USB frames, buffers, the scheduler) only ever delays it, so the estimate is the
/// lower envelope of the arrivals, see DelayEnvelope. The delay that is known, e.g. the bytes' own time on
/// the line, is taken off before. What remains is the smallest delay that the link ever has, below a
/// millisecond on USB, as a constant that no observer at this end can see.
///
/// Under a simulated clock that ticks, arrivals look up to a tick too early: host times are then early by
/// about half a tick, all alike, and as evenly spaced as the board made them.
class DeviceClock {
 public:
  explicit DeviceClock(const DeviceClockOptions& options = {});

  /// Takes in a packet that the board stamped `device_time` [us, 32 bit] and that was here at `receive_time`
  /// [host, ns]; `known_delay` [ns] of what lies between is known. Returns the device time in 64 bits [us].
  /// A reset of the board or a jump of either clock starts the estimate anew.
  std::uint64_t observe(std::uint32_t device_time, std::int64_t receive_time, std::int64_t known_delay);

  bool started() const { return started_; }

  /// The 64-bit device time [us] next to the newest one observed; takes nothing in.
  std::uint64_t widen(std::uint32_t device_time) const;

  /// Host time [ns] of a device time [us, 64 bit]; needs one observe().
  std::int64_t hostTime(std::uint64_t device_time) const;

  /// A new connection: the next packet starts the estimate, and no jump is counted.
  void forget();

  std::uint64_t jumps() const { return jumps_; }
  /// How much faster the host's clock runs than the board's (ratio, 1e-6 = 1 ppm).
  double drift() const { return options_.host_ticks ? 0 : envelope_.drift(); }

 private:
  double secondsSinceStart(std::uint64_t device_time) const;
  double lateness(std::uint64_t device_time, std::int64_t arrival) const;
  bool jumped(std::uint64_t device_time, std::int64_t arrival);
  void start(std::uint64_t device_time, std::int64_t arrival);
  void learn(double x, double y);

  DeviceClockOptions options_;
  DelayEnvelope envelope_;  // one of the two is in use
  TrimmedDelay trimmed_;
  bool started_ = false;
  std::uint64_t newest_ = 0;        // device time [us]
  std::uint64_t start_device_ = 0;  // origin of the envelope's x [us]
  std::int64_t start_host_ = 0;     // host time of that origin, give or take a delay [ns]
  std::int64_t late_since_ = 0;     // arrival of the first of a run of late packets [ns]
  bool late_ = false;
  std::uint64_t jumps_ = 0;
};

/// Makes the stamps of one topic strictly increasing: where a better estimate of the clock would set
/// the stamps back, they catch up by running at half the device's speed instead.
class StampSequence {
 public:
  /// The stamp [ns] for a packet that maps to `host_time` [ns] and was made at `device_time` [us, 64 bit].
  /// Goes back only where the host's time itself went back by more than a second (set clock, restarted
  /// simulation).
  std::int64_t next(std::int64_t host_time, std::uint64_t device_time);

 private:
  bool started_ = false;
  std::int64_t stamp_ = 0;         // [ns]
  std::uint64_t device_time_ = 0;  // [us]
};

}  // namespace fsr::protocol
