#pragma once

#include <boost/process/child.hpp>
#include <memory>
#include <string>

namespace fsr_ros {

/// Has the report of the day written once a session is over: runs the tool day_report in a process of its
/// own.
class DayReporter {
 public:
  /// `folder`: of the session; `plan`: its name.
  DayReporter(std::string folder, const std::string& plan);
  ~DayReporter();
  DayReporter(const DayReporter&) = delete;
  DayReporter& operator=(const DayReporter&) = delete;

  /// Call it a few times a second. `over`: all steps are done and the bags are closed. Where the session was
  /// over already at the first call, a report that is there stays. A step that is taken back ends the
  /// writing; the report is then written anew at the next end.
  void follow(bool over);

  /// "The report of the day is being written." or what became of it; empty while the session is not over.
  const std::string& sentence() const { return sentence_; }

 private:
  void start();
  void stop();
  void finish();
  void say(const std::string& sentence, bool failed = false);

  std::string folder_, report_, log_, output_, sentence_;
  std::unique_ptr<boost::process::child> writer_;
  bool wanted_ = false;   // even where there is a report
  bool settled_ = false;  // the report is there, or failed
};

}  // namespace fsr_ros
