#include "discrepancy/decide/covariate_tests.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/fit/cycle_levels.h"
#include "discrepancy/thresholds.h"
#include "fsr_pressure_map/simulation/effect_info.h"
#include "statistics/multiple_comparisons.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy {

namespace {

constexpr double kLevel = 0.05;
constexpr double kBlock = 5;        // noise is correlated over less than this time [s]
constexpr double kSingular = 1e-9;  // of the largest eigenvalue; smaller ones count as 0
constexpr std::size_t kRateTerms = 2;
constexpr std::size_t kFewTaxels = 4;  // with fewer, rows, columns and taxels are not tested

using Columns = std::vector<Eigen::Index>;

// p value, and excess of the statistic over its mean under the null hypothesis.
struct Outcome {
  double p = 1;
  double beyond = 0;
};

Outcome outcomeOf(double statistic, const std::vector<double>& by_chance) {
  double as_large = 0, sum = 0;
  for (const double one : by_chance) {
    as_large += one >= statistic ? 1 : 0;
    sum += one;
  }
  const auto draws = static_cast<double>(by_chance.size());
  return {(1 + as_large) / (draws + 1), std::max(0.0, statistic - sum / draws)};
}

// Each row holds the contributions of one cycle to all terms. The statistic is the squared length of the sum
// of the rows.
Outcome flipSigns(const Eigen::MatrixXd& cycles, std::uint64_t draws,
                  const statistics::RandomStream& stream) {
  std::vector<double> by_chance;
  const auto words = static_cast<std::uint64_t>((cycles.rows() + 63) / 64);
  Eigen::RowVectorXd sum(cycles.cols());
  for (std::uint64_t draw = 0; draw < draws; ++draw) {
    sum.setZero();
    for (Eigen::Index c = 0; c < cycles.rows(); ++c) {
      const auto bit = static_cast<std::uint64_t>(c);
      const bool flipped = (stream.bits(draw * words + bit / 64) >> (bit % 64) & 1) != 0;
      if (flipped) {
        sum -= cycles.row(c);
      } else {
        sum += cycles.row(c);
      }
    }
    by_chance.push_back(sum.squaredNorm());
  }
  return outcomeOf(cycles.colwise().sum().squaredNorm(), by_chance);
}

// Replaces flipSigns() where there are too few cycles: draws normal noise of this variance in every term.
Outcome drawBlocks(const Eigen::MatrixXd& cycles, double variance, std::uint64_t draws,
                   const statistics::RandomStream& stream) {
  std::vector<double> by_chance;
  const auto terms = static_cast<std::uint64_t>(cycles.cols());
  for (std::uint64_t draw = 0; draw < draws; ++draw) {
    double square = 0;
    for (std::uint64_t k = 0; k < terms; ++k) square += std::pow(stream.normal(draw * terms + k), 2);
    by_chance.push_back(variance * square);
  }
  return outcomeOf(cycles.colwise().sum().squaredNorm(), by_chance);
}

// Matrix that maps the columns to linearly independent ones, which are orthonormal under the gram matrix.
Eigen::MatrixXd whitening(const Eigen::MatrixXd& gram) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
  const double least = kSingular * solver.eigenvalues().maxCoeff();
  Columns kept;
  for (Eigen::Index k = 0; k < gram.cols(); ++k) {
    if (solver.eigenvalues()[k] > least) kept.push_back(k);
  }
  Eigen::MatrixXd result(gram.rows(), static_cast<Eigen::Index>(kept.size()));
  for (Eigen::Index k = 0; k < result.cols(); ++k) {
    const Eigen::Index from = kept[static_cast<std::size_t>(k)];
    result.col(k) = solver.eigenvectors().col(from) / std::sqrt(solver.eigenvalues()[from]);
  }
  return result;
}

Eigen::MatrixXd part(const Eigen::MatrixXd& matrix, const Columns& rows, const Columns& columns) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    for (Eigen::Index j = 0; j < result.cols(); ++j) {
      result(i, j) = matrix(rows[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
    }
  }
  return result;
}

// Terms of the common trace that are tested together. The test is of what `tested` explain in addition to
// `beside`.
struct Terms {
  Columns tested, beside;
};

class Tester {
 public:
  explicit Tester(const CovariateTests& with) : with_(with), grams_(with.candidates.grams()) {
    std::vector<bool> wanted;
    for (const MeasuredCycle& cycle : with.measured.cycles) wanted.push_back(cycle.use == CycleUse::kFit);
    for (std::size_t c = 0; c < wanted.size(); ++c) {
      if (wanted[c]) cycles_.push_back(c);
    }
    total_ = grams_.sum(wanted);
    for (const std::size_t c : cycles_)
      samples_ += static_cast<double>(with.measured.cycles[c].last - with.measured.cycles[c].first);
    const Trace none = Trace::Zero(static_cast<Eigen::Index>(with.measured.samples()));
    square_ = std::max(1e-300, spreadOf(with.measured, with.taxels, none).square);
  }

  std::vector<CovariateTest> run();

 private:
  statistics::RandomStream stream(const std::string& covariate) const {
    return statistics::randomStream(with_.seed, "discrepancy.covariate." + covariate);
  }
  Columns columnsOf(const std::string& family) const;
  Eigen::MatrixXd sums(const Terms& terms) const;
  double blockVariance() const;
  void testWithinCycles(const std::string& covariate, const Terms& terms);
  Eigen::MatrixXd deviations(Eigen::Index& number) const;
  void testLines(simulation::Covariate covariate, const Eigen::MatrixXd& by_taxel, Eigen::Index number,
                 const std::vector<std::size_t>& line);
  void testPlaces();
  void testFromCycleToCycle();
  void add(const std::string& covariate, const std::string& method, const Outcome& outcome, double size) {
    tests_.push_back({covariate, method, outcome.p, 1, size / square_, false});
  }

  const CovariateTests& with_;
  const CycleGrams& grams_;
  std::vector<std::size_t> cycles_;  // indices of the cycles to fit
  Eigen::MatrixXd total_;
  double samples_ = 0, square_ = 0;
  std::vector<CovariateTest> tests_;
};

Columns Tester::columnsOf(const std::string& family) const {
  for (const Family& one : with_.candidates.generics()) {
    if (one.id == family) return one.alternatives.front().columns;
  }
  return {};
}

// Inner products of the terms with the target in each cycle, [cycles x independent terms].
Eigen::MatrixXd Tester::sums(const Terms& terms) const {
  const Columns target = {grams_.target()};
  Eigen::MatrixXd gram = part(total_, terms.tested, terms.tested), shared;
  if (!terms.beside.empty()) {
    const Eigen::MatrixXd white = whitening(part(total_, terms.beside, terms.beside));
    const Eigen::MatrixXd across = part(total_, terms.beside, terms.tested);
    shared = white * (white.transpose() * across);  // coefficients of `beside` in `tested`
    gram -= across.transpose() * shared;
  }
  const Eigen::MatrixXd white = whitening(gram);
  Eigen::MatrixXd sums(static_cast<Eigen::Index>(cycles_.size()), white.cols());
  for (std::size_t c = 0; c < cycles_.size(); ++c) {
    Eigen::VectorXd sum = part(grams_.of(cycles_[c]), terms.tested, target);
    if (!terms.beside.empty()) sum -= shared.transpose() * part(grams_.of(cycles_[c]), terms.beside, target);
    sums.row(static_cast<Eigen::Index>(c)) = sum.transpose() * white;
  }
  return sums;
}

// Variance of the inner product of the noise with a term of unit length. Noise is correlated within a block.
// The variance is estimated from differences between consecutive blocks, so that slow trends are not counted.
double Tester::blockVariance() const {
  const Trace target = with_.candidates.target();
  double squares = 0, number = 0;
  for (const std::size_t c : cycles_) {
    const MeasuredCycle& cycle = with_.measured.cycles[c];
    double before = NAN;
    for (std::size_t from = cycle.first, to = from; from < cycle.last; from = to) {
      while (to < cycle.last && with_.measured.time[to] < with_.measured.time[from] + kBlock) ++to;
      const auto length = static_cast<Eigen::Index>(to - from);
      const double root = std::sqrt(static_cast<double>(length));
      const double sum = target.segment(static_cast<Eigen::Index>(from), length).sum() / root;
      if (!std::isnan(before)) {
        squares += std::pow(sum - before, 2) / 2;
        ++number;
      }
      before = sum;
    }
  }
  return number > 0 ? squares / number : 0;
}

void Tester::testWithinCycles(const std::string& covariate, const Terms& terms) {
  if (terms.tested.empty()) return;
  const Eigen::MatrixXd cycles = sums(terms);
  const bool exchangeable = cycles_.size() >= CovariateTests::kFewestExchangeable;
  const Outcome outcome = exchangeable ? flipSigns(cycles, with_.draws, stream(covariate))
                                       : drawBlocks(cycles, blockVariance(), with_.draws, stream(covariate));
  add(covariate, exchangeable ? "sign_flips" : "block_bootstrap", outcome, outcome.beyond / samples_);
}

// Deviation of each taxel from the common trace, as inner products with the terms of direction and rate;
// [cycles x (taxels x terms)].
Eigen::MatrixXd Tester::deviations(Eigen::Index& number) const {
  const Measured& measured = with_.measured;
  Columns along = columnsOf("direction x pressure"), rate = columnsOf("pressure_rate");
  rate.resize(std::min(rate.size(), kRateTerms));
  along.insert(along.end(), rate.begin(), rate.end());
  const Eigen::MatrixXd terms = with_.candidates.columns(along) * whitening(part(total_, along, along));
  number = terms.cols();
  const auto taxels = static_cast<Eigen::Index>(measured.taxels());
  Eigen::MatrixXd by_taxel(static_cast<Eigen::Index>(cycles_.size()), taxels * number);
  std::vector<double> residual;
  for (std::size_t c = 0; c < cycles_.size(); ++c) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(number, taxels);
    for (std::size_t i = measured.cycles[cycles_[c]].first; i < measured.cycles[cycles_[c]].last; ++i) {
      with_.taxels.residuals(i, residual);
      sum += terms.row(static_cast<Eigen::Index>(i)).transpose() *
             Eigen::Map<const Eigen::RowVectorXd>(residual.data(), taxels);
    }
    const Eigen::VectorXd mean = sum.rowwise().sum() / static_cast<double>(measured.usedTaxels());
    for (Eigen::Index t = 0; t < taxels; ++t) {
      if (measured.used[static_cast<std::size_t>(t)]) sum.col(t) -= mean;
    }
    by_taxel.row(static_cast<Eigen::Index>(c)) = Eigen::Map<const Eigen::RowVectorXd>(sum.data(), sum.size());
  }
  return by_taxel;
}

// Tests rows, columns or single taxels. `line` holds the index of this group for each taxel.
void Tester::testLines(simulation::Covariate covariate, const Eigen::MatrixXd& by_taxel, Eigen::Index number,
                       const std::vector<std::size_t>& line) {
  const auto lines = static_cast<Eigen::Index>(*std::max_element(line.begin(), line.end()) + 1);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(by_taxel.rows(), lines * number);
  std::vector<double> members(static_cast<std::size_t>(lines), 0.0);
  for (std::size_t t = 0; t < line.size(); ++t) members[line[t]] += with_.measured.used[t];
  for (std::size_t t = 0; t < line.size(); ++t) {
    sums.middleCols(static_cast<Eigen::Index>(line[t]) * number, number) +=
        by_taxel.middleCols(static_cast<Eigen::Index>(t) * number, number) /
        std::sqrt(std::max(1.0, members[line[t]]));
  }
  const Outcome outcome = flipSigns(sums, with_.draws, stream(simulation::name(covariate)));
  const auto taxels = static_cast<double>(with_.measured.usedTaxels());
  add(simulation::name(covariate), "sign_flips", outcome, outcome.beyond / samples_ / taxels);
}

void Tester::testPlaces() {
  const Measured& measured = with_.measured;
  if (cycles_.size() < CovariateTests::kFewestExchangeable || measured.usedTaxels() < kFewTaxels) return;
  Eigen::Index number = 0;
  const Eigen::MatrixXd by_taxel = deviations(number);
  std::vector<std::size_t> row, column, taxel;
  for (std::size_t t = 0; t < measured.taxels(); ++t) {
    row.push_back(measured.layout.row({t}));
    column.push_back(measured.layout.column({t}));
    taxel.push_back(t);
  }
  testLines(simulation::Covariate::kRow, by_taxel, number, row);
  testLines(simulation::Covariate::kColumn, by_taxel, number, column);
  testLines(simulation::Covariate::kTaxel, by_taxel, number, taxel);
}

void Tester::testFromCycleToCycle() {
  const CycleLevels levels(with_.measured, with_.fit, with_.fit.residual(with_.common.all));
  for (const CycleLevels::Course& course : levels.courses()) {
    const statistics::RandomStream chance = stream(simulation::name(course.covariate));
    std::vector<double> by_chance;
    for (std::uint64_t draw = 0; draw < with_.draws; ++draw) {
      by_chance.push_back(levels.statistic(levels.drawn(chance, draw), course));
    }
    const Outcome outcome = outcomeOf(levels.statistic(levels.measured(), course), by_chance);
    add(simulation::name(course.covariate), "block_bootstrap", outcome, levels.explained(course));
  }
}

std::vector<CovariateTest> Tester::run() {
  const Columns direction = columnsOf("direction x pressure");
  for (const char* family :
       {"direction x pressure", "pressure_rate", "time_since_reversal", "previous_extremes"})
    testWithinCycles(family, {columnsOf(family), {}});
  testWithinCycles(simulation::name(simulation::Covariate::kCurvature),
                   {columnsOf("direction x pressure x curvature"), direction});
  testPlaces();
  testFromCycleToCycle();
  std::vector<double> p;
  for (const CovariateTest& test : tests_) p.push_back(test.p);
  const std::vector<double> adjusted = statistics::benjaminiYekutieli(p);
  for (std::size_t t = 0; t < tests_.size(); ++t) {
    tests_[t].adjusted = adjusted[t];
    tests_[t].depends = adjusted[t] <= kLevel && tests_[t].share_of_error >= thresholds::kLeastShareOfError;
  }
  return tests_;
}

}  // namespace

std::vector<CovariateTest> CovariateTests::run() const {
  return Tester(*this).run();
}

}  // namespace fsr::discrepancy
