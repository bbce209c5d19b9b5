#include "discrepancy/decide/search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "discrepancy/decide/constancy.h"
#include "discrepancy/fit/signatures.h"
#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/available_evidence.h"
#include "discrepancy/samples/faults.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "matrix/for_each_taxel.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

constexpr double kQuotientStep = 0.05;  // of a parameter, for a difference quotient

bool isFitted(const simulation::EffectParameter& parameter) {
  return parameter.role == simulation::ParameterRole::kStrength || !parameter.tried.empty();
}

// The effect with one parameter a step further; nothing where this is not permitted.
std::optional<simulation::EnabledEffect> stepped(const simulation::EnabledEffect& effect,
                                                 const simulation::EffectParameter& parameter) {
  simulation::EnabledEffect further = effect;
  double& value = further.values.at(parameter.name);
  const double step = kQuotientStep * (value != 0 ? std::abs(value) : std::abs(parameter.usual));
  if (!(step > 0) || !std::isfinite(step)) return std::nullopt;
  for (const double way : {1.0, -1.0}) {
    if (!parameter.permitted.contains(value + way * step)) continue;
    value += way * step;
    return further;
  }
  return std::nullopt;
}

Trace changeOf(const Measured& measured, const StaticFit& fit, const simulation::EffectInfo& info,
               const DrivenSignals& without, const simulation::SimulationSettings& further) {
  const DrivenSignals with = driven(measured, further);
  const DrivenSignals change{with.load - without.load,
                             with.gain.cwiseQuotient(without.gain.cwiseMax(1e-9)).array() - 1,
                             with.reading - without.reading};
  return throughCurve(measured, fit, change, info.stage, 0);
}

// What a small change of each parameter of the enabled effects with a time course would add to the common
// trace [samples x parameters]. These parameters were fitted while other effects were
// missing, so they may be wrong by as much as the missing effects allow.
Eigen::MatrixXd enabledColumns(const Measured& measured, const StaticFit& fit,
                               const simulation::SimulationSettings& settings) {
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(measured.samples()), 0);
  std::optional<DrivenSignals> without;
  for (const simulation::EnabledEffect& effect : settings.effects) {
    const simulation::EffectInfo& info = measured.info(effect.id);
    if (!hasTimeCourse(info)) continue;
    for (const simulation::EffectParameter& parameter : info.parameters) {
      const auto further = isFitted(parameter) ? stepped(effect, parameter) : std::nullopt;
      if (!further) continue;
      if (!without) without = driven(measured, settings);
      Trace change;
      try {
        change = changeOf(measured, fit, info, *without, withEffect(settings, *further));
      } catch (const settings::InputError&) {
        continue;  // the effect refuses this combination of parameters
      }
      if (change.isZero(0)) continue;
      columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
      columns.col(columns.cols() - 1) = change;
    }
  }
  return columns;
}

constexpr double kLeastSlope = 0.05;  // of the mean one: below it a reading tells nothing of the pressure

// The columns that the effects competed with are derivatives, or changes at a few strengths. The effects are
// therefore fitted through the forward model, and the change that the fit gives is a column, too. The fit
// begins at these multiples of the strength of the best column, or of the usual strength: a delay of seconds
// is far from linear.
constexpr double kStarts[] = {1, 3, 10};
// Combinations of shapes at which it begins besides, and how much of the error may be left then.
constexpr std::size_t kShapes = 2;
constexpr double kClearlyLess = 0.9;
constexpr std::size_t kSeconds = 2;  // effects that are tried as a second one

// Signatures of several amplitudes.
bool isOfOneShape(const Signature& a, const Signature& b) {
  return a.id == b.id && a.strength == b.strength && a.state_kept == b.state_kept && a.values == b.values;
}

}  // namespace

Search::Search(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
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

bool Search::matters() const {
  const auto large = [&](const Weighed& one) { return one.at_map >= leastGap(one.explaining); };
  return large(appraisal_.all[appraisal_.best]) || (!appraisal_.credible.empty() && large(preferred()));
}

const Weighed* Search::course() const {
  if (!appraisal_.course) return nullptr;
  const Weighed& course = appraisal_.all[appraisal_.course->explanation];
  const bool plausible = courseStep(appraisal_.course->variance.high) <= courseParameter().plausible.high;
  return plausible && course.at_map >= leastGap(course.explaining) ? &course : nullptr;
}

const simulation::EffectParameter& Search::courseParameter() const {
  const Weighed& course = appraisal_.all[appraisal_.course->explanation];
  const std::string& id = course.explaining.ids.front();
  return simulation::parameter(measured_.info(id), candidates_.courses(id)[course.score.form].step);
}

double Search::courseStep(double variance) const {
  const bool zero = courseParameter().walk == simulation::Walk::kZero;
  return std::sqrt(variance) * (zero ? measured_.full_scale : 1);
}

double Search::leastGap(const Explaining& explaining) const {
  return discrepancy::leastGap(measured_, options_, explaining.slow);
}

double Search::usualCoefficient(const Signature& signature) const {
  return simulation::parameter(measured_.info(signature.id), signature.strength).usual /
         std::abs(signature.scale);
}

// Where the fit of a single effect begins.
std::vector<SingleColumn> Search::startsOf(const Weighed& weighed) const {
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
  for (const double multiple : kStarts)
    starts.push_back({own - all.begin(), multiple * usualCoefficient(*own), false});
  return starts;
}

// Tries each combination of an effect's shapes with its usual strength, which then follows from the change of
// the trace.
std::vector<SingleColumn> Search::nearestShapes(const std::string& id) const {
  const Forward forward(measured_, common_, fit_, base_);
  const Trace nothing = *forward.left({}, {});
  std::vector<std::pair<double, SingleColumn>> tried;  // with what it closes of the squared error
  const auto& all = candidates_.signatures();
  for (std::size_t s = 0; s < all.size(); ++s) {
    if (all[s].id != id || (s > 0 && isOfOneShape(all[s], all[s - 1]))) continue;
    SingleColumn start{static_cast<Eigen::Index>(s), usualCoefficient(all[s]), false};
    if (start.coefficient == 0) continue;
    const auto left = forward.left({begin(start)}, {false});
    if (!left) continue;
    const Trace change = nothing - *left;
    const double pull = change.dot(nothing), square = change.squaredNorm();
    if (!(square > 0) || (pull < 0 && !all[s].free_sign)) continue;
    start.coefficient *= pull / square;
    tried.emplace_back(pull * pull / square, start);
  }
  const std::size_t number = std::min(kShapes, tried.size());
  std::partial_sort(tried.begin(), tried.begin() + number, tried.end(),
                    [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<SingleColumn> nearest;
  for (std::size_t k = 0; k < number; ++k) nearest.push_back(tried[k].second);
  return nearest;
}

simulation::EnabledEffect Search::begin(const SingleColumn& column) const {
  const Signature& signature = candidates_.signatures()[static_cast<std::size_t>(column.column)];
  simulation::EnabledEffect effect{signature.id, signature.values};
  effect.carried_over = signature.state_kept;
  const simulation::EffectParameter& strength =
      simulation::parameter(measured_.info(signature.id), signature.strength);
  effect.values[signature.strength] =
      std::clamp(column.coefficient * signature.scale, strength.permitted.low, strength.permitted.high);
  return effect;
}

// The shapes are a last resort: among sizes and shapes that fit nearly alike, those near the best column
// stay.
Fitted Search::fitSingle(const Weighed& weighed) const {
  Fitted best{weighed.explaining.ids, {}, {false}};
  std::vector<std::pair<simulation::EnabledEffect, bool>> tried;  // clamped strengths may be the same
  const auto tryFrom = [&](const SingleColumn& start, double left) {
    const std::vector<bool> bent = {start.bent_only};
    const simulation::EnabledEffect from = begin(start);
    const bool again = std::any_of(tried.begin(), tried.end(), [&](const auto& one) {
      return one.first.values == from.values && one.first.carried_over == from.carried_over &&
             one.second == start.bent_only;
    });
    if (again) return;
    tried.emplace_back(from, start.bent_only);
    const Refined now = refine(measured_, common_, fit_, base_, {from}, bent);
    if (tried.size() > 1 && 1 - now.share >= left * (1 - best.refined.share)) return;
    best.refined = now;
    best.bent_only = bent;
  };
  for (const SingleColumn& start : startsOf(weighed)) tryFrom(start, 1);
  for (const SingleColumn& start : nearestShapes(weighed.explaining.ids.front()))
    tryFrom(start, kClearlyLess);
  return best;
}

const Fitted& Search::fitted(const Weighed& weighed) {
  for (const Fitted& one : fitted_) {
    if (one.ids == weighed.explaining.ids) return one;
  }
  fitted_.push_back(fitSingle(weighed));
  return fitted_.back();
}

// Adds the columns of the effects that the simulation has. Returns their indices.
std::vector<Eigen::Index> Search::addEnabled() {
  const Eigen::MatrixXd enabled = enabledColumns(measured_, fit_, base_);
  std::vector<Eigen::Index> indices;
  for (Eigen::Index k = 0; k < enabled.cols(); ++k) indices.push_back(addColumn(enabled.col(k)));
  return indices;
}

// Adds a column, scaled to rms 1.
Eigen::Index Search::addColumn(const Trace& trace) {
  const double rms = std::sqrt(trace.squaredNorm() / static_cast<double>(trace.size()));
  columns_.conservativeResize(Eigen::NoChange, columns_.cols() + 1);
  columns_.col(columns_.cols() - 1) = rms > 0 ? Trace(trace / rms) : trace;
  return columns_.cols() - 1;
}

void Search::sharpen() {
  std::vector<std::size_t> effects;
  for (std::size_t e = 0; e < explanations_.size(); ++e) {
    if (explanations_[e].single()) effects.push_back(e);
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

// A slow effect beside a fast one lies in what changes from cycle to cycle. What the fast one closes within
// the cycles is no measure of it, and neither is the error of the fast one's form, unless it is too large.
bool Search::isSlowBesideFast(std::size_t second) {
  const Weighed& first = preferred();
  return explanations_[second].slow && !first.explaining.slow && !fitted(first).refined.implausible;
}

// Effects that may be a second one beside the preferred effect.
std::vector<Search::Second> Search::seconds() {
  std::vector<Second> seconds = secondsByDensity();
  for (const Second& one : secondsByCycles()) {
    const auto same = [&](const Second& second) { return second.effect == one.effect; };
    seconds.erase(std::remove_if(seconds.begin(), seconds.end(), same), seconds.end());
    seconds.push_back(one);
  }
  return seconds;
}

// Those that add to the density, the one that adds most first. Each of the two must add to any form of the
// other: the error of a form looks like a second effect.
std::vector<Search::Second> Search::secondsByDensity() {
  std::vector<std::size_t> chosen;
  for (std::size_t e = 0; e < appraisal_.additions.size(); ++e) {
    const Addition& adds = appraisal_.additions[e];
    const bool other = explanations_[e].single() && explanations_[e].ids != preferred().explaining.ids;
    const bool enough = adds.closes >= options_.second_adds || isSlowBesideFast(e);
    if (other && enough && adds.nats > appraisal_.null_score) chosen.push_back(e);
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
  std::vector<Second> seconds;
  for (const std::size_t e : chosen) seconds.push_back({e, appraisal_.additions[e].beginning, false});
  return seconds;
}

// Slow effects whose course follows from the cycles since the mounting, beside a fast effect that does not
// resemble them. A slow effect of any course would take up the error of the fast one's form.
std::vector<Search::Second> Search::secondsByCycles() {
  const Weighed& first = preferred();
  if (!first.explaining.single() || first.explaining.slow) return {};
  const auto& like = measured_.info(first.explaining.ids.front()).collinear;
  std::vector<Second> seconds;
  for (const Beside& one : slowBeside(design_, null_, explanations_, appraisal_.credible.front(), options_)) {
    const Explaining& slow = explanations_[one.explanation];
    const bool by_cycles =
        std::count(slow.covariates.begin(), slow.covariates.end(), simulation::Covariate::kCycle) > 0;
    if (by_cycles && !std::count(like.begin(), like.end(), slow.ids.front()) &&
        isSlowBesideFast(one.explanation))
      seconds.push_back({one.explanation, one.beginning, true});
  }
  return seconds;
}

// What generic terms add to the preferred effect at most, among those that a second effect competes with.
double Search::genericBeside(bool slow_beside_fast) const {
  double most = 0;
  for (std::size_t e = 0; e < appraisal_.additions.size(); ++e) {
    if (explanations_[e].generic() && (explanations_[e].slow || !slow_beside_fast))
      most = std::max(most, appraisal_.additions[e].nats);
  }
  return most;
}

// A pair acts as the fit through the forward model says. One whose second effect was found in the gains also
// acts by the columns of both, as its first effect alone does.
std::vector<Form> Search::formsOf(const Weighed& first, const Second& second, Eigen::Index fitted) const {
  const SingleColumn& more = second.beginning;
  std::vector<Form> forms = {{{fitted}, {false}, false, true}};
  Form both = first.explaining.forms[first.score.form];
  if (!second.by_gains || both.bent_only != more.bent_only) return forms;
  both.columns.push_back(more.column);
  both.free.push_back(candidates_.signatures()[static_cast<std::size_t>(more.column)].free_sign);
  both.fitted = true;
  forms.push_back(both);
  return forms;
}

// Pairs of the preferred effect with a second one. A pair must be better than the preferred effect with any
// generic terms, unless the gains show its second effect: what generic terms add under the noise of the first
// effect alone does not compare with a pair under a noise of its own.
void Search::pairUp() {
  if (appraisal_.credible.empty()) return;
  const Weighed first = preferred();
  const std::size_t singles = explanations_.size();
  std::vector<double> generic;  // of each pair
  const Fitted alone = fitted(first);
  if (alone.refined.effects.empty()) return;
  for (const Second& second : seconds()) {
    const std::size_t e = second.effect;
    const SingleColumn& more = second.beginning;
    const std::vector<bool> bent = {alone.bent_only.front(), more.bent_only};
    const std::vector<std::string> ids = {first.explaining.ids.front(), explanations_[e].ids.front()};
    const Refined both =
        refine(measured_, common_, fit_, base_, {alone.refined.effects.front(), begin(more)}, bent);
    if (both.share <= alone.refined.share) continue;
    fitted_.push_back({ids, both, bent});
    Explaining pair{ids, formsOf(first, second, addColumn(both.trace)), first.explaining.covariates,
                    first.explaining.slow && explanations_[e].slow};
    for (const simulation::Covariate c : explanations_[e].covariates) {
      if (!std::count(pair.covariates.begin(), pair.covariates.end(), c)) pair.covariates.push_back(c);
    }
    explanations_.push_back(pair);
    generic.push_back(second.by_gains ? 0 : genericBeside(isSlowBesideFast(e)));
  }
  if (explanations_.size() == singles) return;
  design_ = cycleDesign(measured_, fit_, common_.all, columns_, always_);
  Appraisal with = appraise(design_, null_, explanations_, options_);
  if (with.credible.empty() || with.credible.front() < singles) return;
  const std::size_t best = with.credible.front();
  if (with.all[best].total >= first.total + generic[best - singles]) appraisal_ = std::move(with);
}

void Search::run() {
  null_ = fitNull(design_);
  appraisal_ = appraise(design_, null_, explanations_, options_);
  null_ = appraisal_.null;
  measureSizes();
  if (appraisal_.p > options_.level || !matters()) return;
  sharpen();
  if (appraisal_.p > options_.level) return measureSizes();
  pairUp();
  auto& set = appraisal_.credible;
  set.erase(std::remove_if(set.begin(), set.end(), [&](std::size_t e) { return isNone(e) || isPhase(e); }),
            set.end());
  keepLikeTooLarge();
  measureSizes();
}

// What an explanation adds to the common trace, by its columns.
Trace Search::explained(const Weighed& weighed) const {
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
double Search::meanSlope() const {
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
double Search::atMap(const Trace& trace) const {
  const Trace left = fit_.residual(trace);
  double square = 0, number = 0;
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    if (!(fit_.slope()[i] > least_slope_) || !fit_.isFitted(static_cast<std::size_t>(i))) continue;
    square += std::pow(std::min(std::abs(left[i]) / fit_.slope()[i], design_.range), 2);
    ++number;
  }
  return number > 0 ? std::sqrt(square / number) : 0;
}

void Search::measureSizes() {
  for (Weighed& one : appraisal_.all) one.at_map = atMap(explained(one));
}

// An effect that would have to be larger than its sources know does not exclude those that resemble it, that
// would not, and that are no wrong form either.
void Search::keepLikeTooLarge() {
  if (appraisal_.credible.empty()) return;
  const Weighed& first = preferred();
  if (!first.explaining.single() || !fitted(first).refined.implausible) return;
  const auto& like = measured_.info(first.explaining.ids.front()).collinear;
  auto& set = appraisal_.credible;
  for (std::size_t e = 0; e < appraisal_.all.size(); ++e) {
    const Weighed& one = appraisal_.all[e];
    if (!one.contends || !one.explaining.single() || one.closes < options_.wrong_form_below) continue;
    const bool resembles = std::count(like.begin(), like.end(), one.explaining.ids.front()) > 0;
    if (!resembles || std::count(set.begin(), set.end(), e)) continue;
    if (!fitted(one).refined.implausible && !isNone(e) && !isPhase(e)) set.push_back(e);
  }
  std::sort(set.begin(), set.end(),
            [&](std::size_t a, std::size_t b) { return appraisal_.all[a].total > appraisal_.all[b].total; });
}

// Among what the score does not exclude, what is known beforehand counts, too: a size larger than any that
// its sources know, or a lack of evidence that could have refuted it, as much as the odds of `credible`.
void Search::putLikelyFirst() {
  const AvailableEvidence evidence = availableEvidence(measured_);
  const double odds = credibleOdds(options_);
  const auto likely = [&](std::size_t e) {  // [nats]
    const Weighed& one = appraisal_.all[e];
    const auto& ids = one.explaining.ids;
    const bool tested = std::all_of(ids.begin(), ids.end(), [&](const std::string& id) {
      return evidence.hasAll(measured_.info(id).needs);
    });
    return one.total - odds * (fitted(one).refined.implausible + !tested);
  };
  std::stable_sort(appraisal_.credible.begin(), appraisal_.credible.end(),
                   [&](std::size_t a, std::size_t b) { return likely(a) > likely(b); });
}

// An effect explains nothing where its columns take up much more than its forward model does, whose size may
// be none.
bool Search::isNone(std::size_t e) {
  constexpr double kMuch = 0.5;  // of the rms
  const Refined& refined = fitted(appraisal_.all[e]).refined;
  return mayBeNone(refined, measured_.effects()) &&
         refined.trace.norm() < kMuch * fit_.residual(explained(appraisal_.all[e])).norm();
}

// A trace that `part` should explain, without what wrong sizes of the enabled effects add to it.
Trace Search::withoutEnabled(const Trace& trace, const Trace& part) const {
  if (always_.empty()) return trace;
  Eigen::MatrixXd columns(trace.size(), static_cast<Eigen::Index>(always_.size()) + 1);
  columns.col(0) = part;
  for (std::size_t k = 0; k < always_.size(); ++k)
    columns.col(static_cast<Eigen::Index>(k) + 1) = fit_.residual(columns_.col(always_[k]));
  Eigen::VectorXd sizes = columns.colPivHouseholderQr().solve(trace);
  sizes[0] = 0;
  return trace - columns * sizes;
}

// What shifts slow cycles by more time than fast ones is a phase and no delay. Nor is what shifts early ones
// otherwise than late ones.
bool Search::isPhase(std::size_t e) {
  const Fitted& fit = fitted(appraisal_.all[e]);
  const Forward forward(measured_, common_, fit_, base_);
  for (std::size_t k = 0; k < fit.refined.effects.size(); ++k) {
    if (!measured_.info(fit.refined.effects[k].id).constant) continue;
    const Trace part = forward.explained({fit.refined.effects[k]}, {fit.bent_only[k]});
    const Trace wanted = fit_.residual(common_.all) - (fit.refined.trace - part);
    if (!isConstant(measured_, part, withoutEnabled(wanted, part))) return true;
  }
  return false;
}

}  // namespace fsr::discrepancy
