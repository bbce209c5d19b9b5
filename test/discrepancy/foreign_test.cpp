// Readings whose phase is not that of their load, gains of single presses, a decay after each motion, and a
// reference that is too slow. The right answers were written down before the search was asked.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dataset/recording_builder.h"
#include "discrepancy/answer.h"
#include "discrepancy/decide/constancy.h"

namespace fsr::discrepancy {
namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;
constexpr double kMean = 310e3;  // [Pa]

const std::string kTwoPaces =
    planted::withProgram(R"(  - cycles: {peak: 620000, rate: 40000, dwell_peak: 4, cycles: 4}
  - cycles: {peak: 620000, rate: 12000, dwell_peak: 4, cycles: 3}
)");

// Whether sizes that an effect is wanted in are one size. They are those of ten cycles at paces from 5 to
// 80 kPa/s, given the pace and the time from 0 to 1, and of each second cycle a little more.
template <typename Size>
bool isOneSize(Size size, double more = 0.02) {
  Measured measured;
  Trace part(40), wanted(40);
  for (std::size_t c = 0; c < 10; ++c) {
    const double pace = 5e3 * std::pow(2, static_cast<double>(c % 5)), time = static_cast<double>(c) / 9;
    measured.cycles.push_back({0, 4 * c, 4 * c + 4});
    measured.rate.insert(measured.rate.end(), {pace, -pace, pace, -pace});
    measured.time.insert(measured.time.end(), 4, 1000 * time);
    const auto first = static_cast<Eigen::Index>(4 * c);
    part.segment(first, 4) << 1, -1, 1, -1;
    wanted.segment(first, 4) = part.segment(first, 4) * size(pace, time) * (c % 2 ? 1 + more : 1);
  }
  return isConstant(measured, part, wanted);
}

TEST(Constancy, TellsADelayFromFriction) {
  const auto with = [](double exponent, double more = 0.02) {
    return isOneSize([&](double pace, double) { return std::pow(pace, -exponent); }, more);
  };
  EXPECT_TRUE(with(0));
  EXPECT_TRUE(with(0.3));
  EXPECT_FALSE(with(1));
  EXPECT_FALSE(with(-1));
  EXPECT_TRUE(with(0, 0.0)) << "of one size, exactly";
  EXPECT_TRUE(with(1, 50.0)) << "not certain";
}

TEST(Constancy, TellsADelayFromALagThatTurnsRound) {
  const auto falling = [](double by) {
    return isOneSize([&](double, double time) { return 1 - by * time; });
  };
  EXPECT_TRUE(falling(0.6));
  EXPECT_FALSE(falling(2));
}

// A rig whose chamber is run in sines of these periods [s], one after the other. It feels `felt` of the time
// and the period.
template <typename Felt>
DiscrepancyReport sines(const std::vector<double>& periods, Felt felt) {
  DiscrepancyProblem problem = planted::problem(planted::kOneSpeed, "");
  std::vector<dataset::Recording> feels = problem.recordings;
  for (std::size_t r = 0; r < feels.size(); ++r) {
    dataset::Recording& recording = problem.recordings[r];
    const double part = recording.time.back() / static_cast<double>(periods.size());
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      const double time = recording.time[i];
      const double period = periods[std::min(periods.size() - 1, static_cast<std::size_t>(time / part))];
      recording.pressure[i] = kMean * (1 - std::cos(kTurn * time / period));
      feels[r].pressure[i] = felt(time, period);
    }
  }
  planted::readOut(feels, problem);
  return answerTo(problem);
}

// Friction of 15 kPa, and a damper that acts against it and grows with the rate.
TEST(Foreign, DamperAtTwoPacesIsNoDelay) {
  for (const auto& damper : {std::pair{15e3, 0.0}, std::pair{-15e3, 0.3}}) {
    const DiscrepancyReport report =
        answerTo(planted::problemFeeling(kTwoPaces, [&](double, int, double rate) {
          return std::copysign(std::pow(std::abs(rate) / 40e3, damper.second), rate) * damper.first;
        }));
    EXPECT_FALSE(inSet(report, "time_skew")) << report.sentence;
    EXPECT_EQ(report.verdict, Verdict::kUnknown) << report.sentence;
  }
}

TEST(Foreign, ClockThatIsAheadIsADelayBelowZero) {
  const DiscrepancyReport report = sines({20, 60}, [](double time, double period) {
    return kMean * (1 - std::cos(kTurn * (time + 0.4) / period));
  });
  ASSERT_EQ(report.verdict, Verdict::kNamed) << report.sentence;
  EXPECT_EQ(report.effects.at(0).id, "time_skew");
  EXPECT_NEAR(report.effects.at(0).parameters.at(0).value, -0.4, 0.02);
  EXPECT_TRUE(std::any_of(report.limitations.begin(), report.limitations.end(),
                          [](const std::string& said) { return said.find("ahead") != std::string::npos; }));
}

// The gains of the presses have a standard deviation of 8 %.
TEST(Foreign, ScatterOfTheGainBeyondThatOfAnyPartIsUnknown) {
  const double gains[] = {1.1, 0.93, 1.05, 0.88, 1.02, 0.97, 1.12, 0.9, 1.0, 0.95, 1.07};
  const DiscrepancyReport report =
      answerTo(planted::problemReading(kTwoPaces, [&](const planted::Changed& now) {
        return now.count * gains[(static_cast<std::size_t>(now.loads) + 3 * now.recording) % 11];
      }));
  EXPECT_EQ(report.verdict, Verdict::kUnknown) << report.sentence;
  EXPECT_EQ(report.depends_on, std::vector<std::string>{"cycle"});
}

// In each cycle the contact jumps at another pressure, by 3 % of full scale.
TEST(Foreign, WanderWithinTheCyclesIsUnknown) {
  const double jumps[] = {0.35, 0.62, 0.48, 0.29, 0.7, 0.41, 0.55, 0.33, 0.66, 0.5, 0.38};
  const DiscrepancyReport report =
      answerTo(planted::problemReading(kTwoPaces, [&](const planted::Changed& now) {
        const double cycle = std::floor(now.loads), share = 1 - std::abs(1 - 2 * (now.loads - cycle));
        const double jump = jumps[(static_cast<std::size_t>(cycle) + 3 * now.recording) % 11];
        return now.count + 123 / (1 + std::exp((jump - share) / 0.03));
      }));
  EXPECT_EQ(report.verdict, Verdict::kUnknown) << report.sentence;
}

// Each change of the load adds to the reading, up or down alike, and what it added fades over 20 s.
TEST(Foreign, DecayAfterEachMotionHasNoName) {
  double fading = 0, before = 0;
  const DiscrepancyReport report =
      answerTo(planted::problemFeeling(kTwoPaces, [&](double share, int, double) {
        fading = 0.98 * fading + std::abs(share - before);
        before = share;
        return -31e3 * fading;
      }));
  EXPECT_EQ(report.verdict, Verdict::kUnknown) << report.sentence;
}

// The recording as its bag gives it where the reference is read at every third scan.
dataset::Recording withSlowReference(const dataset::Recording& recording) {
  constexpr double kAmbient = 101325;  // [Pa]
  dataset::RecordingBuilder builder;
  builder.addSurface(recording.start_ns, recording.conditions.at(0));
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    const std::int64_t stamp = recording.start_ns + std::llround(1e9 * recording.time[i]);
    const matrix::MatrixSize size = recording.layout.size;
    builder.addScan(stamp, static_cast<std::uint32_t>(i),
                    {size, recording.full_scale, recording.scan(i), size.taxels()});
    if (i % 3 == 0) builder.addChamberPressure(stamp, recording.pressure[i] + kAmbient);
  }
  dataset::RecordingOptions options;
  options.name = recording.name;
  options.ambient_pressure = kAmbient;
  return builder.take(options);
}

// The chamber is filled and vented exponentially within 1.5 s each, and the reference is read each 0.15 s:
// where it turns, nobody knows the pressure.
TEST(Foreign, SlowReferenceIsNoEffect) {
  std::string rig = planted::rig("chamber: {cycles: 1}\n", planted::kFlat);
  const std::string rates = "{scan_rate: 2.5, transducer_rate: 2.5}";
  rig.replace(rig.find(rates), rates.size(), "{scan_rate: 20, transducer_rate: 20}");
  DiscrepancyProblem problem = planted::problem(rig, "");
  dataset::Recording& recording = problem.recordings.front();
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    const double turns = recording.time[i] / 3.01, phase = 2 * (turns - std::floor(turns));
    const double filled = std::expm1(-5 * std::fmod(phase, 1)) / std::expm1(-5.0);
    const double peak = 620e3 - 20e3 * std::fmod(3 * std::floor(turns), 10);
    recording.pressure[i] = peak * (phase < 1 ? filled : 1 - filled);
  }
  planted::readOut({recording}, problem);
  recording = withSlowReference(recording);
  EXPECT_EQ(answerTo(problem).verdict, Verdict::kNone);
  recording.reference_error = recording.reference_interval = 0;
  EXPECT_NE(answerTo(problem).verdict, Verdict::kNone) << "this test cannot fail";
}

// In a chamber of 45 kPa a loop has the same shape as in one of 620 kPa.
TEST(Foreign, EffectsScaleWithTheRangeOfTheChamber) {
  const std::string low =
      planted::withProgram(R"(  - cycles: {peak: 45000, rate: 2900, dwell_peak: 8, cycles: 5}
  - cycles: {peak: 45000, rate: 580, dwell_peak: 8, cycles: 3}
)");
  const DiscrepancyReport loop =
      answerTo(planted::problem(low, "  hysteresis: {loop_width: 0.06, span: 45000, reach: 6000}\n"));
  ASSERT_EQ(loop.verdict, Verdict::kNamed) << loop.sentence;
  EXPECT_EQ(loop.effects.at(0).id, "hysteresis");
}

}  // namespace
}  // namespace fsr::discrepancy
