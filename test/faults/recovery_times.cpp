// Time until data flow again after each fault of the link, with the driver's defaults (the port is tried
// again every second). Prints the table of docs/reliability.md. The board is emulated, 3 x 4 taxels at 500
// Hz.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <thread>
#include <vector>

#include "faults/fault_rig.h"

namespace {

using Clock = std::chrono::steady_clock;
using fsr::emulator::LineDamage;
using test_support::FaultBoard;
using test_support::FaultListener;

constexpr int kRounds = 15;

struct Rig {
  test_support::TemporaryFolder folder;
  std::string port = folder.path("board");
  test_support::SentPackets sent;
  FaultListener listener{sent};
  std::unique_ptr<FaultBoard> board = std::make_unique<FaultBoard>(port, sent);
  fsr::protocol::BoardReader reader{[this] {
                                      return std::make_unique<fsr::protocol::SerialPort>(port, 0, [] {
                                        return std::int64_t{1'000'000'000'000'000'000} +
                                               Clock::now().time_since_epoch().count();
                                      });
                                    },
                                    listener,
                                    {std::chrono::milliseconds(1000), ""}};

  fsr::emulator::Emulator& rig() { return *board->operator->(); }
  std::uint64_t lost() const { return reader.report().counts.of(fsr::protocol::PacketType::kScan).lost; }
};

void wait(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

// Calls `harm`, then `heal`; measures from the end of `heal` to the next scan that may be published.
void measure(const char* fault, const std::function<void(Rig&)>& harm, double duration,
             const std::function<void(Rig&)>& heal) {
  Rig rig;
  rig.listener.knows("A");
  std::vector<double> first, passed;
  for (int round = 0; round < kRounds; ++round) {
    rig.listener.hears(50);
    harm(rig);
    wait(duration + 0.067 * round);  // at a different point of the board's second in each round
    const std::uint64_t before = rig.listener.passed();
    heal(rig);
    const Clock::time_point start = Clock::now();
    rig.listener.hears(1);
    first.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    rig.listener.await([&] { return rig.listener.passedLocked() > before; });
    passed.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
  std::sort(first.begin(), first.end());
  std::sort(passed.begin(), passed.end());
  const FaultListener::Wrong wrong = rig.listener.wrong();
  std::printf("| %s | %.2f (%.2f) | %.2f (%.2f) | %llu |\n", fault, first[kRounds / 2], first.back(),
              passed[kRounds / 2], passed.back(),
              static_cast<unsigned long long>(wrong.scans + wrong.pressures + wrong.boards));
  std::fflush(stdout);
}

LineDamage with(const std::function<void(LineDamage&)>& set) {
  LineDamage damage;
  set(damage);
  return damage;
}

}  // namespace

int main() {
  const auto heal = [](Rig& rig) { rig.rig().setDamage({}); };
  const auto damage = [](const std::function<void(LineDamage&)>& set) {
    return [set](Rig& rig) { rig.rig().setDamage(with(set)); };
  };
  const auto nothing = [](Rig&) {};
  std::puts("| fault | first scan received, median (worst) [s] | published | wrong |\n|---|---:|---:|---:|");
  measure("cable out and in", damage([](LineDamage& d) { d.unplugged = true; }), 0.2, heal);
  measure("board reset", nothing, 1.2, [](Rig& rig) { rig.rig().resetBoard(); });
  measure(
      "another board", [](Rig& rig) { rig.board.reset(); }, 0.2,
      [number = 0](Rig& rig) mutable {
        rig.board = std::make_unique<FaultBoard>(rig.port, rig.sent, ++number % 2 == 1 ? "B" : "A");
      });
  measure("stream of noise", damage([](LineDamage& d) { d.lost_packets = 1, d.noise = 5; }), 0.2, heal);
  measure("silence", damage([](LineDamage& d) { d.pause = 1e4; }), 0.2, heal);
  measure("bytes lost, 1 in 1,000", damage([](LineDamage& d) { d.lost_bytes = 1e-3; }), 0.2, heal);
  measure("bits flipped, 1 in 1,000", damage([](LineDamage& d) { d.flipped_bits = 1e-3; }), 0.2, heal);
  measure("clock jumps 30 s ahead", nothing, 0.2, [](Rig& rig) { rig.rig().jumpClock(30); });
  measure("clock jumps 30 s back", nothing, 0.2, [](Rig& rig) { rig.rig().jumpClock(-30); });
}
