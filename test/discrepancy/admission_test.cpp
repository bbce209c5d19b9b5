#include "discrepancy/samples/admission.h"

#include <gtest/gtest.h>

#include "support/synthetic_recording.h"

namespace fsr::discrepancy {
namespace {

dataset::Recording recorded(const std::string& surface = "flat", double curvature = 0) {
  test_support::SyntheticRig rig;
  rig.name = surface + ".bag";
  rig.size = {4, 5};
  rig.surfaces = {{surface, curvature}};
  return test_support::syntheticRecording(rig);
}

bool tells(const std::vector<std::string>& sentences, const std::string& word) {
  for (const std::string& sentence : sentences) {
    if (sentence.find(word) != std::string::npos) return true;
  }
  return false;
}

TEST(Admission, FindsSoundRecordingsFitForBothUses) {
  dataset::Recording second = recorded("cylinder_7cm", 14.25);
  second.sha256 = "another";
  second.start_ns += 600'000'000'000;
  const Admission admission = inspectRecordings({recorded(), second});
  EXPECT_TRUE(admission.fit());
  EXPECT_EQ(admission.training, "");
  EXPECT_EQ(admission.discrepancy, "");
  EXPECT_EQ(admission.coverage.conditions.size(), 2u);
  EXPECT_EQ(admission.recordings.at(1).name, "cylinder_7cm.bag");
}

TEST(Admission, IsFitForTrainingThoughNotForDiscrepancyWhereCyclesAreFew) {
  test_support::SyntheticRig rig;
  rig.size = {4, 5};
  rig.cycles = 2;
  const Admission admission = inspectRecordings({test_support::syntheticRecording(rig)});
  EXPECT_TRUE(admission.fit());
  EXPECT_NE(admission.discrepancy.find("at least 3"), std::string::npos) << admission.discrepancy;
}

TEST(Admission, TakesClocksThatDifferForAProblem) {
  dataset::Recording recording = recorded();
  std::rotate(recording.pressure.begin(), recording.pressure.begin() + 20, recording.pressure.end());
  const Admission admission = inspectRecordings({recording});
  EXPECT_FALSE(admission.fit());
  EXPECT_TRUE(tells(admission.problems, "2.0")) << admission.problems.at(0);
}

TEST(Admission, RemarksOnAMatrixThatAnswersBeforeTheChamber) {
  const auto shifted = [](std::ptrdiff_t scans) {  // the reference is late by so many tenths of a second
    dataset::Recording recording = recorded();
    std::rotate(recording.pressure.begin(), recording.pressure.end() - scans, recording.pressure.end());
    return inspectRecordings({recording});
  };
  const Admission early = shifted(3);
  EXPECT_TRUE(early.fit());
  EXPECT_TRUE(tells(early.remarks, " s before chamber_pressure, which no sheet does"));
  EXPECT_NEAR(early.recordings.at(0).lag->seconds, -0.3, 0.03);
  EXPECT_FALSE(tells(shifted(0).remarks, "before chamber_pressure"));
  EXPECT_FALSE(tells(shifted(20).remarks, "before chamber_pressure")) << "it is a problem";
}

TEST(Admission, SaysNothingOfASheetThatIsLateByHysteresis) {
  dataset::Recording recording = recorded();
  std::rotate(recording.pressure.begin(), recording.pressure.begin() + 3, recording.pressure.end());
  EXPECT_FALSE(tells(inspectRecordings({recording}).remarks, "chamber_pressure"));
}

TEST(Admission, RemarksOnOneBadTaxelAndRefusesMany) {
  dataset::Recording recording = recorded();
  const auto kill = [&](std::size_t taxel) {
    for (std::size_t i = 0; i < recording.scans(); ++i) recording.counts[i * 20 + taxel] = 700;
  };
  kill(7);
  const Admission one = inspectRecordings({recording});
  EXPECT_TRUE(one.fit());
  EXPECT_TRUE(tells(one.remarks, "1 of 20 taxels"));
  kill(12);
  kill(14);
  const Admission three = inspectRecordings({recording});
  EXPECT_FALSE(three.fit());
  EXPECT_TRUE(tells(three.problems, "3 of 20 taxels"));
}

TEST(Admission, RemarksOnLostScansAndFullScale) {
  dataset::Recording recording = recorded();
  recording.losses.sequence_gaps = 2;
  recording.losses.lost_scans = 30;
  for (std::size_t i = 0; i < recording.counts.size(); i += 10) recording.counts[i] = 4095;
  const Admission admission = inspectRecordings({recording});
  EXPECT_TRUE(tells(admission.remarks, "scans are lost (2 gaps"));
  EXPECT_TRUE(tells(admission.remarks, "at full scale"));
}

}  // namespace
}  // namespace fsr::discrepancy
