#pragma once

#include <string>
#include <vector>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/samples/available_evidence.h"

namespace fsr::discrepancy {

/// An explanation by one effect or two, as signatures and, where it came near, through the forward model.
struct Explanation {
  Score score;
  double share = 0;  ///< of the common trace's error that it explains; the better of the two
  bool is_refined = false;
  Refined refined;

  bool has(const std::string& id) const;
};

/// Every single explanation, and the measures by which explanations are compared: what each explains of
/// cycles that took no part in its fit, and how sure one is ahead of another.
class Comparison {
 public:
  Comparison(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
             const TaxelFit& taxels, const Candidates& candidates,
             const simulation::SimulationSettings& base);

  const Candidates& candidates() const { return candidates_; }
  const CrossValidation& crossValidation() const { return candidates_.crossValidation(); }
  const simulation::EffectLibrary& library() const { return measured_.effects(); }
  /// What the library says about an effect.
  const simulation::EffectInfo& infoOf(const std::string& id) const { return measured_.info(id); }
  const AvailableEvidence& evidence() const { return evidence_; }
  const std::vector<Explanation>& singles() const { return singles_; }
  std::vector<Explanation>& singles() { return singles_; }
  const std::vector<Score>& generics() const { return generics_; }
  std::vector<simulation::Covariate> covariates(const Score& generic) const;

  /// Share of the common trace's error that anything explains.
  double explainable() const { return explainable_; }
  void raiseExplainable(double share);

  const Explanation* best() const;   ///< of the single effects; null without any
  const Score* bestGeneric() const;  ///< null without any
  /// Of the generic terms that do nearly as well as the best those with the fewest covariates: more are not
  /// said to matter unless they do.
  const Score* simplestGeneric() const;

  /// What it explains of the common trace's error.
  double shareOf(const Score& score) const {
    return CrossValidation::share(crossValidation().nothing(), score);
  }
  /// Of the readings' squared error, where the cycles' gains count in full, as far as it holds on cycles that
  /// took no part.
  double shareOfError(const Score& score) const;
  /// A share of the common trace's error as one of the readings'.
  double shareOfReadings(double share) const;
  /// Whether it stands out from noise and from what is too small to matter.
  bool shows(const Score& score) const;
  bool shows(const Explanation& explanation) const;
  double z(const Score& score) const { return crossValidation().z(crossValidation().nothing(), score); }
  /// By how many standard errors `worse` is behind; see Selection::z().
  double behindInErrors(const Explanation& worse, const Explanation& better) const;

  /// What the effects explain together with the generic terms of their own covariates that add most to them:
  /// what some form of them may explain.
  Score inAnyForm(const Explanation& explanation) const;
  /// Whether each of the covariates is one that the effects depend on.
  bool within(const std::vector<simulation::Covariate>& covariates, const Score& effects) const;

  /// Fits it through the forward model, once.
  void refineOne(Explanation& explanation) const;
  /// Those single effects that may yet be the best; none where the best has no rival worth the time.
  void refineNear();

 private:
  Trace leftBy(const Explanation& explanation) const;

  const Measured& measured_;
  const CommonTraces& common_;
  const StaticFit& fit_;
  const TaxelFit& taxels_;
  const Candidates& candidates_;
  const simulation::SimulationSettings& base_;
  const AvailableEvidence evidence_;
  std::vector<Explanation> singles_;
  std::vector<Score> generics_;
  double explainable_ = 0;
};

}  // namespace fsr::discrepancy
