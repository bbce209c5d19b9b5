#include "discrepancy/fit/taxel_curves_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "statistics/random_stream.h"

namespace fsr::discrepancy {
namespace {

constexpr int kKnots = 20;

struct Design {
  std::vector<double> knots;
  Eigen::MatrixXd bends;
};

Design design() {
  Design design;
  for (int k = 0; k < kKnots; ++k) design.knots.push_back(k / (kKnots - 1.0));
  const std::vector<double> bends = simulation::splineBends(design.knots);
  design.bends = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      bends.data(), kKnots, kKnots);
  return design;
}

template <typename Curve>
PenalisedSpline fitted(const Design& design, Curve curve, double noise, std::uint64_t seed = 1) {
  const statistics::RandomStream random = statistics::randomStream(seed, "spline");
  SplineSums sums(kKnots);
  for (int i = 0; i < 400; ++i) {
    const double x = i / 399.0;
    sums.add(simulation::splineWeights(design.knots, x), 1,
             curve(x) + noise * random.normal(static_cast<std::uint64_t>(i)));
  }
  return {sums.normal(design.bends), sums.right(design.bends), sums.square(), sums.number()};
}

double rmsFrom(const Design& design, const Eigen::VectorXd& values, double (*curve)(double)) {
  double squares = 0;
  for (int k = 0; k < kKnots; ++k)
    squares += std::pow(values[k] - curve(design.knots[static_cast<std::size_t>(k)]), 2);
  return std::sqrt(squares / kKnots);
}

double line(double x) {
  return 2 + 3 * x;
}
double wave(double x) {
  return std::sin(6 * x);
}

TEST(PenalisedSpline, LeavesALineAloneWhateverTheWeight) {
  const Design with = design();
  const PenalisedSpline spline = fitted(with, line, 0);
  for (const double weight : {PenalisedSpline::kLeastWeight, 1.0, PenalisedSpline::kMostWeight})
    EXPECT_LT(rmsFrom(with, spline.values(weight), line), 1e-6) << weight;
}

TEST(PenalisedSpline, IsSmootherWhereTheNoiseIsLarger) {
  const Design with = design();
  const double fine = chooseWeight({fitted(with, wave, 0.001)}),
               rough = chooseWeight({fitted(with, wave, 1)});
  EXPECT_GT(rough, 10 * fine);
  EXPECT_GT(chooseWeight({fitted(with, line, 0.1)}), 1) << "a line needs no bend";
}

// An unpenalised spline of 20 values leaves 0.3 sqrt(20 / 400) = 0.067 of white noise of 0.3.
TEST(PenalisedSpline, ChoosesAWeightThatIsBetterThanNone) {
  const Design with = design();
  double chosen = 0, none = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const PenalisedSpline spline = fitted(with, wave, 0.3, seed);
    chosen += rmsFrom(with, spline.values(chooseWeight({spline})), wave) / 20;
    none += rmsFrom(with, spline.values(PenalisedSpline::kLeastWeight), wave) / 20;
  }
  EXPECT_LT(chosen, 0.7 * none);
  EXPECT_LT(chosen, 0.06);
}

TEST(PenalisedSpline, OfNoDataDoesNotSpoilTheWeightOfOthers) {
  const Design with = design();
  const SplineSums empty(kKnots);
  const PenalisedSpline nothing(empty.normal(with.bends), empty.right(with.bends), 0, 0);
  const PenalisedSpline data = fitted(with, wave, 0.3);
  EXPECT_EQ(chooseWeight({data, nothing}), chooseWeight({data}));
  EXPECT_EQ(nothing.values(1).norm(), 0);
}

// Falls from 0.32 to 0.73. Among curves that never fall the best is level there.
double dented(double x) {
  return x + 0.5 * std::sin(6 * x);
}

TEST(PenalisedSpline, RisesWhereItMust) {
  const Design with = design();
  const PenalisedSpline spline = fitted(with, dented, 0.02);
  Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(kKnots - 1, kKnots);
  for (int k = 0; k + 1 < kKnots; ++k) {
    steps(k, k) = -1;
    steps(k, k + 1) = 1;
  }
  const Eigen::VectorXd least = Eigen::VectorXd::Zero(kKnots - 1);
  const double weight = chooseWeight({spline});
  EXPECT_LT((steps * spline.values(weight)).minCoeff(), -0.05);
  const Eigen::VectorXd rising = spline.valuesRising(weight, steps, least);
  EXPECT_GT((steps * rising).minCoeff(), -1e-4);
  EXPECT_NEAR(rising[1], dented(with.knots[1]), 0.05) << "it rises there anyway";
  EXPECT_NEAR(rising[kKnots - 1], dented(1), 0.05) << "likewise";
  EXPECT_NEAR(rising[10], rising[8], 1e-3) << "level";
  const Eigen::VectorXd free = fitted(with, line, 0.05).valuesRising(1, steps, least);
  EXPECT_LT((free - fitted(with, line, 0.05).values(1)).norm(), 1e-12) << "no slope is forbidden";
}

}  // namespace
}  // namespace fsr::discrepancy
