#include "settings/progress.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <utility>

#include "settings/number_text.h"
#include "settings/text.h"

namespace fsr::settings {

namespace {

constexpr double kSilence = 2;         // at the beginning [s]
constexpr double kPeriod = 0.25;       // between two lines on a terminal [s]
constexpr double kPeriodOfFile = 60;   // likewise in a file [s]
constexpr double kLeastShare = 0.005;  // with less, the time left is a guess
constexpr double kLeastSeconds = 0.5;  // likewise [s]

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

std::string durationText(double seconds) {
  if (seconds < 90) return fixedText(std::ceil(seconds), 0) + " s";
  if (seconds < 5400) return fixedText(std::ceil(seconds / 60), 0) + " min";
  return fixedText(seconds / 3600, 1) + " h";
}

Progress::Progress(std::ostream& out, bool terminal, Clock clock)
    : out_(out),
      terminal_(terminal),
      clock_(std::move(clock)),
      shown_(clock_() + (terminal ? kSilence - kPeriod : 0)) {}

Progress::Progress() : Progress(std::cerr, ::isatty(STDERR_FILENO) != 0, steadySeconds) {}

Progress::~Progress() {
  clear();
}

void Progress::report(const std::string& step, double share) {
  const double now = clock_();
  if (share < last_share_) {
    began_ = now;
    first_share_ = share;
  }
  last_share_ = share;
  if (now - shown_ < (terminal_ ? kPeriod : kPeriodOfFile)) return;
  shown_ = now;
  const double done = share - first_share_, took = now - began_;
  std::string line =
      printable(step) + ": " + fixedText(std::floor(100 * std::clamp(share, 0.0, 1.0)), 0) + " %";
  if (done >= kLeastShare && took >= kLeastSeconds && share < 1)
    line += ", " + durationText(took / done * (1 - share)) + " left";
  if (terminal_) {
    out_ << "\r\033[K" << line << std::flush;  // the code clears the rest of the line
    open_ = true;
  } else {
    out_ << line << std::endl;
  }
}

void Progress::clear() {
  if (std::exchange(open_, false)) out_ << "\r\033[K" << std::flush;
}

}  // namespace fsr::settings
