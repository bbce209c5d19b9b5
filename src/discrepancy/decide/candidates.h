#pragma once

#include <memory>
#include <string>
#include <vector>

#include "discrepancy/decide/cross_validation.h"
#include "discrepancy/fit/generic_terms.h"
#include "discrepancy/fit/signatures.h"

namespace fsr::discrepancy {

/// The explanations that compete for the residual of the common trace after the static curves.
class Candidates {
 public:
  Candidates(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
             std::vector<Signature> signatures, unsigned threads);

  const std::vector<Family>& effects() const { return effects_; }
  const std::vector<Family>& generics() const { return generics_; }
  const std::vector<simulation::Covariate>& covariates(std::size_t generic) const {
    return covariates_[generic];
  }
  const std::vector<Signature>& signatures() const { return signatures_; }
  /// Description of an effect in the library.
  const simulation::EffectInfo& info(const std::string& id) const { return measured_.info(id); }
  const CrossValidation& crossValidation() const { return *cross_validation_; }
  const CycleGrams& grams() const { return *grams_; }
  /// The chosen columns after projection [samples x chosen]. Signatures come before generic terms.
  Eigen::MatrixXd columns(const std::vector<Eigen::Index>& chosen) const;

  /// Share of the squared error that an explanation could explain. It is the part that repeats between the
  /// two halves of the taxels and between samples more than one second apart. 0 where nothing repeats.
  double repeating() const { return repeating_; }

  /// Mean squared error of the common trace [share of full scale, squared].
  double meanSquare() const { return mean_square_; }

  /// Contribution of an explanation to the common trace, after projection.
  Trace explained(const Score& score) const;
  /// The same with coefficients that are fitted without some cycles. `cycles` has one flag for each cycle;
  /// true = left out.
  Trace explainedWithout(const Score& score, const std::vector<bool>& cycles) const;
  /// The common trace after projection.
  Trace target() const { return columns_.col(columns_.cols() - 1); }

 private:
  void gather(const StaticFit& fit, const Measured& measured);
  Trace explainedBy(const ColumnSet& set, const Eigen::VectorXd& coefficients) const;
  void judgeRepeating(const Measured& measured, const CommonTraces& common, const StaticFit& fit);

  const Measured& measured_;
  std::vector<Signature> signatures_;
  std::vector<Family> effects_, generics_;
  std::vector<std::vector<simulation::Covariate>> covariates_;  // of each generic family
  Eigen::MatrixXd columns_;  // [samples x columns], the last one is the target
  std::unique_ptr<CycleGrams> grams_;
  std::unique_ptr<CrossValidation> cross_validation_;
  double repeating_ = 0;
  double mean_square_ = 0;
};

/// Whether the traces of an effect depend only on variables that the static curve depends on. Under a uniform
/// load such an effect cannot be distinguished from the static curve.
bool isStatic(const simulation::EffectInfo& info);

}  // namespace fsr::discrepancy
