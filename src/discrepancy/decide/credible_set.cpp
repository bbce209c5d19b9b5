#include "discrepancy/decide/credible_set.h"

#include <algorithm>

#include "discrepancy/decide/second_effect.h"
#include "discrepancy/thresholds.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

constexpr double kRivalWithin = 0.05;  // of what the best explanation explains
constexpr double kRivalFar = 0.15;    // likewise: further behind it is no rival, whatever the standard errors
constexpr double kSecondRival = 0.7;  // of what the second effect adds: a pair that adds as much is a rival
constexpr double kNearBadForm = 0.6;  // of the best explanation's share, where its form is wrong

using Ids = std::vector<std::string>;

// Whether the recordings cannot distinguish them.
bool isRival(const Comparison& comparison, const Explanation& other, const Explanation& best) {
  const AvailableEvidence& evidence = comparison.evidence();
  const double behind = best.share - other.share;
  if (comparison.behindInErrors(other, best) < thresholds::kSignificant && behind < kRivalFar * best.share)
    return true;
  if (mayBeOne(other, best, comparison.library())) return true;
  // A single effect was compared with a pair by what the second effect adds. Two pairs are compared by the
  // same measure.
  if (best.score.ids.size() > 1 && other.score.ids.size() == 1) return false;
  if (best.score.ids.size() > 1)
    return behind <= (1 - kSecondRival) * (best.share - comparison.best()->share);
  const simulation::EffectInfo &first = comparison.infoOf(best.score.ids.front()),
                               &second = comparison.infoOf(other.score.ids.front());
  // A drift imitates every slow effect. It excludes a slow effect only where the covariate of this effect was
  // not proportional to clock time.
  if (first.any_course && second.slow)
    return behind <= (evidence.apartFromClock(second) ? kRivalFar : thresholds::kAnyCourseHides) * best.share;
  // In that case a drift, with its three parameters, is no rival of the slow effect.
  if (second.any_course && first.slow && evidence.apartFromClock(first)) return false;
  return behind <= kRivalWithin * best.share;
}

// Whether the recordings contain the evidence that an effect needs to be named without a partner.
bool standsAlone(const AvailableEvidence& evidence, const simulation::EffectInfo& info) {
  return std::all_of(info.needs.begin(), info.needs.end(),
                     [&](simulation::Evidence e) { return evidence.has(e); });
}

// The best of the effects that are listed as similar to `info`, which is an effect of `explanation`. Null
// where none comes near.
const Explanation* partnerOf(const Comparison& comparison, const simulation::EffectInfo& info,
                             const Explanation& explanation) {
  const Explanation* partner = nullptr;
  for (const Explanation& single : comparison.singles()) {
    const std::string& other = single.score.ids.front();
    const bool listed = std::count(info.collinear.begin(), info.collinear.end(), other) > 0;
    const bool near = comparison.shows(single) || single.share >= kNearBadForm * explanation.share;
    if (!listed || explanation.has(other) || !near) continue;
    if (!partner || single.share > partner->share) partner = &single;
  }
  return partner;
}

}  // namespace

std::vector<Ids> credibleSet(const Comparison& comparison, const std::vector<Explanation>& pairs,
                             const Explanation& best) {
  std::vector<const Explanation*> rivals;
  const auto gather = [&](const Explanation& other) {
    if (other.score.ids != best.score.ids && isRival(comparison, other, best)) rivals.push_back(&other);
  };
  for (const Explanation& single : comparison.singles()) {
    if (comparison.shows(single)) gather(single);
  }
  for (const Explanation& pair : pairs) gather(pair);
  std::sort(rivals.begin(), rivals.end(),
            [](const Explanation* a, const Explanation* b) { return a->share > b->share; });
  std::vector<Ids> credible = {best.score.ids};
  for (const Explanation* rival : rivals) credible.push_back(rival->score.ids);
  if (comparison.evidence().temperature_moved) {
    std::stable_partition(credible.begin(), credible.end(), [&](const Ids& ids) {
      return ids.size() == 1 &&
             simulation::dependsOn(comparison.infoOf(ids.front()), simulation::Covariate::kTemperature);
    });
  }
  std::stable_partition(credible.begin(), credible.end(), [&](const Ids& ids) {
    return ids.size() != 1 || !comparison.infoOf(ids.front()).any_course;
  });
  return credible;
}

std::vector<Ids> partnersOf(const Comparison& comparison, const Explanation& first) {
  std::vector<Ids> partners;
  for (const std::string& id : first.score.ids) {
    const simulation::EffectInfo& info = comparison.infoOf(id);
    if (standsAlone(comparison.evidence(), info)) continue;
    if (const Explanation* partner = partnerOf(comparison, info, first))
      partners.push_back(partner->score.ids);
  }
  if (!partners.empty() || first.share >= thresholds::kGoodForm * comparison.explainable()) return partners;
  const simulation::EffectInfo& info = comparison.infoOf(first.score.ids.front());
  const bool slow_apart = info.slow && comparison.evidence().apartFromClock(info);
  for (const Explanation& single : comparison.singles()) {
    if (single.score.ids == first.score.ids || single.share < kNearBadForm * first.share) continue;
    // Hours of cycles and pauses distinguish the first effect from other slow effects, whatever its form.
    const bool told = slow_apart && comparison.infoOf(single.score.ids.front()).slow &&
                      comparison.behindInErrors(single, first) > thresholds::kSignificant;
    if (!told) partners.push_back(single.score.ids);
  }
  return partners;
}

}  // namespace fsr::discrepancy
