#pragma once

#include <string>
#include <vector>

#include "discrepancy/decide/candidates.h"
#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/samples/available_evidence.h"

namespace fsr::discrepancy {

/// An explanation by one or two effects. It is fitted with signatures and, where it comes near the best, also
/// through the forward model.
struct Explanation {
  Score score;
  double share = 0;  ///< of the common trace's error that it explains; the larger share of the two fits
  bool is_refined = false;
  Refined refined;

  bool has(const std::string& id) const;
};

/// All explanations by a single effect, and the measures that compare explanations. One measure is the share
/// that an explanation explains in cycles that it was not fitted to. The other is the difference between two
/// explanations in standard errors.
class Comparison {
 public:
  Comparison(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
             const TaxelFit& taxels, const Candidates& candidates,
             const simulation::SimulationSettings& base);

  const Candidates& candidates() const { return candidates_; }
  const CrossValidation& crossValidation() const { return candidates_.crossValidation(); }
  const simulation::EffectLibrary& library() const { return measured_.effects(); }
  /// Description of an effect in the library.
  const simulation::EffectInfo& infoOf(const std::string& id) const { return measured_.info(id); }
  const AvailableEvidence& evidence() const { return evidence_; }
  const std::vector<Explanation>& singles() const { return singles_; }
  std::vector<Explanation>& singles() { return singles_; }
  const std::vector<Score>& generics() const { return generics_; }
  std::vector<simulation::Covariate> covariates(const Score& generic) const;

  /// Share of the common trace's error that is explainable.
  double explainable() const { return explainable_; }
  void raiseExplainable(double share);

  const Explanation* best() const;   ///< of the single effects; null without any
  const Score* bestGeneric() const;  ///< null without any
  /// The generic terms with the fewest covariates among those that do nearly as well as the best. A covariate
  /// is reported only where it is needed.
  const Score* simplestGeneric() const;

  /// Share of the common trace's error that it explains.
  double shareOf(const Score& score) const {
    return CrossValidation::share(crossValidation().nothing(), score);
  }
  /// Share of the readings' squared error that it explains. The gains of the cycles count in full. The share
  /// is reduced to the part that holds in cycles that it was not fitted to.
  double shareOfError(const Score& score) const;
  /// Converts a share of the common trace's error to a share of the readings' error.
  double shareOfReadings(double share) const;
  /// Whether it is significant against noise and large enough to matter.
  bool shows(const Score& score) const;
  bool shows(const Explanation& explanation) const;
  double z(const Score& score) const { return crossValidation().z(crossValidation().nothing(), score); }
  /// Number of standard errors by which `worse` is behind `better`; see CrossValidation::z().
  double behindInErrors(const Explanation& worse, const Explanation& better) const;

  /// Score of the effects together with generic terms of their own covariates, namely the terms that add
  /// most. It estimates what the effects could explain in any form.
  Score inAnyForm(const Explanation& explanation) const;
  /// Whether each of the covariates is one that the effects depend on.
  bool within(const std::vector<simulation::Covariate>& covariates, const Score& effects) const;

  /// Fits the explanation through the forward model, unless this was done before.
  void refineOne(Explanation& explanation) const;
  /// Refines the single effects that may still be the best. Refines none where the best one is clear and has
  /// no near rival.
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
