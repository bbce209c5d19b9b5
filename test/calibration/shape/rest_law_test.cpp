// Kriging of the readings at rest: against NumPy, at the surfaces of training, and its stated error.

#include "calibration/stages/shape/rest_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "calibration/stages/shape/read_shape.h"
#include "support/planted_shape.h"

namespace fsr::calibration {
namespace {

using test_support::PlantedShape;

// Three surfaces, 2 x 2 taxels, all terms of the model at work. A reading is a pressure in kPa.
ShapeModel smallModel() {
  ShapeModel model;
  model.missing.clear();
  model.layout = {{2, 2}, 0.01, 0.01};
  model.full_scale = 1000;
  model.used.assign(4, 1);
  model.scale.assign(4, 1e6);
  model.surfaces = {"a", "b", "c"};
  model.curvature = {0, 5, 20};
  model.mounts = {2, 3, 2};
  model.gain = {1, 0.9, 0.8};
  model.zero_share = {0.1, 0, 0};
  model.rest = {2e3, 3e3, 1e3, 2e3, 20e3, 22e3, 17e3, 21e3, 30e3, 35e3, 26e3, 33e3};
  model.scatter = test_support::scatterOf(FieldFamily::kMatern, 3e3, 0.02, 1e3, 300);
  model.scatter.history = 400;
  model.history = {1.2, 0.9, 0.8, 1.1};
  model.scatter.contrasts = 9;
  model.law = {15e3, 1.5, 500, 0.1, 800, 6, 200};
  model.error_between = {0, 0};
  return model;
}

// NumPy 1.24.2 and SciPy 1.10.1, /usr/bin/python3:
//
//     import numpy as np, scipy.stats as st
//     k, w0 = np.array([0, 5, 20.]), 0.1
//     rest = 1e3 * np.array([[2, 3, 1, 2], [20, 22, 17, 21], [30, 35, 26, 33.]])
//     m, at = rest.mean(1), np.array([[0, 0], [1, 0], [0, 1], [1, 1]]) * 0.01
//     gain, mounts, zero = np.array([1, 0.9, 0.8]), np.array([2, 3, 2]), np.array([0.1, 0, 0])
//     r = lambda d, l: (1 + np.sqrt(3) * d / l) * np.exp(-np.sqrt(3) * d / l)
//     w = lambda k: np.log(1 + np.abs(k) * w0)
//     d = np.linalg.norm(at[:, None] - at, axis=2)
//     F = 3e3**2 * r(d, 0.02) + 1e3**2 + 300**2 * np.eye(4)
//     nu = 9 * np.trace(F)**2 / (F**2).sum()
//     F += 400**2 * np.outer([1.2, 0.9, 0.8, 1.1], [1.2, 0.9, 0.8, 1.1])  # the load before
//     J = np.eye(4) - 0.25
//     B, f = J @ F @ J, F.mean()
//     v, cut = gain**2 / mounts, np.trace(F) / 4 * zero / mounts
//     c = lambda a, b: 15e3**2 * r(abs(w(a) - w(b)), 1.5) + 1e10
//     o = lambda a, b, p, q: 500**2 + 0.1**2 * p * q + 800**2 * r(abs(a - b), 6)
//     C = c(k[:, None], k)
//     O = o(k[:, None], k, m[:, None], m)
//     N, V = np.diag(f * v + cut), np.diag(np.trace(B) / 4 * v + cut) + 200**2 * np.eye(3)
//     shares = 1 + 0.1**2 * (rest - m[:, None]).T @ np.linalg.solve(O + V, m)
//     def predict(q):
//         a = np.linalg.solve(C + N, c(q, k)); mean = a @ m
//         oq = o(q, k, mean, m); b = np.linalg.solve(O + V, oq)
//         own = o(q, q, mean, mean) - 2 * b @ oq + b @ O @ b
//         law = c(q, q) - 2 * a @ c(q, k) + a @ C @ a + a @ N @ a
//         S = np.interp(q, k, gain)**2 * F + B * (b**2 @ v) + law * np.outer(shares, shares)
//         x = mean + b @ (rest - m[:, None])
//         S += np.eye(4) * (own + b**2 @ cut + 200**2 * (1 + b @ b)) + 0.03**2 * np.outer(x, x)
//         return x, S
//     mean, S = predict(12.)
//     x = 1e3 * np.array([26, 31, 22, 27])
//     t = [st.multivariate_t(*predict(q), df=nu).logpdf(x) for q in (12., 5.)]
//     print(mean, S[0, 0], S[0, 3], t[0] - t[1])
//
// The tolerance of the covariance is that of sums with 1e10 Pa^2 of the unknown constant.
TEST(RestLaw, AgreesWithNumPy) {
  const ShapeModel model = smallModel();
  const RestLaw law(model);
  const RestPrediction prediction = law.predict(Eigen::VectorXd::Constant(4, 12));
  const double mean[] = {27612.340227790883, 31280.72617751989, 24007.115340806184, 29734.96463362919};
  for (Eigen::Index t = 0; t < 4; ++t) EXPECT_NEAR(prediction.mean(t), mean[t], 1e-6) << t;
  EXPECT_NEAR(prediction.covariance(0, 0), 15489047.680387778, 0.01);
  EXPECT_NEAR(prediction.covariance(0, 3), 12561373.742191676, 0.01);
  const ShapeReader reader(model);
  const RestReading rest{{26, 31, 22, 27}, {0, 0, 0, 0}};
  EXPECT_NEAR(reader.likelihood(rest, {12}).logarithm - reader.likelihood(rest, {5}).logarithm,
              2.857994079076363, 1e-6);
}

// What was measured there is predicted there, within the error of the mean of the mounts.
TEST(RestLaw, PredictsTheMeanOfATrainedSurface) {
  const PlantedShape sheet;
  const ShapeModel model = test_support::learnPlanted(sheet);
  const RestLaw law(model);
  double squares = 0, count = 0;
  for (std::size_t s = 0; s < model.curvature.size(); ++s) {
    const Eigen::VectorXd mean =
        law.predict(Eigen::VectorXd::Constant(Eigen::Index(model.used.size()), model.curvature[s])).mean;
    const double error = std::sqrt(law.means().mount_variance / model.mounts[s]);
    for (Eigen::Index t = 0; t < mean.size(); ++t) {
      const double away = (mean(t) - law.means().rest(Eigen::Index(s), t)) / error;
      EXPECT_LT(std::abs(away), 2) << "surface " << s << ", taxel " << t;
      squares += away * away;
      count += 1;
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.7) << "it smooths less than the mounts scatter";
}

// Sheets are drawn from the law itself. The squared error of a new mount, in units of the stated covariance,
// has the mean 1 for each taxel, on a surface of training, between two and beyond.
class DrawnLaw : public testing::Test {
 protected:
  // Draws readings on the surfaces of `model_` into it, and one more surface.
  void draw(double curvature) {
    ShapeModel all = model_;
    all.curvature.push_back(curvature);
    const auto knots = static_cast<Eigen::Index>(all.curvature.size());
    Eigen::MatrixXd common = commonCovariances(all);
    common.array() -= commonCovariance(model_.law, 0, 1e9);  // without the unknown constant
    const Eigen::VectorXd mean = fieldOf(common).array() + 30e3;
    Eigen::MatrixXd own = ownCovariances(all, mean);
    own.diagonal().array() += model_.law.own_white * model_.law.own_white;
    const auto taxels = static_cast<Eigen::Index>(model_.used.size());
    Eigen::MatrixXd rest = mean.replicate(1, taxels);
    for (Eigen::Index t = 0; t < taxels; ++t) rest.col(t) += fieldOf(own);
    model_.rest.clear();
    for (Eigen::Index s = 0; s + 1 < knots; ++s) {
      const std::size_t mounts = model_.mounts[std::size_t(s)];
      const Eigen::RowVectorXd mounted =
          rest.row(s) + test_support::drawMounts(sheet_, mounts, random_).colwise().mean();
      model_.rest.insert(model_.rest.end(), mounted.begin(), mounted.end());
    }
    // The new mount is at another temperature, which the model allows for with 3 % of the reading.
    const double sensitivity = 1 + 0.03 * normal_(random_);
    mounted_ = (sensitivity * rest.row(knots - 1) + test_support::drawMounts(sheet_, 1, random_)).transpose();
  }

  double standardizedSquare(double curvature) {
    draw(curvature);
    const RestLaw law(model_);
    const RestPrediction prediction = law.predict(Eigen::VectorXd::Constant(mounted_.size(), curvature));
    const Eigen::VectorXd error = mounted_ - prediction.mean;
    return error.dot(prediction.covariance.ldlt().solve(error)) / double(mounted_.size());
  }

  Eigen::VectorXd fieldOf(Eigen::MatrixXd covariance) {
    covariance.diagonal().array() += 1e-9 * covariance.trace();
    const Eigen::MatrixXd root = covariance.llt().matrixL();
    return root *
           Eigen::VectorXd::NullaryExpr(covariance.rows(), [&](Eigen::Index) { return normal_(random_); });
  }

  PlantedShape sheet_;
  ShapeModel model_ = [this] {
    ShapeModel model = test_support::learnPlanted(sheet_);
    model.scatter = sheet_.scatter;
    model.law = {15e3, 2, 300, 0.05, 600, 8, 200};
    return model;
  }();
  Eigen::VectorXd mounted_;
  std::mt19937 random_{1};
  std::normal_distribution<double> normal_;
};

TEST_F(DrawnLaw, StatesTheErrorOfItsPrediction) {
  constexpr int kDraws = 200;
  for (const double curvature : {2.5, 7.0, 17.0, 22.0}) {
    double sum = 0;
    for (int i = 0; i < kDraws; ++i) sum += standardizedSquare(curvature);
    EXPECT_NEAR(sum / kDraws, 1, 0.1) << "at " << curvature;
  }
}

}  // namespace
}  // namespace fsr::calibration
