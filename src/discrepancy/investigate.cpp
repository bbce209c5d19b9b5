#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "discrepancy/decide/decision.h"
#include "discrepancy/decide/detections.h"
#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/parameter_fit.h"
#include "discrepancy/fit/taxel_curves_fit.h"
#include "discrepancy/fit/taxel_fit.h"
#include "discrepancy/prove/driven_gap.h"
#include "discrepancy/prove/freeze.h"
#include "discrepancy/prove/gap.h"
#include "discrepancy/prove/next_experiment.h"
#include "discrepancy/prove/report_gap.h"
#include "discrepancy/prove/wording.h"
#include "discrepancy/samples/measured.h"
#include "discrepancy/samples/views.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

constexpr int kMostRounds = 4;  // of repeat()

using Ids = std::vector<std::string>;

// One run of all steps. Each step needs the results of the steps before it.
class Investigation {
 public:
  Investigation(const DiscrepancyProblem& problem, const DiscrepancyProgress& progress)
      : problem_(problem), progress_(progress), measured_(admit(problem)) {}

  DiscrepancyReport run();

 private:
  void tell(const char* step, double share) const {
    if (progress_) progress_(step, share);
  }
  bool sought(simulation::Detector detector) const { return sought(simulation::foundBy(detector).id); }
  bool sought(const std::string& id) const {
    return mayBeFound(id, problem_.simulation, problem_.options.leave_out) && !current_.effect(id);
  }
  bool humOfAll() const;
  void detectFaults();
  void takeOutStatics();
  void refitStatics();
  void sizeTogether();
  void repeat();
  void moreEffects();
  void takeOutMains();
  void lookAtMounts();
  void compete();
  void lookAtStaticCurves();
  void lookAtTaxels();
  void abstainWithoutProof();
  void dropDetections();
  void abstain(const std::string& outcome);
  bool pays() const;
  void put();
  void report();
  void reportWhatPays();
  void startAgain();
  void putDetections();
  void tellScatter();
  void show();
  simulation::SimulationSettings withFaults(simulation::SimulationSettings settings) const;
  void prove();
  void listDependences();
  void takeInCourse();
  Ids partnersOf(const std::string& detected) const;
  void addPartners();
  CandidateScore& candidate(const std::string& id);
  void listDetections();
  void plan();
  double squareOfReadings() const {
    return spreadOf(measured_, *taxels_, Trace::Zero(common_.all.size())).square;
  }

  const DiscrepancyProblem& problem_;
  const DiscrepancyProgress& progress_;
  Measured measured_;
  CommonTraces common_;
  std::unique_ptr<StaticFit> fit_;
  std::unique_ptr<TaxelFit> taxels_;
  std::unique_ptr<Candidates> candidates_;
  Decision decision_;
  Mains mains_;
  StaticMisfit misfit_;
  bool unknown_statics_ = false;
  OddTaxels odd_;
  std::vector<Detection> detections_, later_;
  simulation::SimulationSettings current_;  // includes all effects that were subtracted
  bool quiet_ = false;
  bool by_terms_ = false;  // the gap is that of fitted terms, not of the effects in the simulation
  Trace left_;             // part of the common trace's residual that the effects explain
  DiscrepancyReport report_;
};

// Whether all taxels hum. The phases of a hum differ from line to line, so it is also a step of lines.
bool Investigation::humOfAll() const {
  const CommonTraces common = commonTraces(measured_);
  const StaticFit fit(measured_, CurvePer::kClass, common.all);
  return findMains(measured_, fit, TaxelFit(measured_, fit), problem_.options).found;
}

void Investigation::detectFaults() {
  const Faults faults = findFaults(measured_, problem_.options);
  const bool hum = std::any_of(faults.faults.begin(), faults.faults.end(),
                               [](const health::Fault& fault) { return fault.isLine(); }) &&
                   humOfAll();
  for (const health::Fault& fault : faults.faults) {
    if (!sought(effectOf(fault).id) || (hum && fault.isLine())) continue;
    detections_.push_back(detectionOf(fault, faults.readings));
    for (const std::size_t t : fault.taxels) measured_.used[t] = 0;
  }
  // All faults share one contribution to the gap. It is counted once.
  for (std::size_t f = 1; f < detections_.size(); ++f) detections_[f].before_more = 0;
  const std::size_t usable = measured_.usedTaxels(), all = measured_.taxels();
  if (thresholds::enoughUsable(usable, all) && usable > 0) return;
  throw settings::InputError(
      problem_.recordings[0].name + ": " + std::to_string(all - usable) + " of " + std::to_string(all) +
      " taxels are masked, dead, stuck or on a failing line, but at least half must be usable");
}

void Investigation::takeOutStatics() {
  common_ = commonTraces(measured_);
  fit_ = std::make_unique<StaticFit>(measured_, CurvePer::kClass, common_.all);
  taxels_ = std::make_unique<TaxelFit>(measured_, *fit_);
  report_.base = fitBase(measured_, *fit_, problem_.simulation);
  report_.base.library = measured_.library;
  report_.base = takeOutEnabled(measured_, common_, *fit_, report_.base, true);
  current_ = report_.base;
  if (!measured_.gain.empty()) refitStatics();
}

// Fits the static curves again after an effect was subtracted.
void Investigation::refitStatics() {
  common_ = commonTraces(measured_);
  if (mains_.found) takeOut(mains_, *fit_, common_);
  fit_ = std::make_unique<StaticFit>(measured_, fit_->per(), common_.all);
  taxels_ = std::make_unique<TaxelFit>(measured_, *fit_);
}

// The sizes of the effects that the simulation enables were fitted without any other effect. After an effect
// is found, their sizes are fitted together with it, and the search is repeated.
void Investigation::sizeTogether() {
  if (measured_.gain.empty() || decision_.credible.empty()) return;
  const std::vector<simulation::EnabledEffect> found = {decision_.refined.effects.front()};
  measured_.load.clear();
  measured_.gain.clear();
  measured_.added.clear();
  refitStatics();
  report_.base = current_ = takeOutEnabled(measured_, common_, *fit_, report_.base, true, found);
  refitStatics();
  compete();
}

// Each round subtracts the named effects and searches the residual again, until nothing is named. The
// hold-out cycles are not used.
void Investigation::repeat() {
  const Trace before = fit_->residual(common_.all);
  const Decision first = decision_;
  std::vector<simulation::EnabledEffect> found;
  for (int round = 0; round < kMostRounds; ++round) {
    const bool named = decision_.verdict == Verdict::kNamed;
    report_.steps.push_back({});
    report_.steps.back().at_map = decision_.at_map;
    if (!named) break;
    report_.steps.back().added = listText(decision_.credible.front(), " with ");
    report_.steps.back().sentence = "Added " + report_.steps.back().added + ".";
    simulation::SimulationSettings with = current_;
    for (const simulation::EnabledEffect& effect : decision_.refined.effects) with = withEffect(with, effect);
    if (round > 0) moreEffects();
    takeOut(measured_, *fit_, current_, with);
    current_ = with;
    refitStatics();
    compete();
  }
  report_.steps.back().sentence = "No further effect is named: " + name(decision_.verdict) + ".";
  if (report_.steps.size() < 2) return;
  const Decision last = decision_;
  decision_ = first;
  quiet_ = last.verdict == Verdict::kNone;
  if (!quiet_)
    report_.limitations.push_back("After the last round a discrepancy remains: " + name(last.verdict) + ".");
  by_terms_ = false;
  const Eigen::Map<const Trace> gain(measured_.gain.data(), before.size());
  left_ = before - fit_->residual(common_.all).cwiseProduct(gain);
}

// Keeps the effects of a later round, to report them beside those of the first round.
void Investigation::moreEffects() {
  for (std::size_t e = 0; e < decision_.refined.effects.size(); ++e) {
    const simulation::EffectInfo& info = measured_.info(decision_.refined.effects[e].id);
    later_.push_back({{info.id, info.summary, decision_.refined.parameters[e], decision_.z, decision_.closes},
                      {decision_.refined.effects[e]},
                      {},
                      {},
                      0,
                      0,
                      false});
    for (const simulation::Covariate c : info.depends_on)
      later_.back().depends_on.push_back(simulation::name(c));
  }
}

void Investigation::takeOutMains() {
  if (!sought(simulation::Detector::kMains)) return;
  mains_ = findMains(measured_, *fit_, *taxels_, problem_.options);
  if (!mains_.found) return;
  detections_.push_back(detectionOf(mains_, squareOfReadings(), measured_));
  takeOut(mains_, *fit_, common_);
}

// Where the readings of the same surface change with each remounting, every mount gets its own curves.
void Investigation::lookAtMounts() {
  if (!sought(simulation::Detector::kMounts)) return;
  const Repositioning mounts = findRepositioning(measured_, *fit_, *taxels_, Trace(), Eigen::MatrixXd());
  if (!mounts.found) return;
  detections_.push_back(detectionOf(mounts, squareOfReadings()));
  fit_ = std::make_unique<StaticFit>(measured_, CurvePer::kVisit, common_.all);
  taxels_ = std::make_unique<TaxelFit>(measured_, *fit_);
}

void Investigation::compete() {
  tell("signatures", 0.2);
  const auto& options = problem_.options;
  candidates_ = std::make_unique<Candidates>(
      measured_, *fit_, signatures(measured_, *fit_, current_, options.leave_out, options.threads));
  tell("naming", 0.6);
  decision_ = decide(measured_, common_, *fit_, *candidates_, current_, options);
}

void Investigation::lookAtStaticCurves() {
  misfit_ = findStaticMisfit(measured_, *fit_, common_.all, squareOfReadings());
  const bool else_found =
      !detections_.empty() || decision_.verdict != Verdict::kNone || !measured_.gain.empty();
  if (!isMisfit(misfit_, else_found) || misfit_.at_map < decision_.least_gap) return;
  // Beside something unknown a misfit has no name: it may be the same thing.
  const bool saturates = isSaturation(misfit_) && decision_.verdict != Verdict::kUnknown;
  if (saturates && sought(simulation::Detector::kSaturation))
    detections_.push_back(saturationOf(misfit_, measured_, *fit_));
  else
    unknown_statics_ = saturates || (decision_.verdict == Verdict::kNone && detections_.empty());
}

// A random course stands beside what the detectors found. It is common to all surfaces, because it is one of
// the clock.
void Investigation::takeInCourse() {
  if (!decision_.course) return;
  const RandomFinding& course = *decision_.course;
  const Trace left = fit_->residual(course.filtered);
  const Spread spread = spreadOf(measured_, *taxels_, left);
  WhereItShows where = placeOf(measured_, left, spread);
  where.conditions.clear();
  const double amplitude = where.taxels.empty() ? 1 : maskOf(measured_, where, spread).maxCoeff();
  detections_.push_back(detectionOf(course, measured_.info(course.effect.id), where, amplitude));
  decision_.limitations.push_back(courseText(course.effect.id, course.a_cycle, course.alone));
}

// Looks for effects on single taxels or lines where neither the common trace nor a detector shows an effect.
void Investigation::lookAtTaxels() {
  const bool else_found = unknown_statics_ || !detections_.empty() || decision_.verdict != Verdict::kNone;
  if (!else_found) odd_ = findOddTaxels(measured_, *taxels_);
}

// Where nothing is held out, no name can be proved, so none is given.
void Investigation::abstainWithoutProof() {
  if (HoldOutView(measured_, FitView(measured_)).scans() > 0) return;
  if (decision_.credible.empty() && detections_.empty()) return;
  dropDetections();
  abstain("required_data_missing");
}

// Keeps where detections show and what they depend on, but not their names.
void Investigation::dropDetections() {
  for (const Detection& detection : detections_) {
    report_.where = detection.where;
    for (const std::string& covariate : detection.depends_on) {
      auto& told = decision_.depends_on;
      if (!std::count(told.begin(), told.end(), covariate)) told.push_back(covariate);
    }
  }
  detections_.clear();
  decision_.course.reset();
}

// Gives no name to what the common trace shows.
void Investigation::abstain(const std::string& outcome) {
  decision_.verdict = Verdict::kUnknown;
  decision_.credible.clear();
  decision_.rivals.clear();
  decision_.refined = {};
  for (CandidateScore& candidate : decision_.candidates) {
    if (candidate.outcome == "credible") candidate.outcome = outcome;
  }
}

// Whether the simulation with what is named is nearer to the hold-out cycles than that without it. What is
// random is in neither of them; a fault need not show in these cycles.
bool Investigation::pays() const {
  if (report_.effects.empty() || report_.hold_out.empty()) return true;
  const Gap& gap = report_.gap;
  return decision_.credible.empty() ? gap.after <= gap.before : gap.after < gap.before;
}

// Writes the decision on the common trace into the report.
void Investigation::put() {
  report_.verdict = decision_.verdict;
  report_.credible_set = decision_.credible;
  report_.depends_on = decision_.depends_on;
  report_.candidates = decision_.candidates;
  report_.covariates = decision_.covariates;
  report_.smallest_seen = decision_.smallest_seen;
  report_.too_small = decision_.too_small;
  report_.scatter = decision_.scatter;
  report_.at_map = decision_.at_map;
  report_.p = decision_.p;
  report_.least_gap = decision_.least_gap;
  report_.options = problem_.options;
  report_.limitations.insert(report_.limitations.end(), decision_.limitations.begin(),
                             decision_.limitations.end());
  for (CandidateScore& candidate : report_.candidates) {
    const bool named = decision_.verdict == Verdict::kNamed && candidate.outcome == "credible";
    if (named) candidate.outcome = "named";
  }
  report_.added = report_.base;
  left_ = Trace::Zero(common_.all.size());
  by_terms_ = decision_.verdict == Verdict::kUnknown;
  if (by_terms_) left_ = fit_->residual(decision_.explained);
  if (decision_.credible.empty()) return;
  const Refined& refined = decision_.refined;
  for (std::size_t e = 0; e < refined.effects.size(); ++e) {
    report_.added = withEffect(report_.added, refined.effects[e]);
    const simulation::EffectInfo& info = measured_.info(refined.effects[e].id);
    report_.effects.push_back({info.id, info.summary, refined.parameters[e], decision_.z, decision_.closes});
    if (!info.if_negative.empty() && refined.parameters[e].front().interval.high < 0)
      report_.limitations.push_back(info.if_negative);
  }
  left_ = refined.trace;
}

// Restores readings and curves to those before the rounds of repeat(). The gap is measured against them.
void Investigation::startAgain() {
  measured_.load.clear();
  measured_.gain.clear();
  measured_.added.clear();
  refitStatics();
  takeOutEnabled(measured_, common_, *fit_, report_.base, false);
  refitStatics();
}

// Noise that no sound sheet has is itself what is missing: a gain that scatters from cycle to cycle by more
// than data sheets give for a single part (Interlink FSR 400: 2 %), or a reading that wanders over the whole
// range, or within the cycles by clearly more than the least gap, and more than all other noise.
void Investigation::tellScatter() {
  constexpr double kRepeatability = 0.02, kClearly = 2, kMost = 0.5;
  if (report_.verdict != Verdict::kNone) return;
  for (const Scatter& one : report_.scatter) {
    const bool gain = one.part == "cycle_gain";
    const double least = one.size > 0 ? one.at_map * one.interval.low / one.size : 0;  // [Pa]
    const bool wanders =
        one.at_map >= measured_.range() ||
        (one.part == "wandering" && one.of_noise > kMost && least > kClearly * report_.least_gap);
    if (!(gain ? one.interval.low > kRepeatability : wanders)) continue;
    report_.verdict = Verdict::kUnknown;
    report_.at_map = one.at_map;
    report_.depends_on = {
        simulation::name(gain ? simulation::Covariate::kCycle : simulation::Covariate::kClockTime)};
    report_.limitations.push_back(
        gain ? "The gain changes from cycle to cycle by " + settings::percentText(one.size, 1) +
                   "; data sheets give 2 % for a single part."
             : "The reading wanders by " + settings::roundedText(1e-3 * one.at_map, 2) + " kPa at the map.");
    return;
  }
}

// Adds the effects that detectors found to every explanation of the common trace.
void Investigation::putDetections() {
  const bool named = report_.verdict != Verdict::kNone && report_.verdict != Verdict::kUnknown;
  if (unknown_statics_ && named)
    report_.limitations.push_back(
        "The static curves of the surfaces differ in a way that nothing that was found explains.");
  if (unknown_statics_ && !named) {
    report_.verdict = Verdict::kUnknown;
    report_.at_map = misfit_.at_map;
    report_.depends_on = {simulation::name(simulation::Covariate::kPressure),
                          simulation::name(simulation::Covariate::kCurvature)};
    report_.where.pressure = misfit_.pressure;
    report_.where.conditions = misfit_.conditions;
  }
  if (!odd_.taxels.empty() && report_.verdict == Verdict::kNone) {
    report_.verdict = Verdict::kUnknown;
    report_.depends_on = {simulation::name(odd_.by)};
    report_.where.taxels = odd_.taxels;
  }
  if (detections_.empty()) return tellScatter();
  if (report_.verdict == Verdict::kUnknown) {
    report_.limitations.push_back("In addition to the unknown discrepancy there is " +
                                  detections_.front().effect.id + ".");
    return;
  }
  if (report_.verdict == Verdict::kNone) {
    report_.verdict = Verdict::kNamed;
    report_.credible_set = {{}};
    report_.where = detections_.front().where;
  }
  for (const Detection& detection : detections_) {
    for (Ids& ids : report_.credible_set) ids.push_back(detection.effect.id);
    report_.effects.push_back(detection.effect);
    for (const simulation::EnabledEffect& effect : detection.enable)
      report_.added = withEffect(report_.added, effect);
    for (const std::string& covariate : detection.depends_on) {
      auto& told = report_.depends_on;
      if (!std::count(told.begin(), told.end(), covariate)) told.push_back(covariate);
    }
  }
  addPartners();
}

// What the lack of evidence does not exclude in place of an effect that a detector found.
Ids Investigation::partnersOf(const std::string& detected) const {
  if (decision_.course && decision_.course->effect.id == detected) return decision_.course->partners;
  return untestedBeside(detected, measured_, *candidates_, current_, problem_.options.leave_out);
}

void Investigation::addPartners() {
  const Ids with = report_.credible_set.front();
  for (const Detection& detection : detections_) {
    for (const std::string& partner : partnersOf(detection.effect.id)) {
      if (std::count(with.begin(), with.end(), partner)) continue;
      report_.verdict = Verdict::kAmbiguous;
      report_.credible_set.push_back(with);
      std::replace(report_.credible_set.back().begin(), report_.credible_set.back().end(),
                   detection.effect.id, partner);
    }
  }
}

void Investigation::show() {
  tell("showing", 0.9);
  std::vector<simulation::EnabledEffect> beside;
  for (const Detection& more : later_) beside.insert(beside.end(), more.enable.begin(), more.enable.end());
  const double static_square = unknown_statics_ ? misfit_.rms * misfit_.rms : 0;
  const auto& options = problem_.options;
  reportGap({measured_, common_, *fit_, *taxels_, decision_, detections_, beside, left_, by_terms_,
             static_square, options.threads, options.seed},
            report_);
}

// Adds the faults of single taxels and lines that were found. What a taxel reads while it fails is no
// property of its static curve, so the curves are fitted together with its fault.
simulation::SimulationSettings Investigation::withFaults(simulation::SimulationSettings settings) const {
  for (const Detection& detection : detections_) {
    const simulation::EffectInfo& info = measured_.info(detection.effect.id);
    const bool fault =
        info.kind == simulation::EffectKind::kDetector && info.level != simulation::EffectLevel::kRig;
    for (const simulation::EnabledEffect& effect : detection.enable) {
      if (fault) settings = withEffect(settings, effect);
    }
  }
  return settings;
}

// Adds the curves of single taxels to both simulations and measures the gap of both as they are written.
void Investigation::prove() {
  const FitView fit(measured_);
  const HoldOutView hold_out(measured_, fit);
  report_.base.taxel_curves = withTaxelCurves(fit, withFaults(report_.base), "").taxel_curves;
  report_.base.taxel_curves_file = "base_curves.csv";
  if (report_.effects.empty()) {
    report_.added.taxel_curves = report_.base.taxel_curves;
    report_.added.taxel_curves_file = "simulation_curves.csv";
  } else {
    report_.added = withTaxelCurves(fit, report_.added, "simulation_curves.csv");
  }
  const auto& found = report_.effects;
  const auto chance = std::count_if(found.begin(), found.end(), [&](const FoundEffect& effect) {
    const simulation::EnabledEffect* added = report_.added.effect(effect.id);
    return added && simulation::isByChance(measured_.info(effect.id), *added);
  });
  tell("gap", 0.97);
  measureDrivenGap(fit, hold_out, report_.base, report_.added, fit_->slope(),
                   chance < static_cast<std::ptrdiff_t>(found.size()), problem_.options.seed, report_.gap);
  report_.hold_out = hold_out.spans();
  auto& missing = report_.gap.missing;
  if (chance > 0)
    missing.push_back(
        "A part of what was found is random, so no simulation repeats it as it was recorded. The gap leaves "
        "it out, as it leaves out noise.");
  if (hold_out.leftOut() > 0)
    missing.push_back(std::to_string(hold_out.leftOut()) +
                      (hold_out.leftOut() == 1 ? " scan of the hold-out cycles was"
                                               : " scans of the hold-out cycles were") +
                      " left out of the gap: no fitted cycle reaches such a pressure.");
  if (hold_out.scans() > 0) return;
  missing = {"Nothing was held out, so no gap was measured and no effect is named: record more cycles."};
  report_.gap.held_out_by.clear();
  report_.gap.foretold.clear();
}

// The entry of a single effect. One that did not compete has no scores.
CandidateScore& Investigation::candidate(const std::string& id) {
  auto& all = report_.candidates;
  const Ids ids = {id};
  const auto competed =
      std::find_if(all.begin(), all.end(), [&](const CandidateScore& one) { return one.ids == ids; });
  if (competed != all.end()) return *competed;
  CandidateScore added;
  added.ids = ids;
  added.nats = added.p = added.z = added.share_of_explainable = added.at_map = NAN;
  return *all.insert(all.begin(), added);
}

// Lists what detectors and later rounds found beside the explanations of the common trace.
void Investigation::listDetections() {
  if (report_.verdict == Verdict::kUnknown) return;
  for (const Detection& detection : detections_) {
    const Ids partners = partnersOf(detection.effect.id);
    for (const std::string& partner : partners) candidate(partner).outcome = "credible";
    CandidateScore& own = candidate(detection.effect.id);
    own.outcome = partners.empty() ? "named" : "credible";
    if (!std::isnan(own.z)) continue;
    own.z = detection.effect.z;
    own.share_of_explainable = detection.effect.share_of_explainable;
  }
}

// The findings depend on covariates, too. Where terms of such a covariate alone do not show it, the finding
// does, so its test stands in the list.
void Investigation::listDependences() {
  for (const std::string& covariate : report_.depends_on) {
    auto& tests = report_.covariates;
    const auto alone = std::find_if(tests.begin(), tests.end(),
                                    [&](const CovariateTest& test) { return test.covariate == covariate; });
    if (alone != tests.end() && alone->depends) continue;
    const auto& competed = decision_.depends_on;
    const bool of_effect =
        !std::isnan(decision_.at_map) && std::count(competed.begin(), competed.end(), covariate) > 0;
    CovariateTest test;
    test.covariate = covariate;
    test.method = of_effect                  ? "effect"
                  : !report_.effects.empty() ? "detector"
                  : unknown_statics_         ? "static_curves"
                  : !odd_.taxels.empty()     ? "odd_taxels"
                                             : "detector";
    test.p = test.adjusted = of_effect ? decision_.p : NAN;
    test.at_map = of_effect ? decision_.at_map : NAN;
    test.depends = true;
    if (alone != tests.end()) {
      *alone = test;
    } else {
      tests.push_back(test);
    }
  }
}

// Recommends the next experiment and predicts its result. The set misses the best explanation with the
// probability that remains beside `credible`.
void Investigation::plan() {
  const auto& pressure = measured_.raw_pressure;
  const double peak = *std::max_element(pressure.begin(), pressure.end());
  if (report_.verdict == Verdict::kUnknown) {
    report_.next_experiment = experimentFor(report_.depends_on, !report_.hold_out.empty(), peak);
    return;
  }
  Ids partners = decision_.untested, covariates;
  for (const Detection& detection : detections_) {
    const Ids of_detection = partnersOf(detection.effect.id);
    partners.insert(partners.end(), of_detection.begin(), of_detection.end());
  }
  for (const std::string& partner : partners) {
    for (const simulation::Covariate c : measured_.info(partner).depends_on)
      covariates.push_back(simulation::name(c));
  }
  if (report_.verdict == Verdict::kAmbiguous) report_.next_experiment = experimentFor(covariates, true, peak);
  if (decision_.credible.empty()) return;
  report_.prediction = freeze(decision_, measured_, common_, *fit_, report_.base, problem_.options);
  Contest contest;
  contest.explanations = {decision_.refined.effects};
  for (const Refined& rival : decision_.rivals) contest.explanations.push_back(rival.effects);
  contest.weights = report_.prediction.weights;
  contest.unknown = 1 - problem_.options.credible;
  contest.untested = decision_.untested;
  contest.at_hand = availableEvidence(measured_);
  contest.noise = decision_.noise;
  contest.peak = peak;
  contest.draws = problem_.options.null_draws;
  contest.seed = problem_.options.seed;
  const auto next = nextExperiment(onItsSurfaces(report_.base, measured_), contest);
  if (!next.empty()) report_.next_experiment = next;
}

// Writes the findings and their gap into the report.
void Investigation::report() {
  put();
  if (problem_.options.repeat) {
    repeat();
    detections_.insert(detections_.begin(), later_.begin(), later_.end());
    startAgain();
  }
  putDetections();
  show();
  tellOfOthers(problem_, measured_, *candidates_, decision_, report_);
  listDetections();
  listDependences();
  tell("curves", 0.92);
  prove();
}

// Where the simulation with the preferred effects does not pay, the next member of the set is preferred.
// Where none of them pays, none is named.
void Investigation::reportWhatPays() {
  const DiscrepancyReport before = report_;
  const std::vector<Detection> detections = detections_;
  report();
  if (pays()) return;
  const std::string best = listText(report_.credible_set.front(), " with ");
  const std::string farther = "the simulation with it is farther from the hold-out cycles than without it.";
  const auto start_again = [&](const std::string& said) {
    report_ = before;
    report_.limitations.push_back(said);
    detections_ = detections;
    later_.clear();
    quiet_ = false;
  };
  const Preference first = decision_;
  for (const Preference& other : std::exchange(decision_.others, {})) {
    static_cast<Preference&>(decision_) = other;
    start_again("The best guess, " + best + ", does not come first, because " + farther);
    report();
    if (pays()) return;
  }
  static_cast<Preference&>(decision_) = first;
  start_again("Best guess: " + best + ". It is no name, because " + farther);
  if (decision_.credible.empty()) {
    dropDetections();
  } else {
    decision_.explained = decision_.refined.trace;
  }
  abstain("does_not_pay");
  report();
}

DiscrepancyReport Investigation::run() {
  report_.seed = problem_.options.seed;
  report_.version = FSR_VERSION;
  for (const dataset::Recording& recording : problem_.recordings) {
    report_.inputs.push_back({recording.name, recording.sha256, recording.scans(), 1});
  }
  tell("faults", 0.05);
  detectFaults();
  tell("static curves", 0.1);
  takeOutStatics();
  lookAtMounts();
  takeOutMains();
  compete();
  sizeTogether();
  takeInCourse();
  lookAtStaticCurves();
  lookAtTaxels();
  abstainWithoutProof();
  reportWhatPays();
  plan();
  if (!decision_.credible.empty() && !by_terms_) {
    report_.in_use = costsInUse(measured_, report_.base, report_.added,
                                std::clamp(report_.gap.closed_interval.low, 0.0, 1.0));
  }
  if (!report_.prediction.effects.empty()) {
    report_.prediction.hash = hashOf(report_.prediction, report_.base);
  }
  report_.limitations.insert(report_.limitations.begin(), measured_.limitations.begin(),
                             measured_.limitations.end());
  report_.sentence = sentenceOf(report_);
  abstainIfUnfit(problem_.recordings, report_);
  tell("done", 1);
  return std::move(report_);
}

}  // namespace

DiscrepancyReport investigate(const DiscrepancyProblem& problem, const DiscrepancyProgress& progress) {
  validate(problem);
  if (progress) progress("reading", 0);
  try {
    return Investigation(problem, progress).run();
  } catch (const TooFewCycles& error) {
    const std::optional<DiscrepancyReport> answers = answersWithoutCycles(problem, error.what());
    if (!answers) throw;
    return *answers;
  }
}

}  // namespace fsr::discrepancy
