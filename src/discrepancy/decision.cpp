#include "fsr_pressure_map/discrepancy/decision.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fsr_pressure_map/simulation/effects/effect_library.h"

namespace fsr {

namespace {

constexpr double kLeastZ = 3;                 // of an explanation over nothing
constexpr double kLeastShareOfError = 0.02;   // of the readings' squared error
constexpr double kLeastShareOfCeiling = 0.5;  // of an effect, else it is unknown
constexpr double kGenericBetter = 0.1;        // of the ceiling
constexpr double kRivalWithin = 0.05;         // of what the best explains
constexpr double kSignificant = 2;            // standard errors
constexpr double kRivalFar = 0.15;            // likewise: behind it by more it is none, whatever the errors
constexpr double kSecondOfRest = 0.45;   // of what remains explainable: a wrong form alone leaves that much
constexpr double kSecondOfFirst = 0.03;  // of what the first effect explains
constexpr double kSecondLookalike = 8;   // standard errors, where a wrong form of one looks like the other
constexpr double kCreepNear = 0.8;       // of a loop with a break-in
constexpr double kSecondRival = 0.7;     // of what the second adds: another that adds as much is as good
constexpr std::size_t kPairsRefined = 4;
constexpr double kMuchOpen = 0.75;       // of the common trace's error: less explained leaves room for two
constexpr double kGoodForm = 0.7;        // of the ceiling
constexpr double kTemperatureMoved = 5;  // [K]
constexpr double kUnevenPace = 0.2;      // of the way's deviation, that a straight line of the clock leaves
constexpr double kLongPause = 3600;      // [s]
constexpr double kDriftHides = 0.5;      // of what drift explains: it may be any slow effect that near
constexpr double kNearBadForm = 0.6;     // of the best one's share, where its form is wrong
constexpr double kWorthRefining = 0.35;  // of what the best one explains
constexpr double kClear = 0.9;           // of the ceiling: an explanation that leaves nothing open
constexpr double kFarBehind = 0.35;      // of the best: no rival of a clear one

bool within(const std::vector<Covariate>& covariates, const Score& effects) {
  return std::all_of(covariates.begin(), covariates.end(), [&](Covariate c) {
    return std::any_of(effects.ids.begin(), effects.ids.end(), [&](const std::string& id) {
      const auto& own = findEffect(id)->info.depends_on;
      return std::count(own.begin(), own.end(), c) > 0;
    });
  });
}

// Effects that change from cycle to cycle: some dozens of gains do not hold two of them.
bool isSlow(const std::string& id) {
  return id == "drift" || id == "temperature" || id == "wear" || id == "break_in";
}

// A creep whose form is not quite the library's leaves something of a loop, and goes on otherwise in the
// first cycles of every mount, as a break-in does.
bool lookAlike(const std::vector<std::string>& ids) {
  const auto has = [&](const char* id) { return std::count(ids.begin(), ids.end(), id) > 0; };
  return has("creep") && (has("break_in") || has("hysteresis"));
}

// The single signatures that do most of what a mixture did, one for each effect, as settings.
struct Start {
  std::vector<EnabledEffect> effects;
  std::vector<bool> bent_only;  // of each
  bool carried = true;
};

bool isBentOnly(const Competition& competition, const Score& explanation, const std::string& id) {
  const ColumnSet& set = explanation.set;
  for (std::size_t i = 0; i < set.columns.size(); ++i) {
    if (competition.signatures()[static_cast<std::size_t>(set.columns[i])].id == id) return set.bent_only[i];
  }
  return false;
}

Start startOf(const Competition& competition, const Score& explanation) {
  ColumnSet chosen;
  Start start;
  for (const std::string& id : explanation.ids) {
    start.bent_only.push_back(isBentOnly(competition, explanation, id));
    Score best;
    best.total = INFINITY;
    for (std::size_t s = 0; s < competition.signatures().size(); ++s) {
      const Signature& signature = competition.signatures()[s];
      if (signature.id != id) continue;
      const ColumnSet one{{static_cast<Eigen::Index>(s)}, {signature.free_sign}, {start.bent_only.back()}};
      const Score now = competition.selection().score(together(chosen, one));
      if (now.total < best.total) best = now;
    }
    chosen = best.set;
  }
  const Eigen::VectorXd coefficients = competition.selection().score(chosen).coefficients;
  for (std::size_t k = 0; k < chosen.columns.size(); ++k) {
    const Signature& signature = competition.signatures()[static_cast<std::size_t>(chosen.columns[k])];
    EnabledEffect effect{signature.id, signature.values};
    const EffectParameter& strength = parameter(findEffect(signature.id)->info, signature.strength);
    const double value = coefficients[static_cast<Eigen::Index>(k)] * signature.scale;
    effect.values[signature.strength] = std::clamp(value, strength.permitted.low, strength.permitted.high);
    start.effects.push_back(effect);
    start.carried = signature.carried;
  }
  return start;
}

// An explanation by effects, as signatures and, where it came near, through the forward model.
struct Explanation {
  Score score;
  double share = 0;  // the better of the two
  bool is_refined = false;
  Refined refined;
};

// Everything that was scored, and what the decision needs of it.
class Contest {
 public:
  Contest(const Measured& measured, const CommonTraces& common, const StaticFit& fit, const TaxelFit& taxels,
          const Competition& competition, const SimulationSettings& base)
      : measured_(measured),
        common_(common),
        fit_(fit),
        taxels_(taxels),
        competition_(competition),
        base_(base),
        evidence_(evidenceIn(measured)),
        nothing_(selection().nothing()) {
    for (const Family& family : competition.effects()) {
      Explanation single;
      single.score = selection().score(nothing_, family);
      single.share = shareOf(single.score);
      singles_.push_back(single);
    }
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
  bool shows(const Explanation& explanation) const;
  const Explanation* best() const;
  Explanation* best() { return const_cast<Explanation*>(std::as_const(*this).best()); }
  const Score* bestGeneric() const;
  const Score* simplestGeneric() const;
  Score inAnyForm(const Explanation& explanation) const;
  bool leavesOfItsForm(const Explanation& explanation) const;
  void refineOne(Explanation& explanation) const;
  void refineNear();
  std::vector<Explanation> bestPairs(const Explanation& one) const;
  bool isWorthIt(const Explanation& one, const Explanation& two) const;
  static bool mayBeCreep(const Explanation& creep, const Explanation& pair);
  void tryPairs(const Explanation& one);
  bool unknown(const Explanation& best);
  Trace leftBy(const Explanation& explanation) const;
  double behindInErrors(const Explanation& worse, const Explanation& better) const;
  bool temperatureMoved() const;
  bool apartFromClock(const std::string& slow) const;
  bool isRival(const Explanation& other, const Explanation& best) const;
  void gatherRivals(const Explanation& best);
  bool standsAlone(const EffectInfo& info) const;
  void weigh();
  Explanation* find(const std::vector<std::string>& ids);
  bool fitsWell(const Explanation& explanation) const;
  void keepNearest(const Explanation& best);
  void nameIt(Explanation& best);
  void listCandidates();

  const Measured& measured_;
  const CommonTraces& common_;
  const StaticFit& fit_;
  const TaxelFit& taxels_;
  const Competition& competition_;
  const SimulationSettings& base_;
  const EvidenceAtHand evidence_;
  const Score& nothing_;
  std::vector<Explanation> singles_;
  std::vector<Score> generics_;
  std::vector<Explanation> pairs_;  // those that are worth it, best first
  Decision decision_;
};

// Of the readings, where the cycles' gains count in full; as far as it holds on cycles that took no part.
double Contest::shareOfError(const Score& score) const {
  const Trace explained = competition_.explained(score);
  const double moments = static_cast<double>(explained.size());
  const double fitted = explained.squaredNorm() / moments / competition_.meanSquare();
  if (!(fitted > 0)) return 0;
  const Trace grown = fit_.grown(explained);
  const Spread spread = spreadOf(measured_, taxels_, grown);
  const double holds = std::clamp(shareOf(score) / fitted, 0.0, 1.0);
  return spread.square > 0 ? holds * grown.squaredNorm() / moments * spread.local / spread.square : 0;
}

bool Contest::shows(const Explanation& explanation) const {
  Explanation nothing;
  nothing.score = nothing_;
  const double by_signatures = shareOf(explanation.score);
  const double more = by_signatures > 0 ? explanation.share / by_signatures : 1;
  return behindInErrors(nothing, explanation) > kLeastZ &&
         more * shareOfError(explanation.score) >= kLeastShareOfError;
}

const Explanation* Contest::best() const {
  const auto worse = [](const Explanation& a, const Explanation& b) { return a.share < b.share; };
  const auto found = std::max_element(singles_.begin(), singles_.end(), worse);
  return found == singles_.end() ? nullptr : &*found;
}

const Score* Contest::bestGeneric() const {
  const auto better = [](const Score& a, const Score& b) { return a.total < b.total; };
  const auto found = std::min_element(generics_.begin(), generics_.end(), better);
  return found == generics_.end() ? nullptr : &*found;
}

void Contest::refineOne(Explanation& explanation) const {
  if (explanation.is_refined) return;
  const Start start = startOf(competition_, explanation.score);
  explanation.refined =
      refine(measured_, common_, fit_, base_, start.effects, start.carried, start.bent_only);
  explanation.is_refined = true;
  explanation.share = std::max(explanation.share, explanation.refined.share);
}

// Those that may yet be the best; none where the best has no rival worth the time.
void Contest::refineNear() {
  const Explanation* first = best();
  const double least = kWorthRefining * first->share;
  double second = 0;
  for (const Explanation& single : singles_) {
    if (&single != first) second = std::max(second, single.share);
  }
  const bool clear = first->share > kClear * decision_.ceiling && second < kFarBehind * first->share;
  if (clear) return;
  for (Explanation& single : singles_) {
    if (single.share >= least) refineOne(single);
  }
}

// The pairs that do best as signatures, best first, and the best single effect with each of the others: a
// large effect bends, and its signature alone says too little of it.
std::vector<Explanation> Contest::bestPairs(const Explanation& one) const {
  std::vector<Explanation> pairs;
  for (std::size_t a = 0; a < singles_.size(); ++a) {
    for (std::size_t b = a + 1; b < singles_.size(); ++b) {
      if (isSlow(competition_.effects()[a].id) && isSlow(competition_.effects()[b].id)) continue;
      Explanation pair;
      pair.score = selection().score(singles_[a].score, competition_.effects()[b]);
      Score swapped = selection().score(singles_[b].score, competition_.effects()[a]);
      std::swap(swapped.ids.front(), swapped.ids.back());
      if (swapped.total < pair.score.total) pair.score = swapped;
      pair.share = shareOf(pair.score);
      pairs.push_back(pair);
    }
  }
  const auto better = [](const Explanation& a, const Explanation& b) { return a.share > b.share; };
  std::sort(pairs.begin(), pairs.end(), better);
  const auto with_one = [&](const Explanation& pair) {
    return std::count(pair.score.ids.begin(), pair.score.ids.end(), one.score.ids.front()) > 0;
  };
  const auto first = pairs.begin() + static_cast<std::ptrdiff_t>(std::min(pairs.size(), kPairsRefined));
  pairs.erase(std::remove_if(first, pairs.end(), [&](const auto& pair) { return !with_one(pair); }),
              pairs.end());
  return pairs;
}

bool Contest::isWorthIt(const Explanation& one, const Explanation& two) const {
  const double gain = two.share - one.share, rest = std::max(decision_.ceiling, two.share) - one.share;
  if (lookAlike(two.score.ids) && selection().z(one.score, two.score) < kSecondLookalike) return false;
  if (shareOf(inAnyForm(one)) >= one.share + kSecondRival * gain) return false;
  return gain >= kSecondOfRest * rest && gain >= kSecondOfFirst * one.share &&
         behindInErrors(one, two) > kSignificant &&
         gain / two.share * shareOfError(two.score) >= kLeastShareOfError;
}

// A loop with a break-in does what a creep in a form that the library lacks does: while the library's comes
// near, it stays beside them.
bool Contest::mayBeCreep(const Explanation& creep, const Explanation& pair) {
  const auto has = [&](const char* id) {
    return std::count(pair.score.ids.begin(), pair.score.ids.end(), id) > 0;
  };
  return creep.score.ids.front() == "creep" && has("hysteresis") && has("break_in") &&
         creep.share >= kCreepNear * pair.share;
}

// Two effects, where the second closes enough of what remains and no other pair does as well; with drift,
// which everything slow looks like, or beyond what is plausible, only where no other pair adds half as much.
void Contest::tryPairs(const Explanation& one) {
  pairs_ = bestPairs(one);
  if (pairs_.empty()) return;
  const double open = std::max(decision_.ceiling, pairs_.front().share) - one.share;
  if (open < kSecondOfFirst * one.share && one.share > kMuchOpen) pairs_.clear();
  for (Explanation& pair : pairs_) refineOne(pair);
  const auto hopeless = [&](const Explanation& pair) { return !isWorthIt(one, pair); };
  pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(), hopeless), pairs_.end());
  const auto merit = [&](const Explanation& pair) {
    const bool drift = std::count(pair.score.ids.begin(), pair.score.ids.end(), "drift") > 0;
    return one.share + (pair.share - one.share) * (drift || pair.refined.at_bound ? kDriftHides : 1);
  };
  std::stable_sort(pairs_.begin(), pairs_.end(),
                   [&](const auto& a, const auto& b) { return merit(a) > merit(b); });
  decision_.ceiling = std::max(decision_.ceiling, pairs_.empty() ? 0 : pairs_.front().share);
}

// Of the generic terms that do nearly as well as the best those with the fewest covariates: more are not said
// to matter unless they do.
const Score* Contest::simplestGeneric() const {
  const Score* chosen = bestGeneric();
  if (!chosen) return nullptr;
  const double least = (1 - kRivalWithin) * shareOf(*chosen);
  const auto covariates = [&](const Score& score) {
    return competition_.covariates(static_cast<std::size_t>(&score - generics_.data()));
  };
  const std::vector<Covariate> all = covariates(*chosen);
  for (const Score& score : generics_) {
    const std::vector<Covariate> own = covariates(score);
    const bool part = std::all_of(own.begin(), own.end(),
                                  [&](Covariate c) { return std::count(all.begin(), all.end(), c) > 0; });
    if (part && own.size() < covariates(*chosen).size() && shareOf(score) >= least) chosen = &score;
  }
  return chosen;
}

bool Contest::unknown(const Explanation& best) {
  const Score* generic = simplestGeneric();
  if (!generic || !shows(*generic)) return false;
  const auto number = static_cast<std::size_t>(generic - generics_.data());
  const double more = shareOf(*generic) - best.share;
  const bool beaten =
      more > kGenericBetter * decision_.ceiling && selection().z(best.score, *generic) > kSignificant;
  const bool weak = !shows(best) || best.share < kLeastShareOfCeiling * decision_.ceiling;
  if (!weak && !(beaten && !within(competition_.covariates(number), best.score))) return false;
  decision_.verdict = Verdict::kUnknown;
  decision_.explanation = *generic;
  decision_.share = shareOf(*generic);
  for (const Covariate c : competition_.covariates(number)) decision_.depends_on.push_back(name(c));
  return true;
}

// What an explanation leaves of the projected common trace.
Trace Contest::leftBy(const Explanation& explanation) const {
  if (explanation.is_refined && explanation.refined.share >= shareOf(explanation.score)) {
    return explanation.refined.left;
  }
  Trace left = competition_.target() - competition_.explained(explanation.score);
  for (const MeasuredCycle& cycle : measured_.cycles) {
    if (cycle.use == CycleUse::kFit) continue;
    left.segment(static_cast<Eigen::Index>(cycle.first), static_cast<Eigen::Index>(cycle.last - cycle.first))
        .setZero();
  }
  return left;
}

// By how many standard errors `worse` is behind; see Selection::z().
double Contest::behindInErrors(const Explanation& worse, const Explanation& better) const {
  const Trace least = leftBy(better), more = leftBy(worse) - least;
  double squares = 0;
  for (const MeasuredCycle& cycle : measured_.cycles) {
    const auto first = static_cast<Eigen::Index>(cycle.first);
    const auto moments = static_cast<Eigen::Index>(cycle.last - cycle.first);
    squares += std::pow(more.segment(first, moments).dot(least.segment(first, moments)), 2);
  }
  const double gained = more.squaredNorm() + 2 * more.dot(least);
  return squares > 0 ? gained / (2 * std::sqrt(squares)) : 0;
}

bool Contest::temperatureMoved() const {
  if (measured_.temperature.empty()) return false;
  const auto [low, high] = std::minmax_element(measured_.temperature.begin(), measured_.temperature.end());
  return *high - *low > kTemperatureMoved;
}

// Whether what a slow effect follows went another way than the clock, so that a drift is told from it.
bool Contest::apartFromClock(const std::string& slow) const {
  return slow == "temperature" ? temperatureMoved() && evidence_.uneven_warmth : evidence_.uneven_pace;
}

// Whether the recordings do not tell them apart.
bool Contest::isRival(const Explanation& other, const Explanation& best) const {
  const double behind = best.share - other.share;
  if (behindInErrors(other, best) < kSignificant && behind < kRivalFar * best.share) return true;
  if (mayBeCreep(other, best)) return true;
  // One effect against two was weighed by what the second adds; two against two by the same.
  if (best.score.ids.size() > 1 && other.score.ids.size() == 1) return false;
  if (best.score.ids.size() > 1) return behind <= (1 - kSecondRival) * (best.share - this->best()->share);
  const std::string &first = best.score.ids.front(), &second = other.score.ids.front();
  // What everything slow looks like excludes nothing slow, unless that went another way than the clock.
  if (first == "drift" && isSlow(second))
    return behind <= (apartFromClock(second) ? kRivalFar : kDriftHides) * best.share;
  // And where that did, a drift with its three parameters is no simpler explanation that comes near.
  if (second == "drift" && isSlow(first) && apartFromClock(first)) return false;
  return behind <= kRivalWithin * best.share;
}

void Contest::gatherRivals(const Explanation& best) {
  std::vector<const Explanation*> rivals;
  for (const Explanation& single : singles_) {
    if (single.score.ids != best.score.ids && shows(single) && isRival(single, best))
      rivals.push_back(&single);
  }
  for (const Explanation& pair : pairs_) {
    if (pair.score.ids != best.score.ids && isRival(pair, best)) rivals.push_back(&pair);
  }
  std::sort(rivals.begin(), rivals.end(),
            [](const Explanation* a, const Explanation* b) { return a->share > b->share; });
  decision_.credible.push_back(best.score.ids);
  for (const Explanation* rival : rivals) decision_.credible.push_back(rival->score.ids);
  // A temperature that was measured, and moved, comes before what was not.
  if (temperatureMoved()) {
    std::stable_partition(decision_.credible.begin(), decision_.credible.end(),
                          [](const auto& ids) { return ids == std::vector<std::string>{"temperature"}; });
  }
  // Drift is what everything slow looks like: it stands behind whatever comes near it.
  const auto is_drift = [](const std::vector<std::string>& ids) {
    return ids == std::vector<std::string>{"drift"};
  };
  std::stable_partition(decision_.credible.begin(), decision_.credible.end(),
                        [&](const auto& ids) { return !is_drift(ids); });
}

// Whether the recordings hold what an effect needs, to be named without a partner.
bool Contest::standsAlone(const EffectInfo& info) const {
  const bool all =
      std::all_of(info.needs.begin(), info.needs.end(), [&](Evidence e) { return evidence_.has(e); });
  // Whatever goes on slowly looks like a drift while the clock and the cycles go on together, and a wear that
  // fades like a break-in until a surface is mounted again.
  if (info.id == "drift") return all && evidence_.uneven_pace;
  if (info.id == "break_in") return all && evidence_.remounted;
  return all;
}

// An effect that needs what was not recorded is not named alone: the best of its partners stays beside it.
void Contest::weigh() {
  if (decision_.credible.size() > 1) return;
  const std::vector<std::string> ids = decision_.explanation.ids;
  for (const std::string& id : ids) {
    const EffectInfo& info = findEffect(id)->info;
    if (standsAlone(info)) continue;
    const Explanation* partner = nullptr;
    for (const Explanation& single : singles_) {
      const std::string& other = single.score.ids.front();
      const bool listed = std::count(info.collinear.begin(), info.collinear.end(), other) > 0;
      const bool near = shows(single) || single.share >= kNearBadForm * decision_.share;
      if (!listed || std::count(ids.begin(), ids.end(), other) > 0 || !near) continue;
      if (!partner || single.share > partner->share) partner = &single;
    }
    if (partner) decision_.credible.push_back(partner->score.ids);
  }
}

void Contest::listCandidates() {
  const Trace none = Trace::Zero(static_cast<Eigen::Index>(measured_.moments()));
  const double square = std::max(1e-300, spreadOf(measured_, taxels_, none).square);
  const auto add = [&](const Score& score, double share) {
    CandidateScore candidate{score.ids, "refused", 0, 0, selection().z(nothing_, score)};
    candidate.share_of_ceiling = decision_.ceiling > 0 ? share / decision_.ceiling : 0;
    candidate.share_of_error = share * competition_.meanSquare() / square;
    const auto& credible = decision_.credible;
    if (std::count(credible.begin(), credible.end(), score.ids)) candidate.outcome = "credible";
    decision_.candidates.push_back(candidate);
  };
  for (const Explanation& e : singles_) add(e.score, e.share);
  for (const Explanation& e : pairs_) add(e.score, e.share);
  for (const Score& score : generics_) add(score, shareOf(score));
  std::stable_sort(decision_.candidates.begin(), decision_.candidates.end(),
                   [](const CandidateScore& a, const CandidateScore& b) {
                     return a.share_of_ceiling > b.share_of_ceiling;
                   });
}

// What the effects explain together with the generic terms of their own covariates that add most to them:
// what some form of them may explain.
Score Contest::inAnyForm(const Explanation& explanation) const {
  Score best = explanation.score;
  for (std::size_t g = 0; g < generics_.size(); ++g) {
    if (!within(competition_.covariates(g), explanation.score)) continue;
    const Score both = selection().score(explanation.score, competition_.generics()[g]);
    if (both.total < best.total) best = both;
  }
  return best;
}

// Whether another form would add to the effects: then theirs is not quite it.
bool Contest::leavesOfItsForm(const Explanation& explanation) const {
  const Score any = inAnyForm(explanation);
  return shareOf(any) - explanation.share > kGenericBetter * decision_.ceiling &&
         selection().z(explanation.score, any) > kSignificant;
}

bool Contest::fitsWell(const Explanation& explanation) const {
  return explanation.share >= kGoodForm * decision_.ceiling && !explanation.refined.at_bound &&
         !leavesOfItsForm(explanation);
}

// Where the best one does not fit well, others that do not either stay credible, even if noise might be all
// that they explain: a wrong form hides the right effect as well.
void Contest::keepNearest(const Explanation& best) {
  if (decision_.credible.size() > 1) return;
  for (const Explanation& single : singles_) {
    if (single.score.ids == best.score.ids) continue;
    if (single.share >= kNearBadForm * best.share) decision_.credible.push_back(single.score.ids);
  }
}

Explanation* Contest::find(const std::vector<std::string>& ids) {
  for (std::vector<Explanation>* all : {&singles_, &pairs_}) {
    for (Explanation& explanation : *all) {
      if (explanation.score.ids == ids) return &explanation;
    }
  }
  return nullptr;
}

void Contest::nameIt(Explanation& best) {
  gatherRivals(best);
  Explanation& first = *find(decision_.credible.front());
  refineOne(first);
  decision_.refined = first.refined;
  decision_.explanation = first.score;
  decision_.share = first.share;
  weigh();
  if (first.share < kGoodForm * decision_.ceiling) keepNearest(first);
  for (std::size_t r = 1; r < decision_.credible.size(); ++r) {
    Explanation& rival = *find(decision_.credible[r]);
    refineOne(rival);
    decision_.rivals.push_back(rival.refined);
  }
  const bool good = fitsWell(first);
  decision_.verdict = decision_.credible.size() > 1 ? Verdict::kAmbiguous
                      : good                        ? Verdict::kNamed
                                                    : Verdict::kWrongForm;
  for (const std::string& id : first.score.ids) {
    for (const Covariate c : findEffect(id)->info.depends_on) {
      auto& told = decision_.depends_on;
      if (!std::count(told.begin(), told.end(), name(c))) told.push_back(name(c));
    }
  }
}

Decision Contest::decide() {
  const Score* generic = bestGeneric();
  decision_.ceiling = competition_.repeating();
  if (best()) decision_.ceiling = std::max(decision_.ceiling, best()->share);
  if (generic) decision_.ceiling = std::max(decision_.ceiling, shareOf(*generic));
  const bool anything = best() && (shows(*best()) || (generic && shows(*generic)));
  if (anything) {
    refineNear();
    decision_.ceiling = std::max(decision_.ceiling, best()->share);
    tryPairs(*best());
    Explanation& put = pairs_.empty() ? *best() : pairs_.front();
    if (!unknown(put)) nameIt(put);
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
    case Evidence::kManyCycles:
      return uneven_pace;
    default:
      return false;
  }
}

// What a covariate and what the clock has done are two things only where a pause was long and the one is no
// straight line of the other, from cycle to cycle.
bool wentApart(const Measured& measured, const std::vector<double>& covariate) {
  if (covariate.empty()) return false;
  double sum_t = 0, sum_w = 0, tt = 0, ww = 0, tw = 0, longest = 0;
  for (std::size_t c = 0; c < measured.cycles.size(); ++c) {
    const std::size_t first = measured.cycles[c].first;
    const double t = measured.time[first], w = covariate[first];
    sum_t += t, sum_w += w, tt += t * t, ww += w * w, tw += t * w;
    if (c > 0) longest = std::max(longest, t - measured.time[measured.cycles[c - 1].last - 1]);
  }
  const auto n = static_cast<double>(measured.cycles.size());
  const double var_t = tt - sum_t * sum_t / n, var_w = ww - sum_w * sum_w / n, both = tw - sum_t * sum_w / n;
  if (longest < kLongPause || var_t <= 0 || var_w <= 0) return false;
  return 1 - both * both / (var_t * var_w) > kUnevenPace * kUnevenPace;
}

EvidenceAtHand evidenceIn(const Measured& measured) {
  EvidenceAtHand evidence;
  evidence.thermometer = !measured.temperature.empty();
  evidence.uneven_pace = wentApart(measured, measured.way);
  evidence.uneven_warmth = wentApart(measured, measured.temperature);
  evidence.remounted = measured.classes.size() < measured.visits.size();
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

Decision decide(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                const TaxelFit& taxels, const Competition& competition, const SimulationSettings& base) {
  return Contest(measured, common, fit, taxels, competition, base).decide();
}

}  // namespace fsr
