#include "report/calibration_check_report.h"

#include <gtest/gtest.h>

namespace {

using fsr::calibration::CalibrationCheck;
using fsr::calibration::CheckedClass;
using fsr::report::checkText;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// A check of 1,000 readings with an error of 3 kPa, where 4 kPa are expected.
CalibrationCheck example() {
  CalibrationCheck check;
  check.still_good = true;
  check.whole.readings = 1000;
  check.whole.expected_rmse = 4000;
  check.whole.rmse = 3000;
  check.whole.bias = -250;
  check.whole.within_one_deviation = 0.71;
  check.whole.beyond_training = 0.002;
  return check;
}

TEST(CalibrationCheckReport, HasARowForAllReadings) {
  EXPECT_TRUE(
      contains(checkText(example()),
               "all             1000           4.0        3.0       -0.2          71.0         0.2\n"))
      << checkText(example());
}

TEST(CalibrationCheckReport, OfASurfaceWithoutReadingsHasDashes) {
  CalibrationCheck check = example();
  check.classes.emplace_back();
  check.classes.back().name = "flat";
  EXPECT_TRUE(
      contains(checkText(check),
               "flat               0             -          -          -             -           -\n"))
      << checkText(check);
  EXPECT_FALSE(contains(checkText(check), "nan"));
}

TEST(CalibrationCheckReport, SaysWhatTheBagsDoNotShow) {
  EXPECT_TRUE(contains(checkText(example()), "\nStill good.\n"));
  CalibrationCheck check = example();
  check.not_shown = {"the sheet's memory: 100.0 % of the readings were not settled"};
  EXPECT_TRUE(contains(checkText(check), "\nNot shown: the sheet's memory: 100.0 %"));
  EXPECT_TRUE(contains(checkText(check), "\nStill good as far as these bags show.\n"));
  EXPECT_FALSE(contains(checkText(check), "Still good.\n"));
}

}  // namespace
