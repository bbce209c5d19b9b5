#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "emulator/emulator.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/protocol/wire.h"
#include "protocol/board_reader.h"
#include "protocol/device_clock.h"
#include "protocol/serial_port.h"
#include "support/pty.h"
#include "support/small_tables.h"
#include "support/source_dir.h"

namespace test_support {

constexpr std::chrono::seconds kFaultPatience(30);  // limit for events that must happen

/// All packets that the boards sent, byte for byte. Every packet received over a damaged line must be one of
/// them.
class SentPackets {
 public:
  void add(const std::vector<std::uint8_t>& packet) {
    const std::lock_guard<std::mutex> lock(mutex_);
    packets_.insert(packet);
  }
  bool has(const std::vector<std::uint8_t>& packet) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return packets_.count(packet) == 1;
  }

 private:
  mutable std::mutex mutex_;
  std::set<std::vector<std::uint8_t>> packets_;
};

/// An emulated board with 3 x 4 taxels at 500 Hz, on a port whose name does not change.
class FaultBoard {
 public:
  FaultBoard(const std::string& link, SentPackets& sent, const std::string& serial = "A",
             std::uint32_t baud = 0, std::uint32_t clock_offset = 0) {
    fsr::emulator::EmulatorOptions options;
    options.simulation = fsr::simulation::readSimulationFile(sourceDir() + "/config/simulation/bench.yaml");
    options.simulation.board.scan_rate = 500;
    options.simulation.board.serial = serial;
    options.link = link;
    options.baud = baud;
    options.clock.offset = clock_offset;
    options.autostart = true;
    options.on_packet = [&sent](const std::vector<std::uint8_t>& packet) { sent.add(packet); };
    rig_ = std::make_unique<fsr::emulator::Emulator>(options);
  }
  fsr::emulator::Emulator* operator->() { return rig_.get(); }

 private:
  std::unique_ptr<fsr::emulator::Emulator> rig_;
};

/// Reads from the port to pressure as driver and calibration node do, and compares each result with the
/// truth.
class FaultListener : public fsr::protocol::LinkHandler {
 public:
  /// Number of wrong results; all are 0 where the code is correct.
  struct Wrong {
    std::uint64_t scans = 0;      ///< scans that no board sent
    std::uint64_t pressures = 0;  ///< pressures that are not the table's for the count sent
    std::uint64_t stamps = 0;     ///< stamps that are not later than the previous one
    std::uint64_t boards = 0;     ///< scans that were attributed to another board
  };

  explicit FaultListener(const SentPackets& sent)
      : sent_(sent), calibrator_(smallTables({3, 4}, {0.0}, 4095), fsr::matrix::Layout{{3, 4}}) {}

  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override {
    const fsr::protocol::PacketTime time = stamper_.scan(header, scan.duration);
    const std::uint64_t jumps = stamper_.clock().jumps();
    if (std::exchange(jumps_, jumps) != jumps) gate_.doubt();
    const bool held = gate_.scan(arrival_) == fsr::protocol::BoardGate::Verdict::kHold;
    const fsr::matrix::ScanView view = {scan.size, scan.full_scale, scan.counts, scan.size.taxels()};
    calibrator_.calibrate(view, 1e-9 * static_cast<double>(time.stamp), map_);
    const bool sent = sent_.has(asSent(header, scan));
    const std::lock_guard<std::mutex> lock(mutex_);
    ++scans_;
    clock_jumps_ = jumps;
    if (!held) passed_ = scans_;
    if (!held && !expected_serial_.empty() && serial_ != expected_serial_) ++wrong_.boards;
    if (!sent) ++wrong_.scans;
    if (!pressureIsTheTables(scan)) ++wrong_.pressures;
    if (time.stamp <= stamp_) ++wrong_.stamps;
    stamp_ = time.stamp;
    changed_.notify_all();
  }
  void onTransducer(const fsr::protocol::PacketHeader& header, std::int32_t) override {
    stamper_.transducer(header);
  }
  void onTemperature(const fsr::protocol::PacketHeader& header, std::int32_t) override {
    stamper_.temperature(header);
  }
  void onIdentity(const fsr::protocol::PacketHeader&,
                  const fsr::protocol::IdentityPacket& identity) override {
    const bool same = gate_.identity(identity.serial, arrival_) == fsr::protocol::BoardGate::Board::kSame;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (same) passed_ = scans_;
    serial_ = identity.serial;
    changed_.notify_all();
  }
  void onOpen(std::uint32_t baud) override {
    stamper_.startLine(baud);
    gate_.doubt();
  }
  void onBytes(std::int64_t receive_time) override {
    arrival_ = receive_time;
    stamper_.setArrival(receive_time);
  }
  void onChange(const fsr::protocol::LinkReport& report) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    phase_ = report.phase;
    changed_.notify_all();
  }

  template <typename Condition>
  bool await(Condition condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, kFaultPatience, condition);
  }
  /// Waits for this many further scans.
  bool hears(std::uint64_t more) {
    const std::uint64_t target = scans() + more;
    return await([&] { return scans_ >= target; });
  }
  bool reaches(fsr::protocol::LinkPhase phase) {
    return await([&] { return phase_ == phase; });
  }
  bool knows(const std::string& serial) {
    return await([&] { return serial_ == serial; });
  }
  /// Sets the board that is really on the port from now on.
  void expectBoard(const std::string& serial) {
    const std::lock_guard<std::mutex> lock(mutex_);
    expected_serial_ = serial;
  }
  std::uint64_t scans() const { return locked(scans_); }
  /// Scans that a driver would have published so far, including those that it held first.
  std::uint64_t passed() const { return locked(passed_); }
  std::uint64_t passedLocked() const { return passed_; }  ///< only inside await()
  std::uint64_t clockJumps() const { return locked(clock_jumps_); }
  Wrong wrong() const { return locked(wrong_); }

 private:
  template <typename T>
  T locked(const T& value) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return value;
  }
  static std::vector<std::uint8_t> asSent(const fsr::protocol::PacketHeader& header,
                                          const fsr::protocol::ScanPacket& scan) {
    std::vector<std::uint8_t> packet(FSR_WIRE_MAX_PACKET);
    const fsr_wire_scan content = {static_cast<std::uint8_t>(scan.size.rows),
                                   static_cast<std::uint8_t>(scan.size.columns), scan.full_scale,
                                   scan.duration, scan.counts};
    packet.resize(
        fsr_wire_encode_scan(packet.data(), packet.size(), header.sequence, header.device_time, &content));
    return packet;
  }
  bool pressureIsTheTables(const fsr::protocol::ScanPacket& scan) const {
    for (std::size_t i = 0; i < scan.size.taxels(); ++i) {
      const float pressure = map_.pressure[i];
      if (std::isnan(pressure)) {
        if (map_.flags[i] == 0) return false;
      } else if (pressure != knownPressure(i, 0, scan.counts[i])) {
        return false;
      }
    }
    return true;
  }

  const SentPackets& sent_;
  // Used by the link's thread:
  fsr::protocol::PacketStamper stamper_;
  fsr::protocol::BoardGate gate_;
  fsr::calibration::Calibrator calibrator_;
  fsr::map::PressureMap map_;
  std::int64_t arrival_ = 0, stamp_ = 0;  // [ns]
  std::uint64_t jumps_ = 0;

  mutable std::mutex mutex_;  // guards all members below
  std::condition_variable changed_;
  std::uint64_t scans_ = 0, passed_ = 0, clock_jumps_ = 0;
  Wrong wrong_;
  std::string serial_, expected_serial_;
  fsr::protocol::LinkPhase phase_ = fsr::protocol::LinkPhase::kWaiting;
};

}  // namespace test_support
