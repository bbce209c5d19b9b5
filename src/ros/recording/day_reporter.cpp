#include "ros/recording/day_reporter.h"

#include <ros/console.h>

#include <csignal>
#include <filesystem>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/programs/sibling_program.h"
#include "session/session_files.h"

namespace fsr_ros {

namespace fs = std::filesystem;

DayReporter::DayReporter(std::string folder, const std::string& plan)
    : folder_(fs::absolute(folder).lexically_normal().string()) {
  const fs::path results = fsr::session::sessionFile(plan, fsr::session::kResultsFolder, folder_);
  report_ = fsr::session::sessionFile(plan, fsr::session::kReportFile, folder_);
  output_ = (results / "day_report.txt").string();
  log_ = (results / "day_report.log").string();
}

DayReporter::~DayReporter() {
  stop();
}

void DayReporter::follow(bool over) {
  if (!over) {
    stop();
    settled_ = false;
    wanted_ = true;
    sentence_.clear();
    return;
  }
  if (writer_ && !writer_->running()) finish();
  if (writer_ || settled_) return;
  if (!wanted_ && fs::exists(report_)) {
    settled_ = true;
    say("The report of the day is " + report_);
  } else {
    start();
  }
}

void DayReporter::start() {
  try {
    fs::create_directories(fs::path(log_).parent_path());
    fs::remove(report_);  // it is of an earlier end, and must not stay if this run is interrupted
    writer_ = std::make_unique<boost::process::child>(
        startProgram(siblingProgram("day_report"), {folder_}, {folder_, output_, log_}));
    say("The report of the day is being written.");
  } catch (const std::exception& error) {
    settled_ = true;
    say(std::string("The report of the day could not be written: ") + error.what(), true);
  }
}

void DayReporter::finish() {
  // Status 1 means that a tool gave no result. The report is there and says so.
  constexpr int kNoReport = 2;
  const std::string reason = whyItFailed(*writer_, log_);
  const bool written =
      reason.empty() || (WIFEXITED(writer_->native_exit_code()) && writer_->exit_code() < kNoReport);
  writer_.reset();
  wanted_ = false;
  settled_ = true;
  if (written)
    say("The report of the day is " + report_);
  else
    say("The report of the day could not be written: " + reason + "; begin again with: day_report " + folder_,
        true);
}

// The tools that day_report runs end with it.
void DayReporter::stop() {
  if (!writer_) return;
  if (writer_->running()) {
    ::kill(writer_->id(), SIGTERM);
    writer_->wait();
  }
  writer_.reset();
}

void DayReporter::say(const std::string& sentence, bool failed) {
  sentence_ = sentence;
  if (failed)
    ROS_ERROR_STREAM(sentence);
  else
    ROS_INFO_STREAM(sentence);
}

}  // namespace fsr_ros
