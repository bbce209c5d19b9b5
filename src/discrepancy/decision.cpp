#include "fsr_pressure_map/discrepancy/decision.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/simulation/effects/effect_library.h"

namespace fsr {

namespace {

constexpr double kLeastZ = 3;                 // of an explanation over nothing
constexpr double kLeastShareOfError = 0.02;   // of the readings' squared error
constexpr double kLeastShareOfCeiling = 0.5;  // of an effect, else it is unknown
constexpr double kGenericBetter = 0.1;        // of the ceiling
constexpr double kRivalWithin = 0.05;         // of what the best explains
constexpr double kSignificant = 2;            // standard errors
constexpr double kSecondOfRest = 0.2;         // of what remains explainable

bool within(const std::vector<Covariate>& covariates, const Score& effects) {
  return std::all_of(covariates.begin(), covariates.end(), [&](Covariate c) {
    return std::any_of(effects.ids.begin(), effects.ids.end(), [&](const std::string& id) {
      const auto& own = findEffect(id)->info.depends_on;
      return std::count(own.begin(), own.end(), c) > 0;
    });
  });
}

// Everything that was scored, and what the decision needs of it.
class Contest {
 public:
  Contest(const Measured& measured, const TaxelFit& taxels, const Competition& competition)
      : measured_(measured), taxels_(taxels), competition_(competition), nothing_(selection().nothing()) {
    for (const Family& family : competition.effects())
      singles_.push_back(selection().score(nothing_, family));
    for (const Family& family : competition.generics())
      generics_.push_back(selection().score(nothing_, family));
  }

  Decision decide();

 private:
  const Selection& selection() const { return competition_.selection(); }
  double shareOf(const Score& score) const { return Selection::share(nothing_, score); }
  double shareOfError(const Score& score) const;
  bool shows(const Score& score) const {
    return selection().z(nothing_, score) > kLeastZ && shareOfError(score) >= kLeastShareOfError;
  }
  const Score* best(const std::vector<Score>& scores) const;
  void tryPairs();
  bool unknown(const Score& best);
  void gatherRivals(const Score& best);
  void weigh(const EvidenceAtHand& evidence);
  void listCandidates();

  const Measured& measured_;
  const TaxelFit& taxels_;
  const Competition& competition_;
  const Score& nothing_;
  std::vector<Score> singles_, generics_;
  std::vector<Score> pair_;  // none or the one that is accepted
  Decision decision_;
};

double Contest::shareOfError(const Score& score) const {
  const Spread spread = spreadOf(measured_, taxels_, competition_.explained(score));
  return spread.square > 0 ? shareOf(score) * competition_.meanSquare() * spread.local / spread.square : 0;
}

const Score* Contest::best(const std::vector<Score>& scores) const {
  const auto better = [](const Score& a, const Score& b) { return a.total < b.total; };
  const auto found = std::min_element(scores.begin(), scores.end(), better);
  return found == scores.end() ? nullptr : &*found;
}

// Two effects, where the second closes enough of what remains and no other pair does as well.
void Contest::tryPairs() {
  const Score* one = best(singles_);
  if (!one || !shows(*one)) return;
  Score two;
  two.total = INFINITY;
  for (std::size_t a = 0; a < singles_.size(); ++a) {
    for (std::size_t b = a + 1; b < singles_.size(); ++b) {
      const Score now = selection().score(singles_[a], competition_.effects()[b]);
      if (now.total < two.total) two = now;
    }
  }
  if (!std::isfinite(two.total)) return;
  const double gain = shareOf(two) - shareOf(*one);
  const double rest = std::max(decision_.ceiling, shareOf(two)) - shareOf(*one);
  const bool enough = gain >= kSecondOfRest * rest && gain >= 0.1 * shareOf(*one) &&
                      selection().z(*one, two) > kSignificant &&
                      gain / shareOf(two) * shareOfError(two) >= kLeastShareOfError / 2;
  // Each of the two must be needed: without it the other one alone must do clearly worse.
  if (enough) pair_.push_back(two);
}

bool Contest::unknown(const Score& best) {
  const Score* generic = this->best(generics_);
  if (!generic || !shows(*generic)) return false;
  const auto number = static_cast<std::size_t>(generic - generics_.data());
  const double more = shareOf(*generic) - shareOf(best);
  const bool beaten =
      more > kGenericBetter * decision_.ceiling && selection().z(best, *generic) > kSignificant;
  const bool weak = !shows(best) || shareOf(best) < kLeastShareOfCeiling * decision_.ceiling;
  if (!weak && !(beaten && !within(competition_.covariates(number), best))) return false;
  decision_.verdict = Verdict::kUnknown;
  decision_.explanation = *generic;
  for (const Covariate c : competition_.covariates(number)) decision_.depends_on.push_back(name(c));
  return true;
}

void Contest::gatherRivals(const Score& best) {
  std::vector<const Score*> rivals;
  for (const Score& single : singles_) {
    if (&single == &best || single.ids == best.ids || !shows(single)) continue;
    const double behind = shareOf(best) - shareOf(single);
    const bool close = behind <= kRivalWithin * shareOf(best);
    const bool indistinct = selection().z(single, best) < kSignificant && behind < 0.3 * shareOf(best);
    if (close || indistinct) rivals.push_back(&single);
  }
  std::sort(rivals.begin(), rivals.end(), [](const Score* a, const Score* b) { return a->total < b->total; });
  decision_.credible.push_back(best.ids);
  for (const Score* rival : rivals) decision_.credible.push_back(rival->ids);
}

// An effect that needs what was not recorded is not named alone: the best of its partners stays beside it.
void Contest::weigh(const EvidenceAtHand& evidence) {
  if (decision_.credible.size() > 1 || decision_.explanation.ids.size() > 1) return;
  const EffectInfo& info = findEffect(decision_.explanation.ids.front())->info;
  const bool all =
      std::all_of(info.needs.begin(), info.needs.end(), [&](Evidence e) { return evidence.has(e); });
  if (all) return;
  const Score* partner = nullptr;
  for (const Score& single : singles_) {
    const bool listed = std::count(info.collinear.begin(), info.collinear.end(), single.ids.front()) > 0;
    if (listed && shows(single) && (!partner || single.total < partner->total)) partner = &single;
  }
  if (partner) decision_.credible.push_back(partner->ids);
}

void Contest::listCandidates() {
  std::vector<const Score*> all;
  for (const Score& s : singles_) all.push_back(&s);
  for (const Score& s : generics_) all.push_back(&s);
  for (const Score& s : pair_) all.push_back(&s);
  std::sort(all.begin(), all.end(), [](const Score* a, const Score* b) { return a->total < b->total; });
  for (const Score* s : all) {
    CandidateScore candidate{s->ids, "", 0, 0, selection().z(nothing_, *s)};
    candidate.share_of_ceiling = decision_.ceiling > 0 ? shareOf(*s) / decision_.ceiling : 0;
    candidate.share_of_error =
        shareOf(*s) * competition_.meanSquare() /
        std::max(
            1e-300,
            spreadOf(measured_, taxels_, Trace::Zero(static_cast<Eigen::Index>(measured_.moments()))).square);
    const auto& credible = decision_.credible;
    candidate.outcome = std::count(credible.begin(), credible.end(), s->ids) ? "credible" : "refused";
    decision_.candidates.push_back(candidate);
  }
}

Decision Contest::decide() {
  const Score* one = best(singles_);
  const Score* generic = best(generics_);
  decision_.ceiling = competition_.repeating();
  for (const Score* s : {one, generic}) {
    if (s) decision_.ceiling = std::max(decision_.ceiling, shareOf(*s));
  }
  const bool anything = (one && shows(*one)) || (generic && shows(*generic));
  if (anything && one) {
    tryPairs();
    const Score& put = pair_.empty() ? *one : pair_.front();
    decision_.explanation = put;
    if (!unknown(put)) {
      gatherRivals(put);
      weigh(evidenceIn(measured_));
      decision_.verdict = decision_.credible.size() > 1 ? Verdict::kAmbiguous : Verdict::kNamed;
      const double share = shareOf(put) / decision_.ceiling;
      if (decision_.verdict == Verdict::kNamed && share < 0.7) decision_.verdict = Verdict::kWrongForm;
      for (const std::string& id : put.ids) {
        for (const Covariate c : findEffect(id)->info.depends_on) {
          if (!std::count(decision_.depends_on.begin(), decision_.depends_on.end(), name(c)))
            decision_.depends_on.push_back(name(c));
        }
      }
    }
    decision_.share = shareOf(decision_.explanation);
    decision_.z = selection().z(nothing_, decision_.explanation);
    decision_.share_of_error = shareOfError(decision_.explanation);
  }
  listCandidates();
  return decision_;
}

}  // namespace

bool EvidenceAtHand::has(Evidence evidence) const {
  switch (evidence) {
    case Evidence::kThermometer:
      return thermometer;
    case Evidence::kTwoRampRates:
      return two_rates;
    case Evidence::kMountLabels:
      return mount_labels;
    default:
      return false;
  }
}

EvidenceAtHand evidenceIn(const Measured& measured) {
  EvidenceAtHand evidence;
  evidence.thermometer = !measured.temperature.empty();
  evidence.mount_labels = std::all_of(measured.visits.begin(), measured.visits.end(),
                                      [](const Visit& v) { return v.surface.mount > 0; });
  // Ramps of one speed show one peak of the rates; dwells at load are moments that stand still.
  const double highest = *std::max_element(measured.pressure.begin(), measured.pressure.end());
  std::vector<double> moving;
  double still = 0, loaded = 0;
  double fastest = 0;
  for (const double r : measured.rate) fastest = std::max(fastest, std::abs(r));
  for (std::size_t i = 0; i < measured.moments(); ++i) {
    if (measured.pressure[i] < 0.1 * highest) continue;
    ++loaded;
    if (std::abs(measured.rate[i]) < 0.02 * fastest)
      ++still;
    else
      moving.push_back(std::abs(measured.rate[i]));
  }
  std::sort(moving.begin(), moving.end());
  const auto at = [&](double share) {
    return moving.empty() ? 0
                          : moving[static_cast<std::size_t>(share * static_cast<double>(moving.size() - 1))];
  };
  evidence.two_rates = at(0.1) > 0 && at(0.9) > 1.5 * at(0.1);
  evidence.two_rates = evidence.two_rates || still > 0.1 * loaded;
  return evidence;
}

Decision decide(const Measured& measured, const TaxelFit& taxels, const Competition& competition) {
  return Contest(measured, taxels, competition).decide();
}

}  // namespace fsr
