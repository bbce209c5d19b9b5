#include "discrepancy/decide/comparison.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/thresholds.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

constexpr double kLeastZ = 3;            // of an explanation against no explanation
constexpr double kNearlyAsWell = 0.05;   // of what the best generic term explains
constexpr double kWorthRefining = 0.35;  // of what the best single effect explains
constexpr double kClear = 0.9;       // of the explainable share: an explanation above it leaves nothing open
constexpr double kFarBehind = 0.35;  // of the best share: an effect below it is no rival of a clear best one

// Start of the fit through the forward model. For each effect it holds the single signature that fits best,
// converted to settings. This signature replaces a mixture of signatures.
struct Start {
  std::vector<simulation::EnabledEffect> effects;
  std::vector<bool> bent_only;  // of each effect
  bool state_kept = true;
};

bool isBentOnly(const Candidates& candidates, const Score& explanation, const std::string& id) {
  const ColumnSet& set = explanation.set;
  for (std::size_t i = 0; i < set.columns.size(); ++i) {
    if (candidates.signatures()[static_cast<std::size_t>(set.columns[i])].id == id) return set.bent_only[i];
  }
  return false;
}

Start startOf(const Candidates& candidates, const Score& explanation) {
  ColumnSet chosen;
  Start start;
  for (const std::string& id : explanation.ids) {
    start.bent_only.push_back(isBentOnly(candidates, explanation, id));
    Score best;
    best.total = INFINITY;
    for (std::size_t s = 0; s < candidates.signatures().size(); ++s) {
      const Signature& signature = candidates.signatures()[s];
      if (signature.id != id) continue;
      const ColumnSet one{{static_cast<Eigen::Index>(s)}, {signature.free_sign}, {start.bent_only.back()}};
      const Score now = candidates.crossValidation().score(together(chosen, one));
      if (now.total < best.total) best = now;
    }
    chosen = best.set;
  }
  const Eigen::VectorXd coefficients = candidates.crossValidation().score(chosen).coefficients;
  for (std::size_t k = 0; k < chosen.columns.size(); ++k) {
    const Signature& signature = candidates.signatures()[static_cast<std::size_t>(chosen.columns[k])];
    simulation::EnabledEffect effect{signature.id, signature.values};
    const simulation::EffectParameter& strength =
        simulation::parameter(candidates.info(signature.id), signature.strength);
    const double value = coefficients[static_cast<Eigen::Index>(k)] * signature.scale;
    effect.values[signature.strength] = std::clamp(value, strength.permitted.low, strength.permitted.high);
    start.effects.push_back(effect);
    start.state_kept = signature.state_kept;
  }
  return start;
}

}  // namespace

bool Explanation::has(const std::string& id) const {
  return std::count(score.ids.begin(), score.ids.end(), id) > 0;
}

Comparison::Comparison(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                       const TaxelFit& taxels, const Candidates& candidates,
                       const simulation::SimulationSettings& base)
    : measured_(measured),
      common_(common),
      fit_(fit),
      taxels_(taxels),
      candidates_(candidates),
      base_(base),
      evidence_(availableEvidence(measured)) {
  for (const Family& family : candidates.effects()) {
    Explanation single;
    single.score = crossValidation().score(crossValidation().nothing(), family);
    single.share = shareOf(single.score);
    singles_.push_back(single);
  }
  for (const Family& family : candidates.generics())
    generics_.push_back(crossValidation().score(crossValidation().nothing(), family));
  raiseExplainable(candidates.repeating());
  if (best()) raiseExplainable(best()->share);
  if (bestGeneric()) raiseExplainable(shareOf(*bestGeneric()));
}

void Comparison::raiseExplainable(double share) {
  explainable_ = std::max(explainable_, share);
}

std::vector<simulation::Covariate> Comparison::covariates(const Score& generic) const {
  return candidates_.covariates(static_cast<std::size_t>(&generic - generics_.data()));
}

bool Comparison::within(const std::vector<simulation::Covariate>& covariates, const Score& effects) const {
  return std::all_of(covariates.begin(), covariates.end(), [&](simulation::Covariate c) {
    return std::any_of(effects.ids.begin(), effects.ids.end(), [&](const std::string& id) {
      const auto& own = infoOf(id).depends_on;
      return std::count(own.begin(), own.end(), c) > 0;
    });
  });
}

double Comparison::shareOfError(const Score& score) const {
  const Trace explained = candidates_.explained(score);
  const double samples = static_cast<double>(explained.size());
  const double fitted = explained.squaredNorm() / samples / candidates_.meanSquare();
  if (!(fitted > 0)) return 0;
  const Trace withoutGainWeights = fit_.withoutGainWeights(explained);
  const Spread spread = spreadOf(measured_, taxels_, withoutGainWeights);
  const double holds = std::clamp(shareOf(score) / fitted, 0.0, 1.0);
  return spread.square > 0 ? holds * withoutGainWeights.squaredNorm() / samples * spread.local / spread.square
                           : 0;
}

double Comparison::shareOfReadings(double share) const {
  const Trace none = Trace::Zero(static_cast<Eigen::Index>(measured_.samples()));
  return share * candidates_.meanSquare() / std::max(1e-300, spreadOf(measured_, taxels_, none).square);
}

bool Comparison::shows(const Score& score) const {
  return z(score) > kLeastZ && shareOfError(score) >= thresholds::kLeastShareOfError;
}

bool Comparison::shows(const Explanation& explanation) const {
  Explanation nothing;
  nothing.score = crossValidation().nothing();
  const double by_signatures = shareOf(explanation.score);
  const double more = by_signatures > 0 ? explanation.share / by_signatures : 1;
  return behindInErrors(nothing, explanation) > kLeastZ &&
         more * shareOfError(explanation.score) >= thresholds::kLeastShareOfError;
}

const Explanation* Comparison::best() const {
  const auto worse = [](const Explanation& a, const Explanation& b) { return a.share < b.share; };
  const auto found = std::max_element(singles_.begin(), singles_.end(), worse);
  return found == singles_.end() ? nullptr : &*found;
}

const Score* Comparison::bestGeneric() const {
  const auto better = [](const Score& a, const Score& b) { return a.total < b.total; };
  const auto found = std::min_element(generics_.begin(), generics_.end(), better);
  return found == generics_.end() ? nullptr : &*found;
}

const Score* Comparison::simplestGeneric() const {
  const Score* chosen = bestGeneric();
  if (!chosen) return nullptr;
  const double least = (1 - kNearlyAsWell) * shareOf(*chosen);
  const std::vector<simulation::Covariate> all = covariates(*chosen);
  for (const Score& score : generics_) {
    const std::vector<simulation::Covariate> own = covariates(score);
    const bool part = std::all_of(own.begin(), own.end(), [&](simulation::Covariate c) {
      return std::count(all.begin(), all.end(), c) > 0;
    });
    if (part && own.size() < covariates(*chosen).size() && shareOf(score) >= least) chosen = &score;
  }
  return chosen;
}

void Comparison::refineOne(Explanation& explanation) const {
  if (explanation.is_refined) return;
  const Start start = startOf(candidates_, explanation.score);
  explanation.refined =
      refine(measured_, common_, fit_, base_, start.effects, start.state_kept, start.bent_only);
  explanation.is_refined = true;
  explanation.share = std::max(explanation.share, explanation.refined.share);
}

void Comparison::refineNear() {
  const Explanation* first = best();
  const double least = kWorthRefining * first->share;
  double second = 0;
  for (const Explanation& single : singles_) {
    if (&single != first) second = std::max(second, single.share);
  }
  const bool clear = first->share > kClear * explainable_ && second < kFarBehind * first->share;
  if (clear) return;
  for (Explanation& single : singles_) {
    if (single.share >= least) refineOne(single);
  }
}

// Residual of the projected common trace after an explanation.
Trace Comparison::leftBy(const Explanation& explanation) const {
  if (explanation.is_refined && explanation.refined.share >= shareOf(explanation.score)) {
    return explanation.refined.left;
  }
  Trace left = candidates_.target() - candidates_.explained(explanation.score);
  for (const MeasuredCycle& cycle : measured_.cycles) {
    if (cycle.use == CycleUse::kFit) continue;
    left.segment(static_cast<Eigen::Index>(cycle.first), static_cast<Eigen::Index>(cycle.last - cycle.first))
        .setZero();
  }
  return left;
}

double Comparison::behindInErrors(const Explanation& worse, const Explanation& better) const {
  const Trace least = leftBy(better), more = leftBy(worse) - least;
  double squares = 0;
  for (const MeasuredCycle& cycle : measured_.cycles) {
    const auto first = static_cast<Eigen::Index>(cycle.first);
    const auto samples = static_cast<Eigen::Index>(cycle.last - cycle.first);
    squares += std::pow(more.segment(first, samples).dot(least.segment(first, samples)), 2);
  }
  const double gained = more.squaredNorm() + 2 * more.dot(least);
  return squares > 0 ? gained / (2 * std::sqrt(squares)) : 0;
}

Score Comparison::inAnyForm(const Explanation& explanation) const {
  Score best = explanation.score;
  for (std::size_t g = 0; g < generics_.size(); ++g) {
    if (!within(covariates(generics_[g]), explanation.score)) continue;
    const Score both = crossValidation().score(explanation.score, candidates_.generics()[g]);
    if (both.total < best.total) best = both;
  }
  return best;
}

}  // namespace fsr::discrepancy
