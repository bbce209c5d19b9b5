// Where a session rests: at the level that its chamber holds, under noise and spikes of the reference.

#include "calibration/stages/session/session_rests.h"
#include "support/holds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace fsr::calibration {
namespace {

constexpr double kRate = 48.7;  // of the scans [Hz]

// A chamber pressure [Pa] over time [s], with normal noise and single samples of 17 kPa more.
dataset::Recording course(const std::function<double(double)>& pressure, double noise = 0,
                          std::size_t spike_every = 0) {
  dataset::Recording recording;
  recording.name = "a.bag";
  recording.layout.size = {1, 1};
  recording.full_scale = 255;
  recording.conditions.resize(1);
  std::mt19937 random(1);
  std::normal_distribution<double> scatter(0, 1);
  for (std::size_t i = 0; i < 3000; ++i) {
    const double time = double(i) / kRate;
    const bool spike = spike_every > 0 && i % spike_every == spike_every / 2;
    recording.time.push_back(time);
    recording.pressure.push_back(pressure(time) + noise * scatter(random) + (spike ? 17e3 : 0));
    recording.counts.push_back(100);
    recording.condition.push_back(0);
  }
  return recording;
}

// From `rest` after `wait`, up to 300 kPa and back.
std::function<double(double)> cycle(double rest, double wait) {
  return [=](double time) { return rest + std::max(0.0, 300e3 - 15e3 * std::abs(time - wait - 20)); };
}

TEST(SessionRests, FindsARestUnderNoiseAndSpikes) {
  const dataset::Recording recording = course(cycle(4.3e3, 6), 0.5e3, 31);
  const std::vector<std::size_t> rest = restAtStart(recording, 0);
  ASSERT_FALSE(rest.empty()) << whyNoRest(recording, 0);
  EXPECT_EQ(whyNoRest(recording, 0), "");
  EXPECT_NEAR(recording.time[rest.back()], 2.0, 0.1);
  for (const std::size_t scan : rest) EXPECT_LT(recording.pressure[scan], 12e3) << "a spike";
}

TEST(SessionRests, FindsARestAfterTheLoadUnderNoiseAndSpikes) {
  const dataset::Recording recording = course(cycle(4.3e3, 6), 0.5e3, 31);
  const std::vector<std::size_t> rest = restAfterLoad(recording, 0);
  ASSERT_FALSE(rest.empty());
  EXPECT_NEAR(recording.time[rest.front()], 46, 1);
}

TEST(SessionRests, TakesASlowRampForNoRest) {
  for (const double rate : {0.8e3, 2e3, 5e3}) {  // [Pa/s]
    const dataset::Recording recording = course([&](double time) { return rate * time; }, 0.05e3);
    EXPECT_TRUE(restAtStart(recording, 0).empty()) << rate;
    EXPECT_NE(whyNoRest(recording, 0).find("it does not start with 2 s at rest: the chamber moves between"),
              std::string::npos)
        << whyNoRest(recording, 0);
  }
}

TEST(SessionRests, SaysThatARecordingBeginsUnderLoad) {
  const dataset::Recording recording = course(cycle(31e3, 6), 0.5e3);
  EXPECT_TRUE(restAtStart(recording, 0).empty());
  EXPECT_NE(whyNoRest(recording, 0).find("kPa, which is a load"), std::string::npos)
      << whyNoRest(recording, 0);
}

TEST(SessionRests, SaysThatTheChamberLaterHoldsALowerLevel) {
  const dataset::Recording recording =
      course([](double time) { return time < 6 ? 8e3 : cycle(1e3, 6)(time); });
  EXPECT_TRUE(test_support::holds(whyNoRest(recording, 0), {"2 s", "8.0 kPa", "later is 1.0 kPa"}));
}

TEST(SessionRests, SaysThatARecordingIsShort) {
  dataset::Recording recording = course(cycle(0, 6));
  for (auto* values : {&recording.time, &recording.pressure}) values->resize(50);
  recording.counts.resize(50);
  recording.condition.resize(50);
  EXPECT_EQ(whyNoRest(recording, 0), "it does not start with 2 s at rest: it is shorter than 2 s");
}

}  // namespace
}  // namespace fsr::calibration
