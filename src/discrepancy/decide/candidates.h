#pragma once

#include <memory>
#include <string>
#include <vector>

#include "discrepancy/decide/cross_validation.h"
#include "discrepancy/fit/generic_terms.h"
#include "discrepancy/fit/signatures.h"

namespace fsr::discrepancy {

/// The explanations that compete for what the static curves leave of the common trace.
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
  /// What the library says about an effect.
  const simulation::EffectInfo& info(const std::string& id) const { return measured_.info(id); }
  const CrossValidation& crossValidation() const { return *cross_validation_; }
  const CycleGrams& grams() const { return *grams_; }
  /// Some of the projected columns, signatures before generic terms, [samples x chosen].
  Eigen::MatrixXd columns(const std::vector<Eigen::Index>& chosen) const;

  /// Share of the squared error that repeats from one half of the taxels to the other and from one
  /// sample to one a second later: what anything could explain. 0 where nothing is hidden.
  double repeating() const { return repeating_; }

  /// Mean squared error of the common trace [share of full scale, squared].
  double meanSquare() const { return mean_square_; }

  /// What an explanation adds to the common trace, projected.
  Trace explained(const Score& score) const;
  /// The same with coefficients that have not seen some cycles, of which there is one flag each.
  Trace explainedWithout(const Score& score, const std::vector<bool>& cycles) const;
  /// The projected common trace.
  Trace target() const { return columns_.col(columns_.cols() - 1); }

 private:
  void gather(const StaticFit& fit, const Measured& measured);
  Trace explainedBy(const ColumnSet& set, const Eigen::VectorXd& coefficients) const;
  void judgeRepeating(const Measured& measured, const CommonTraces& common, const StaticFit& fit);

  const Measured& measured_;
  std::vector<Signature> signatures_;
  std::vector<Family> effects_, generics_;
  std::vector<std::vector<simulation::Covariate>> covariates_;  // of each generic
  Eigen::MatrixXd columns_;  // [samples x columns], the last one the target
  std::unique_ptr<CycleGrams> grams_;
  std::unique_ptr<CrossValidation> cross_validation_;
  double repeating_ = 0;
  double mean_square_ = 0;
};

/// Whether the traces of an effect depend on nothing but where the static curve depends on: under a
/// uniform load they cannot be told from it.
bool isStatic(const simulation::EffectInfo& info);

}  // namespace fsr::discrepancy
