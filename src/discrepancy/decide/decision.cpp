#include "discrepancy/decide/decision.h"

#include <algorithm>
#include <utility>

#include "discrepancy/decide/comparison.h"
#include "discrepancy/decide/credible_set.h"
#include "discrepancy/decide/second_effect.h"
#include "discrepancy/thresholds.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

constexpr double kLeastShareOfExplainable = 0.5;  // least share of an effect; below it the verdict is unknown
constexpr double kGenericBetter = 0.1;            // of the explainable share

// Chooses the preferred explanation and its verdict.
class Verdicts {
 public:
  explicit Verdicts(Comparison& comparison) : comparison_(comparison) {}

  Decision decide();

 private:
  bool unknown(const Explanation& best);
  bool leavesOfItsForm(const Explanation& explanation) const;
  bool fitsWell(const Explanation& explanation) const;
  Explanation& find(const std::vector<std::string>& ids);
  void nameIt(const Explanation& best);
  void listCandidates();

  Comparison& comparison_;
  std::vector<Explanation> pairs_;  // pairs whose second effect adds enough, best first
  Decision decision_;
};

bool Verdicts::unknown(const Explanation& best) {
  const Score* generic = comparison_.simplestGeneric();
  const bool none = mayBeNone(best.refined, comparison_.library());
  if (!generic || !(none || comparison_.shows(*generic))) return false;
  const double more = comparison_.shareOf(*generic) - best.share;
  const bool beaten = more > kGenericBetter * comparison_.explainable() &&
                      comparison_.crossValidation().z(best.score, *generic) > thresholds::kSignificant;
  const bool weak =
      none || !comparison_.shows(best) || best.share < kLeastShareOfExplainable * comparison_.explainable();
  if (!weak && !(beaten && !comparison_.within(comparison_.covariates(*generic), best.score))) return false;
  decision_.verdict = Verdict::kUnknown;
  decision_.explanation = *generic;
  decision_.share = comparison_.shareOf(*generic);
  for (const simulation::Covariate c : comparison_.covariates(*generic))
    decision_.depends_on.push_back(simulation::name(c));
  return true;
}

// Whether another form of the effects would explain more. If so, the library's form is not the right one.
bool Verdicts::leavesOfItsForm(const Explanation& explanation) const {
  const Score any = comparison_.inAnyForm(explanation);
  return comparison_.shareOf(any) - explanation.share > kGenericBetter * comparison_.explainable() &&
         comparison_.crossValidation().z(explanation.score, any) > thresholds::kSignificant;
}

bool Verdicts::fitsWell(const Explanation& explanation) const {
  return explanation.share >= thresholds::kGoodForm * comparison_.explainable() &&
         !explanation.refined.at_bound && !leavesOfItsForm(explanation);
}

Explanation& Verdicts::find(const std::vector<std::string>& ids) {
  const auto is = [&](const Explanation& explanation) { return explanation.score.ids == ids; };
  const auto pair = std::find_if(pairs_.begin(), pairs_.end(), is);
  if (pair != pairs_.end()) return *pair;
  return *std::find_if(comparison_.singles().begin(), comparison_.singles().end(), is);
}

void Verdicts::nameIt(const Explanation& best) {
  decision_.credible = credibleSet(comparison_, pairs_, best);
  Explanation& first = find(decision_.credible.front());
  comparison_.refineOne(first);
  decision_.refined = first.refined;
  decision_.explanation = first.score;
  decision_.share = first.share;
  if (decision_.credible.size() == 1) {
    for (const auto& partner : partnersOf(comparison_, first)) decision_.credible.push_back(partner);
  }
  for (std::size_t r = 1; r < decision_.credible.size(); ++r) {
    Explanation& rival = find(decision_.credible[r]);
    comparison_.refineOne(rival);
    decision_.rivals.push_back(rival.refined);
  }
  const bool good = fitsWell(first);
  decision_.verdict = decision_.credible.size() > 1 ? Verdict::kAmbiguous
                      : good                        ? Verdict::kNamed
                                                    : Verdict::kWrongForm;
  for (const std::string& id : first.score.ids) {
    for (const simulation::Covariate c : comparison_.infoOf(id).depends_on) {
      auto& told = decision_.depends_on;
      if (!std::count(told.begin(), told.end(), simulation::name(c))) told.push_back(simulation::name(c));
    }
  }
}

void Verdicts::listCandidates() {
  const double of_readings = comparison_.shareOfReadings(1), explainable = comparison_.explainable();
  const auto add = [&](const Score& score, double share) {
    CandidateScore candidate{score.ids, "refused", 0, 0, comparison_.z(score)};
    candidate.share_of_explainable = explainable > 0 ? share / explainable : 0;
    candidate.share_of_error = share * of_readings;
    const auto& credible = decision_.credible;
    if (std::count(credible.begin(), credible.end(), score.ids)) candidate.outcome = "credible";
    decision_.candidates.push_back(candidate);
  };
  for (const Explanation& e : comparison_.singles()) add(e.score, e.share);
  for (const Explanation& e : pairs_) add(e.score, e.share);
  for (const Score& score : comparison_.generics()) add(score, comparison_.shareOf(score));
  std::stable_sort(decision_.candidates.begin(), decision_.candidates.end(),
                   [](const CandidateScore& a, const CandidateScore& b) {
                     return a.share_of_explainable > b.share_of_explainable;
                   });
}

Decision Verdicts::decide() {
  const Explanation* best = comparison_.best();
  const Score* generic = comparison_.bestGeneric();
  if (best && (comparison_.shows(*best) || (generic && comparison_.shows(*generic)))) {
    comparison_.refineNear();
    const Explanation& one = *comparison_.best();
    comparison_.raiseExplainable(one.share);
    pairs_ = pairsWorthIt(comparison_, one);
    Explanation& put = pairs_.empty() ? find(one.score.ids) : pairs_.front();
    comparison_.refineOne(put);
    if (!unknown(put)) nameIt(put);
    decision_.z = comparison_.z(decision_.explanation);
    decision_.share_of_error = comparison_.shareOfError(decision_.explanation);
  }
  decision_.explainable = comparison_.explainable();
  listCandidates();
  return decision_;
}

}  // namespace

Decision decide(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                const TaxelFit& taxels, const Candidates& candidates,
                const simulation::SimulationSettings& base) {
  Comparison comparison(measured, common, fit, taxels, candidates, base);
  return Verdicts(comparison).decide();
}

}  // namespace fsr::discrepancy
