#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/fit/cycle_design.h"
#include "discrepancy/fit/cycle_noise.h"

namespace fsr::discrepancy {

/// Coefficients of a form, and the prior variance that they were fitted with.
struct FormFit {
  Eigen::VectorXd coefficients;
  double variance = 0;    ///< of each coefficient before the data; 0 = the form explains nothing
  double likelihood = 0;  ///< logarithm of the marginal likelihood above that of nothing [nats]
};

/// The prior variance of a form's coefficients, with the 95 % interval of its marginal likelihood.
struct PriorVariance {
  double best = 0, low = 0, high = 0;
};

/// Fits a form by empirical Bayes: the prior variance maximises the marginal likelihood; then the
/// coefficients are the posterior mode, never negative where they are not free. `gram` and `right` are the
/// normal equations after the static model was eliminated. Source: D. MacKay, Bayesian interpolation, Neural
/// Computation 4 (1992) 415-447.
FormFit fitForm(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right, const std::vector<bool>& free);

/// What an explanation adds to the logarithm of the predictive density of cycles that it was not fitted to.
struct HeldOutScore {
  std::vector<double> nats;  ///< of each cycle of the design
  /// Their sum. Of a random course: the logarithm of its marginal likelihood above that of nothing.
  double total = 0;
  std::size_t form = 0;  ///< the one that counts when all cycles are fitted
  FormFit fit;           ///< likewise
};

/// Scores of explanations in recordings that hold the static model and the noise alone, sorted.
struct NullScores {
  std::vector<double> largest;          ///< over all explanations but random courses, one of each draw [nats]
  std::vector<std::vector<double>> of;  ///< of each explanation
};

/// Scores of explanations against the static model, by cross-validation over the cycles.
class HeldOutScores {
 public:
  /// `folds`: of the cycles, interleaved. `degrees`: of freedom of density().
  HeldOutScores(const CycleDesign& design, const CycleNoise& noise, const StaticModel& model,
                const std::vector<Explaining>& explanations, std::size_t folds, double degrees);

  const std::vector<HeldOutScore>& scores() const { return scores_; }
  /// Logarithm of the predictive density of a cycle, without constants, after a score has changed it [nats].
  /// The density is that of Student's t: the noise of each cycle has a scale of its own, so that one odd
  /// cycle does not outweigh all others. Source: K. Lange, R. Little, J. Taylor, Robust statistical modeling
  /// using the t distribution, JASA 84 (1989) 881-896.
  double density(std::size_t cycle, double nats) const;

  /// Totals of the explanations in `draws` recordings that hold the static model and the noise alone.
  /// Parametric bootstrap; the largest over all explanations corrects for the search. Source: P. Westfall,
  /// S. Young, Resampling-based multiple testing, Wiley 1993.
  NullScores nullScores(std::size_t draws, std::uint64_t seed, unsigned threads) const;

  /// Fit of a form to all cycles. Its columns must be columns of some explanation.
  FormFit fitAll(const Form& form) const;
  /// The prior variance that all cycles give a form whose signs are free.
  PriorVariance varianceOf(const Form& form) const;

  /// Squared whitened error of the static model in cycles that it was not fitted to, and its expectation.
  double loss() const { return loss_; }
  double expectedLoss() const { return expected_loss_; }

  /// Information on a column's coefficient over all cycles, after the static model was eliminated. The column
  /// must be one of some form that does not act on bent surfaces alone.
  double information(Eigen::Index column) const;

 private:
  using Grams = std::vector<Eigen::MatrixXd>;  // products of the columns of each form
  struct Fold {
    Eigen::MatrixXd solved;   // prior-regularised statics' inverse times their products with the columns
    Eigen::MatrixXd inverse;  // of the regularised statics
    Grams gram;               // statics eliminated
    Eigen::VectorXd right;    // likewise, with the reading
    std::vector<std::size_t> tested;  // cycles that are predicted
  };
  struct Whitened {
    Eigen::MatrixXd root;              // Cholesky factor of the noise
    Eigen::MatrixXd statics, columns;  // of all bins
    Eigen::VectorXd reading;
    std::vector<Eigen::Index> places;
    std::vector<Eigen::Index> covered;           // bins within the pressures of the other folds
    Eigen::MatrixXd test_root;                   // of the covariance of those bins, given the other folds
    Eigen::MatrixXd test_statics, test_columns;  // whitened, of those bins
    Eigen::VectorXd test_reading;
    Eigen::MatrixXd test_net;    // columns less statics times `solved`
    Eigen::VectorXd test_error;  // reading less the fitted statics
    std::size_t fold = 0;
  };
  struct UsedColumn {
    Eigen::Index column = 0;  // of the design
    bool bent_only = false;
  };
  struct Drawn;
  struct Products;
  std::vector<Drawn> draw(Eigen::Index draws, std::uint64_t seed, std::vector<Eigen::MatrixXd>& test) const;
  Eigen::MatrixXd gains(const Fold& fold, std::size_t explanation, const Eigen::MatrixXd& right,
                        const std::vector<Eigen::MatrixXd>& errors) const;
  std::vector<double> likelihoods(std::size_t explanation, const Eigen::MatrixXd& right) const;
  void chooseColumns();
  void whiten(const CycleNoise& noise, const StaticModel& model);
  void assignFolds();
  void cover();
  static void whitenTest(Whitened& cycle, const Eigen::MatrixXd& inverse);
  std::vector<Products> productsOfFolds() const;
  void solveFolds();
  std::pair<FormFit, std::size_t> bestForm(std::size_t explanation) const;
  void score();
  Eigen::Index columnOf(const Form& form, std::size_t k) const {
    return place_[static_cast<std::size_t>(form.columns[k] + (form.bent_only ? design_.columns : 0))];
  }
  Eigen::MatrixXd columnsOf(const Eigen::MatrixXd& all, const Form& form) const;
  Eigen::MatrixXd gramOf(const Form& form) const;
  void addGrams(const Eigen::MatrixXd& columns, Grams& sums) const;
  Grams noGrams() const;
  std::vector<Eigen::Index> placesOf(const Form& form) const;

  const CycleDesign& design_;
  const StaticModel model_;
  const std::vector<Explaining>& explanations_;
  std::vector<const Form*> forms_;       // of all explanations
  std::vector<std::size_t> first_form_;  // among those, of each explanation
  std::vector<UsedColumn> used_;
  std::vector<Eigen::Index> place_;  // among those, of each column of the design; -1 = not used
  std::vector<Whitened> cycles_;
  std::vector<Fold> folds_;
  Fold all_;               // without test
  Eigen::MatrixXd mixed_;  // products of the statics with the columns over all cycles
  std::vector<HeldOutScore> scores_;
  std::size_t fold_number_;
  double degrees_;
  double loss_ = 0, expected_loss_ = 0;
};

}  // namespace fsr::discrepancy
