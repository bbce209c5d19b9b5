#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fsr::protocol {

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
