#include "statistics/repeated_measures_anova.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::statistics {

namespace {

const char* const kAnova = "repeated-measures ANOVA";

/// Orthonormal contrasts between treatments, one a row: Helmert's. [k - 1 x k]
Eigen::MatrixXd contrasts(Eigen::Index k) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(k - 1, k);
  for (Eigen::Index i = 0; i < k - 1; ++i) {
    const double m = static_cast<double>(i + 1);
    rows.row(i).head(i + 1).setConstant(-1 / std::sqrt(m * (m + 1)));
    rows(i, i + 1) = std::sqrt(m / (m + 1));
  }
  return rows;
}

/// The data as contrasts, one unit a row. [n x k - 1]
Eigen::MatrixXd contrastScores(const RepeatedMeasures& measures) {
  const auto n = static_cast<Eigen::Index>(measures.units());
  const auto k = static_cast<Eigen::Index>(measures.values.size());
  Eigen::MatrixXd x(n, k);
  for (Eigen::Index j = 0; j < k; ++j)
    x.col(j) = Eigen::Map<const Eigen::VectorXd>(measures.values[j].data(), n);
  x.colwise() -=
      x.rowwise().mean().eval();  // units differ much more than treatments; this keeps the precision
  return x * contrasts(k).transpose();
}

double upperTail(double f, double df1, double df2) {
  return boost::math::cdf(boost::math::complement(boost::math::fisher_f(df1, df2), f));
}

/// Box's series as in Anderson (1958). `contrasts` = k - 1 of them, `df` = n - 1.
double mauchlyP(double log_w, double contrasts, double df) {
  const double q = contrasts;
  const double rho = 1 - (2 * q * q + q + 2) / (6 * q * df);
  const double second = (q + 2) * (q - 1) * (q - 2) * (2 * q * q * q + 6 * q * q + 3 * q + 2) /
                        (288 * df * df * q * q * rho * rho);
  const double z = -df * rho * log_w, freedom = q * (q + 1) / 2 - 1;
  const auto tail = [z](double f) {
    return boost::math::cdf(boost::math::complement(boost::math::chi_squared(f), std::max(z, 0.0)));
  };
  return std::clamp(tail(freedom) + second * (tail(freedom + 4) - tail(freedom)), 0.0, 1.0);
}

TestResult mauchly(const Eigen::VectorXd& lambda, std::size_t n) {
  const auto q = static_cast<double>(lambda.size()), df = static_cast<double>(n - 1);
  TestResult result;
  result.test = "Mauchly";
  result.symbol = "W";
  result.n = n;
  result.degrees_of_freedom = {q * (q + 1) / 2 - 1};
  result.method = PMethod::kChiSquaredApproximation;
  if (lambda.size() == 1) {
    result.statistic = result.p = 1;
    result.method = PMethod::kNothingToTest;
  } else if (df < q || lambda.minCoeff() <= 1e-12 * lambda.maxCoeff()) {
    result.statistic = 0;
  } else {
    const double log_w = lambda.array().log().sum() - q * std::log(lambda.mean());
    result.statistic = std::exp(log_w);
    result.p = mauchlyP(log_w, q, df);
  }
  return result;
}

double huynhFeldtEpsilon(double greenhouse_geisser, double q, double n) {
  const double denominator = q * (n - 1 - q * greenhouse_geisser);
  return denominator > 1e-9 ? (n * q * greenhouse_geisser - 2) / denominator : 1;
}

SphericityCorrection corrected(const TestResult& f, double epsilon) {
  const double factor = std::min(epsilon, 1.0);
  return {epsilon,
          upperTail(f.statistic, factor * f.degrees_of_freedom[0], factor * f.degrees_of_freedom[1])};
}

/// The result where nothing varies: F = 0, p = 1, spherical.
RepeatedMeasuresAnova flat(std::size_t n, std::size_t k) {
  const auto q = static_cast<double>(k - 1);
  RepeatedMeasuresAnova result;
  result.test.test = kAnova;
  result.test.symbol = "F";
  result.test.statistic = 0;
  result.test.p = 1;
  result.test.n = n;
  result.test.degrees_of_freedom = {q, q * static_cast<double>(n - 1)};
  result.test.method = PMethod::kNothingToTest;
  result.mauchly = mauchly(Eigen::VectorXd::Ones(1), n);
  result.greenhouse_geisser.p = result.huynh_feldt.p = 1;
  return result;
}

double largestMagnitude(const RepeatedMeasures& measures) {
  double largest = 0;
  for (const auto& treatment : measures.values) {
    for (const double x : treatment) largest = std::max(largest, std::abs(x));
  }
  return largest;
}

}  // namespace

RepeatedMeasuresAnova repeatedMeasuresAnova(const RepeatedMeasures& measures) {
  requireMeasures(measures, 2, 2, kAnova);
  const Eigen::MatrixXd scores = contrastScores(measures);
  const auto n = static_cast<double>(scores.rows()), q = static_cast<double>(scores.cols());
  const Eigen::RowVectorXd mean = scores.colwise().mean();
  const Eigen::MatrixXd centred = scores.rowwise() - mean;
  const Eigen::MatrixXd covariance = centred.transpose() * centred / (n - 1);

  RepeatedMeasuresAnova result = flat(measures.units(), measures.values.size());
  const double rounding = 10 * std::numeric_limits<double>::epsilon() * largestMagnitude(measures);
  if (covariance.trace() <= q * rounding * rounding) {
    if (mean.norm() <= std::sqrt(q) * rounding) return result;
    throw settings::InputError(
        std::string(kAnova) +
        ": the treatments differ by the same on every unit; it needs differences that are not all equal");
  }
  const Eigen::VectorXd lambda =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(covariance, Eigen::EigenvaluesOnly).eigenvalues();
  const double total = lambda.sum();
  result.test.statistic = n * mean.squaredNorm() / total;
  result.test.p = upperTail(result.test.statistic, q, q * (n - 1));
  result.test.method = PMethod::kParametric;
  result.mauchly = mauchly(lambda, measures.units());
  const double epsilon = total * total / (q * lambda.squaredNorm());
  result.greenhouse_geisser = corrected(result.test, epsilon);
  result.huynh_feldt = corrected(result.test, huynhFeldtEpsilon(epsilon, q, n));
  return result;
}

}  // namespace fsr::statistics
