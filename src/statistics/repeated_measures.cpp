#include "statistics/repeated_measures.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <initializer_list>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::statistics {

namespace {

constexpr std::size_t kFewest = 3;
constexpr std::size_t kMost = 5000;
const char* const kShapiroWilk = "Shapiro-Wilk test";

/// Coefficients from the constant term upwards; Royston's C1 to C6 and G.
double polynomial(std::initializer_list<double> coefficients, double x) {
  double sum = 0;
  for (auto c = std::rbegin(coefficients); c != std::rend(coefficients); ++c) sum = sum * x + *c;
  return sum;
}

/// Upper half of the weights, that of the largest value first; the lower half mirrors it.
std::vector<double> upperWeights(std::size_t n) {
  if (n == 3) return {std::sqrt(0.5)};
  const boost::math::normal normal;
  std::vector<double> m(n / 2);  // expected order statistics, Blom's formula
  double square = 0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    m[i] = -boost::math::quantile(normal, (static_cast<double>(i) + 0.625) / (static_cast<double>(n) + 0.25));
    square += 2 * m[i] * m[i];
  }
  // The outermost one or two weights come from polynomials. The others are scaled to the rest of the norm.
  const double x = 1 / std::sqrt(static_cast<double>(n)), norm = std::sqrt(square);
  std::vector<double> outer = {m[0] / norm +
                               polynomial({0, 0.221157, -0.147981, -2.07119, 4.434685, -2.706056}, x)};
  if (n > 5) {
    outer.push_back(m[1] / norm + polynomial({0, 0.042981, -0.293762, -1.752461, 5.682633, -3.582633}, x));
  }
  double left = 1;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    square -= 2 * m[i] * m[i];
    left -= 2 * outer[i] * outer[i];
  }
  for (double& weight : m) weight *= std::sqrt(left / square);
  std::copy(outer.begin(), outer.end(), m.begin());
  return m;
}

/// 1 - W, without cancellation where W is close to 1. `sorted`: sorted values about zero.
double oneMinusW(const std::vector<double>& sorted) {
  const std::size_t n = sorted.size();
  const std::vector<double> upper = upperWeights(n);
  double weighted = 0, weights = 0;
  for (std::size_t i = 0; i < upper.size(); ++i) {
    weighted += upper[i] * (sorted[n - 1 - i] - sorted[i]);
    weights += 2 * upper[i] * upper[i];
  }
  const double total = weights * squaredDeviations(sorted), root = std::sqrt(total);
  return (root - weighted) * (root + weighted) / total;
}

double pOfThree(double w) {
  const double pi = std::acos(-1.0);
  return std::max(0.0, 6 / pi * (std::asin(std::sqrt(w)) - std::asin(std::sqrt(0.75))));
}

double pOf(double one_minus_w, std::size_t size) {
  if (size == 3) return pOfThree(1 - one_minus_w);
  const double n = static_cast<double>(size), log_n = std::log(n);
  double y = std::log(one_minus_w), mean = 0, deviation = 0;
  if (size <= 11) {
    const double gamma = polynomial({-2.273, 0.459}, n);
    if (y >= gamma) return 0;  // beyond the range of the approximation
    y = -std::log(gamma - y);
    mean = polynomial({0.544, -0.39978, 0.025054, -6.714e-4}, n);
    deviation = std::exp(polynomial({1.3822, -0.77857, 0.062767, -0.0020322}, n));
  } else {
    mean = polynomial({-1.5861, -0.31082, -0.083751, 0.0038915}, log_n);
    deviation = std::exp(polynomial({-0.4803, -0.082676, 0.0030302}, log_n));
  }
  return boost::math::cdf(boost::math::complement(boost::math::normal(mean, deviation), y));
}

/// Sorted values minus the median, divided by their range. W does not depend on either, rounding does.
std::vector<double> standardised(std::vector<double> sample) {
  std::sort(sample.begin(), sample.end());
  const double middle = sample[sample.size() / 2], range = sample.back() - sample.front();
  for (double& x : sample) x = (x - middle) / range;
  return sample;
}

}  // namespace

TestResult shapiroWilk(const std::vector<double>& sample) {
  requireSample(sample, kFewest, kShapiroWilk);
  if (sample.size() > kMost) {
    throw settings::InputError(std::string(kShapiroWilk) + ": " + std::to_string(sample.size()) +
                               " values given, but its approximation holds for at most 5000");
  }
  if (isConstant(sample))
    throw settings::InputError(std::string(kShapiroWilk) +
                               ": all values are equal; it needs values that are not all equal");

  const double one_minus_w = std::max(0.0, oneMinusW(standardised(sample)));
  TestResult result;
  result.test = "Shapiro-Wilk";
  result.symbol = "W";
  result.statistic = 1 - one_minus_w;
  result.p = pOf(one_minus_w, sample.size());
  result.n = sample.size();
  result.method = sample.size() == 3 ? PMethod::kExact : PMethod::kNormalApproximation;
  return result;
}

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

namespace {

struct RankSums {
  std::vector<double> of_treatment;
  double ties = 0;
};

RankSums rankWithinUnits(const RepeatedMeasures& measures) {
  RankSums sums;
  sums.of_treatment.resize(measures.values.size());
  std::vector<double> row(measures.values.size());
  for (std::size_t unit = 0; unit < measures.units(); ++unit) {
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = measures.values[j][unit];
    const Ranking ranking = midranks(row);
    for (std::size_t j = 0; j < row.size(); ++j) sums.of_treatment[j] += ranking.ranks[j];
    sums.ties += ranking.tie_sum;
  }
  return sums;
}

}  // namespace

TestResult friedman(const RepeatedMeasures& measures) {
  requireMeasures(measures, 2, 2, "Friedman test");
  const RankSums sums = rankWithinUnits(measures);
  const double n = static_cast<double>(measures.units()), k = static_cast<double>(measures.values.size());
  double square = 0;
  for (const double sum : sums.of_treatment) square += (sum - n * (k + 1) / 2) * (sum - n * (k + 1) / 2);
  const double scale = n * k * (k + 1) - sums.ties / (k - 1);

  TestResult result;
  result.test = "Friedman";
  result.symbol = "chi2";
  result.degrees_of_freedom = {k - 1};
  result.n = measures.units();
  // All terms are multiples of one half, so the comparison with zero is exact.
  result.statistic = scale == 0 ? 0 : 12 * square / scale;
  result.p = boost::math::cdf(boost::math::complement(boost::math::chi_squared(k - 1), result.statistic));
  result.method = scale == 0 ? PMethod::kNothingToTest : PMethod::kChiSquaredApproximation;
  return result;
}

}  // namespace fsr::statistics
