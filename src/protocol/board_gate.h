#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fsr::protocol {

/// Whether a scan is from the board that last named itself. A plug may be pulled and another board put on
/// the same port: until that one names itself, up to a second later, its scans look like the old one's,
/// and a calibration would make wrong pressure of them. So scans wait where a board is in doubt.
///
/// A board that never named itself is never waited for.
class BoardGate {
 public:
  enum class Verdict {
    kPass,  ///< of the board that is known
    kHold,  ///< keep it until the verdict on the board
  };
  enum class Board {
    kSame,     ///< what was held is its own
    kAnother,  ///< what was held is of a board unknown until now
  };

  /// `patience`: how long a board that named itself before may stay silent about it [ns]. `settling`: how
  /// long scans of another board still wait, so that the news of its name travels ahead of them [ns].
  explicit BoardGate(std::int64_t patience = 3'000'000'000, std::int64_t settling = 200'000'000)
      : patience_(patience), settling_(settling) {}

  /// The port was opened, or the board's clock started anew.
  void doubt();

  /// A scan came at `time` [host, ns].
  Verdict scan(std::int64_t time);

  /// The board named itself at `time` [host, ns].
  Board identity(std::string_view serial, std::int64_t time);

  /// True once, where the board had been waited for in vain: it is nobody known, and its scans pass.
  bool gaveUp();

 private:
  std::int64_t patience_;
  std::int64_t settling_;
  std::string serial_;
  bool known_ = false;  // serial_ was heard
  bool doubted_ = false;
  bool waiting_ = false;  // since_ holds
  bool gave_up_ = false;
  std::int64_t since_ = 0;  // arrival of the first scan in doubt [ns]
  std::int64_t until_ = 0;  // scans wait for the news to settle [ns]; 0 = no news
};

}  // namespace fsr::protocol
