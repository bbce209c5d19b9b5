#include "discrepancy/decide/held_out_scores.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "matrix/for_each_taxel.h"
#include "statistics/random_stream.h"
#include "statistics/signed_least_squares.h"

namespace fsr::discrepancy {

namespace {

using Index = Eigen::Index;

// Exponents of ten of the prior variances that are tried [share of full scale, squared].
constexpr double kLowest = -14, kHighest = 1, kGridStep = 0.5;
constexpr double kFineStep = 0.02;       // likewise, for the interval of a prior variance
constexpr double kWithin95 = 3.841 / 2;  // nats below the largest likelihood: chi-squared of one degree

// The prior variances that are tried.
const Eigen::ArrayXd& triedVariances() {
  static const Eigen::ArrayXd tried = [] {
    const auto number = static_cast<Index>(std::lround((kHighest - kLowest) / kGridStep)) + 1;
    return Eigen::ArrayXd(Eigen::pow(10.0, Eigen::ArrayXd::LinSpaced(number, kLowest, kHighest)));
  }();
  return tried;
}

// Fits columns whose coefficients may have either sign.
class FreeFitter {
 public:
  explicit FreeFitter(const Eigen::MatrixXd& gram) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
    values_ = solver.eigenvalues().cwiseMax(0.0);
    vectors_ = solver.eigenvectors();
    const Eigen::ArrayXd& tried = triedVariances();
    const Eigen::ArrayXXd grown = 1 + (tried.matrix() * values_.matrix().transpose()).array();
    shrunk_ = (grown.inverse().colwise() * tried).matrix();
    width_ = grown.log().rowwise().sum();
  }

  FormFit fit(const Eigen::VectorXd& right) const {
    FormFit fit;
    fit.coefficients.setZero(right.size());
    const Eigen::VectorXd turned = vectors_.transpose() * right;
    const Eigen::ArrayXd pull = turned.array().square();
    Index best;
    const double likelihood =
        (0.5 * ((shrunk_ * pull.matrix()).array() - width_)).maxCoeff(&best);  // above that of nothing [nats]
    if (likelihood <= fit.likelihood) return fit;
    fit.likelihood = likelihood;
    fit.variance = triedVariances()[best];
    fit.coefficients = vectors_ * (fit.variance / (1 + fit.variance * values_) * turned.array()).matrix();
    return fit;
  }

  PriorVariance variance(const Eigen::VectorXd& right) const {
    const Eigen::ArrayXd pull = (vectors_.transpose() * right).array().square();
    PriorVariance found;
    double most = 0;
    for (double e = kLowest; e <= kHighest; e += kFineStep) {
      const double likelihood = likelihoodAt(std::pow(10, e), pull);
      if (likelihood > most) most = likelihood, found.best = std::pow(10, e);
    }
    found.low = most < kWithin95 ? 0 : found.best;
    for (double e = kLowest; e <= kHighest; e += kFineStep) {
      const double variance = std::pow(10, e);
      if (likelihoodAt(variance, pull) < most - kWithin95) continue;
      found.low = std::min(found.low, variance);
      found.high = variance;
    }
    return found;
  }

 private:
  // Above that of nothing [nats].
  double likelihoodAt(double variance, const Eigen::ArrayXd& pull) const {
    const Eigen::ArrayXd grown = 1 + variance * values_;
    return 0.5 * (variance * pull / grown - grown.log()).sum();
  }

  Eigen::ArrayXd values_;
  Eigen::MatrixXd vectors_;
  Eigen::MatrixXd shrunk_;  // weight of each squared pull under each tried variance
  Eigen::ArrayXd width_;    // logarithm of the determinant under each tried variance
};

Eigen::MatrixXd among(const Eigen::MatrixXd& gram, const std::vector<Index>& chosen) {
  const auto size = static_cast<Index>(chosen.size());
  Eigen::MatrixXd part(size, size);
  for (Index a = 0; a < size; ++a) {
    for (Index b = 0; b < size; ++b)
      part(a, b) = gram(chosen[static_cast<std::size_t>(a)], chosen[static_cast<std::size_t>(b)]);
  }
  return part;
}

// A form whose Gram matrix is decomposed, so that many right sides are fitted quickly. Where signs are bound,
// the columns that take part are found by least squares with signs, and only these are fitted.
class FormFitter {
 public:
  FormFitter(Eigen::MatrixXd gram, std::vector<bool> free)
      : gram_(std::move(gram)),
        free_(std::move(free)),
        all_free_(std::count(free_.begin(), free_.end(), false) == 0),
        whole_(gram_) {}

  FormFit fit(const Eigen::VectorXd& right) const {
    if (all_free_) return whole_.fit(right);
    if (right.size() == 1) return right[0] > 0 ? whole_.fit(right) : nothing(1);
    std::vector<Index> chosen = supportOf(right);
    while (!chosen.empty()) {
      Eigen::VectorXd own(static_cast<Index>(chosen.size()));
      for (std::size_t k = 0; k < chosen.size(); ++k) own[static_cast<Index>(k)] = right[chosen[k]];
      FormFit fit = FreeFitter(among(gram_, chosen)).fit(own);
      const auto negative = [&](std::size_t k) {
        return !free_[static_cast<std::size_t>(chosen[k])] && fit.coefficients[static_cast<Index>(k)] < 0;
      };
      std::vector<Index> kept;
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        if (!negative(k)) kept.push_back(chosen[k]);
      }
      if (kept.size() == chosen.size()) {
        const Eigen::VectorXd few = fit.coefficients;
        fit.coefficients.setZero(right.size());
        for (std::size_t k = 0; k < chosen.size(); ++k)
          fit.coefficients[chosen[k]] = few[static_cast<Index>(k)];
        return fit;
      }
      chosen = kept;
    }
    return nothing(right.size());
  }

 private:
  static FormFit nothing(Index size) {
    FormFit fit;
    fit.coefficients.setZero(size);
    return fit;
  }
  std::vector<Index> supportOf(const Eigen::VectorXd& right) const {
    Eigen::MatrixXd gram = gram_;
    gram.diagonal() *= 1 + 1e-6;
    gram.diagonal().array() += 1e-300;
    const Eigen::VectorXd fitted = statistics::solveSigned(gram, right, free_);
    std::vector<Index> support;
    for (Index k = 0; k < fitted.size(); ++k) {
      if (fitted[k] != 0) support.push_back(k);
    }
    return support;
  }

  Eigen::MatrixXd gram_;
  std::vector<bool> free_;
  bool all_free_;
  FreeFitter whole_;
};

void addTo(Eigen::MatrixXd& sum, const std::vector<Index>& rows, const Eigen::MatrixXd& part) {
  for (std::size_t a = 0; a < rows.size(); ++a) sum.row(rows[a]) += part.row(static_cast<Index>(a));
}

double logOfSum(double a, double b) {  // of exp(a) + exp(b); b is finite
  return std::max(a, b) + std::log1p(std::exp(-std::abs(a - b)));
}

// What a form that was fitted to other cycles predicts: its coefficients at the posterior mode, and their
// covariance. `gram`: of the fit. Columns that signs leave out predict nothing.
class FormPrediction {
 public:
  FormPrediction(const Eigen::MatrixXd& gram, const FormFit& fit) : mean_(fit.coefficients) {
    for (Index k = 0; k < mean_.size(); ++k) {
      if (mean_[k] != 0) used_.push_back(k);
    }
    precision_ = among(gram, used_);
    precision_.diagonal().array() += 1 / fit.variance;
    root_ = sumOfLogs(Eigen::LLT<Eigen::MatrixXd>(precision_));
  }

  // What it adds to the logarithm of the predictive density of a cycle [nats]. `columns`, `error`: whitened,
  // the statics subtracted.
  double nats(const Eigen::MatrixXd& columns, const Eigen::VectorXd& error) const {
    const Eigen::VectorXd predicted = columns * mean_, left = error - predicted;
    const Eigen::MatrixXd used = columns(Eigen::all, used_);
    const Eigen::LLT<Eigen::MatrixXd> after(precision_ + used.transpose() * used);
    const Eigen::VectorXd pull = after.matrixL().solve(used.transpose() * left);
    return predicted.dot(error) - 0.5 * predicted.squaredNorm() + 0.5 * pull.squaredNorm() + root_ -
           sumOfLogs(after);
  }

 private:
  static double sumOfLogs(const Eigen::LLT<Eigen::MatrixXd>& root) {
    return root.matrixLLT().diagonal().array().log().sum();
  }

  Eigen::VectorXd mean_;
  std::vector<Index> used_;
  Eigen::MatrixXd precision_;
  double root_ = 0;  // half the logarithm of the determinant of the precision
};

Eigen::MatrixXd rowsOf(const Eigen::MatrixXd& matrix, const std::vector<Index>& rows) {
  Eigen::MatrixXd chosen(static_cast<Index>(rows.size()), matrix.cols());
  for (std::size_t a = 0; a < rows.size(); ++a) chosen.row(static_cast<Index>(a)) = matrix.row(rows[a]);
  return chosen;
}

}  // namespace

FormFit fitForm(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right, const std::vector<bool>& free) {
  return FormFitter(gram, free).fit(right);
}

HeldOutScores::HeldOutScores(const CycleDesign& design, const CycleNoise& noise, const StaticModel& model,
                             const std::vector<Explaining>& explanations, std::size_t folds, double degrees)
    : design_(design),
      model_(model),
      explanations_(explanations),
      cycles_(design.cycles.size()),
      fold_number_(folds),
      degrees_(degrees) {
  chooseColumns();
  assignFolds();
  cover();
  whiten(noise, model);
  solveFolds();
  score();
}

// Only columns of some form are computed with.
void HeldOutScores::chooseColumns() {
  place_.assign(static_cast<std::size_t>(2 * design_.columns), -1);
  for (const Explaining& explanation : explanations_) {
    first_form_.push_back(forms_.size());
    for (const Form& form : explanation.forms) {
      forms_.push_back(&form);
      for (const Index column : form.columns) {
        Index& place = place_[static_cast<std::size_t>(column + (form.bent_only ? design_.columns : 0))];
        if (place >= 0) continue;
        place = static_cast<Index>(used_.size());
        used_.push_back({column, form.bent_only});
      }
    }
  }
}

// Interleaved, so that every fold leaves cycles of each surface.
void HeldOutScores::assignFolds() {
  for (std::size_t c = 0; c < cycles_.size(); ++c) cycles_[c].fold = c % fold_number_;
}

// A held-out bin counts only within the pressures that the other folds covered on its surface.
void HeldOutScores::cover() {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<std::vector<double>> low(fold_number_, std::vector<double>(design_.classes, kNone)), high = low;
  for (auto& of_fold : high) std::fill(of_fold.begin(), of_fold.end(), -kNone);
  for (std::size_t c = 0; c < cycles_.size(); ++c) {
    const CycleBins& bins = design_.cycles[c];
    for (std::size_t f = 0; f < fold_number_; ++f) {
      if (f == cycles_[c].fold) continue;
      double& l = low[f][bins.curvature_class];
      double& h = high[f][bins.curvature_class];
      l = std::min(l, bins.pressure.minCoeff());
      h = std::max(h, bins.pressure.maxCoeff());
    }
  }
  for (std::size_t c = 0; c < cycles_.size(); ++c) {
    const CycleBins& bins = design_.cycles[c];
    const double l = low[cycles_[c].fold][bins.curvature_class];
    const double h = high[cycles_[c].fold][bins.curvature_class];
    for (Index b = 0; b < bins.bins(); ++b) {
      if (bins.pressure[b] >= l && bins.pressure[b] <= h) cycles_[c].covered.push_back(b);
    }
  }
}

void HeldOutScores::whiten(const CycleNoise& noise, const StaticModel& model) {
  for (std::size_t c = 0; c < cycles_.size(); ++c) {
    const CycleBins& bins = design_.cycles[c];
    Whitened& w = cycles_[c];
    const Eigen::MatrixXd covariance = noise.covariance(bins, design_.cycle_time);
    const Eigen::MatrixXd statics = model.columns(bins);
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(bins.bins(), static_cast<Index>(used_.size()));
    for (std::size_t k = 0; k < used_.size(); ++k) {
      if (used_[k].bent_only && design_.flat[bins.curvature_class]) continue;
      columns.col(static_cast<Index>(k)) = bins.columns.col(used_[k].column);
    }
    w.places = model.places(bins);
    const Eigen::LLT<Eigen::MatrixXd> root(covariance);
    w.root = root.matrixL();
    w.statics = root.matrixL().solve(statics);
    w.columns = root.matrixL().solve(columns);
    w.reading = root.matrixL().solve(bins.reading);
    if (w.covered.empty()) continue;
    w.test_root = among(covariance, w.covered);
    w.test_statics = rowsOf(statics, w.covered);
    w.test_columns = rowsOf(columns, w.covered);
    w.test_reading = rowsOf(bins.reading, w.covered);
  }
}

// Whitens a cycle that the static model was not fitted to. Beside the noise there is what the other cycles
// leave open in the static model: the curve at its ends, or the gain of a mounting that has no other cycle.
// `inverse`: covariance of the statics, given the cycles of the other folds.
void HeldOutScores::whitenTest(Whitened& w, const Eigen::MatrixXd& inverse) {
  const Eigen::LLT<Eigen::MatrixXd> root(w.test_root + w.test_statics * among(inverse, w.places) *
                                                           w.test_statics.transpose());
  w.test_root = root.matrixL();
  root.matrixL().solveInPlace(w.test_statics);
  root.matrixL().solveInPlace(w.test_columns);
  root.matrixL().solveInPlace(w.test_reading);
}

// Sums of products over the cycles of one fold.
struct HeldOutScores::Products {
  Eigen::MatrixXd statics, mixed;                  // of the statics, with the columns
  Grams forms;                                     // of the columns of each form
  Eigen::VectorXd static_reading, column_reading;  // with the reading

  Products(Index statics_number, Index columns_number, Grams nothing)
      : statics(Eigen::MatrixXd::Zero(statics_number, statics_number)),
        mixed(Eigen::MatrixXd::Zero(statics_number, columns_number)),
        forms(std::move(nothing)),
        static_reading(Eigen::VectorXd::Zero(statics_number)),
        column_reading(Eigen::VectorXd::Zero(columns_number)) {}

  void operator+=(const Products& other) {
    statics += other.statics;
    mixed += other.mixed;
    for (std::size_t i = 0; i < forms.size(); ++i) forms[i] += other.forms[i];
    static_reading += other.static_reading;
    column_reading += other.column_reading;
  }
};

// Columns of different forms are never fitted together, so their products are not needed.
void HeldOutScores::addGrams(const Eigen::MatrixXd& columns, Grams& sums) const {
  for (std::size_t i = 0; i < forms_.size(); ++i) {
    const Eigen::MatrixXd own = columnsOf(columns, *forms_[i]);
    sums[i] += own.transpose() * own;
  }
}

HeldOutScores::Grams HeldOutScores::noGrams() const {
  Grams nothing;
  for (const Form* form : forms_) {
    const auto size = static_cast<Index>(form->columns.size());
    nothing.push_back(Eigen::MatrixXd::Zero(size, size));
  }
  return nothing;
}

std::vector<HeldOutScores::Products> HeldOutScores::productsOfFolds() const {
  std::vector<Products> of_fold(fold_number_,
                                Products(model_.size(), cycles_.front().columns.cols(), noGrams()));
  for (const Whitened& w : cycles_) {
    Products& sums = of_fold[w.fold];
    const Eigen::MatrixXd own = w.statics.transpose() * w.statics;
    const Eigen::VectorXd right = w.statics.transpose() * w.reading;
    for (std::size_t a = 0; a < w.places.size(); ++a) {
      sums.static_reading[w.places[a]] += right[static_cast<Index>(a)];
      for (std::size_t b = 0; b < w.places.size(); ++b)
        sums.statics(w.places[a], w.places[b]) += own(static_cast<Index>(a), static_cast<Index>(b));
    }
    addTo(sums.mixed, w.places, w.statics.transpose() * w.columns);
    addGrams(w.columns, sums.forms);
    sums.column_reading += w.columns.transpose() * w.reading;
  }
  return of_fold;
}

void HeldOutScores::solveFolds() {
  const Index statics = model_.size(), columns = cycles_.front().columns.cols();
  const std::vector<Products> of_fold = productsOfFolds();
  const Eigen::MatrixXd prior = model_.prior();
  folds_.resize(fold_number_);
  for (std::size_t f = 0; f <= fold_number_; ++f) {
    Fold& fold = f < fold_number_ ? folds_[f] : all_;
    Products others(statics, columns, noGrams());
    for (std::size_t other = 0; other < fold_number_; ++other) {
      if (other != f) others += of_fold[other];
    }
    const Eigen::MatrixXd gram_ss = others.statics + prior;
    fold.inverse = gram_ss.llt().solve(Eigen::MatrixXd::Identity(statics, statics));
    fold.solved = fold.inverse * others.mixed;
    fold.gram = others.forms;
    for (std::size_t i = 0; i < forms_.size(); ++i)
      fold.gram[i] -= columnsOf(others.mixed, *forms_[i]).transpose() * columnsOf(fold.solved, *forms_[i]);
    fold.right = others.column_reading - fold.solved.transpose() * others.static_reading;
    if (f == fold_number_) mixed_ = std::move(others.mixed);
    if (f == fold_number_) break;
    const Eigen::VectorXd curve = fold.inverse * others.static_reading;
    for (std::size_t c = 0; c < cycles_.size(); ++c) {
      Whitened& w = cycles_[c];
      if (w.fold != f || w.covered.empty()) continue;
      fold.tested.push_back(c);
      whitenTest(w, fold.inverse);
      Eigen::VectorXd own(static_cast<Index>(w.places.size()));
      for (std::size_t a = 0; a < w.places.size(); ++a) own[static_cast<Index>(a)] = curve[w.places[a]];
      w.test_net = w.test_columns - w.test_statics * rowsOf(fold.solved, w.places);
      w.test_error = w.test_reading - w.test_statics * own;
      loss_ += w.test_error.squaredNorm();
      expected_loss_ += static_cast<double>(w.covered.size());
    }
  }
}

Eigen::MatrixXd HeldOutScores::columnsOf(const Eigen::MatrixXd& all, const Form& form) const {
  Eigen::MatrixXd own(all.rows(), static_cast<Index>(form.columns.size()));
  for (std::size_t k = 0; k < form.columns.size(); ++k)
    own.col(static_cast<Index>(k)) = all.col(columnOf(form, k));
  return own;
}

// Over all cycles, the statics eliminated.
Eigen::MatrixXd HeldOutScores::gramOf(const Form& form) const {
  Eigen::MatrixXd gram = -columnsOf(mixed_, form).transpose() * columnsOf(all_.solved, form);
  for (const Whitened& w : cycles_) {
    const Eigen::MatrixXd own = columnsOf(w.columns, form);
    gram += own.transpose() * own;
  }
  return gram;
}

std::vector<Index> HeldOutScores::placesOf(const Form& form) const {
  std::vector<Index> places;
  for (std::size_t k = 0; k < form.columns.size(); ++k) places.push_back(columnOf(form, k));
  return places;
}

// The form of an explanation with the largest marginal likelihood in all cycles.
std::pair<FormFit, std::size_t> HeldOutScores::bestForm(std::size_t explanation) const {
  const std::vector<Form>& forms = explanations_[explanation].forms;
  std::pair<FormFit, std::size_t> best;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const FormFit fit = fitForm(all_.gram[first_form_[explanation] + i],
                                rowsOf(all_.right, placesOf(forms[i])), forms[i].free);
    if (i == 0 || fit.likelihood > best.first.likelihood) best = {fit, i};
  }
  return best;
}

void HeldOutScores::score() {
  std::vector<Eigen::MatrixXd> errors;
  for (const Whitened& w : cycles_) errors.push_back(w.test_error);
  for (std::size_t e = 0; e < explanations_.size(); ++e) {
    HeldOutScore score;
    score.nats.assign(cycles_.size(), 0.0);
    for (const Fold& fold : folds_) {
      const Eigen::MatrixXd nats = gains(fold, e, fold.right, errors);
      for (std::size_t k = 0; k < fold.tested.size(); ++k)
        score.nats[fold.tested[k]] = nats(static_cast<Index>(k), 0);
    }
    std::tie(score.fit, score.form) = bestForm(e);
    for (const double nats : score.nats) score.total += nats;
    if (explanations_[e].by_chance) score.total = score.fit.likelihood;
    scores_.push_back(score);
  }
}

// What an explanation adds to the logarithm of the predictive density of the cycles that are tested in a
// fold, for each of some readings [cycles x readings] [nats]. Its forms predict together, weighed by their
// marginal likelihoods in the other folds. `right`: products of the columns with the readings of the other
// folds. `errors`: of each cycle, the static model fitted to the other folds. Source: J. Hoeting et al.,
// Bayesian model averaging, Statistical Science 14 (1999) 382-417.
Eigen::MatrixXd HeldOutScores::gains(const Fold& fold, std::size_t explanation, const Eigen::MatrixXd& right,
                                     const std::vector<Eigen::MatrixXd>& errors) const {
  const std::vector<Form>& forms = explanations_[explanation].forms;
  Eigen::MatrixXd nats = Eigen::MatrixXd::Constant(Index(fold.tested.size()), right.cols(), -INFINITY);
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(right.cols(), -INFINITY);
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const Eigen::MatrixXd& gram = fold.gram[first_form_[explanation] + i];
    const FormFitter fitter(gram, forms[i].free);
    const Eigen::MatrixXd own = rowsOf(right, placesOf(forms[i]));
    std::vector<Eigen::MatrixXd> columns;
    for (const std::size_t c : fold.tested) columns.push_back(columnsOf(cycles_[c].test_net, forms[i]));
    for (Index d = 0; d < right.cols(); ++d) {
      const FormFit fit = fitter.fit(own.col(d));
      weights[d] = logOfSum(weights[d], fit.likelihood);
      std::optional<FormPrediction> prediction;
      if (fit.variance > 0) prediction.emplace(gram, fit);
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const Eigen::MatrixXd& error = errors[fold.tested[k]];
        double& sum = nats(static_cast<Index>(k), d);
        sum = logOfSum(sum, fit.likelihood + (prediction ? prediction->nats(columns[k], error.col(d)) : 0));
      }
    }
  }
  return nats.rowwise() - weights.transpose();
}

// Noise, one column for each draw.
struct HeldOutScores::Drawn {
  Eigen::MatrixXd statics;  // products of the whitened statics with it, of each static [all cycles of a fold]
  Eigen::MatrixXd columns;  // likewise, of the explanations' columns
};

std::vector<HeldOutScores::Drawn> HeldOutScores::draw(Index draws, std::uint64_t seed,
                                                      std::vector<Eigen::MatrixXd>& test) const {
  const Index statics = all_.inverse.rows(), columns = all_.right.size();
  const Drawn nothing{Eigen::MatrixXd::Zero(statics, draws), Eigen::MatrixXd::Zero(columns, draws)};
  std::vector<Drawn> drawn(fold_number_, nothing);
  for (std::size_t c = 0; c < cycles_.size(); ++c) {
    const Whitened& w = cycles_[c];
    const statistics::RandomStream stream = statistics::randomStream(seed, "discrepancy.null", c);
    Eigen::MatrixXd z(w.root.rows(), draws);
    for (Index i = 0; i < z.size(); ++i) z.data()[i] = stream.normal(static_cast<std::uint64_t>(i));
    addTo(drawn[w.fold].statics, w.places, w.statics.transpose() * z);
    drawn[w.fold].columns += w.columns.transpose() * z;
    test[c] = w.test_root.triangularView<Eigen::Lower>().solve(rowsOf(w.root * z, w.covered));
  }
  return drawn;
}

// The largest marginal likelihood of the forms of an explanation, for each draw.
std::vector<double> HeldOutScores::likelihoods(std::size_t explanation, const Eigen::MatrixXd& right) const {
  std::vector<double> largest(static_cast<std::size_t>(right.cols()), 0.0);
  for (std::size_t i = 0; i < explanations_[explanation].forms.size(); ++i) {
    const Form& form = explanations_[explanation].forms[i];
    const FormFitter fitter(all_.gram[first_form_[explanation] + i], form.free);
    const Eigen::MatrixXd own_right = rowsOf(right, placesOf(form));
    for (std::size_t d = 0; d < largest.size(); ++d)
      largest[d] = std::max(largest[d], fitter.fit(own_right.col(static_cast<Index>(d))).likelihood);
  }
  return largest;
}

NullScores HeldOutScores::nullScores(std::size_t draws, std::uint64_t seed, unsigned threads) const {
  std::vector<Eigen::MatrixXd> errors(cycles_.size());  // of each cycle, one column for each draw
  const std::vector<Drawn> drawn = draw(static_cast<Index>(draws), seed, errors);
  Drawn all = drawn.front();
  for (std::size_t f = 1; f < fold_number_; ++f) {
    all.statics += drawn[f].statics;
    all.columns += drawn[f].columns;
  }
  NullScores null;
  null.of.assign(explanations_.size(), std::vector<double>(draws, 0.0));
  for (std::size_t f = 0; f < fold_number_; ++f) {
    const Fold& fold = folds_[f];
    const Eigen::MatrixXd statics = all.statics - drawn[f].statics;
    const Eigen::MatrixXd right = all.columns - drawn[f].columns - fold.solved.transpose() * statics;
    const Eigen::MatrixXd curves = fold.inverse * statics;
    for (const std::size_t c : fold.tested)
      errors[c] -= cycles_[c].test_statics * rowsOf(curves, cycles_[c].places);
    matrix::forEachTaxel(explanations_.size(), threads, [&](std::size_t e) {
      if (explanations_[e].by_chance) return;
      const Eigen::RowVectorXd sums = gains(fold, e, right, errors).colwise().sum();
      for (std::size_t d = 0; d < draws; ++d) null.of[e][d] += sums[static_cast<Index>(d)];
    });
  }
  const Eigen::MatrixXd right = all.columns - all_.solved.transpose() * all.statics;
  matrix::forEachTaxel(explanations_.size(), threads, [&](std::size_t e) {
    if (explanations_[e].by_chance) null.of[e] = likelihoods(e, right);
  });
  null.largest.assign(draws, 0.0);
  for (std::size_t e = 0; e < explanations_.size(); ++e) {
    std::vector<double>& totals = null.of[e];
    for (std::size_t d = 0; d < draws && !explanations_[e].by_chance; ++d)
      null.largest[d] = std::max(null.largest[d], totals[d]);
    std::sort(totals.begin(), totals.end());
  }
  std::sort(null.largest.begin(), null.largest.end());
  return null;
}

FormFit HeldOutScores::fitAll(const Form& form) const {
  return fitForm(gramOf(form), rowsOf(all_.right, placesOf(form)), form.free);
}

PriorVariance HeldOutScores::varianceOf(const Form& form) const {
  return FreeFitter(gramOf(form)).variance(rowsOf(all_.right, placesOf(form)));
}

double HeldOutScores::density(std::size_t cycle, double nats) const {
  const Whitened& w = cycles_[cycle];
  if (w.covered.empty()) return 0;
  const auto bins = static_cast<double>(w.covered.size());
  const double square = std::max(0.0, w.test_error.squaredNorm() - 2 * nats);
  return -w.test_root.diagonal().array().log().sum() -
         0.5 * (degrees_ + bins) * std::log(1 + square / degrees_);
}

double HeldOutScores::information(Index column) const {
  return gramOf({{column}, {true}})(0, 0);
}

}  // namespace fsr::discrepancy
