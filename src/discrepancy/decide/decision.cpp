#include "discrepancy/decide/decision.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/decide/search.h"
#include "discrepancy/fit/cycle_noise.h"
#include "discrepancy/samples/available_evidence.h"
#include "discrepancy/samples/faults.h"
#include "settings/number_text.h"
#include "simulation/effects/effect_library.h"
#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

constexpr double kHour = 3600;  // [s]

using Ids = std::vector<std::string>;

class Verdicts {
 public:
  Verdicts(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
           const Candidates& candidates, const simulation::SimulationSettings& base,
           const DiscrepancyOptions& options)
      : measured_(measured),
        fit_(fit),
        candidates_(candidates),
        base_(base),
        options_(options),
        search_(measured, common, fit, candidates, base, options),
        appraisal_(search_.appraisal()) {
    decision_.explained = Trace::Zero(common.all.size());
  }

  Decision run();

 private:
  bool unknown() const;
  bool wrongForm();
  const Weighed* withFewestCovariates(const Weighed* best) const;
  void tellUnknown();
  bool courseIsBest();
  void tellCourse();
  void tellEffects();
  Preference preferring(const std::vector<std::size_t>& order, const std::vector<std::size_t>& partners);
  void tellRest();
  void addPartners(const Ids& ids);
  void addPartner(const std::string& id);
  void addUntested(const Ids& ids, const std::string& id, bool proved);
  void listCandidates();
  void listCovariates();
  void listSmallestSeen();
  void listTooSmall();
  const CycleNoise& noise() const;

  const Measured& measured_;
  const StaticFit& fit_;
  const Candidates& candidates_;
  const simulation::SimulationSettings& base_;
  const DiscrepancyOptions& options_;
  Search search_;
  const Appraisal& appraisal_;         // of the search
  std::vector<std::size_t> credible_;  // explanations, the preferred one first
  std::vector<Ids> untold_;            // explanations by effects that could not compete
  const Weighed* told_ = nullptr;      // explanation of the verdict; nullptr = nothing is missing
  Decision decision_;
};

bool Verdicts::unknown() const {
  if (appraisal_.credible.empty()) return true;
  if (search_.refuted() && search_.preferred().closes < options_.unknown_below) return true;
  return appraisal_.generic_better;
}

// An effect that would have to be larger than any that its sources know has another form as well.
bool Verdicts::wrongForm() {
  return (search_.refuted() && search_.preferred().closes < options_.wrong_form_below) ||
         appraisal_.own_form_better || search_.fitted(search_.preferred()).refined.implausible;
}

// Of the generic terms that close about as much as the best ones, those of fewest of their covariates.
const Weighed* Verdicts::withFewestCovariates(const Weighed* best) const {
  const Weighed* fewest = best;
  for (const Weighed& one : appraisal_.all) {
    const auto& own = one.explaining.covariates;
    if (!one.contends || !one.explaining.generic() || own.size() >= fewest->explaining.covariates.size())
      continue;
    const bool part = std::all_of(own.begin(), own.end(), [&](simulation::Covariate c) {
      return std::count(best->explaining.covariates.begin(), best->explaining.covariates.end(), c) > 0;
    });
    if (part && one.closes + options_.generic_better >= best->closes) fewest = &one;
  }
  return fewest;
}

void Verdicts::tellUnknown() {
  decision_.verdict = Verdict::kUnknown;
  const Weighed* best = nullptr;
  for (const Weighed& one : appraisal_.all) {
    if (one.contends && one.explaining.generic() && (!best || one.total > best->total)) best = &one;
  }
  if (!best) best = &appraisal_.all[appraisal_.best];
  best = withFewestCovariates(best);
  decision_.closes = best->closes;
  decision_.z = best->z;
  decision_.at_map = best->at_map;
  decision_.explained = search_.explained(*best);
  told_ = best;
  for (const simulation::Covariate c : best->explaining.covariates)
    decision_.depends_on.push_back(simulation::name(c));
}

// Whether a random course takes the place of what is found: where it scores highest and excludes all of it;
// or, where it leaves nothing, what is found is no good explanation, leaves something, or is the same effect
// with another course.
bool Verdicts::courseIsBest() {
  const Weighed* course = search_.course();
  if (!course) return false;
  const bool best = std::all_of(appraisal_.all.begin(), appraisal_.all.end(), [&](const Weighed& one) {
    return !one.contends || one.total <= course->total;
  });
  if (!best) return false;
  if (!appraisal_.credible.empty() && appraisal_.course->rivals.empty()) return true;
  return appraisal_.course->p_beyond > options_.level &&
         (unknown() || search_.refuted() || wrongForm() ||
          search_.preferred().explaining.ids == course->explaining.ids);
}

void Verdicts::tellCourse() {
  const Weighed& found = *search_.course();
  told_ = &found;
  const std::string& id = found.explaining.ids.front();
  const simulation::EffectInfo& info = measured_.info(id);
  const RandomCourse& course = candidates_.courses(id)[found.score.form];
  const simulation::EffectParameter& step = search_.courseParameter();
  const simulation::EffectParameter& fades = simulation::parameter(info, step.fades_over);
  const PriorVariance& variance = appraisal_.course->variance;
  const double size = search_.courseStep(variance.best);
  RandomFinding finding;
  finding.effect.id = id;
  for (const simulation::EffectParameter& one : info.parameters)
    finding.effect.values[one.name] = std::isnan(one.neutral) ? one.usual : one.neutral;
  finding.effect.values[fades.name] = course.shape.at(fades.name);
  finding.effect.values[step.name] = size;
  finding.parameters = {{step.name,
                         size,
                         step.permitted.unit,
                         {search_.courseStep(variance.low), search_.courseStep(variance.high)}},
                        {fades.name, course.shape.at(fades.name), fades.permitted.unit, {NAN, NAN}}};
  finding.filtered = search_.explained(found);
  finding.z = found.z;
  finding.alone = appraisal_.course->p_beyond > options_.level;
  finding.a_cycle = std::sqrt(variance.best * search_.design().cycle_time / kHour);
  if (step.walk == simulation::Walk::kGain)
    finding.a_cycle *= std::sqrt(fit_.curve().squaredNorm() / static_cast<double>(fit_.curve().size()));
  for (const std::size_t e : appraisal_.course->rivals) {
    const Ids& other = appraisal_.all[e].explaining.ids;
    const bool credible = std::count(appraisal_.credible.begin(), appraisal_.credible.end(), e) > 0;
    if (credible && !unknown() && !wrongForm() && other.size() == 1 && other != Ids{id})
      finding.partners.push_back(other.front());
  }
  addPartners({id});
  for (const Ids& untold : untold_) finding.partners.push_back(untold.front());
  decision_.p = found.p;
  decision_.at_map = found.at_map;
  for (const simulation::Covariate c : found.explaining.covariates)
    decision_.depends_on.push_back(simulation::name(c));
  decision_.course = finding;
}

// An effect that needs evidence which was not recorded cannot be told from the effects with similar traces.
// Those that come near it stay credible, and so do those that could not compete.
void Verdicts::addPartners(const Ids& ids) {
  const AvailableEvidence evidence = availableEvidence(measured_);
  for (const std::string& id : ids) {
    const simulation::EffectInfo& info = measured_.info(id);
    const bool proved = evidence.hasAll(info.needs);
    if (!proved) {
      for (const std::string& other : info.collinear) addPartner(other);
    }
    addUntested(ids, id, proved);
  }
}

void Verdicts::addPartner(const std::string& id) {
  for (std::size_t e = 0; e < appraisal_.all.size(); ++e) {
    const Weighed& one = appraisal_.all[e];
    const bool own = one.explaining.ids == Ids{id} && !one.explaining.by_chance;
    if (own && one.contends && !std::count(credible_.begin(), credible_.end(), e)) credible_.push_back(e);
  }
}

// Explanations in which an effect that could not compete takes the place of one that did. Beside one that
// lacks no evidence (`proved`), generic terms of its covariates must stand for it.
void Verdicts::addUntested(const Ids& ids, const std::string& id, bool proved) {
  const auto& generic = appraisal_.generic;
  for (const std::string& other : untestedBeside(id, measured_, candidates_, base_, options_.leave_out)) {
    const auto stands = [&](std::size_t e) {
      return within(appraisal_.all[e].explaining.covariates, measured_.info(other).depends_on);
    };
    if (proved && std::none_of(generic.begin(), generic.end(), stands)) continue;
    Ids instead = ids;
    std::replace(instead.begin(), instead.end(), id, other);
    if (!std::count(untold_.begin(), untold_.end(), instead)) untold_.push_back(instead);
    auto& untested = decision_.untested;
    if (!std::count(untested.begin(), untested.end(), other)) untested.push_back(other);
  }
}

void Verdicts::tellEffects() {
  search_.putLikelyFirst();
  std::vector<std::size_t> order = appraisal_.credible;
  credible_ = order;
  for (const std::size_t e : order) addPartners(appraisal_.all[e].explaining.ids);
  const std::vector<std::size_t> partners(credible_.begin() + static_cast<std::ptrdiff_t>(order.size()),
                                          credible_.end());
  static_cast<Preference&>(decision_) = preferring(order, partners);
  for (std::size_t k = 1; k < order.size(); ++k) {
    std::rotate(order.begin(), order.begin() + 1, order.end());
    decision_.others.push_back(preferring(order, partners));
  }
  told_ = &search_.preferred();
  tellRest();
  decision_.verdict = decision_.credible.size() > 1 ? Verdict::kAmbiguous
                      : wrongForm()                 ? Verdict::kWrongForm
                                                    : Verdict::kNamed;
}

// The first of `order` is preferred to the others, which are not excluded either, and to its partners.
Preference Verdicts::preferring(const std::vector<std::size_t>& order,
                                const std::vector<std::size_t>& partners) {
  const Weighed& first = appraisal_.all[order.front()];
  Preference told;
  told.closes = first.closes;
  told.z = first.z;
  told.at_map = first.at_map;
  told.explained = search_.explained(first);
  told.refined = search_.fitted(first).refined;
  told.bent_only = search_.fitted(first).bent_only;
  const auto add = [&](std::size_t e, const std::vector<double>& density) {
    told.densities.push_back(density);
    told.credible.push_back(appraisal_.all[e].explaining.ids);
    if (e != order.front()) told.rivals.push_back(search_.fitted(appraisal_.all[e]).refined);
  };
  for (const std::size_t e : order) add(e, appraisal_.all[e].density);
  for (const std::size_t e : partners) add(e, first.density);
  told.credible.insert(told.credible.end(), untold_.begin(), untold_.end());
  for (const simulation::Covariate c : first.explaining.covariates)
    told.depends_on.push_back(simulation::name(c));
  return told;
}

// What chance does not explain beside the preferred effects, and what would add most to them.
void Verdicts::tellRest() {
  constexpr double kPrinted = 0.0005;  // share of what can be closed; less is printed as 0.0 %
  if (!search_.refuted() || appraisal_.additions.empty()) return;
  const auto less = [](const Addition& a, const Addition& b) { return a.nats < b.nats; };
  const auto most = std::max_element(appraisal_.additions.begin(), appraisal_.additions.end(), less);
  if (most->closes < kPrinted) return;
  const Explaining& more =
      appraisal_.all[static_cast<std::size_t>(most - appraisal_.additions.begin())].explaining;
  const Ids& ids = search_.preferred().explaining.ids;
  decision_.limitations.push_back(
      "Something remains beside " + nameOf(search_.preferred().explaining) +
      " that chance does not explain. " + (more.ids == ids ? "Another form of it" : nameOf(more)) +
      " would add most: " + settings::fixedText(100 * most->closes, 1) + " % of what can be closed.");
}

void Verdicts::listCandidates() {
  for (const Weighed& one : appraisal_.all) {
    // An effect is listed once: with its random course where that is told.
    const bool same = told_ && told_->explaining.by_chance && told_->explaining.ids == one.explaining.ids;
    if (same ? &one != told_ : one.explaining.by_chance) continue;
    CandidateScore candidate;
    candidate.ids = one.explaining.generic() ? Ids{nameOf(one.explaining)} : one.explaining.ids;
    candidate.generic = one.explaining.generic();
    candidate.outcome = "refused";
    const auto& credible = decision_.credible;
    if (std::count(credible.begin(), credible.end(), candidate.ids)) candidate.outcome = "credible";
    candidate.nats = one.total;
    candidate.p = one.p;
    candidate.z = one.z;
    candidate.share_of_explainable = one.closes;
    candidate.at_map = one.at_map;
    decision_.candidates.push_back(candidate);
  }
  for (const Ids& ids : untold_) {
    CandidateScore candidate;
    candidate.ids = ids;
    candidate.outcome = "credible";
    for (double* none :
         {&candidate.nats, &candidate.p, &candidate.z, &candidate.share_of_explainable, &candidate.at_map})
      *none = NAN;
    decision_.candidates.push_back(candidate);
  }
  std::stable_sort(decision_.candidates.begin(), decision_.candidates.end(),
                   [](const CandidateScore& a, const CandidateScore& b) {
                     const bool credible[] = {a.outcome == "credible", b.outcome == "credible"};
                     if (credible[0] != credible[1]) return credible[0];
                     return std::isnan(b.nats) ? !std::isnan(a.nats) : a.nats > b.nats;
                   });
}

void Verdicts::listCovariates() {
  for (const Weighed& one : appraisal_.all) {
    if (!one.explaining.generic()) continue;
    CovariateTest test;
    test.covariate = nameOf(one.explaining);
    test.method = "predictive_density";
    test.p = one.p_alone;
    test.adjusted = one.p;
    test.at_map = one.at_map;
    test.depends = told_ && one.p <= options_.level && one.at_map >= search_.leastGap(one.explaining);
    decision_.covariates.push_back(test);
  }
}

// Of each effect: the size from which it would have been found. It is the median over the forms, and not
// known where every form of it needs more than a plausible strength to be found.
void Verdicts::listSmallestSeen() {
  for (const Weighed& one : appraisal_.all) {
    if (!one.explaining.single()) continue;
    std::vector<double> sizes;
    bool plausible = false;
    for (const Form& form : one.explaining.forms) {
      for (const Eigen::Index column : form.columns) {
        const auto& least = appraisal_.least_seen[static_cast<std::size_t>(column)];
        if (form.bent_only || form.fitted || !least) continue;
        const Signature& signature = candidates_.signatures()[static_cast<std::size_t>(column)];
        const double strength = std::abs(*least * signature.scale);
        const settings::Range& range =
            simulation::parameter(measured_.info(signature.id), signature.strength).plausible;
        plausible = plausible || strength <= std::max(std::abs(range.low), std::abs(range.high));
        sizes.push_back(
            std::max(search_.atMap(*least * search_.column(column)), search_.leastGap(one.explaining)));
      }
    }
    const double size = plausible && !sizes.empty() ? statistics::upperMedian(sizes) : NAN;
    decision_.smallest_seen.push_back({one.explaining.ids.front(), size});
  }
}

// What is visible, but smaller than the least gap: the best explanation, and the best one by effects.
void Verdicts::listTooSmall() {
  std::vector<std::size_t> shown = {appraisal_.best};
  const auto& credible = appraisal_.credible;
  if (!credible.empty() && credible.front() != appraisal_.best) shown.push_back(credible.front());
  for (const std::size_t e : shown) {
    const Weighed& one = appraisal_.all[e];
    decision_.too_small.push_back(
        {nameOf(one.explaining), one.p, one.at_map, search_.leastGap(one.explaining)});
  }
}

// The noise fitted together with the explanation of the verdict, or with none.
const CycleNoise& Verdicts::noise() const {
  return told_ && told_->contends ? told_->noise : search_.null().best;
}

Decision Verdicts::run() {
  decision_.least_gap = leastGap(measured_, options_);
  if (search_.empty()) return decision_;
  search_.run();
  decision_.p = appraisal_.p;
  const bool matters = search_.found() && search_.matters();
  if (matters ? courseIsBest() : search_.course() != nullptr) {
    tellCourse();
  } else if (matters) {
    unknown() ? tellUnknown() : tellEffects();
  } else if (search_.found()) {
    listTooSmall();
  }
  decision_.scatter = scatterOf(search_.design(), noise());
  decision_.noise = noiseOf(search_.design(), noise());
  listCandidates();
  listCovariates();
  listSmallestSeen();
  return std::move(decision_);
}

}  // namespace

std::vector<std::string> untestedBeside(const std::string& id, const Measured& measured,
                                        const Candidates& candidates,
                                        const simulation::SimulationSettings& base,
                                        const std::vector<std::string>& leave_out) {
  const AvailableEvidence evidence = availableEvidence(measured);
  const auto& explanations = candidates.explanations();
  std::vector<std::string> untested;
  if (!isSlow(measured.info(id).depends_on)) return untested;
  for (const simulation::EffectEntry& entry : measured.effects().entries()) {
    const simulation::EffectInfo& info = entry.info;
    const bool competed = std::any_of(explanations.begin(), explanations.end(), [&](const Explaining& one) {
      return one.ids == Ids{info.id} && !one.by_chance;
    });
    const bool resembles = std::count(info.collinear.begin(), info.collinear.end(), id) > 0;
    if (resembles && !competed && info.looked_for && !evidence.lacking(info.needs).empty() &&
        mayBeFound(info.id, base, leave_out))
      untested.push_back(info.id);
  }
  return untested;
}

Decision decide(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                const Candidates& candidates, const simulation::SimulationSettings& base,
                const DiscrepancyOptions& options) {
  return Verdicts(measured, common, fit, candidates, base, options).run();
}

}  // namespace fsr::discrepancy
