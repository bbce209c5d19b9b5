#pragma once

#include <cstdint>
#include <string>

#include "fsr_pressure_map/protocol/decoder.h"

namespace fsr::protocol {

/// Passes packets on to a handler and catches what the handler throws. A fault of the handler costs the
/// packet at hand; it neither stops the decoder nor looks like a broken link.
class HandlerGuard final : public PacketHandler {
 public:
  /// `handler` must outlive the guard.
  explicit HandlerGuard(PacketHandler& handler) : handler_(handler) {}

  void onScan(const PacketHeader& header, const ScanPacket& scan) override;
  void onTransducer(const PacketHeader& header, std::int32_t counts) override;
  void onTemperature(const PacketHeader& header, std::int32_t millidegrees) override;
  void onIdentity(const PacketHeader& header, const IdentityPacket& identity) override;

  /// Calls `call` and catches what it throws. `task`: what failed then, e.g. "handling a scan".
  template <typename Call>
  void run(const char* task, Call call) {
    try {
      call();
    } catch (...) {
      note(task);
    }
  }

  /// How many calls have thrown.
  std::uint64_t faults() const { return faults_; }
  /// What the last of them threw, one sentence; empty = none threw.
  const std::string& complaint() const { return complaint_; }

 private:
  void note(const char* task);

  PacketHandler& handler_;
  std::uint64_t faults_ = 0;
  std::string complaint_;
};

}  // namespace fsr::protocol
