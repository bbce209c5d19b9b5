#include "discrepancy/decide/decision.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "discrepancy/decide/enabled_columns.h"
#include "discrepancy/fit/cycle_scatter.h"
#include "discrepancy/samples/available_evidence.h"
#include "matrix/for_each_taxel.h"
#include "settings/number_text.h"
#include "simulation/effects/effect_library.h"
#include "statistics/median.h"

namespace fsr::discrepancy {

namespace {

using Ids = std::vector<std::string>;

constexpr double kLeastSlope = 0.05;  // of the mean one: below it a reading tells nothing of the pressure

// The columns that the effects competed with are derivatives, or changes at a few strengths. The effects are
// therefore fitted through the forward model, and the change that the fit gives is a column, too. The fit
// begins at these multiples of the strength of the best column, or of the usual strength: a delay of seconds
// is far from linear.
constexpr double kStarts[] = {1, 3, 10};
constexpr std::size_t kSeconds = 2;  // effects that are tried as a second one

class Verdicts {
 public:
  Verdicts(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
           const Candidates& candidates, const simulation::SimulationSettings& base,
           const DiscrepancyOptions& options)
      : measured_(measured),
        common_(common),
        fit_(fit),
        candidates_(candidates),
        base_(base),
        options_(options),
        explanations_(candidates.explanations()),
        columns_(candidates.columns()),
        always_(addEnabled()),
        design_(cycleDesign(measured, fit, common.all, columns_, always_)),
        least_slope_(kLeastSlope * meanSlope()) {}

  Decision run();

 private:
  // An effect or a pair, fitted through the forward model.
  struct Fitted {
    Ids ids;
    Refined refined;
    std::vector<bool> bent_only;
  };
  void search();
  void sharpen();
  void pairUp();
  std::vector<SingleColumn> startsOf(const Weighed& weighed) const;
  std::vector<std::size_t> seconds() const;
  simulation::EnabledEffect begin(const SingleColumn& column) const;
  const Fitted& fitted(const Weighed& weighed);
  Fitted fitSingle(const Weighed& weighed) const;
  std::vector<Eigen::Index> addEnabled();
  Eigen::Index addColumn(const Trace& trace);
  Trace explained(const Weighed& weighed) const;
  double meanSlope() const;
  double atMap(const Trace& trace) const;
  void measureSizes();
  bool matters() const;
  bool unknown() const;
  bool wrongForm();
  const Weighed& preferred() const { return appraisal_.all[appraisal_.credible.front()]; }
  bool refuted() const { return appraisal_.p_beyond <= options_.level; }
  const Weighed* withFewestCovariates(const Weighed* best) const;
  void tellUnknown();
  void tellEffects();
  void tellRest();
  void putPlausibleFirst();
  void dropSizesOfNone();
  void addPartners();
  void addPartner(const std::string& id, bool lacks_the_same);
  void listCandidates();
  void listCovariates();
  void listSmallestSeen();
  void listTooSmall();
  const CycleNoise& noise() const;

  const Measured& measured_;
  const CommonTraces& common_;
  const StaticFit& fit_;
  const Candidates& candidates_;
  const simulation::SimulationSettings& base_;
  const DiscrepancyOptions& options_;
  std::vector<Explaining> explanations_;
  Eigen::MatrixXd columns_;  // [samples x columns]
  std::vector<Eigen::Index> always_;
  CycleDesign design_;
  double least_slope_;  // [share of full scale / Pa]
  NullFit null_;
  Appraisal appraisal_;
  std::deque<Fitted> fitted_;
  std::vector<std::string> untold_;  // effects that could not compete and cannot be excluded
  const Weighed* told_ = nullptr;    // explanation of the verdict; nullptr = nothing is missing
  Decision decision_;
};

bool Verdicts::matters() const {
  double largest = appraisal_.all[appraisal_.best].at_map;
  if (!appraisal_.credible.empty()) largest = std::max(largest, preferred().at_map);
  return largest >= decision_.least_gap;
}

// Where the fit of a single effect begins.
std::vector<SingleColumn> Verdicts::startsOf(const Weighed& weighed) const {
  std::vector<SingleColumn> starts;
  if (weighed.contends) {
    for (const double multiple : kStarts) {
      starts.push_back(weighed.beginning);
      starts.back().coefficient *= multiple;
    }
    return starts;
  }
  const auto& all = candidates_.signatures();
  const auto own = std::find_if(all.begin(), all.end(),
                                [&](const Signature& s) { return s.id == weighed.explaining.ids.front(); });
  const double usual =
      simulation::parameter(measured_.info(own->id), own->strength).usual / std::abs(own->scale);
  for (const double multiple : kStarts) starts.push_back({own - all.begin(), multiple * usual, false});
  return starts;
}

simulation::EnabledEffect Verdicts::begin(const SingleColumn& column) const {
  const Signature& signature = candidates_.signatures()[static_cast<std::size_t>(column.column)];
  simulation::EnabledEffect effect{signature.id, signature.values};
  const simulation::EffectParameter& strength =
      simulation::parameter(measured_.info(signature.id), signature.strength);
  effect.values[signature.strength] =
      std::clamp(column.coefficient * signature.scale, strength.permitted.low, strength.permitted.high);
  return effect;
}

Verdicts::Fitted Verdicts::fitSingle(const Weighed& weighed) const {
  Fitted best{weighed.explaining.ids, {}, {false}};
  bool any = false;
  for (const SingleColumn& start : startsOf(weighed)) {
    const Signature& signature = candidates_.signatures()[static_cast<std::size_t>(start.column)];
    const std::vector<bool> bent = {start.bent_only};
    const Refined now = refine(measured_, common_, fit_, base_, {begin(start)}, signature.state_kept, bent);
    if (any && now.share <= best.refined.share) continue;
    any = true;
    best.refined = now;
    best.bent_only = bent;
  }
  return best;
}

const Verdicts::Fitted& Verdicts::fitted(const Weighed& weighed) {
  for (const Fitted& one : fitted_) {
    if (one.ids == weighed.explaining.ids) return one;
  }
  fitted_.push_back(fitSingle(weighed));
  return fitted_.back();
}

// Adds the columns of the effects that the simulation has. Returns their indices.
std::vector<Eigen::Index> Verdicts::addEnabled() {
  const Eigen::MatrixXd enabled = enabledColumns(measured_, fit_, base_);
  std::vector<Eigen::Index> indices;
  for (Eigen::Index k = 0; k < enabled.cols(); ++k) indices.push_back(addColumn(enabled.col(k)));
  return indices;
}

// Adds a column, scaled to rms 1.
Eigen::Index Verdicts::addColumn(const Trace& trace) {
  const double rms = std::sqrt(trace.squaredNorm() / static_cast<double>(trace.size()));
  columns_.conservativeResize(Eigen::NoChange, columns_.cols() + 1);
  columns_.col(columns_.cols() - 1) = rms > 0 ? Trace(trace / rms) : trace;
  return columns_.cols() - 1;
}

void Verdicts::sharpen() {
  std::vector<std::size_t> effects;
  for (std::size_t e = 0; e < explanations_.size(); ++e) {
    if (explanations_[e].ids.size() == 1) effects.push_back(e);
  }
  std::vector<Fitted> fits(effects.size());
  matrix::forEachTaxel(effects.size(), options_.threads,
                       [&](std::size_t k) { fits[k] = fitSingle(appraisal_.all[effects[k]]); });
  for (std::size_t k = 0; k < effects.size(); ++k) {
    fitted_.push_back(fits[k]);
    const Refined& refined = fitted_.back().refined;
    if (refined.share > 0)
      explanations_[effects[k]].forms.push_back({{addColumn(refined.trace)}, {false}, false, true});
  }
  design_ = cycleDesign(measured_, fit_, common_.all, columns_, always_);
  appraisal_ = appraise(design_, null_, explanations_, options_);
}

// Effects that may be a second one beside the preferred effect, the one that adds most first. Each of the two
// must add to any form of the other: the error of a form looks like a second effect.
std::vector<std::size_t> Verdicts::seconds() const {
  std::vector<std::size_t> chosen;
  for (std::size_t e = 0; e < appraisal_.additions.size(); ++e) {
    const Addition& adds = appraisal_.additions[e];
    const bool other = explanations_[e].ids.size() == 1 && explanations_[e].ids != preferred().explaining.ids;
    if (other && adds.nats > appraisal_.null_score && adds.closes >= options_.second_adds)
      chosen.push_back(e);
  }
  std::sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) {
    return appraisal_.additions[a].nats > appraisal_.additions[b].nats;
  });
  chosen.resize(std::min(chosen.size(), kSeconds));
  const std::size_t first = appraisal_.credible.front();
  const auto error_of_form = [&](std::size_t e) {
    const auto added = [&](std::size_t one, std::size_t to) {
      return addedToAnyForm(design_, null_, explanations_, one, to, options_);
    };
    return std::min(added(e, first), added(first, e)) <= appraisal_.null_score;
  };
  chosen.erase(std::remove_if(chosen.begin(), chosen.end(), error_of_form), chosen.end());
  return chosen;
}

// Pairs of the preferred effect with a second one. A pair must be better than the preferred effect with any
// generic terms.
void Verdicts::pairUp() {
  if (appraisal_.credible.empty() || !refuted()) return;
  const Weighed first = preferred();
  const std::size_t singles = explanations_.size();
  const Fitted alone = fitted(first);
  if (alone.refined.effects.empty()) return;
  for (const std::size_t e : seconds()) {
    const SingleColumn& more = appraisal_.additions[e].beginning;
    const std::vector<bool> bent = {alone.bent_only.front(), more.bent_only};
    const Ids ids = {first.explaining.ids.front(), explanations_[e].ids.front()};
    const Refined both = refine(measured_, common_, fit_, base_, {alone.refined.effects.front(), begin(more)},
                                alone.refined.state_kept, bent);
    if (both.share <= alone.refined.share) continue;
    fitted_.push_back({ids, both, bent});
    Explaining pair{ids,
                    {{{addColumn(both.trace)}, {false}, false, true}},
                    first.explaining.covariates,
                    first.explaining.slow && explanations_[e].slow};
    for (const simulation::Covariate c : explanations_[e].covariates) {
      if (!std::count(pair.covariates.begin(), pair.covariates.end(), c)) pair.covariates.push_back(c);
    }
    explanations_.push_back(pair);
  }
  if (explanations_.size() == singles) return;
  double generic = 0;
  for (std::size_t e = 0; e < singles; ++e) {
    if (explanations_[e].generic()) generic = std::max(generic, appraisal_.additions[e].nats);
  }
  design_ = cycleDesign(measured_, fit_, common_.all, columns_, always_);
  Appraisal with = appraise(design_, null_, explanations_, options_);
  if (!with.credible.empty() && with.credible.front() >= singles &&
      with.all[with.credible.front()].total >= first.total + generic)
    appraisal_ = std::move(with);
}

void Verdicts::search() {
  null_ = fitNull(design_);
  appraisal_ = appraise(design_, null_, explanations_, options_);
  null_ = appraisal_.null;
  measureSizes();
  if (appraisal_.p > options_.level || !matters()) return;
  sharpen();
  if (appraisal_.p > options_.level) return measureSizes();
  pairUp();
  dropSizesOfNone();
  measureSizes();
}

bool Verdicts::unknown() const {
  if (appraisal_.credible.empty()) return true;
  if (refuted() && preferred().closes < options_.unknown_below) return true;
  return appraisal_.generic_better;
}

// An effect that would have to be larger than any that its sources know has another form as well.
bool Verdicts::wrongForm() {
  return (refuted() && preferred().closes < options_.wrong_form_below) || appraisal_.own_form_better ||
         fitted(preferred()).refined.implausible;
}

// What an explanation adds to the common trace, by its columns.
Trace Verdicts::explained(const Weighed& weighed) const {
  const Form& form = weighed.explaining.forms[weighed.score.form];
  Trace trace = Trace::Zero(columns_.rows());
  for (std::size_t k = 0; k < form.columns.size(); ++k) {
    const double coefficient = weighed.score.fit.coefficients[static_cast<Eigen::Index>(k)];
    if (coefficient != 0) trace += coefficient * columns_.col(form.columns[k]);
  }
  if (!form.bent_only) return trace;
  for (std::size_t i = 0; i < measured_.samples(); ++i) {
    if (dataset::isFlat(measured_.classes[measured_.classOf(i)])) trace[static_cast<Eigen::Index>(i)] = 0;
  }
  return trace;
}

// Rise of the static curves over the range of the pressure [share of full scale / Pa].
double Verdicts::meanSlope() const {
  double highest = -INFINITY, lowest = INFINITY;
  for (std::size_t i = 0; i < measured_.samples(); ++i) {
    if (!fit_.isFitted(i)) continue;
    highest = std::max(highest, fit_.curve()[static_cast<Eigen::Index>(i)]);
    lowest = std::min(lowest, fit_.curve()[static_cast<Eigen::Index>(i)]);
  }
  return (highest - lowest) / std::max(1.0, design_.range);
}

// Rms of what a trace adds and the static curves cannot take up, at the map: the change of the reading
// divided by the slope of the static curve, over the fit cycles [Pa]. No error is larger than the range.
double Verdicts::atMap(const Trace& trace) const {
  const Trace left = fit_.residual(trace);
  double square = 0, number = 0;
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    if (!(fit_.slope()[i] > least_slope_) || !fit_.isFitted(static_cast<std::size_t>(i))) continue;
    square += std::pow(std::min(std::abs(left[i]) / fit_.slope()[i], design_.range), 2);
    ++number;
  }
  return number > 0 ? std::sqrt(square / number) : 0;
}

void Verdicts::measureSizes() {
  for (Weighed& one : appraisal_.all) one.at_map = atMap(explained(one));
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
  decision_.explained = explained(*best);
  told_ = best;
  for (const simulation::Covariate c : best->explaining.covariates)
    decision_.depends_on.push_back(simulation::name(c));
}

// An effect that needs evidence which was not recorded cannot be told from the effects with similar traces.
// Those that come near it stay credible, and those that could not compete for lack of the same evidence.
void Verdicts::addPartners() {
  const AvailableEvidence evidence = availableEvidence(measured_);
  const auto lacks = [&](const simulation::EffectInfo& info, simulation::Evidence need) {
    return std::count(info.needs.begin(), info.needs.end(), need) > 0 && !evidence.has(need);
  };
  const std::vector<std::size_t> certain = appraisal_.credible;
  for (const std::size_t e : certain) {
    for (const std::string& id : appraisal_.all[e].explaining.ids) {
      const simulation::EffectInfo& info = measured_.info(id);
      for (const simulation::Evidence need : info.needs) {
        if (!lacks(info, need)) continue;
        for (const std::string& other : info.collinear) addPartner(other, lacks(measured_.info(other), need));
      }
    }
  }
}

void Verdicts::addPartner(const std::string& id, bool lacks_the_same) {
  bool competed = false;
  for (std::size_t e = 0; e < appraisal_.all.size(); ++e) {
    const Weighed& one = appraisal_.all[e];
    if (one.explaining.ids != Ids{id}) continue;
    competed = true;
    auto& set = appraisal_.credible;
    if (one.contends && !std::count(set.begin(), set.end(), e)) set.push_back(e);
  }
  const auto& out = options_.leave_out;
  const bool sought =
      measured_.info(id).looked_for && !base_.effect(id) && !std::count(out.begin(), out.end(), id);
  if (!competed && lacks_the_same && sought && !std::count(untold_.begin(), untold_.end(), id))
    untold_.push_back(id);
}

// What is known of the sizes of effects decides where the score does not: among the effects that the score
// does not exclude, one that would have to be larger than its sources know does not come first.
void Verdicts::putPlausibleFirst() {
  auto& set = appraisal_.credible;
  std::stable_partition(set.begin(), set.end(),
                        [&](std::size_t e) { return !fitted(appraisal_.all[e]).refined.implausible; });
}

// An effect explains nothing where its columns take up much more than its forward model does, whose size may
// be none.
void Verdicts::dropSizesOfNone() {
  constexpr double kMuch = 0.5;  // of the rms
  const auto none = [&](std::size_t e) {
    const Refined& refined = fitted(appraisal_.all[e]).refined;
    return mayBeNone(refined, measured_.effects()) &&
           refined.trace.norm() < kMuch * fit_.residual(explained(appraisal_.all[e])).norm();
  };
  auto& set = appraisal_.credible;
  set.erase(std::remove_if(set.begin(), set.end(), none), set.end());
}

void Verdicts::tellEffects() {
  putPlausibleFirst();
  const std::size_t not_excluded = appraisal_.credible.size();
  addPartners();
  const Weighed& first = preferred();
  decision_.closes = first.closes;
  decision_.z = first.z;
  decision_.at_map = first.at_map;
  decision_.explained = explained(first);
  told_ = &first;
  decision_.refined = fitted(first).refined;
  decision_.bent_only = fitted(first).bent_only;
  for (const std::size_t e : appraisal_.credible) {
    decision_.densities.push_back(decision_.credible.size() < not_excluded ? appraisal_.all[e].density
                                                                           : first.density);
    decision_.credible.push_back(appraisal_.all[e].explaining.ids);
    if (e != appraisal_.credible.front()) decision_.rivals.push_back(fitted(appraisal_.all[e]).refined);
  }
  for (const std::string& id : untold_) decision_.credible.push_back({id});
  tellRest();
  for (const simulation::Covariate c : first.explaining.covariates)
    decision_.depends_on.push_back(simulation::name(c));
  decision_.verdict = decision_.credible.size() > 1 ? Verdict::kAmbiguous
                      : wrongForm()                 ? Verdict::kWrongForm
                                                    : Verdict::kNamed;
}

// What chance does not explain beside the preferred effects, and what would add most to them.
void Verdicts::tellRest() {
  constexpr double kPrinted = 0.0005;  // share of what can be closed; less is printed as 0.0 %
  if (!refuted() || appraisal_.additions.empty()) return;
  const auto less = [](const Addition& a, const Addition& b) { return a.nats < b.nats; };
  const auto most = std::max_element(appraisal_.additions.begin(), appraisal_.additions.end(), less);
  if (most->closes < kPrinted) return;
  const Explaining& more =
      appraisal_.all[static_cast<std::size_t>(most - appraisal_.additions.begin())].explaining;
  const Ids& ids = preferred().explaining.ids;
  decision_.limitations.push_back(
      "Something remains beside " + nameOf(preferred().explaining) + " that chance does not explain. " +
      (more.ids == ids ? "Another form of it" : nameOf(more)) +
      " would add most: " + settings::fixedText(100 * most->closes, 1) + " % of what can be closed.");
}

void Verdicts::listCandidates() {
  for (const Weighed& one : appraisal_.all) {
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
  for (const std::string& id : untold_) {
    CandidateScore candidate;
    candidate.ids = {id};
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
    test.depends = told_ && one.p <= options_.level && one.at_map >= decision_.least_gap;
    decision_.covariates.push_back(test);
  }
}

// Of each effect: the size from which it would have been found. It is the median over the forms, and not
// known where no form of it needs a plausible strength to be found.
void Verdicts::listSmallestSeen() {
  for (const Weighed& one : appraisal_.all) {
    if (one.explaining.ids.size() != 1) continue;
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
        plausible = plausible || range.contains(strength) || range.contains(-strength);
        sizes.push_back(std::max(atMap(*least * columns_.col(column)), decision_.least_gap));
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
    decision_.too_small.push_back({nameOf(one.explaining), one.p, one.at_map});
  }
}

// The noise fitted together with the explanation of the verdict, or with none.
const CycleNoise& Verdicts::noise() const {
  return told_ && told_->contends ? told_->noise : null_.best;
}

Decision Verdicts::run() {
  decision_.least_gap =
      std::isnan(options_.least_gap) ? options_.least_gap_share * design_.range : options_.least_gap;
  decision_.explained = Trace::Zero(common_.all.size());
  if (explanations_.empty() || design_.cycles.size() < 2) return decision_;
  search();
  decision_.p = appraisal_.p;
  if (appraisal_.p <= options_.level) {
    if (!matters()) {
      listTooSmall();
    } else if (unknown()) {
      tellUnknown();
    } else {
      tellEffects();
    }
  }
  decision_.scatter = scatterOf(design_, noise());
  decision_.noise = noiseOf(design_, noise());
  listCandidates();
  listCovariates();
  listSmallestSeen();
  return std::move(decision_);
}

}  // namespace

Decision decide(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                const Candidates& candidates, const simulation::SimulationSettings& base,
                const DiscrepancyOptions& options) {
  return Verdicts(measured, common, fit, candidates, base, options).run();
}

}  // namespace fsr::discrepancy
