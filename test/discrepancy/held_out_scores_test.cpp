// Scores of explanations in cycles that they were not fitted to.
#include "discrepancy/decide/held_out_scores.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "discrepancy/drawn_design.h"

namespace fsr::discrepancy {
namespace {

double fadingSoon(const drawn::Place& at) {
  return at.share * std::exp(-static_cast<double>(at.cycle) / 3);
}

Explaining explaining(std::vector<Eigen::Index> columns, std::vector<bool> free) {
  return {{"effect"}, {{std::move(columns), std::move(free)}}, {}};
}

// The expected values of the tests of fitForm(): /usr/bin/python3, numpy 1.24.2.
// def fit(G, r):
//   n = len(r); best = (0, 0)
//   for v in 10**np.arange(-14, 1.01, .5):
//     l = .5*r@np.linalg.solve(G+np.eye(n)/v, r) - .5*np.linalg.slogdet(np.eye(n)+v*G)[1]
//     best = max(best, (l, v))
//   return best, np.linalg.solve(G+np.eye(n)/best[1], r)
constexpr double kVariance = 3.1622776601683794e-04;

TEST(FitForm, OfOneColumnIsTheClosedForm) {
  const Eigen::MatrixXd gram = Eigen::MatrixXd::Constant(1, 1, 4e4);
  // fit(np.array([[4e4]]), np.array([900.]))
  const FormFit fit = fitForm(gram, Eigen::VectorXd::Constant(1, 900), {true});
  EXPECT_NEAR(fit.likelihood, 8.07635624369407, 1e-10);
  EXPECT_NEAR(fit.variance, kVariance, 1e-12);
  EXPECT_NEAR(fit.coefficients[0], 0.020851540947, 1e-11);
  // A pull of less than one standard error, sqrt(4e4) = 200: the best prior variance is 0.
  const FormFit nothing = fitForm(gram, Eigen::VectorXd::Constant(1, 150), {true});
  EXPECT_EQ(nothing.variance, 0);
  EXPECT_EQ(nothing.likelihood, 0);
  EXPECT_EQ(nothing.coefficients[0], 0);
}

TEST(FitForm, OfTwoColumnsSharesOnePriorVariance) {
  const Eigen::Matrix2d gram = (Eigen::Matrix2d() << 5e4, 1e4, 1e4, 3e4).finished();
  // fit(np.array([[5e4, 1e4], [1e4, 3e4]]), np.array([700., -400.]))
  const FormFit fit = fitForm(gram, Eigen::Vector2d(700, -400), {true, true});
  EXPECT_NEAR(fit.likelihood, 6.569929208076237, 1e-10);
  EXPECT_NEAR(fit.variance, kVariance, 1e-12);
  EXPECT_NEAR(fit.coefficients[0], 0.016364332795, 1e-11);
  EXPECT_NEAR(fit.coefficients[1], -0.016996520375, 1e-11);
}

// scipy.optimize.nnls(L, np.linalg.solve(L.T, r)) with L = np.linalg.cholesky(G).T, SciPy 1.10.1, keeps the
// columns 0 and 2; fit(G[np.ix_([0, 2], [0, 2])], r[[0, 2]]) is their fit.
TEST(FitForm, KeepsBoundSigns) {
  const Eigen::Matrix3d gram = (Eigen::Matrix3d() << 5e4, 4e4, 1e4, 4e4, 5e4, 1e4, 1e4, 1e4, 3e4).finished();
  const FormFit fit = fitForm(gram, Eigen::Vector3d(900, 500, 800), {false, false, false});
  EXPECT_NEAR(fit.likelihood, 11.41959687254449, 1e-10);
  EXPECT_NEAR(fit.coefficients[0], 0.013136670811, 1e-11);
  EXPECT_EQ(fit.coefficients[1], 0);
  EXPECT_NEAR(fit.coefficients[2], 0.020162465882, 1e-11);
  EXPECT_LT(fitForm(gram, Eigen::Vector3d(900, 500, 800), {true, true, true}).coefficients[1], 0)
      << "where it is free";
  const FormFit against = fitForm(gram.topLeftCorner(1, 1), Eigen::VectorXd::Constant(1, -900), {false});
  EXPECT_EQ(against.variance, 0);
  EXPECT_EQ(against.likelihood, 0);
}

// The static model and the columns as one dense least-squares problem.
class Dense {
 public:
  Dense(const CycleDesign& design, const CycleNoise& noise, const StaticModel& model,
        std::vector<Eigen::Index> columns)
      : design_(design), noise_(noise), model_(model), columns_(std::move(columns)) {}

  // Rows of the static model and the columns in a cycle.
  Eigen::MatrixXd rows(std::size_t cycle) const {
    const CycleBins& bins = design_.cycles[cycle];
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(bins.bins(), size());
    const auto places = model_.places(bins);
    const Eigen::MatrixXd statics = model_.columns(bins);
    for (std::size_t k = 0; k < places.size(); ++k)
      rows.col(places[k]) = statics.col(static_cast<Eigen::Index>(k));
    for (std::size_t k = 0; k < columns_.size(); ++k)
      rows.col(model_.size() + static_cast<Eigen::Index>(k)) = bins.columns.col(columns_[k]);
    return rows;
  }
  Eigen::MatrixXd weight(std::size_t cycle) const {
    return noise_.covariance(design_.cycles[cycle], design_.cycle_time).inverse();
  }
  Eigen::Index size() const { return model_.size() + static_cast<Eigen::Index>(columns_.size()); }

  // Normal equations over all cycles except those of a fold.
  void gather(std::size_t folds, std::size_t fold) {
    gram_.setZero(size(), size());
    right_.setZero(size());
    for (std::size_t c = 0; c < design_.cycles.size(); ++c) {
      if (c % folds == fold) continue;
      gram_ += rows(c).transpose() * weight(c) * rows(c);
      right_ += rows(c).transpose() * weight(c) * design_.cycles[c].reading;
    }
    gram_.topLeftCorner(model_.size(), model_.size()) += model_.prior();
  }
  const Eigen::MatrixXd& gram() const { return gram_; }

  // Mode of the static model alone (variance 0) or together with the columns.
  Eigen::VectorXd mode(double variance) const {
    Eigen::VectorXd mode = Eigen::VectorXd::Zero(size());
    const Eigen::Index n = variance > 0 ? size() : model_.size();
    mode.head(n) = precision(variance).ldlt().solve(right_.head(n));
    return mode;
  }
  double logLikelihood(double variance) const {
    const Eigen::Index n = variance > 0 ? size() : model_.size();
    const Eigen::VectorXd pivots = precision(variance).ldlt().vectorD();
    const double prior = static_cast<double>(n - model_.size()) * std::log(std::max(variance, 1e-300));
    return 0.5 * (right_.head(n).dot(mode(variance).head(n)) - pivots.array().log().sum() - prior);
  }
  double bestVariance() const {
    double best = logLikelihood(0), chosen = 0;
    for (double e = -14; e <= 1; e += 0.5) {
      const double now = logLikelihood(std::pow(10, e));
      if (now > best) best = now, chosen = std::pow(10, e);
    }
    return chosen;
  }
  // Squared error of a cycle, and the logarithm of its density without constants. Beside the noise there is
  // what the other cycles leave open in the static model and in the coefficients.
  double squaredError(std::size_t cycle, double variance) const {
    const Eigen::VectorXd left = leftOf(cycle, variance);
    return left.dot(spread(cycle, variance).ldlt().solve(left));
  }
  double logDensity(std::size_t cycle, double variance) const {
    const Eigen::VectorXd pivots = spread(cycle, variance).ldlt().vectorD();
    return -0.5 * (squaredError(cycle, variance) + pivots.array().log().sum());
  }

 private:
  Eigen::VectorXd leftOf(std::size_t cycle, double variance) const {
    return design_.cycles[cycle].reading - rows(cycle) * mode(variance);
  }
  Eigen::MatrixXd spread(std::size_t cycle, double variance) const {
    const Eigen::MatrixXd known = precision(variance), own = rows(cycle).leftCols(known.rows());
    return weight(cycle).inverse() + own * known.ldlt().solve(own.transpose());
  }
  Eigen::MatrixXd precision(double variance) const {
    if (!(variance > 0)) return gram_.topLeftCorner(model_.size(), model_.size());
    Eigen::MatrixXd precision = gram_;
    precision.diagonal().tail(size() - model_.size()).array() += 1 / variance;
    return precision;
  }
  const CycleDesign& design_;
  const CycleNoise noise_;
  const StaticModel& model_;
  std::vector<Eigen::Index> columns_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_;
};

TEST(HeldOutScores, EqualADenseComputation) {
  CycleDesign design = drawn::design({6, 8, 1, 4, {drawn::loop, fadingSoon}});
  drawn::addColumn(design, 0, 3e-4);
  drawn::addNoise(design, drawn::wanderingNoise(), 1);
  StaticModel model(design);
  constexpr std::size_t kFolds = 3;
  constexpr double kDegrees = 4;
  const std::vector<Explaining> all = {explaining({0, 1}, {true, true})};
  const HeldOutScores scores(design, drawn::wanderingNoise(), model, all, kFolds, kDegrees);
  double total = 0, loss = 0;
  for (std::size_t c = 0; c < design.cycles.size(); ++c) {
    Dense dense(design, drawn::wanderingNoise(), model, {0, 1});
    dense.gather(kFolds, c % kFolds);
    const double variance = dense.bestVariance();
    EXPECT_GT(variance, 0) << "the example shows the loop";
    const double alone = dense.squaredError(c, 0);
    const double nats = dense.logDensity(c, variance) - dense.logDensity(c, 0);
    EXPECT_NEAR(scores.scores()[0].nats[c], nats, 1e-6 * alone) << c;
    total += nats;
    loss += alone;
    // Student's t of 4 degrees of freedom in 8 dimensions, without the determinant and its constants.
    const double density =
        0.5 * (kDegrees + 8) * std::log((1 + alone / kDegrees) / (1 + (alone - 2 * nats) / kDegrees));
    EXPECT_NEAR(scores.density(c, nats) - scores.density(c, 0), density, 1e-6 * std::abs(density));
  }
  EXPECT_NEAR(scores.scores()[0].total, total, 1e-6 * loss);
  EXPECT_NEAR(scores.loss(), loss, 1e-6 * loss);
  EXPECT_EQ(scores.expectedLoss(), 6 * 8);
  Dense whole(design, drawn::wanderingNoise(), model, {0});
  whole.gather(kFolds, kFolds);
  const Eigen::Index last = model.size();
  const double information =
      whole.gram()(last, last) -
      whole.gram().col(last).head(last).dot(
          whole.gram().topLeftCorner(last, last).ldlt().solve(whole.gram().col(last).head(last)));
  EXPECT_NEAR(scores.information(0), information, 1e-6 * information);
}

// The predictions of two forms, weighed by their marginal likelihoods in the other folds.
TEST(HeldOutScores, OfTwoFormsAreTheirMeanDensity) {
  CycleDesign design = drawn::design({6, 8, 1, 4, {drawn::loop, fadingSoon}});
  drawn::addColumn(design, 0, 3e-4);
  drawn::addNoise(design, drawn::wanderingNoise(), 1);
  const StaticModel model(design);
  constexpr std::size_t kFolds = 3;
  Explaining either = explaining({0}, {true});
  either.forms.push_back({{1}, {true}});
  const std::vector<Explaining> all = {explaining({0}, {true}), explaining({1}, {true}), either};
  const HeldOutScores scores(design, drawn::wanderingNoise(), model, all, kFolds, 4);
  for (std::size_t c = 0; c < design.cycles.size(); ++c) {
    double sum = 0, weights = 0;
    for (Eigen::Index k = 0; k < 2; ++k) {
      Dense dense(design, drawn::wanderingNoise(), model, {k});
      dense.gather(kFolds, c % kFolds);
      const double weight = std::exp(dense.logLikelihood(dense.bestVariance()) - dense.logLikelihood(0));
      sum += weight * std::exp(scores.scores()[static_cast<std::size_t>(k)].nats[c]);
      weights += weight;
    }
    EXPECT_NEAR(scores.scores()[2].nats[c], std::log(sum / weights), 1e-6) << c;
  }
}

// The form with the largest marginal likelihood counts; one that acts on bent surfaces alone is 0 on flat
// ones.
TEST(HeldOutScores, ChooseTheFormThatActs) {
  CycleDesign design = drawn::design({16, 20, 2, 14, {drawn::loop, drawn::turning}});
  for (CycleBins& bins : design.cycles) {
    if (bins.curvature_class == 1) bins.reading += 2e-3 * bins.columns.col(1);
  }
  drawn::addNoise(design, drawn::wanderingNoise(), 2);
  Explaining forms = explaining({0}, {true});
  forms.forms.push_back({{1}, {true}});
  forms.forms.push_back({{1}, {true}, true});
  const StaticModel model(design);
  const HeldOutScores scores(design, drawn::wanderingNoise(), model, {forms}, 4, 4);
  EXPECT_EQ(scores.scores()[0].form, 2u);
  EXPECT_NEAR(scores.scores()[0].fit.coefficients[0], 2e-3, 1e-4);
  EXPECT_GT(scores.scores()[0].total, 50);
}

// Under the model's own noise the probability of the best score is uniform, except that it is 1 where no
// explanation scores above 0. The number out of 200 seeds below a level is binomial. The bounds hold with
// probability 0.999: scipy.stats.binom.ppf([.0005, .9995], 200, p), SciPy 1.10.1. For the share of the scores
// above 0 see the null, whose 99 x 200 draws give it with an error of 0.003.
TEST(HeldOutScores, OfNoiseAloneHaveUniformProbabilities) {
  const std::vector<Explaining> all = {explaining({0, 2}, {true, true}), explaining({1}, {false}),
                                       explaining({0, 1, 2}, {false, false, true})};
  constexpr int kSeeds = 200, kDraws = 99;
  int to_5 = 0, to_10 = 0, above = 0;
  double above_in_null = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    CycleDesign design = drawn::design({15, 12, 1, 14, {drawn::loop, fadingSoon, drawn::turning}});
    drawn::addNoise(design, drawn::wanderingNoise(), seed);
    const StaticModel model(design);
    const HeldOutScores scores(design, drawn::wanderingNoise(), model, all, 5, 4);
    const NullScores null = scores.nullScores(kDraws, seed, 1);
    double best = -INFINITY;
    for (const HeldOutScore& score : scores.scores()) best = std::max(best, score.total);
    const auto larger =
        std::count_if(null.largest.begin(), null.largest.end(), [&](double drawn) { return drawn >= best; });
    const double p = (1 + static_cast<double>(larger)) / (1 + kDraws);
    to_5 += p <= 0.05;
    to_10 += p <= 0.1;
    above += best > 0;
    above_in_null += static_cast<double>(std::count_if(null.largest.begin(), null.largest.end(),
                                                       [](double drawn) { return drawn > 0; })) /
                     kDraws;
  }
  EXPECT_GE(to_5, 2);
  EXPECT_LE(to_5, 21);
  EXPECT_GE(to_10, 8);
  EXPECT_LE(to_10, 35);
  const double share = above_in_null / kSeeds;
  EXPECT_NEAR(above, kSeeds * share, 3.3 * std::sqrt(kSeeds * share * (1 - share)));
}

// The static curves are uncertain, too. The first cycle alone belongs to a mounting of its own, whose gain no
// other cycle tells.
TEST(HeldOutScores, ExpectTheMeanLossOfRecordingsWithoutAnEffect) {
  double loss = 0;
  constexpr int kRecordings = 100;
  constexpr double kGain = 0.2;  // of a mounting, standard deviation
  for (std::uint64_t seed = 1; seed <= kRecordings; ++seed) {
    CycleDesign design = drawn::design({15, 12, 1, 14, {drawn::loop}});
    design.visits = 2;
    design.class_of = {0, 0};
    design.visited_again = {true, true};
    const statistics::RandomStream stream = statistics::randomStream(seed, "mounting", 0);
    for (std::size_t c = 0; c < design.cycles.size(); ++c) {
      CycleBins& bins = design.cycles[c];
      bins.visit = c == 0 ? 0 : 1;
      bins.reading += kGain * stream.normal(bins.visit) * bins.net;
    }
    drawn::addNoise(design, drawn::wanderingNoise(), seed);
    StaticModel model(design);
    model.visit_gain = kGain * kGain;
    const std::vector<Explaining> all = {explaining({0}, {true})};
    const HeldOutScores scores(design, drawn::wanderingNoise(), model, all, 5, 4);
    EXPECT_EQ(scores.expectedLoss(), 15 * 12);
    loss += scores.loss() / kRecordings;
  }
  EXPECT_NEAR(loss, 15 * 12, 0.03 * 15 * 12);
}

// Cycle 4 has two bins beyond the pressures of all other cycles. What they read has no part in its score.
TEST(HeldOutScores, LeaveOutPressuresThatOtherFoldsDoNotCover) {
  CycleDesign design = drawn::design({15, 12, 1, 14, {drawn::loop}});
  drawn::addColumn(design, 0, 1e-3);
  drawn::addNoise(design, drawn::wanderingNoise(), 1);
  const std::vector<Explaining> all = {explaining({0}, {true})};
  const StaticModel model(design);
  CycleBins& high = design.cycles[4];
  for (const Eigen::Index b : {5, 6}) high.pressure[b] = 1.1 * drawn::kHighest;
  const HeldOutScores before(design, drawn::wanderingNoise(), model, all, 5, 4);
  for (const Eigen::Index b : {5, 6}) high.reading[b] += 0.1;
  const HeldOutScores after(design, drawn::wanderingNoise(), model, all, 5, 4);
  EXPECT_EQ(after.scores()[0].nats[4], before.scores()[0].nats[4]);
  EXPECT_EQ(after.density(4, 0), before.density(4, 0));
  EXPECT_NE(after.scores()[0].nats[5], before.scores()[0].nats[5]) << "it is fitted to cycle 4";
}

}  // namespace
}  // namespace fsr::discrepancy
