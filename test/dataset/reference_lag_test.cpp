#include "dataset/reference_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_recording.h"

namespace fsr::dataset {
namespace {

constexpr double kTolerance = 0.03;  // of a lag on a sheet without hysteresis: a third of a scan [s]

Recording recorded(double loop = 0) {
  test_support::SyntheticRig rig;
  rig.loop = loop;
  return test_support::syntheticRecording(rig);
}

// Shifts the reference by `scans`, so that the matrix follows later than the reference.
Recording late(std::ptrdiff_t scans) {
  Recording recording = recorded();
  const std::vector<double> pressure = recording.pressure;
  const auto last = static_cast<std::ptrdiff_t>(pressure.size()) - 1;
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    const auto from = std::min(last, std::max<std::ptrdiff_t>(0, i + scans));
    recording.pressure[static_cast<std::size_t>(i)] = pressure[static_cast<std::size_t>(from)];
  }
  return recording;
}

TEST(ReferenceLag, IsZeroWhereStampsAreRight) {
  const auto lag = referenceLag(recorded());
  ASSERT_TRUE(lag);
  EXPECT_NEAR(lag->seconds, 0, kTolerance);
  EXPECT_GT(lag->correlation, 0.8);
}

TEST(ReferenceLag, IsFoundInBothDirections) {
  for (const int scans : {-30, -7, 4, 25}) {
    const auto lag = referenceLag(late(scans));
    ASSERT_TRUE(lag) << scans;
    EXPECT_NEAR(lag->seconds, 0.1 * scans, kTolerance) << scans;
  }
}

TEST(ReferenceLag, IsSmallForAHysteresisLoop) {
  const auto lag = referenceLag(recorded(200));  // 5 % of full scale
  ASSERT_TRUE(lag);
  EXPECT_NEAR(lag->seconds, 0, 0.3);
}

// A chamber that fills and vents exponentially, under sheets that read most of it at the start or at the end.
TEST(ReferenceLag, IsNoneOfACurvedCharacteristic) {
  for (const double exponent : {0.2, 4.0}) {
    std::vector<double> time, reading, pressure;
    double now = 0;
    for (int i = 0; i < 2000; ++i) {
      const bool fills = i % 200 < 100;
      now += 0.1 / 4 * ((fills ? 1 : 0) - now);
      time.push_back(0.1 * i);
      pressure.push_back(620e3 * now);
      reading.push_back(4000 * std::pow(now, exponent));
    }
    const auto lag = referenceLag(time, reading, pressure);
    ASSERT_TRUE(lag) << exponent;
    EXPECT_NEAR(lag->seconds, 0, kTolerance) << exponent;
  }
}

TEST(ReferenceLag, IsUnknownWithoutReferenceOrMotion) {
  Recording none = recorded();
  none.pressure.clear();
  EXPECT_FALSE(referenceLag(none));
  Recording still = recorded();
  std::fill(still.counts.begin(), still.counts.end(), 100);
  EXPECT_FALSE(referenceLag(still));
}

TEST(ReferenceLag, IgnoresMaskedTaxels) {
  Recording recording = recorded();
  recording.mask = {1, 1, 1, 1, 0, 0};
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    for (std::size_t t = 0; t < 4; ++t) recording.counts[i * 6 + t] = 4095;
  }
  const auto lag = referenceLag(recording);
  ASSERT_TRUE(lag);
  EXPECT_NEAR(lag->seconds, 0, kTolerance);
}

}  // namespace
}  // namespace fsr::dataset
