#include "emulator/emulator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "fsr_pressure_map/settings/range.h"

namespace fsr::emulator {

// Vents the chamber and returns the time at which it is at rest. A run that was commanded but has not begun,
// because the chamber is still venting, never begins.
double Chamber::vent(double time) {
  while (!sections_.empty() && sections_.back().start > time) sections_.pop_back();
  const simulation::PressureProfile venting = simulation::ventingProfile(protocol_, gaugePressure(time));
  sections_.push_back({time, venting});
  return time + venting.duration();
}

void Chamber::startCycles(double time, const simulation::ChamberProtocol& protocol) {
  const double at_rest = vent(time);
  protocol_ = protocol;
  sections_.push_back({at_rest, simulation::pressureProfile(protocol)});
  cycles_end_ = at_rest + sections_.back().profile.duration();
}

void Chamber::stop(double time) {
  vent(time);
  cycles_end_ = std::numeric_limits<double>::infinity();
}

double Chamber::gaugePressure(double time) const {
  const auto next = std::upper_bound(sections_.begin(), sections_.end(), time,
                                     [](double t, const Section& section) { return t < section.start; });
  return next == sections_.begin() ? 0.0 : (next - 1)->profile.at(time - (next - 1)->start);
}

namespace {

using WallClock = std::chrono::steady_clock;
using Outcome = PseudoTerminal::Outcome;

constexpr std::uint32_t kUsualBaud = 115200;         // speed of a port without a UART
constexpr std::chrono::milliseconds kPatience{500};  // longest wait for a slow reader

}  // namespace

BoardLink::BoardLink(const std::string& link, std::uint32_t baud, std::uint64_t seed)
    : link_(link), baud_(baud), line_(seed) {
  plugIn();
}

void BoardLink::plugIn() {
  port_ = std::make_unique<PseudoTerminal>(link_, baud_ != 0 ? baud_ : kUsualBaud);
}

void BoardLink::setDamage(const LineDamage& damage, double time) {
  validate(damage);
  if (damage.unplugged) {
    port_.reset();
  } else if (!port_) {
    plugIn();
  }
  damage_ = damage;
  silent_until_ = time + damage.pause;
}

WallClock::duration BoardLink::send(std::vector<std::uint8_t>& packet, double time, bool patient) {
  if (!port_ || time < silent_until_) {
    ++counts_.unheard;
    return {};
  }
  const std::uint32_t baud = damage_.baud != 0 ? damage_.baud : baud_;
  if (baud != 0) packet = heardByUart(packet, baud, port_->readerBaud());
  line_.pass(damage_, packet);
  if (packet.empty()) {  // the line lost all of it
    ++counts_.sent;
    return {};
  }
  const auto start = WallClock::now();
  Outcome outcome = port_->write(packet.data(), packet.size());
  while (outcome == Outcome::kFull && patient && reader_keeps_up_) {
    const auto left = kPatience - (WallClock::now() - start);
    reader_keeps_up_ =
        left.count() > 0 && port_->waitForRoom(std::chrono::duration_cast<std::chrono::milliseconds>(left));
    outcome = port_->write(packet.data(), packet.size());
  }
  count(outcome);
  return outcome == Outcome::kUnheard ? WallClock::duration{} : WallClock::now() - start;
}

void BoardLink::count(Outcome outcome) {
  if (outcome == Outcome::kSent) {
    ++counts_.sent;
    reader_keeps_up_ = true;
  } else if (outcome == Outcome::kFull) {
    ++counts_.dropped;
  } else {
    ++counts_.unheard;
  }
}

LinkCounts BoardLink::counts() const {
  LinkCounts counts = counts_;
  counts.damage = line_.counts();
  return counts;
}

namespace {

using std::chrono::milliseconds;

constexpr int kPacketsATurn = 64;            // then other threads get the mutex
constexpr milliseconds kTick{4};             // interval at which the clock is read
constexpr milliseconds kLag{50};             // largest lag of scaled rig time before it waits
constexpr milliseconds kHiccup{5};           // delay of the scheduler that is not counted as late
constexpr milliseconds kDraining{500};       // time to empty a port full of overdue packets
constexpr milliseconds kMostPatience{2000};  // longest wait for the reader until the emulator has caught up

const EmulatorOptions& checked(const EmulatorOptions& options) {
  const settings::Range scale{0.01, 1000, ""};
  if (!scale.contains(options.time_scale)) {
    std::ostringstream sentence;
    sentence << "time_scale is " << options.time_scale << ", but must be " << scale.text();
    throw settings::InputError(sentence.str());
  }
  simulation::validate(options.simulation.chamber, options.simulation.origin + ": chamber");
  simulation::validate(options.simulation.board, options.simulation.origin + ": board");
  return options;
}

void refuseOverload(const Board& board, const EmulatorOptions& options) {
  if (options.baud == 0 || board.bitsPerSecond() <= options.baud) return;
  std::ostringstream sentence;
  sentence << options.simulation.origin << ": board.scan_rate is " << options.simulation.board.scan_rate
           << " Hz, but a link of " << options.baud << " baud cannot carry it: it needs "
           << std::ceil(board.bitsPerSecond()) << " baud";
  throw settings::InputError(sentence.str());
}

// A sheet that lies on nothing: no gas pressure bends or loads it.
simulation::LoadPattern noLoad() {
  simulation::LoadPattern pattern;
  pattern.kind = simulation::LoadPattern::Kind::kDisc;
  pattern.centre = {1e3, 1e3};
  return pattern;
}

}  // namespace

std::string stateName(RigStatus::State state) {
  switch (state) {
    case RigStatus::State::kRunning:
      return "running";
    case RigStatus::State::kStopped:
      return "stopped";
    case RigStatus::State::kDone:
      return "done";
    default:
      return "idle";
  }
}

/// Locks the mutex for a caller. The emulator's thread releases it between packets when a caller waits.
class Emulator::Turn {
 public:
  explicit Turn(const Emulator& emulator) : emulator_(emulator) {
    ++emulator.waiting_;
    lock_ = std::unique_lock<std::mutex>(emulator.mutex_);
    --emulator.waiting_;
  }
  std::unique_lock<std::mutex>& lock() { return lock_; }
  ~Turn() { emulator_.changed_.notify_all(); }

 private:
  const Emulator& emulator_;
  std::unique_lock<std::mutex> lock_;
};

Emulator::Emulator(const EmulatorOptions& options)
    : options_(checked(options)),
      board_(options.simulation, options.clock),
      link_(options.link, options.baud, options.simulation.seed),
      schedule_(options.time_scale) {
  refuseOverload(board_, options_);
  board_.mount(options_.surface);
  mountings_.push_back({0, options_.surface});
  if (options_.autostart) chamber_.startCycles(0, options_.simulation.chamber);
  status_ = options_.autostart ? RigStatus{RigStatus::State::kRunning, 1} : RigStatus{};
  thread_ = std::thread([this] { run(); });
}

Emulator::~Emulator() {
  {
    const Turn turn(*this);
    stopping_ = true;
  }
  thread_.join();
}

// --- the emulator's thread -------------------------------------------------------------------------

void Emulator::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (options_.on_status) options_.on_status(status_);
  while (!stopping_) {
    heard_ = link_.hasReader();
    catchUp();
    changed_.notify_all();
    while (waiting_ > 0) {
      lock.unlock();
      std::this_thread::yield();
      lock.lock();
    }
    const auto now = RigSchedule::WallClock::now();
    const auto wake = std::min(schedule_.wallTime(board_.nextDue()), now + kTick);
    expected_ = std::max(wake, now);
    changed_.wait_until(lock, wake, [this] { return stopping_; });
  }
}

// Sends the packets that are due. Afterwards time_ is now, or the time of the first packet that is still to
// be sent. So a command from time_ on acts on all later packets and on none that was sent.
void Emulator::catchUp() {
  const double now = schedule_.now();
  for (int i = 0; i < kPacketsATurn && board_.nextDue() <= now; ++i) sendNext();
  noteLateness();
  forgiveLateness();
  advance(std::min(now, board_.nextDue()));
  if (schedule_.realTime()) return;
  const auto lag = RigSchedule::WallClock::now() - schedule_.wallTime(board_.nextDue());
  if (lag > kLag) schedule_.hold(lag);
}

// Notes whether the scheduler or a callback delayed the thread. A board is never delayed.
void Emulator::noteLateness() {
  const auto now = RigSchedule::WallClock::now();
  if (now - expected_ > kHiccup) {
    behind_ = true;
    late_ = now;
    waited_ = {};
  }
  expected_ = now;
}

// Also waits while the port is still full of the packets that were sent late all at once.
void Emulator::forgiveLateness() {
  const auto now = RigSchedule::WallClock::now();
  if (board_.nextDue() <= schedule_.now()) {
    late_ = now;
  } else if (now - late_ > kDraining) {
    behind_ = false;
  }
}

bool Emulator::patient() const {
  return !schedule_.realTime() || (behind_ && waited_ < kMostPatience);
}

void Emulator::sendNext() {
  noteLateness();
  advance(board_.nextDue());
  auto& packet = board_.next([this](double time) { return pressureAt(time); });
  if (options_.on_packet) options_.on_packet(packet);
  noteLateness();
  const auto waited = link_.send(packet, time_, patient());
  expected_ += waited;  // the reader caused this delay
  waited_ += waited;
  if (!schedule_.realTime()) schedule_.hold(waited);
}

void Emulator::advance(double time) {
  if (time <= time_) return;
  time_ = time;
  if (options_.on_clock) options_.on_clock(time);
  if (options_.person) {
    for (const Act& act : options_.person->takeActs(time)) perform(act);
  }
  if (status_.state == RigStatus::State::kRunning && time >= chamber_.cyclesEnd()) {
    setState(RigStatus::State::kDone);
  }
}

void Emulator::setState(RigStatus::State state) {
  status_.state = state;
  if (options_.on_status) options_.on_status(status_);
}

void Emulator::putOn(const matrix::Surface& surface) {
  board_.mount(surface);
  mountings_.push_back({time_, surface});
}

void Emulator::perform(const Act& act) {
  if (act.kind == Act::Kind::kTakeOff)
    board_.mount({"", mountings_.back().surface.mount, {matrix::Curvature{}}, {}}, noLoad());
  if (act.kind == Act::Kind::kPutOn) {
    matrix::Surface surface = options_.surface_called(act.surface);
    surface.mount = act.mount;
    putOn(surface);
  }
  if (act.change) {
    act.change(board_, damage_, time_);
    link_.setDamage(damage_, time_);
  }
  if (options_.on_act) options_.on_act(act);
}

double Emulator::pressureAt(double time) const {
  return options_.person ? options_.person->gaugePressure(time) : chamber_.gaugePressure(time);
}

void Emulator::requireNobody(const char* command) const {
  if (!options_.person) return;
  throw settings::InputError(std::string(command) +
                             ": an operator works at this rig; give instructions instead");
}

// --- commands, from any thread -----------------------------------------------------------------------

unsigned Emulator::startCycles() {
  return startCycles(options_.simulation.chamber);
}

unsigned Emulator::startCycles(const simulation::ChamberProtocol& protocol) {
  requireNobody("start");
  simulation::validate(protocol, "chamber");
  const Turn turn(*this);
  catchUp();
  chamber_.startCycles(time_, protocol);
  ++status_.run;
  setState(RigStatus::State::kRunning);
  return status_.run;
}

void Emulator::stopCycles() {
  requireNobody("stop");
  const Turn turn(*this);
  catchUp();
  chamber_.stop(time_);
  if (status_.state == RigStatus::State::kRunning) setState(RigStatus::State::kStopped);
}

void Emulator::setSurface(const matrix::Surface& surface) {
  requireNobody("set_surface");
  const Turn turn(*this);
  catchUp();
  putOn(surface);
}

void Emulator::instruct(const Task& task) {
  if (!options_.person) throw settings::InputError("instruction: no operator works at this rig");
  if (task.kind == TaskKind::kMount) {
    matrix::requireFit(options_.surface_called(task.surface), options_.simulation.layout.size);
  }
  const Turn turn(*this);
  catchUp();
  options_.person->instruct(std::max(time_, 0.0), task);
}

void Emulator::setDamage(const LineDamage& damage) {
  const Turn turn(*this);
  catchUp();
  link_.setDamage(damage, time_);
  damage_ = damage;
}

void Emulator::setTrigger(bool high) {
  const Turn turn(*this);
  catchUp();
  board_.setTrigger(high, time_);
  sendNext();
}

void Emulator::resetBoard() {
  const Turn turn(*this);
  catchUp();
  board_.reset(time_);
}

void Emulator::jumpClock(double seconds) {
  const Turn turn(*this);
  catchUp();
  board_.jumpClock(seconds);
}

// --- queries, from any thread ----------------------------------------------------------------------

std::string Emulator::port() const {
  const Turn turn(*this);
  return link_.port();
}

RigStatus Emulator::status() const {
  const Turn turn(*this);
  return status_;
}

LinkCounts Emulator::counts() const {
  const Turn turn(*this);
  return link_.counts();
}

std::uint64_t Emulator::scans() const {
  const Turn turn(*this);
  return board_.scans();
}

double Emulator::rigTime() const {
  const Turn turn(*this);
  return std::max(time_, 0.0);
}

double Emulator::rigTime(std::uint64_t device_time) const {
  const Turn turn(*this);
  return board_.rigTime(device_time);
}

double Emulator::gaugePressure(double rig_time) const {
  const Turn turn(*this);
  return pressureAt(rig_time);
}

matrix::Surface Emulator::surface(double rig_time) const {
  const Turn turn(*this);
  auto mounting = mountings_.rbegin();
  while (mounting->since > rig_time && std::next(mounting) != mountings_.rend()) ++mounting;
  return mounting->surface;
}

template <typename Condition>
bool Emulator::waitFor(Condition condition, milliseconds timeout) const {
  Turn turn(*this);
  return changed_.wait_for(turn.lock(), timeout, condition);
}

bool Emulator::waitForStatus(RigStatus::State state, milliseconds timeout) const {
  return waitFor([this, state] { return status_.state == state; }, timeout);
}

bool Emulator::waitForReader(milliseconds timeout) const {
  return waitFor([this] { return heard_; }, timeout);
}

bool Emulator::waitForRigTime(double time, milliseconds timeout) const {
  return waitFor([this, time] { return time_ >= time; }, timeout);
}

}  // namespace fsr::emulator
