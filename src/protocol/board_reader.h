#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "fsr_pressure_map/protocol/decoder.h"
#include "protocol/byte_source.h"
#include "protocol/capture.h"
#include "protocol/handler_guard.h"

namespace fsr::protocol {

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

}  // namespace fsr::protocol
