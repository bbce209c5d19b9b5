#include "report/admission_report.h"

#include <gtest/gtest.h>

namespace fsr::report {
namespace {

check::SocketCheck example() {
  check::SocketCheck check;
  check.name = "socket.bag";
  check.layout.size = {2, 2};
  check.before = check::SocketRest{0.5, 9.5, {}};
  check.after = check::SocketRest{71, 79, {}};
  check.change = {0, 0.01, -0.03, 0};
  check.worst = 2;
  check.changed = 1;
  check.median_change = 0;
  check.saturated = 0.0025;
  check.longest = {35, 20, 3};
  return check;
}

std::string lastLine(const std::string& text) {
  return text.substr(text.rfind('\n', text.size() - 2) + 1);
}

TEST(SocketText, ReportsTheCheckOfARecordingWithoutReference) {
  EXPECT_EQ(
      socketText(example()),
      "socket.bag\n"
      "Rest before: 0.5 to 9.5 s\n"
      "Rest after: 71.0 to 79.0 s\n"
      "Change of the readings at rest: median 0.00 % of full scale, largest -3.00 % at (row, column) (1, 0); "
      "1 taxel beyond the limit\n"
      "At full scale: 0.25 % of the readings\n"
      "Outside the readings of training: not known; outside its curvatures: not known (give --calibration)\n"
      "Longest static load: 35 s, from second 20, at (row, column) (1, 1)\n"
      "Dead (row, column): none; stuck: none\n"
      "Readings are usable; no reference: accuracy not assessed.\n");
}

TEST(SocketText, EndsWithTheFirstReasonToLookAgain) {
  check::SocketCheck check = example();
  check.after.reset();
  check.change.clear();
  check.reasons = {"no rest was recorded after", "4 % of the readings are at full scale"};
  const std::string text = socketText(check);
  EXPECT_NE(text.find("Rest after: none recorded\n"), std::string::npos);
  EXPECT_EQ(
      lastLine(text),
      "Look again, because no rest was recorded after; and 1 more; no reference: accuracy not assessed.\n");
}

TEST(AdmissionText, EndsWithTheUseThatTheRecordingsAreFitFor) {
  discrepancy::Admission admission;
  EXPECT_EQ(lastLine(admissionText(admission)), "Fit for training and for discrepancy.\n");
  admission.discrepancy = "one cycle is not enough";
  EXPECT_EQ(lastLine(admissionText(admission)),
            "Fit for training; not for discrepancy, because one cycle is not enough.\n");
  admission.mounts = {"flat: mount 1 and mount 2 differ"};
  EXPECT_EQ(lastLine(admissionText(admission)),
            "Fit for training; not for discrepancy, because one cycle is not enough. First look at the mounts "
            "that differ.\n");
  EXPECT_NE(admissionText(admission).find("\nMounts differ: flat: mount 1 and mount 2 differ\n"),
            std::string::npos);
  admission.problems = {"no pressure", "no curvature"};
  EXPECT_EQ(lastLine(admissionText(admission)), "Not fit, because no pressure; and 1 more.\n");
}

}  // namespace
}  // namespace fsr::report
