// The noise of the common trace, and the static model that is fitted together with it.
#include "discrepancy/fit/cycle_noise.h"

#include <gtest/gtest.h>

#include "discrepancy/drawn_design.h"

namespace fsr::discrepancy {
namespace {

// White noise, a gain of each cycle of 1 % and a slow wandering of 3e-4 of full scale.
CycleNoise plantedNoise() {
  return drawn::wanderingNoise(1e-4, 9e-8);
}

double logLikelihood(const CycleDesign& design, const CycleNoise& noise) {
  double sum = 0;
  for (const CycleBins& bins : design.cycles) {
    const Eigen::LLT<Eigen::MatrixXd> root(noise.covariance(bins, design.cycle_time));
    Eigen::VectorXd left = bins.reading;
    for (Eigen::Index b = 0; b < bins.bins(); ++b)
      left[b] -= drawn::straight(bins.pressure[b] / drawn::kHighest);
    sum -= 0.5 * root.matrixL().solve(left).squaredNorm();
    sum -= root.matrixLLT().diagonal().array().log().sum();
  }
  return sum;
}

// The relative standard error of a variance from 40 cycles is sqrt(2 / 40) = 0.22, of its mean over 10 seeds
// 0.07. White noise has some hundreds of degrees of freedom; a part of it passes for fast wandering.
TEST(CycleNoise, RecoversVariancesThatWerePlanted) {
  constexpr int kSeeds = 10;
  std::array<double, CycleNoise::kParts> mean{};
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    CycleDesign design = drawn::design({40, 24});
    drawn::addNoise(design, plantedNoise(), seed);
    StaticModel model(design);
    const CycleNoise noise = fitNoise(design, model);
    for (std::size_t k = 0; k < CycleNoise::kParts; ++k) mean[k] += noise.variance[k] / kSeeds;
    EXPECT_GT(logLikelihood(design, noise), logLikelihood(design, plantedNoise()) - 5) << "seed " << seed;
  }
  EXPECT_NEAR(mean[CycleNoise::kCycleGain], 1e-4, 0.2e-4);
  EXPECT_NEAR(mean[CycleNoise::kSlow], 9e-8, 0.25 * 9e-8);
  EXPECT_NEAR(mean[CycleNoise::kWhite], 1, 0.3);
  EXPECT_LT(mean[CycleNoise::kFast], 0.25 * 9e-8) << "was not planted";
  EXPECT_LT(mean[CycleNoise::kCycleOffset], 0.25 * 9e-8) << "likewise; slow noise is nearly an offset";
  EXPECT_LT(mean[CycleNoise::kWanderingGain], 0.1 * 1e-4) << "likewise";
}

TEST(CycleNoise, FindsWhiteNoiseAloneWhereThereIsNoOther) {
  CycleDesign design = drawn::design({40, 24});
  drawn::addNoise(design, drawn::whiteNoise(), 3);
  StaticModel model(design);
  const CycleNoise noise = fitNoise(design, model);
  EXPECT_NEAR(noise.variance[CycleNoise::kWhite], 1, 0.15);
  EXPECT_LT(noise.variance[CycleNoise::kCycleGain], 1e-7);
  EXPECT_LT(noise.variance[CycleNoise::kSlow], 0.1 * drawn::kWhiteVariance);
}

// From a start that is near, the fit ends where it ends without it.
// Slow noise takes up a loop until the loop belongs to the model. Then white noise and the gain of each cycle
// come back, though the steps multiply the variances.
TEST(CycleNoise, ComesBackWhereAnExplanationTakesItsPlace) {
  const auto loop = [](const drawn::Place& at) { return at.direction * std::sin(3.14159265 * at.share); };
  CycleDesign design = drawn::design({30, 16, 1, 14, {loop}});
  drawn::addColumn(design, 0, 3e-3);
  drawn::addNoise(design, plantedNoise(), 1);
  StaticModel null(design);
  const CycleNoise without = fitNoise(design, null);
  EXPECT_LT(without.variance[CycleNoise::kWhite], 0.1);
  StaticModel model(design, {0}, {1e-5});
  model.stiffness = null.stiffness;
  const CycleNoise with = fitNoise(design, model, &without);
  EXPECT_NEAR(with.variance[CycleNoise::kWhite], 1, 0.25);
  EXPECT_NEAR(with.variance[CycleNoise::kCycleGain], 1e-4, 0.6e-4);
  EXPECT_NEAR(with.variance[CycleNoise::kSlow], 9e-8, 0.4 * 9e-8);
}

TEST(CycleNoise, EndsAtTheSamePlaceFromANearStart) {
  CycleDesign design = drawn::design({40, 24});
  drawn::addNoise(design, plantedNoise(), 4);
  StaticModel model(design);
  const CycleNoise noise = fitNoise(design, model);
  const double stiffness = model.stiffness;
  CycleNoise start = noise;
  for (double& variance : start.variance) variance *= 1.5;
  const CycleNoise again = fitNoise(design, model, &start);
  EXPECT_EQ(model.stiffness, stiffness) << "it stays";
  for (const auto k : {CycleNoise::kWhite, CycleNoise::kCycleGain, CycleNoise::kSlow})
    EXPECT_NEAR(again.variance[k] / noise.variance[k], 1, 0.1) << k;
}

// Covariance of the parts, written out: at bins a and b it is
// white + gain net_a net_b + slow exp(-|t_a - t_b| / (a third of a cycle)).
TEST(CycleNoise, IsASumOfItsParts) {
  const CycleDesign design = drawn::design({2, 8});
  const CycleBins& bins = design.cycles[1];
  const Eigen::MatrixXd covariance = plantedNoise().covariance(bins, design.cycle_time);
  for (Eigen::Index a = 0; a < 8; ++a) {
    for (Eigen::Index b = 0; b < 8; ++b) {
      const double apart = std::abs(bins.time[a] - bins.time[b]);
      const double expected = (a == b ? drawn::kWhiteVariance : 0) + 1e-4 * bins.net[a] * bins.net[b] +
                              9e-8 * std::exp(-apart / (design.cycle_time / 3));
      EXPECT_NEAR(covariance(a, b), expected, 1e-12 * expected + 1e-30);
    }
  }
}

double step(double share) {
  return 0.3 / (1 + std::exp(-(share - 0.5) / 0.02));
}

TEST(StaticModel, IsStiffUnderALineAndSoftUnderAStep) {
  CycleDesign line = drawn::design({24, 40, 1, 40}), stepped = line;
  for (CycleBins& bins : stepped.cycles) {
    for (Eigen::Index b = 0; b < bins.bins(); ++b) bins.reading[b] = step(bins.pressure[b] / drawn::kHighest);
  }
  drawn::addNoise(line, drawn::whiteNoise(), 5);
  drawn::addNoise(stepped, drawn::whiteNoise(), 5);
  StaticModel stiff(line), soft(stepped);
  fitNoise(line, stiff);
  fitNoise(stepped, soft);
  EXPECT_GE(stiff.stiffness, 1e7);
  EXPECT_LE(soft.stiffness, 1e4);
}

// Two visits of one surface and one of another, two columns for all.
CycleDesign threeVisits() {
  const auto loop = [](const drawn::Place& at) { return at.direction * (1 - at.share); };
  const auto fading = [](const drawn::Place& at) {
    return at.share * std::exp(-static_cast<double>(at.cycle) / 5);
  };
  CycleDesign design = drawn::design({18, 20, 2, 14, {loop, fading}});
  design.visits = 3;
  design.class_of = {0, 1, 0};
  design.visited_again = {true, false, true};
  for (std::size_t c = 0; c < design.cycles.size(); ++c) {
    CycleBins& bins = design.cycles[c];
    if (bins.curvature_class == 0 && c >= 9) bins.visit = 2;
  }
  drawn::addColumn(design, 0, 3e-3);
  drawn::addNoise(design, plantedNoise(), 6);
  return design;
}

TEST(StaticSolution, EqualsADenseSolution) {
  const CycleDesign design = threeVisits();
  StaticModel model(design, {0, 1}, {1e-4, 1e-5}, {false, true});
  model.stiffness = 1e5;
  model.visit_gain = 1e-4;
  model.visit_offset = 1e-6;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(model.size(), model.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(model.size());
  for (const CycleBins& bins : design.cycles) {
    const Eigen::MatrixXd inverse = plantedNoise().covariance(bins, design.cycle_time).inverse();
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(bins.bins(), model.size());
    const auto places = model.places(bins);
    for (std::size_t k = 0; k < places.size(); ++k)
      whole.col(places[k]) = model.columns(bins).col(static_cast<Eigen::Index>(k));
    gram += whole.transpose() * inverse * whole;
    right += whole.transpose() * inverse * bins.reading;
  }
  const StaticSolution solution(model, gram, right);
  const Eigen::MatrixXd precision = gram + model.prior();
  const Eigen::MatrixXd covariance = precision.fullPivLu().inverse();
  const Eigen::VectorXd coefficients = precision.fullPivLu().solve(right);
  EXPECT_LT((solution.coefficients() - coefficients).norm(), 1e-9 * coefficients.norm());
  const double determinant = precision.fullPivLu().matrixLU().diagonal().array().abs().log().sum();
  EXPECT_NEAR(solution.logDeterminant(), determinant, 1e-9 * std::abs(determinant));
  const double degrees = (covariance * gram).trace();
  EXPECT_NEAR(solution.degrees(), degrees, 1e-9 * degrees);
  for (const std::size_t c : {std::size_t{0}, std::size_t{1}}) {
    for (Eigen::Index k = model.startOf(c); k < model.startOf(c) + model.sizeOf(c); ++k)
      EXPECT_NEAR(solution.variance(c, k), covariance(k, k), 1e-8 * covariance(k, k)) << k;
  }
}

// A column that acts only on bent surfaces is 0 in the cycles of the flat one.
TEST(StaticModel, ActsOnBentSurfacesAloneWhereItMust) {
  const CycleDesign design = threeVisits();
  const StaticModel model(design, {0, 1}, {1, 1}, {false, true});
  for (const CycleBins& bins : design.cycles) {
    const Eigen::MatrixXd columns = model.columns(bins);
    EXPECT_EQ(columns.col(columns.cols() - 2), bins.columns.col(0));
    const Eigen::VectorXd bent =
        bins.curvature_class == 0 ? Eigen::VectorXd::Zero(bins.bins()).eval() : bins.columns.col(1).eval();
    EXPECT_EQ(columns.col(columns.cols() - 1), bent);
  }
}

}  // namespace
}  // namespace fsr::discrepancy
