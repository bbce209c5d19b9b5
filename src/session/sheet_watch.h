#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "session/step_watch.h"

namespace fsr::session {

/// What the taxels read without load, and how noisy it is. Memory does not grow with time.
class RestCounts {
 public:
  static constexpr unsigned kLeastScans = 20;

  void restart();
  /// A scan at rest.
  void take(const std::uint16_t* counts, std::size_t taxels);
  bool known() const { return scans_ >= kLeastScans; }
  /// How many taxels read more than noise does at rest. All of them while that is not known.
  std::size_t answering(const std::uint16_t* counts, std::size_t taxels) const;
  /// Sum over the taxels above their means at rest [counts]; NaN while that is not known.
  double excess(const std::uint16_t* counts, std::size_t taxels) const;
  /// Standard deviation of a single reading, median over the taxels [counts]. The board cuts off what is
  /// below 0, which hides up to 42 % of the deviation; it is given back. 0 while it is not known.
  double noise() const;

 private:
  unsigned scans_ = 0;
  std::vector<double> mean_, squares_;      // of each taxel
  std::vector<double> last_, differences_;  // of each taxel: last scan, sum of squared differences
};

/// What the sheet says in one scan.
struct SheetAnswer {
  double time = 0;         ///< [s]
  double excess = 0;       ///< sum over the taxels above what they read at rest [counts]; NaN = not known
  bool answers = false;    ///< at least half of the taxels read more than at rest
  bool saturated = false;  ///< half of the taxels are at full scale: the sheet cannot follow
};

/// Tells a chamber that is vented at once from a transducer whose plug was pulled: in both the pressure jumps
/// within one reading, but only in the first does the sheet follow. Memory does not grow with time.
class JumpWatch {
 public:
  /// Whether the pressure more than doubled or halved between two readings, and by more than the accuracy of
  /// rest and load.
  static bool isJump(const Reading& before, const Reading& after);

  void scan(const SheetAnswer& now);
  void begin(const Reading& before, const Reading& after);
  bool open() const { return open_; }
  void drop() { open_ = false; }
  /// Whether the sheet followed the jump that is open; none while that cannot be told. `time` [s]: where no
  /// scan comes for long, the jump counts as followed. `answered`: pressure that the sheet answered before
  /// [Pa].
  std::optional<bool> followed(double time, std::optional<double> answered);
  /// Behind a jump that was not followed: whether sheet and pressure agree again.
  bool agrees(double pressure) const;

  const Reading& before() const { return before_; }
  const Reading& after() const { return after_; }

 private:
  bool follows(const SheetAnswer& first, const SheetAnswer& last, std::optional<double> answered) const;

  std::deque<SheetAnswer> recent_;
  bool open_ = false;
  Reading before_, after_;
  double loaded_ = 0;  // excess at the jump [counts]
};

}  // namespace fsr::session
