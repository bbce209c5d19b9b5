#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "emulator/board.h"
#include "emulator/board_link.h"
#include "emulator/chamber.h"
#include "emulator/rig_schedule.h"

namespace fsr::emulator {

/// What the chamber is doing.
struct RigStatus {
  enum class State {
    kIdle,     ///< at rest, no run yet
    kRunning,  ///< cycles of the run go on
    kStopped,  ///< the run was stopped before its end
    kDone,     ///< the run's cycles are done, the chamber is at rest
  };
  State state = State::kIdle;
  unsigned run = 0;  ///< counts the runs from 1
};

/// The state in lower case: idle, running, stopped, done.
std::string stateName(RigStatus::State state);

struct EmulatorOptions {
  simulation::SimulationSettings simulation;
  matrix::Surface surface{"flat", 1, {matrix::Curvature{}}, {}};
  std::string link;        ///< where a link to the port is put, empty = none: ask port()
  std::uint32_t baud = 0;  ///< of the board's UART [1/s]; 0 = native USB, any speed is right
  double time_scale = 1;   ///< seconds of rig time in a second, 0.01 to 1,000
  BoardClock clock;
  bool autostart = false;  ///< cycles begin at rig time 0
  /// Called with the rig time [s] before each scan is sent, at least every 5 ms, in ascending order.
  std::function<void(double)> on_clock;
  /// Called with each packet as the board made it, before the line damages it: the truth of tests.
  std::function<void(const std::vector<std::uint8_t>&)> on_packet;
  /// Called with the status at the start and at each change, in its caller's thread.
  std::function<void(const RigStatus&)> on_status;
};

/// A board and its pressure chamber behind a serial port: the device of the desk and of all tests.
///
///     Emulator rig(options);                     // is running; open rig.port() with any program
///     rig.startCycles();
///     rig.setSurface(cylinder);
///     EXPECT_TRUE(rig.waitForStatus(RigStatus::State::kDone, 10s));
///     rig.gaugePressure(rig.rigTime(device_time));   // the truth behind a stamp
///
/// Everything follows rig time, which is wall time since the start times the time scale, on an absolute
/// schedule. At a scale other than 1 rig time waits where the computer or a reader cannot follow, so
/// that a slow computer changes nothing but the duration; at scale 1 packets that the reader leaves in
/// the port are dropped, as by a UART. Where the emulator itself came late, which no board does, it waits for
/// the reader to take what is overdue: what is lost then was lost by the reader. All functions may be called
/// from any thread; the callbacks must not call back.
class Emulator {
 public:
  /// Opens the port and starts. Throws InputError.
  explicit Emulator(const EmulatorOptions& options);
  ~Emulator();
  Emulator(const Emulator&) = delete;
  Emulator& operator=(const Emulator&) = delete;

  /// What to open; the same for the emulator's life if a link was asked for.
  std::string port() const;

  /// A fresh run of cycles, after venting where the chamber is under pressure. Returns its number.
  /// Throws InputError.
  unsigned startCycles();
  unsigned startCycles(const simulation::ChamberProtocol& protocol);
  /// Vents to rest.
  void stopCycles();
  /// Throws InputError where the surface does not fit the matrix.
  void setSurface(const matrix::Surface& surface);
  /// Damage from now on; LineDamage{} heals. Throws InputError.
  void setDamage(const LineDamage& damage);
  /// Switches the board off and on.
  void resetBoard();
  /// Its clock steps by `seconds`, forward or back.
  void jumpClock(double seconds);

  RigStatus status() const;
  LinkCounts counts() const;
  /// Scans that the board made.
  std::uint64_t scans() const;

  /// Rig time now [s].
  double rigTime() const;
  /// Rig time [s] at which the board's clock, unwrapped, showed that, since the last reset.
  double rigTime(std::uint64_t device_time) const;
  /// The truth at a rig time up to now: gauge pressure [Pa] and surface.
  double gaugePressure(double rig_time) const;
  matrix::Surface surface(double rig_time) const;

  /// Wait for an event; false where it did not come in time [wall time].
  bool waitForStatus(RigStatus::State state, std::chrono::milliseconds timeout) const;
  bool waitForReader(std::chrono::milliseconds timeout) const;
  bool waitForRigTime(double time, std::chrono::milliseconds timeout) const;

 private:
  class Turn;
  struct Mounting {
    double since;  // [s rig time]
    matrix::Surface surface;
  };

  void run();
  void catchUp();
  void sendNext();
  void noteLateness();
  void forgiveLateness();
  bool patient() const;
  void advance(double time);
  void setState(RigStatus::State state);
  template <typename Condition>
  bool waitFor(Condition condition, std::chrono::milliseconds timeout) const;

  const EmulatorOptions options_;
  mutable std::mutex mutex_;  // of all below
  mutable std::condition_variable changed_;
  mutable std::atomic<unsigned> waiting_{0};  // callers who want it
  Board board_;
  Chamber chamber_;
  BoardLink link_;
  RigSchedule schedule_;
  std::vector<Mounting> mountings_;
  RigStatus status_;
  bool heard_ = false;                                                          // a reader is there
  RigSchedule::WallClock::time_point expected_{RigSchedule::WallClock::now()};  // the thread meant to run
  bool behind_ = false;                        // it came late, and is catching up
  RigSchedule::WallClock::time_point late_;    // when it last was
  RigSchedule::WallClock::duration waited_{};  // for the reader since then
  double time_ = -1;                           // rig time up to which all was sent [s]; nothing yet
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace fsr::emulator
