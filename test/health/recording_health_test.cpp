#include "health/recording_health.h"

#include <gtest/gtest.h>

#include <cmath>

#include "health/recorded.h"

namespace fsr::health {
namespace {

void keep(dataset::Recording& recording, std::size_t taxel, std::uint16_t code) {
  for (std::size_t i = 0; i < recording.scans(); ++i) recording.counts[i * 20 + taxel] = code;
}

TEST(RecordingHealth, FindsNothingOnAHealthySheet) {
  const RecordingHealth health = recordingHealth(recorded());
  EXPECT_TRUE(health.dead.empty() && health.stuck.empty() && health.rows.empty() && health.columns.empty());
  EXPECT_EQ(health.saturated, 0);
  EXPECT_TRUE(std::isnan(health.saturated_from));
}

TEST(RecordingHealth, NamesDeadAndStuckTaxelsAndLines) {
  dataset::Recording recording = recorded();
  keep(recording, 7, 0);
  keep(recording, 13, 812);
  EXPECT_EQ(recordingHealth(recording).dead, std::vector<std::size_t>{7});
  EXPECT_EQ(recordingHealth(recording).stuck, std::vector<std::size_t>{13});
  dataset::Recording broken = recorded();
  for (std::size_t column = 0; column < 5; ++column) keep(broken, 5 + column, 0);
  EXPECT_EQ(recordingHealth(broken).rows, std::vector<std::size_t>{1});
  EXPECT_TRUE(recordingHealth(broken).columns.empty());
}

TEST(RecordingHealth, ReportsThePressureFromWhichReadingsAreClipped) {
  dataset::Recording recording = recorded();
  std::size_t clipped = 0;
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (recording.pressure[i] < 450e3) continue;
    recording.counts[i * 20 + 3] = recording.full_scale;
    ++clipped;
  }
  const RecordingHealth health = recordingHealth(recording);
  EXPECT_EQ(health.saturated_taxels, 1u);
  EXPECT_DOUBLE_EQ(health.saturated, double(clipped) / double(20 * recording.scans()));
  EXPECT_NEAR(health.saturated_from, 450e3, 15e3);
}

TEST(RecordingHealth, IgnoresMaskedTaxels) {
  dataset::Recording recording = recorded();
  keep(recording, 7, 0);
  keep(recording, 8, recording.full_scale);
  recording.mask.assign(20, 0);
  recording.mask[7] = recording.mask[8] = 1;
  const RecordingHealth health = recordingHealth(recording);
  EXPECT_TRUE(health.dead.empty());
  EXPECT_EQ(health.saturated, 0);
}

}  // namespace
}  // namespace fsr::health
