#pragma once

#include <functional>
#include <ostream>
#include <string>

namespace fsr::settings {

/// Tells the user of a tool how far it is and how long it will still take. A terminal shows one line that
/// is overwritten, after two seconds and four times a second at most; it disappears at the end. A file gets a
/// line every minute.
class Progress {
 public:
  using Clock = std::function<double()>;  ///< [s]

  /// `terminal`: whether `out` is one.
  Progress(std::ostream& out, bool terminal, Clock clock);
  /// To stderr, by the computer's clock.
  Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Removes the line.
  ~Progress();

  /// `share` of the work that is done, 0 to 1; `step`: what is being done. The time left is that of all steps
  /// over which the share rises; where it falls, other work begins.
  void report(const std::string& step, double share);
  /// Removes the line, so that other output may follow.
  void clear();

 private:
  std::ostream& out_;
  const bool terminal_;
  const Clock clock_;
  double shown_;      // when the last line was written [s]
  double began_ = 0;  // the work [s]
  double first_share_ = 0, last_share_ = 2;
  bool open_ = false;  // a line stands on the terminal
};

/// "42 s", "3 min", "2.5 h".
std::string durationText(double seconds);

}  // namespace fsr::settings
