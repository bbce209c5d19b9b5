#include "blind/static_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "blind/small_case.h"

namespace blind {
namespace {

TEST(Isotonic, AgreesWithScikitLearn) {
  const std::vector<double> fit = isotonic({1, 3, 2, 4, 3.5, 3, 6, 5}, {1, 2, 1, 1, 3, 1, 1, 2});
  // scikit-learn 1.2.1: IsotonicRegression().fit_transform(range(8), [1, 3, 2, 4, 3.5, 3, 6, 5],
  //                                                        sample_weight=[1, 2, 1, 1, 3, 1, 1, 2])
  const std::vector<double> expected = {1, 8 / 3.0, 8 / 3.0, 3.5, 3.5, 3.5, 16 / 3.0, 16 / 3.0};
  ASSERT_EQ(fit.size(), expected.size());
  for (std::size_t i = 0; i < fit.size(); ++i) EXPECT_NEAR(fit[i], expected[i], 1e-12) << i;
}

class StaticFits : public testing::Test {
 protected:
  StaticFits()
      : made_(makeCase(smallCase("", ""))),
        fit_(made_.campaign),
        shared_(made_.campaign, StaticFit::kSharedBin) {}

  static double rms(const Trace& trace) {
    double squares = 0;
    for (const double value : trace) squares += value * value;
    return std::sqrt(squares / static_cast<double>(trace.size()));
  }
  // A taxel's reading plus `change(pressure, scan)`.
  template <typename Change>
  Trace changed(Change change) const {
    Trace reading = made_.base[0];
    for (std::size_t i = 0; i < reading.size(); ++i) reading[i] += change(made_.campaign.pressure[i], i);
    return reading;
  }

  BlindCase made_;
  StaticFit fit_;
  StaticFit shared_;
};

TEST_F(StaticFits, LeaveNothingOfASheetWithNothingHidden) {
  EXPECT_EQ(rms(fit_.residualOfCurves(made_.base[0], made_.base[0])), 0);
  EXPECT_LT(rms(shared_.residualOfSharedCurve(made_.base[0], made_.base[0], 0.045)), 2e-4);
}

TEST_F(StaticFits, LeaveNothingOfAnotherStaticCurve) {
  const Trace bent =
      changed([](double pressure, std::size_t) { return 0.1 * std::pow(pressure / kPeak, 3); });
  EXPECT_LT(rms(fit_.residualOfCurves(made_.base[0], bent)), 3e-4);
}

TEST_F(StaticFits, LeaveWhatIsNoMatterOfPressure) {
  const Trace beating =
      changed([](double, std::size_t scan) { return 0.01 * std::sin(0.7 * static_cast<double>(scan)); });
  EXPECT_NEAR(rms(fit_.residualOfCurves(made_.base[0], beating)), 0.01 / std::sqrt(2), 0.02 * 0.01);
}

TEST_F(StaticFits, OfASharedCurveLeaveWhatOneSurfaceHasForItself) {
  const Trace snap = changed([&](double pressure, std::size_t scan) {
    return made_.campaign.curvature(scan) > 0 && pressure > 300e3 ? 0.05 : 0.0;
  });
  EXPECT_LT(rms(fit_.residualOfCurves(made_.base[0], snap)), 2e-3);  // from the bin that contains the jump
  EXPECT_GT(rms(shared_.residualOfSharedCurve(made_.base[0], snap, 0.045)), 4e-3);
}

}  // namespace
}  // namespace blind
