#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "protocol/board_reader.h"
#include "support/packet_recorder.h"

namespace test_support {

/// Notes everything that a link reports, so that the test's thread can wait for it. A test may set the
/// functions that run before a call is noted; what they throw leaves the handler.
class LinkListener : public fsr::protocol::LinkHandler {
 public:
  std::function<void(const fsr::protocol::PacketHeader&)> before_transducer = [](const auto&) {};
  std::function<void()> before_open = [] {};
  std::function<void()> before_bytes = [] {};
  std::function<void()> before_change = [] {};

  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    add([&] { recorder_.onScan(header, scan); });
  }
  void onTransducer(const fsr::protocol::PacketHeader& header, std::int32_t counts) override {
    before_transducer(header);
    add([&] { recorder_.onTransducer(header, counts); });
  }
  void onTemperature(const fsr::protocol::PacketHeader& header, std::int32_t value) override {
    recorder_.onTemperature(header, value);
  }
  void onIdentity(const fsr::protocol::PacketHeader& header,
                  const fsr::protocol::IdentityPacket& identity) override {
    recorder_.onIdentity(header, identity);
  }
  void onOpen(std::uint32_t) override { before_open(); }
  void onBytes(std::int64_t) override { before_bytes(); }
  void onChange(const fsr::protocol::LinkReport& report) override {
    add([&] {
      phases_.push_back(report.phase);
      complaint_ = report.handler_complaint;
    });
    before_change();
  }

  // True once `count` packets came.
  bool packets(std::size_t count) {
    return await([&] { return recorder_.lines.size() >= count; });
  }
  // True once the link came to `phase`, after what an earlier call waited for.
  bool reaches(fsr::protocol::LinkPhase phase) {
    return await([&] {
      while (seen_ < phases_.size()) {
        if (phases_[seen_++] == phase) return true;
      }
      return false;
    });
  }
  // True once the link reported a fault of this handler.
  bool complains() {
    return await([&] { return !complaint_.empty(); });
  }
  std::vector<std::string> lines() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return recorder_.lines;
  }
  std::size_t packetCount() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return recorder_.lines.size();
  }

 private:
  template <typename Do>
  void add(Do action) {
    const std::lock_guard<std::mutex> lock(mutex_);
    action();
    changed_.notify_all();
  }
  template <typename Condition>
  bool await(Condition condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, kPatience, condition);
  }

  static constexpr std::chrono::seconds kPatience{20};  // never reached where the code is right

  std::mutex mutex_;
  std::condition_variable changed_;
  PacketRecorder recorder_;
  std::vector<fsr::protocol::LinkPhase> phases_;
  std::size_t seen_ = 0;
  std::string complaint_;
};

}  // namespace test_support
