#include "emulator/board_link.h"

namespace fsr::emulator {

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

}  // namespace fsr::emulator
