#include "ros/recording/recording_watch.h"

#include <filesystem>

#include "settings/number_text.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;
using Level = diagnostic_msgs::DiagnosticStatus;

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

RecordingLook lookAtRecording(const std::string& bag) {
  const std::string closed = endsWith(bag, ".bag") ? bag : bag + ".bag";
  for (const std::string& file : {closed + ".active", closed}) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (error) continue;
    const fs::space_info space = fs::space(file, error);
    return {file, size, error ? 0 : space.available};
  }
  return {};
}

void RecordingWatch::noteGrowth(std::uint64_t size, double time) {
  if (!first_) first_ = Growth{size, time};
  if (!last_ || size != last_->size) last_ = Growth{size, time};
}

void RecordingWatch::judge(const RecordingLook& look, double time,
                           diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (look.file.empty()) {
    status.summary(Level::ERROR, "waiting for the recorder: there is no bag yet");
    return;
  }
  noteGrowth(look.size, time);
  const double still = time - last_->time;
  const std::string left = fsr::settings::megabytesText(look.space) + " are left on its disk";
  if (!endsWith(look.file, ".active")) {
    status.summary(Level::WARN, "the recording has ended: " + look.file + " is closed");
  } else if (look.space < least_space_) {
    status.summary(Level::ERROR, "RECORDING STOPPED: " + left + ", and recording stops below " +
                                     fsr::settings::megabytesText(least_space_) +
                                     "; make room, then start a new recording");
  } else if (still > patience_) {
    status.summary(Level::ERROR,
                   look.file + " has not grown for " + fsr::settings::fixedText(still, 0) + " s" +
                       ": does the board send scans (see the diagnostics of the driver)? " + left);
  } else {
    status.summary(Level::OK, "recording to " + look.file + ": " + fsr::settings::megabytesText(look.size) +
                                  ", " + left);
  }
  const double span = last_->time - first_->time;
  status.add("size [bytes]", look.size);
  status.add("space left [bytes]", look.space);
  status.add("bytes a second", span > 0 ? static_cast<double>(last_->size - first_->size) / span : 0.0);
}

}  // namespace fsr_ros
