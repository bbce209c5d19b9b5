#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "emulator/board.h"
#include "emulator/line_damage.h"
#include "emulator/operator.h"
#include "emulator/pseudo_terminal.h"
#include "fsr_pressure_map/simulation/chamber.h"
#include "simulation/pressure_profile.h"

namespace fsr::emulator {

/// The pressure chamber: at rest at first, then with the runs and stops that were commanded. All times are
/// rig time [s]. A command acts from its time on and never changes the past.
class Chamber {
 public:
  /// Starts a new run of cycles. A chamber under pressure is vented first.
  void startCycles(double time, const simulation::ChamberProtocol& protocol);

  /// Vents to rest at the rate of the last run.
  void stop(double time);

  /// Gauge pressure at any time so far [Pa].
  double gaugePressure(double time) const;

  /// End of the last run's cycles; infinite where they never end or were stopped.
  double cyclesEnd() const { return cycles_end_; }

 private:
  struct Section {
    double start;  // [s]
    simulation::PressureProfile profile;
  };
  double vent(double time);

  simulation::ChamberProtocol protocol_;
  std::vector<Section> sections_;  // by ascending start
  double cycles_end_ = 0;
};

/// Numbers of packets by outcome.
struct LinkCounts {
  std::uint64_t sent = 0;  ///< packets that reached the port, damaged or not
  std::uint64_t unheard =
      0;  ///< packets lost because the port was not open or unplugged, or the line was silent
  std::uint64_t dropped = 0;  ///< packets lost because the reader was too slow
  LineDamageCounts damage;
};

/// The line from the board's pin to the computer's port, with its faults.
class BoardLink {
 public:
  /// `link`: path of a symbolic link to the port, empty = none. `baud`: rate of the board's UART [1/s], 0 =
  /// native USB. Throws InputError.
  BoardLink(const std::string& link, std::uint32_t baud, std::uint64_t seed);

  /// Sets the damage from `time` [s rig time] on. Throws InputError.
  void setDamage(const LineDamage& damage, double time);

  /// Sends a packet and changes it where it is damaged. `patient`: wait for a slow reader, up to half a
  /// second, instead of dropping the packet at once. Returns the time waited.
  std::chrono::steady_clock::duration send(std::vector<std::uint8_t>& packet, double time, bool patient);

  /// Path to open; empty while a port without a link is unplugged.
  std::string port() const { return port_ ? port_->path() : link_; }
  bool hasReader() { return port_ && port_->hasReader(); }
  LinkCounts counts() const;

 private:
  void plugIn();
  void count(PseudoTerminal::Outcome outcome);

  std::string link_;
  std::uint32_t baud_;
  bool reader_keeps_up_ = true;  // otherwise it is not waited for
  LossyLine line_;
  LineDamage damage_;
  double silent_until_ = -std::numeric_limits<double>::infinity();  // [s rig time]
  std::unique_ptr<PseudoTerminal> port_;                            // none = unplugged
  LinkCounts counts_;
};

/// Rig time [s]: wall time of the monotonic clock since the start, times a scale. This is an absolute
/// schedule: it does not drift where a thread wakes late.
class RigSchedule {
 public:
  using WallClock = std::chrono::steady_clock;

  /// Rig time 0 is now. `scale`: seconds of rig time per second.
  explicit RigSchedule(double scale) : scale_(scale), origin_(WallClock::now()) {}

  double now() const { return std::chrono::duration<double>(WallClock::now() - origin_).count() * scale_; }

  WallClock::time_point wallTime(double rig_time) const {
    const std::chrono::duration<double> since_origin(rig_time / scale_);
    return origin_ + std::chrono::duration_cast<WallClock::duration>(since_origin);
  }

  bool realTime() const { return scale_ == 1; }

  /// Stops rig time for this duration.
  void hold(WallClock::duration duration) { origin_ += duration; }

 private:
  double scale_;
  WallClock::time_point origin_;
};

/// State of the chamber.
struct RigStatus {
  enum class State {
    kIdle,     ///< at rest, no run yet
    kRunning,  ///< the cycles of a run
    kStopped,  ///< the run was stopped before its end
    kDone,     ///< the run is complete and the chamber at rest
  };
  State state = State::kIdle;
  unsigned run = 0;  ///< number of the run, from 1
};

/// The state in lower case: idle, running, stopped, done.
std::string stateName(RigStatus::State state);

struct EmulatorOptions {
  simulation::SimulationSettings simulation;
  matrix::Surface surface{"flat", 1, {matrix::Curvature{}}, {}};
  std::string link;        ///< path of a symbolic link to the port; empty = none, use port()
  std::uint32_t baud = 0;  ///< rate of the board's UART [1/s]; 0 = native USB, any rate works
  double time_scale = 1;   ///< seconds of rig time per second, 0.01 to 1,000
  BoardClock clock;
  bool autostart = false;  ///< start cycles at rig time 0
  /// A person who works chamber and sheet as instruct() says. startCycles() and setSurface() are refused
  /// then.
  std::shared_ptr<Operator> person;
  /// Surface of a name; throws InputError where there is none. Needed by `person`.
  std::function<matrix::Surface(const std::string&)> surface_called;
  /// Called with each act of the person, in the emulator's thread, before the packets after it.
  std::function<void(const Act&)> on_act;
  /// Called with the rig time [s] before each scan is sent, at least every 5 ms, in ascending order.
  std::function<void(double)> on_clock;
  /// Called with each packet before the line damages it, so that tests can compare.
  std::function<void(const std::vector<std::uint8_t>&)> on_packet;
  /// Called with the status at the start and at each change, in the thread that causes it.
  std::function<void(const RigStatus&)> on_status;
};

/// A board and its pressure chamber behind a serial port, for tests and for work without hardware.
///
///     Emulator rig(options);                     // it runs; open rig.port() with any program
///     rig.startCycles();
///     rig.setSurface(cylinder);
///     EXPECT_TRUE(rig.waitForStatus(RigStatus::State::kDone, 10s));
///     rig.gaugePressure(rig.rigTime(device_time));   // the true pressure at a stamp
///
/// Everything follows rig time, which is wall time since the start times the time scale, on an absolute
/// schedule. At a scale other than 1, rig time waits where the computer or a reader is too slow, so that a
/// slow computer changes only the duration. At scale 1, packets that the reader leaves in the port are
/// dropped, as by a UART. Where the emulator itself is late, which a board never is, it waits until the
/// reader has taken the overdue packets; packets that are lost then were lost by the reader. All functions
/// may be called from any thread. The callbacks must not call functions of the emulator.
class Emulator {
 public:
  /// Opens the port and starts. Throws InputError.
  explicit Emulator(const EmulatorOptions& options);
  ~Emulator();
  Emulator(const Emulator&) = delete;
  Emulator& operator=(const Emulator&) = delete;

  /// Path to open. With a link it does not change.
  std::string port() const;

  /// Starts a new run of cycles and returns its number. A chamber under pressure is vented first.
  /// Throws InputError.
  unsigned startCycles();
  unsigned startCycles(const simulation::ChamberProtocol& protocol);
  /// Vents the chamber to rest.
  void stopCycles();
  /// Throws InputError where the surface does not fit the matrix.
  void setSurface(const matrix::Surface& surface);
  /// Gives the person at the rig an instruction. Throws InputError where there is no person, no such surface,
  /// or a number is out of range.
  void instruct(const Task& task);
  /// Sets the damage of the line from now on; LineDamage{} ends it. Throws InputError.
  void setDamage(const LineDamage& damage);
  /// Makes an edge at the board's trigger input.
  void setTrigger(bool high);
  /// Switches the board off and on.
  void resetBoard();
  /// Makes the board's clock jump by `seconds`, forwards or backwards.
  void jumpClock(double seconds);

  RigStatus status() const;
  LinkCounts counts() const;
  /// Number of scans that the board made.
  std::uint64_t scans() const;

  /// Rig time now [s].
  double rigTime() const;
  /// Rig time [s] at which the board's clock, without wrapping, had this value since the last reset.
  double rigTime(std::uint64_t device_time) const;
  /// True gauge pressure [Pa] and surface at a rig time up to now.
  double gaugePressure(double rig_time) const;
  matrix::Surface surface(double rig_time) const;

  /// Wait for an event; false where it did not occur within `timeout` of wall time.
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
  void perform(const Act& act);
  void putOn(const matrix::Surface& surface);
  void requireNobody(const char* command) const;
  double pressureAt(double time) const;
  template <typename Condition>
  bool waitFor(Condition condition, std::chrono::milliseconds timeout) const;

  const EmulatorOptions options_;
  mutable std::mutex mutex_;  // guards everything below
  mutable std::condition_variable changed_;
  mutable std::atomic<unsigned> waiting_{0};  // callers that wait for the mutex
  Board board_;
  Chamber chamber_;
  BoardLink link_;
  RigSchedule schedule_;
  LineDamage damage_;
  std::vector<Mounting> mountings_;
  RigStatus status_;
  bool heard_ = false;  // a reader has the port open
  RigSchedule::WallClock::time_point expected_{
      RigSchedule::WallClock::now()};          // time at which the thread should run
  bool behind_ = false;                        // it was late and is catching up
  RigSchedule::WallClock::time_point late_;    // time at which it was last late
  RigSchedule::WallClock::duration waited_{};  // for the reader since then
  double time_ = -1;  // rig time up to which everything was sent [s]; -1 = nothing yet
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace fsr::emulator
