#include "discrepancy/decide/decision.h"

#include <algorithm>
#include <utility>

#include "discrepancy/decide/contest.h"
#include "discrepancy/decide/rivals.h"
#include "discrepancy/decide/second_effect.h"
#include "discrepancy/thresholds.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

constexpr double kLeastShareOfCeiling = 0.5;  // of an effect, else it is unknown
constexpr double kGenericBetter = 0.1;        // of the ceiling

// Puts one explanation forward and says how sure it is.
class Verdicts {
 public:
  explicit Verdicts(Contest& contest) : contest_(contest) {}

  Decision decide();

 private:
  bool unknown(const Explanation& best);
  bool leavesOfItsForm(const Explanation& explanation) const;
  bool fitsWell(const Explanation& explanation) const;
  Explanation& find(const std::vector<std::string>& ids);
  void nameIt(const Explanation& best);
  void listCandidates();

  Contest& contest_;
  std::vector<Explanation> pairs_;  // those that are worth it, best first
  Decision decision_;
};

bool Verdicts::unknown(const Explanation& best) {
  const Score* generic = contest_.simplestGeneric();
  const bool none = mayBeNone(best.refined, contest_.library());
  if (!generic || !(none || contest_.shows(*generic))) return false;
  const double more = contest_.shareOf(*generic) - best.share;
  const bool beaten = more > kGenericBetter * contest_.ceiling() &&
                      contest_.selection().z(best.score, *generic) > thresholds::kSignificant;
  const bool weak = none || !contest_.shows(best) || best.share < kLeastShareOfCeiling * contest_.ceiling();
  if (!weak && !(beaten && !contest_.within(contest_.covariates(*generic), best.score))) return false;
  decision_.verdict = Verdict::kUnknown;
  decision_.explanation = *generic;
  decision_.share = contest_.shareOf(*generic);
  for (const simulation::Covariate c : contest_.covariates(*generic))
    decision_.depends_on.push_back(simulation::name(c));
  return true;
}

// Whether another form would add to the effects: then theirs is not quite it.
bool Verdicts::leavesOfItsForm(const Explanation& explanation) const {
  const Score any = contest_.inAnyForm(explanation);
  return contest_.shareOf(any) - explanation.share > kGenericBetter * contest_.ceiling() &&
         contest_.selection().z(explanation.score, any) > thresholds::kSignificant;
}

bool Verdicts::fitsWell(const Explanation& explanation) const {
  return explanation.share >= thresholds::kGoodForm * contest_.ceiling() && !explanation.refined.at_bound &&
         !leavesOfItsForm(explanation);
}

Explanation& Verdicts::find(const std::vector<std::string>& ids) {
  const auto is = [&](const Explanation& explanation) { return explanation.score.ids == ids; };
  const auto pair = std::find_if(pairs_.begin(), pairs_.end(), is);
  if (pair != pairs_.end()) return *pair;
  return *std::find_if(contest_.singles().begin(), contest_.singles().end(), is);
}

void Verdicts::nameIt(const Explanation& best) {
  decision_.credible = credibleSet(contest_, pairs_, best);
  Explanation& first = find(decision_.credible.front());
  contest_.refineOne(first);
  decision_.refined = first.refined;
  decision_.explanation = first.score;
  decision_.share = first.share;
  if (decision_.credible.size() == 1) {
    for (const auto& partner : partnersOf(contest_, first)) decision_.credible.push_back(partner);
  }
  for (std::size_t r = 1; r < decision_.credible.size(); ++r) {
    Explanation& rival = find(decision_.credible[r]);
    contest_.refineOne(rival);
    decision_.rivals.push_back(rival.refined);
  }
  const bool good = fitsWell(first);
  decision_.verdict = decision_.credible.size() > 1 ? Verdict::kAmbiguous
                      : good                        ? Verdict::kNamed
                                                    : Verdict::kWrongForm;
  for (const std::string& id : first.score.ids) {
    for (const simulation::Covariate c : contest_.infoOf(id).depends_on) {
      auto& told = decision_.depends_on;
      if (!std::count(told.begin(), told.end(), simulation::name(c))) told.push_back(simulation::name(c));
    }
  }
}

void Verdicts::listCandidates() {
  const double of_readings = contest_.shareOfReadings(1), ceiling = contest_.ceiling();
  const auto add = [&](const Score& score, double share) {
    CandidateScore candidate{score.ids, "refused", 0, 0, contest_.z(score)};
    candidate.share_of_ceiling = ceiling > 0 ? share / ceiling : 0;
    candidate.share_of_error = share * of_readings;
    const auto& credible = decision_.credible;
    if (std::count(credible.begin(), credible.end(), score.ids)) candidate.outcome = "credible";
    decision_.candidates.push_back(candidate);
  };
  for (const Explanation& e : contest_.singles()) add(e.score, e.share);
  for (const Explanation& e : pairs_) add(e.score, e.share);
  for (const Score& score : contest_.generics()) add(score, contest_.shareOf(score));
  std::stable_sort(decision_.candidates.begin(), decision_.candidates.end(),
                   [](const CandidateScore& a, const CandidateScore& b) {
                     return a.share_of_ceiling > b.share_of_ceiling;
                   });
}

Decision Verdicts::decide() {
  const Explanation* best = contest_.best();
  const Score* generic = contest_.bestGeneric();
  if (best && (contest_.shows(*best) || (generic && contest_.shows(*generic)))) {
    contest_.refineNear();
    const Explanation& one = *contest_.best();
    contest_.raiseCeiling(one.share);
    pairs_ = pairsWorthIt(contest_, one);
    Explanation& put = pairs_.empty() ? find(one.score.ids) : pairs_.front();
    contest_.refineOne(put);
    if (!unknown(put)) nameIt(put);
    decision_.z = contest_.z(decision_.explanation);
    decision_.share_of_error = contest_.shareOfError(decision_.explanation);
  }
  decision_.ceiling = contest_.ceiling();
  listCandidates();
  return decision_;
}

}  // namespace

Decision decide(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                const TaxelFit& taxels, const Competition& competition,
                const simulation::SimulationSettings& base) {
  Contest contest(measured, common, fit, taxels, competition, base);
  return Verdicts(contest).decide();
}

}  // namespace fsr::discrepancy
