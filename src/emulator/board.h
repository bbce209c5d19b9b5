#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "simulation/rig.h"

namespace fsr::emulator {

/// How the board's clock runs.
struct BoardClock {
  std::uint32_t offset = 0;  ///< what it shows when the board starts [us]
  double drift = 0;          ///< how much too fast it runs [parts per million]
};

/// The board: it scans the matrix, samples transducer and temperature, and packs all that for the wire.
/// It knows rig time only, does no input or output, and is not thread-safe.
class Board {
 public:
  /// Gauge pressure of the chamber [Pa] at a rig time [s].
  using Pressure = simulation::PressureCourse;

  /// Switched on at rig time 0. Throws InputError.
  Board(const simulation::SimulationSettings& simulation, const BoardClock& clock);

  /// When the next packet leaves the board [s rig time].
  double nextDue() const;

  /// Makes that packet; valid until the next call.
  std::vector<std::uint8_t>& next(const Pressure& pressure);

  /// Lays the matrix on a surface. Throws InputError.
  void mount(const matrix::Surface& surface) { rig_.mount(surface); }

  /// Switches it off and on: clock and counters start again.
  void reset(double time);

  /// Its clock steps by `seconds`, forward or back, as by an upset of its crystal.
  void jumpClock(double seconds);

  /// What the board's clock shows at a rig time [us]; on the wire it wraps at 2^32.
  std::uint64_t deviceTime(double time) const;
  /// The other way round, since the last reset.
  double rigTime(std::uint64_t device_time) const;

  std::uint64_t scans() const { return rig_.scans(); }

  /// What the link must carry [bits a second of rig time].
  double bitsPerSecond() const;

 private:
  enum Kind { kIdentity, kTemperature, kTransducer, kScan, kKinds };
  /// What one kind of packet tells is sampled at `start` + `number` * `period` and sent `delay` later.
  struct Source {
    double start = 0;          // [s rig time]
    double period = 0;         // [s], 0 = never
    double delay = 0;          // [s]
    std::uint64_t number = 0;  // of the next packet
    std::uint32_t sequence = 0;

    double time() const { return start + static_cast<double>(number) * period; }
    double due() const;
  };
  Kind nextKind() const;
  std::size_t encode(Kind kind, double time, const Pressure& pressure);
  std::size_t encodeScan(std::uint32_t sequence, double time, const Pressure& pressure);
  std::size_t encodeIdentity(std::uint32_t sequence, std::uint32_t device_time);

  simulation::SimulationSettings settings_;
  BoardClock clock_;
  simulation::Rig rig_;
  std::array<Source, kKinds> sources_;
  double switched_on_ = 0;  // [s rig time]
  std::vector<std::uint8_t> packet_;
};

}  // namespace fsr::emulator
