#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "fsr_pressure_map/protocol/decoder.h"
#include "protocol/capture.h"
#include "protocol/serial_port.h"

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
  void onTrigger(const PacketHeader& header, const TriggerPacket& trigger) override;

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

enum class LinkPhase {
  kDisabled,  ///< by setEnabled(false): the port is closed
  kWaiting,   ///< the port does not open or the link broke; tried again after the reconnect delay
  kReading,
  kNoTime,  ///< bytes come, but the host's clock has not started (simulated time without /clock)
  kEnded,   ///< a replay is over
};

/// The state of a link.
struct LinkReport {
  LinkPhase phase = LinkPhase::kWaiting;
  std::string reason;                ///< why it waits, or how the replay's file is damaged; else empty
  std::uint64_t connections = 0;     ///< how often the port was opened
  double silence = 0;                ///< since the last byte, or since the port was opened [s]
  DecoderCounts counts;              ///< since the link was made
  std::uint64_t captured_bytes = 0;  ///< in the capture file
  std::string capture_complaint;     ///< why capturing stopped; empty = it continues or was not asked for
  std::uint64_t handler_faults = 0;  ///< calls of the handler that threw; each costs the packet at hand
  std::string handler_complaint;     ///< what the last of them threw; empty = none threw
};

/// Receives what comes over a link. All calls come from the link's own thread. An exception is counted and
/// reported as a fault of the handler, and the link continues.
class LinkHandler : public PacketHandler {
 public:
  /// A port was opened whose line runs at `baud` [1/s] (0 = none).
  virtual void onOpen(std::uint32_t baud) = 0;
  /// Bytes arrived at `receive_time` [host, ns]; the packets that they complete follow.
  virtual void onBytes(std::int64_t receive_time) = 0;
  /// The phase or its reason changed, or the handler threw for the first time.
  virtual void onChange(const LinkReport& report) = 0;
};

/// Reads a board on a thread of its own for as long as it lives: opens the port and decodes. Where the port
/// is missing or the link breaks, it tries again.
class BoardReader {
 public:
  /// Opens the source of bytes, or throws LinkError.
  using Open = std::function<std::unique_ptr<ByteSource>()>;

  struct Options {
    std::chrono::milliseconds reconnect_delay{1000};
    std::string capture_file;                              ///< where raw bytes are kept; empty = nowhere
    DecoderMaker make_decoder = protocols().front().make;  ///< of the protocol that the board speaks
    DecoderOptions decoder{};                              ///< for a protocol that needs them
  };

  /// `handler` must outlive the link. Throws InputError where the capture file cannot be made, or the decoder
  /// needs an option that is not set.
  BoardReader(Open open, LinkHandler& handler, const Options& options);
  ~BoardReader();
  BoardReader(const BoardReader&) = delete;
  BoardReader& operator=(const BoardReader&) = delete;

  /// false closes the port, e.g. for a firmware update; true opens it again.
  void setEnabled(bool enabled);

  LinkReport report() const;

 private:
  void run();
  void connect();
  void readAll(ByteSource& source);
  void take(const std::uint8_t* bytes, const Chunk& chunk);
  void decode(const std::uint8_t* bytes, const Chunk& chunk);
  void finishStream();
  void keeping(const std::function<void()>& write);
  void change(LinkPhase phase, const std::string& reason);
  void tellChange();
  void reportFaults();
  bool wanted() const;
  void pause(std::optional<std::chrono::milliseconds> longest);

  Open open_;
  LinkHandler& handler_;
  Options options_;
  HandlerGuard guard_;
  std::uint64_t reported_faults_ = 0;
  std::unique_ptr<Decoder> decoder_;
  std::unique_ptr<CaptureWriter> capture_;
  std::vector<std::uint8_t> buffer_;

  mutable std::mutex mutex_;  // guards everything below
  std::condition_variable changed_;
  bool stopping_ = false;
  bool enabled_ = true;
  bool toggled_ = false;  // enabled_ was set since the last pause
  LinkReport report_;
  std::chrono::steady_clock::time_point last_byte_;

  std::thread thread_;  // last: it uses everything above
};

/// Tells whether a scan is from the board that last sent its identity. Another board may be plugged into the
/// same port. Until it sends its identity, up to a second later, its scans look like those of the first
/// board, and the calibration would convert them to wrong pressures. So scans are held while the board is in
/// doubt.
///
/// Scans of a board that never sent an identity are never held.
class BoardGate {
 public:
  enum class Verdict {
    kPass,  ///< the scan is from the known board
    kHold,  ///< keep the scan until the board is known
  };
  enum class Board {
    kSame,     ///< the scans held are its own
    kAnother,  ///< the scans held are from a board that was unknown until now
  };

  /// `patience`: how long to wait for the identity of a board that sent one before [ns]. `settling`: how long
  /// scans of another board are still held, so that its identity reaches other nodes before them [ns].
  explicit BoardGate(std::int64_t patience = 3'000'000'000, std::int64_t settling = 200'000'000)
      : patience_(patience), settling_(settling) {}

  /// Call it when the port was opened or the board's clock restarted.
  void doubt();

  /// A scan arrived at `time` [host, ns].
  Verdict scan(std::int64_t time);

  /// The identity of a board arrived at `time` [host, ns].
  Board identity(std::string_view serial, std::int64_t time);

  /// True once after the patience ended without an identity: the board is unknown, and its scans pass.
  bool gaveUp();

 private:
  std::int64_t patience_;
  std::int64_t settling_;
  std::string serial_;
  bool known_ = false;  // serial_ was received
  bool doubted_ = false;
  bool waiting_ = false;  // since_ holds
  bool gave_up_ = false;
  std::int64_t since_ = 0;  // arrival of the first scan in doubt [ns]
  std::int64_t until_ = 0;  // scans are held until then [ns]; 0 = not
};

}  // namespace fsr::protocol
