#include "discrepancy/decide/second_effect.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "discrepancy/thresholds.h"

namespace fsr::discrepancy {

namespace {

constexpr double kSecondOfRest = 0.45;   // of what remains explainable: a wrong form alone leaves that much
constexpr double kSecondOfFirst = 0.03;  // of what the first effect explains
constexpr double kSecondLookalike = 8;   // standard errors, where a wrong form of one looks like the other
constexpr double kAnyForm = 0.7;  // of what the second adds: if a form of the first adds it, there is none
constexpr double kWrongFormNear = 0.8;  // of the share of the pair that describes its wrong form
constexpr std::size_t kPairsRefined = 4;
constexpr double kMuchOpen = 0.75;  // of the common trace's error: below it there is room for a second effect

// Whether one effect of the pair resembles the residual of the other where the other's form differs from the
// library's.
bool lookAlike(const simulation::EffectLibrary& library, const Explanation& pair) {
  return std::any_of(pair.score.ids.begin(), pair.score.ids.end(), [&](const std::string& id) {
    const std::vector<std::string>& like = library.info(id).wrong_form_like;
    return std::any_of(like.begin(), like.end(), [&](const std::string& other) { return pair.has(other); });
  });
}

// Whether the pair describes the residual of an effect of `single` where its form differs from the library's.
bool isLeftBy(const simulation::EffectLibrary& library, const Explanation& pair, const Explanation& single) {
  return std::any_of(single.score.ids.begin(), single.score.ids.end(), [&](const std::string& id) {
    const std::vector<std::string>& like = library.info(id).wrong_form_like;
    const auto in_pair = [&](const std::string& other) { return pair.has(other); };
    return !like.empty() && std::all_of(like.begin(), like.end(), in_pair);
  });
}

bool takesAnyCourse(const simulation::EffectLibrary& library, const Explanation& pair) {
  const auto any_course = [&](const std::string& id) { return library.info(id).any_course; };
  return std::any_of(pair.score.ids.begin(), pair.score.ids.end(), any_course);
}

// The pairs with the best signatures, best first, and all pairs with the best single effect. The latter are
// included because a large effect is not linear in its strength, and its signature alone describes it badly.
std::vector<Explanation> bestPairs(const Comparison& comparison, const Explanation& one) {
  const CrossValidation& crossValidation = comparison.crossValidation();
  const std::vector<Explanation>& singles = comparison.singles();
  const std::vector<Family>& families = comparison.candidates().effects();
  std::vector<Explanation> pairs;
  for (std::size_t a = 0; a < singles.size(); ++a) {
    for (std::size_t b = a + 1; b < singles.size(); ++b) {
      // The gains of a few dozen cycles cannot determine two slow effects.
      if (comparison.infoOf(families[a].id).slow && comparison.infoOf(families[b].id).slow) continue;
      Explanation pair;
      pair.score = crossValidation.score(singles[a].score, families[b]);
      Score swapped = crossValidation.score(singles[b].score, families[a]);
      std::swap(swapped.ids.front(), swapped.ids.back());
      if (swapped.total < pair.score.total) pair.score = swapped;
      pair.share = comparison.shareOf(pair.score);
      pairs.push_back(pair);
    }
  }
  const auto better = [](const Explanation& a, const Explanation& b) { return a.share > b.share; };
  std::sort(pairs.begin(), pairs.end(), better);
  const auto first = pairs.begin() + static_cast<std::ptrdiff_t>(std::min(pairs.size(), kPairsRefined));
  pairs.erase(
      std::remove_if(first, pairs.end(), [&](const auto& pair) { return !pair.has(one.score.ids.front()); }),
      pairs.end());
  return pairs;
}

bool isWorthIt(const Comparison& comparison, const Explanation& one, double in_any_form,
               const Explanation& two) {
  const double gain = two.share - one.share, rest = std::max(comparison.explainable(), two.share) - one.share;
  if (lookAlike(comparison.library(), two) &&
      comparison.crossValidation().z(one.score, two.score) < kSecondLookalike)
    return false;
  if (in_any_form >= one.share + kAnyForm * gain) return false;
  return gain >= kSecondOfRest * rest && gain >= kSecondOfFirst * one.share &&
         comparison.behindInErrors(one, two) > thresholds::kSignificant &&
         gain / two.share * comparison.shareOfError(two.score) >= thresholds::kLeastShareOfError;
}

}  // namespace

bool mayBeOne(const Explanation& single, const Explanation& pair, const simulation::EffectLibrary& library) {
  return isLeftBy(library, pair, single) && single.share >= kWrongFormNear * pair.share;
}

std::vector<Explanation> pairsWorthIt(Comparison& comparison, const Explanation& one) {
  std::vector<Explanation> pairs = bestPairs(comparison, one);
  if (pairs.empty()) return pairs;
  const double open = std::max(comparison.explainable(), pairs.front().share) - one.share;
  if (open < kSecondOfFirst * one.share && one.share > kMuchOpen) pairs.clear();
  for (Explanation& pair : pairs) comparison.refineOne(pair);
  const double in_any_form = comparison.shareOf(comparison.inAnyForm(one));
  const auto hopeless = [&](const Explanation& pair) {
    return !isWorthIt(comparison, one, in_any_form, pair);
  };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), hopeless), pairs.end());
  const auto merit = [&](const Explanation& pair) {
    const bool doubtful = takesAnyCourse(comparison.library(), pair) || pair.refined.at_bound;
    return one.share + (pair.share - one.share) * (doubtful ? thresholds::kAnyCourseHides : 1);
  };
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const auto& a, const auto& b) { return merit(a) > merit(b); });
  if (!pairs.empty()) comparison.raiseExplainable(pairs.front().share);
  return pairs;
}

}  // namespace fsr::discrepancy
