#include "discrepancy/decide/appraisal.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/decide/cycle_gains.h"
#include "matrix/for_each_taxel.h"
#include "statistics/random_stream.h"
#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

using Index = Eigen::Index;

constexpr double kNineOfTen = 1.2816;  // quantile of the normal distribution
constexpr int kNoiseRounds = 3;        // of the noise under the best explanation
constexpr double kHardly = 0.01;       // of the variances from cycle to cycle

// Columns that are fitted together with the static curves.
struct Chosen {
  std::vector<Index> columns;
  std::vector<double> variances;
  std::vector<bool> bent_only;

  void add(Index column, double variance, bool bent) {
    columns.push_back(column);
    variances.push_back(variance);
    bent_only.push_back(bent);
  }
  // Adds the columns of a form that take part.
  void add(const Form& form, const FormFit& fit) {
    for (std::size_t k = 0; k < form.columns.size(); ++k) {
      if (fit.variance > 0 && fit.coefficients[static_cast<Index>(k)] != 0)
        add(form.columns[k], fit.variance, form.bent_only);
    }
  }
};

// A reference that averages, or is read too rarely, is no discovery, and neither is a better size of an
// effect that the simulation has: their columns belong to every model.
Chosen always(const CycleDesign& design) {
  Chosen chosen;
  for (const Index column : design.always) chosen.add(column, 1, false);
  return chosen;
}

double meanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// Mean less `centre`, in standard errors.
double studentised(const std::vector<double>& values, double centre = 0) {
  const auto n = static_cast<double>(values.size());
  const double mean = meanOf(values);
  double square = 0;
  for (const double x : values) square += (x - mean) * (x - mean) / std::max(1.0, n - 1);
  return (mean - centre) / std::sqrt(std::max(square / n, 1e-300));
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> d(a);
  for (std::size_t c = 0; c < d.size(); ++c) d[c] -= b[c];
  return d;
}

// The column by which a single effect acts best.
SingleColumn beginningOf(const HeldOutScores& scores, const Explaining& explaining) {
  SingleColumn best;
  double most = -1;
  for (const Form& form : explaining.forms) {
    for (std::size_t k = 0; k < form.columns.size() && !form.fitted; ++k) {
      const FormFit fit = scores.fitAll({{form.columns[k]}, {form.free[k]}, form.bent_only, false});
      if (fit.likelihood <= most) continue;
      most = fit.likelihood;
      best = {form.columns[k], fit.coefficients[0], form.bent_only};
    }
  }
  return best;
}

// The same explanations in the same order; random courses have no form.
std::vector<Explaining> withoutCourses(std::vector<Explaining> explanations) {
  for (Explaining& one : explanations) {
    if (one.by_chance) one.forms.clear();
  }
  return explanations;
}

class Appraiser {
 public:
  Appraiser(const CycleDesign& design, const NullFit& null, const std::vector<Explaining>& explanations,
            const DiscrepancyOptions& options)
      : design_(design),
        options_(options),
        explanations_(explanations),
        competing_(withoutCourses(explanations)),
        null_(null),
        model_(modelWith(always(design))) {}

  Appraisal run() {
    for (const Explaining& explaining : explanations_) {
      result_.all.emplace_back();
      result_.all.back().explaining = explaining;
    }
    testNull();
    for (std::size_t e = 0; e < first_.size(); ++e) {
      result_.all[e].score = first_[e];
      result_.all[e].total = first_[e].total;
    }
    if (result_.p <= options_.level) weigh();
    if (result_.p <= options_.level) {
      gatherSet();
      listAdditions();
      compareGeneric();
    }
    weighCourses();
    result_.null = null_;
    return std::move(result_);
  }

  double addedToAnyForm(std::size_t one, std::size_t to) const {
    const Weighed first = underNull(to);
    const std::vector<HeldOutScore> plain = beyond(first, always(design_)).scores();
    const bool slow_to_fast = explanations_[one].slow && !first.explaining.slow;
    Chosen forms = always(design_);
    for (std::size_t g = 0; g < explanations_.size(); ++g) {
      const Explaining& generic = explanations_[g];
      if (!generic.generic() || plain[g].total <= 0) continue;
      if (slow_to_fast ? !generic.slow : within(generic.covariates, first.explaining.covariates))
        forms.add(generic.forms[plain[g].form], plain[g].fit);
    }
    return beyond(first, forms).scores()[one].total;
  }

  std::vector<Beside> slowBeside(std::size_t to) const {
    Weighed first = underNull(to);
    CycleDesign left = design_;
    takeOff(first.explaining.forms[first.score.form], first.score.fit, left);
    const std::vector<double> beside_it = chanceOfGains(left);
    const Form any = fastForms();
    if (!any.columns.empty()) takeOff(any, beyond(first, always(design_)).fitAll(any), left);
    const std::vector<double> beside_any = chanceOfGains(left);
    first.noise = withoutCycles();
    const HeldOutScores still = beyond(first, always(design_));
    std::vector<Beside> found;
    for (std::size_t e = 0; e < explanations_.size(); ++e) {
      if (std::max(beside_it[e], beside_any[e]) <= options_.level)
        found.push_back({e, beginningOf(still, explanations_[e])});
    }
    return found;
  }

 private:
  Weighed underNull(std::size_t e) const {
    Weighed one;
    one.explaining = explanations_[e];
    const std::vector<Explaining> alone = {one.explaining};
    one.score = scored(null_.noise, model_, alone).scores().front();
    one.noise = noiseUnder(one.explaining, one.score);
    return one;
  }

  // All fast generic terms in one form.
  Form fastForms() const {
    Form all;
    for (const Explaining& generic : explanations_) {
      if (!generic.generic() || generic.slow) continue;
      const Form& own = generic.forms.front();
      all.columns.insert(all.columns.end(), own.columns.begin(), own.columns.end());
      all.free.insert(all.free.end(), own.free.begin(), own.free.end());
    }
    return all;
  }
  static void takeOff(const Form& form, const FormFit& fit, CycleDesign& design) {
    for (CycleBins& bins : design.cycles) {
      if (form.bent_only && design.flat[bins.curvature_class]) continue;
      for (std::size_t k = 0; k < form.columns.size(); ++k)
        bins.reading -= fit.coefficients[static_cast<Index>(k)] * bins.columns.col(form.columns[k]);
    }
  }
  std::vector<double> chanceOfGains(const CycleDesign& design) const {
    return chanceByGains(design, explanations_, options_.null_draws, options_.seed);
  }

  StaticModel modelWith(const Chosen& chosen) const {
    StaticModel model(design_, chosen.columns, chosen.variances, chosen.bent_only);
    model.stiffness = null_.stiffness;
    model.visit_gain = null_.visit_gain;
    model.visit_offset = null_.visit_offset;
    return model;
  }
  StaticModel modelUnder(const Explaining& explaining, const HeldOutScore& score) const {
    Chosen chosen = always(design_);
    chosen.add(explaining.forms[score.form], score.fit);
    return modelWith(chosen);
  }
  CycleNoise noiseUnder(const Explaining& explaining, const HeldOutScore& score) const {
    return noiseUnder(explaining, score, null_.noise);
  }
  CycleNoise noiseUnder(const Explaining& explaining, const HeldOutScore& score,
                        const CycleNoise& start) const {
    StaticModel model = modelUnder(explaining, score);
    return fitNoise(design_, model, &start);
  }
  HeldOutScores scored(const CycleNoise& noise, const StaticModel& model,
                       const std::vector<Explaining>& explanations) const {
    return HeldOutScores(design_, noise, model, explanations, options_.folds, options_.degrees);
  }

  // Of the explanations that have a course of their own.
  std::size_t bestOf(const std::vector<HeldOutScore>& scores) const {
    std::size_t best = 0;
    for (std::size_t e = 1; e < scores.size(); ++e) {
      if (!explanations_[e].by_chance && scores[e].total > scores[best].total) best = e;
    }
    return best;
  }
  static double chance(const std::vector<double>& sorted, double score) {
    const auto above = sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), score);
    return (1 + static_cast<double>(above)) / (1 + static_cast<double>(sorted.size()));
  }

  // A random course has a null of its own, because it is scored in another way. Each of the two tests gets
  // its share (Bonferroni).
  double correctedChance(const NullScores& null, std::size_t e, double score) const {
    if (!explanations_[e].by_chance) return chance(null.largest, score);
    return std::min(1.0, 2 * chance(null.of[e], score));
  }

  void testNull() {
    const HeldOutScores scores = scored(null_.best, model_, explanations_);
    const NullScores null = scores.nullScores(options_.null_draws, options_.seed, options_.threads);
    first_ = scores.scores();
    null_density_ = densityOfNothing(scores);
    result_.best = bestOf(first_);
    result_.p = chance(null.largest, first_[result_.best].total);
    const auto at = static_cast<std::size_t>((1 - options_.level) * static_cast<double>(null.largest.size()));
    result_.null_score = null.largest[std::min(at, null.largest.size() - 1)];
    for (std::size_t e = 0; e < first_.size(); ++e) {
      result_.all[e].p = correctedChance(null, e, first_[e].total);
      result_.all[e].p_alone = chance(null.of[e], first_[e].total);
    }
    testGains();
    listLeastSeen(scores);
  }

  // The second test of whether anything is missing (Bonferroni).
  void testGains() {
    const std::vector<double> by_gains = chanceOfGains(design_);
    for (std::size_t e = 0; e < by_gains.size(); ++e) {
      const double p = std::min(1.0, 2 * by_gains[e]);
      result_.all[e].p = std::min(result_.all[e].p, p);
      result_.p = std::min(result_.p, p);
    }
  }

  // A column of coefficient b adds b^2 I / 2 - 1/2 nats in the mean, with a standard deviation of b sqrt(I),
  // where I is the information on it. At the least coefficient this exceeds the score of chance in nine of
  // ten recordings.
  void listLeastSeen(const HeldOutScores& scores) {
    result_.least_seen.resize(static_cast<std::size_t>(design_.columns));
    for (const Explaining& explaining : explanations_) {
      for (const Form& form : explaining.forms) {
        if (form.bent_only || !explaining.single()) continue;
        for (std::size_t k = 0; k < form.columns.size(); ++k) {
          const double information = scores.information(form.columns[k]);
          if (!(information > 0)) continue;
          const double needed = 2 * std::max(0.0, result_.null_score) + 1;
          result_.least_seen[static_cast<std::size_t>(form.columns[k])] =
              (kNineOfTen + std::sqrt(kNineOfTen * kNineOfTen + needed)) / std::sqrt(information);
        }
      }
    }
  }

  // Scores under the noise that is fitted together with the best explanation.
  struct Settled {
    std::vector<HeldOutScore> scores;
    std::size_t best = 0;
    double closable = 0;  // whitened loss
    CycleNoise start;     // of the fits of the noise
    double density = -INFINITY;
  };

  // Under the noise of the null, slow noise takes a part of a strong effect. So the noise is fitted again
  // together with the best explanation, until this stays the best.
  Settled settle(const std::vector<HeldOutScore>& first, const CycleNoise& start) const {
    Settled settled{first, bestOf(first), 1e-9, start};
    for (int round = 0; round < kNoiseRounds; ++round) {
      const std::size_t best = settled.best;
      if (settled.scores[best].fit.variance == 0) return settled;
      const CycleNoise noise = noiseUnder(explanations_[best], settled.scores[best], start);
      const HeldOutScores under = scored(noise, model_, competing_);
      settled.scores = under.scores();
      settled.best = bestOf(settled.scores);
      const HeldOutScore& score = settled.scores[settled.best];
      // What the best explanation closes can be closed.
      settled.closable = std::max({under.loss() - under.expectedLoss(), 2 * score.total, 1e-9});
      settled.density = 0;
      for (std::size_t c = 0; c < design_.cycles.size(); ++c)
        settled.density += under.density(c, score.nats[c]);
      if (settled.best == best) break;
    }
    return settled;
  }

  // What changes from cycle to cycle alike on all mounts, noise with a gain of each cycle explains as well as
  // an effect does. The noise is therefore also fitted from a start at which the cycles hardly differ.
  CycleNoise withoutCycles() const {
    CycleNoise noise = null_.noise;
    for (const auto part : {CycleNoise::kCycleOffset, CycleNoise::kCycleGain, CycleNoise::kWanderingGain})
      noise.variance[part] *= kHardly;
    return noise;
  }

  // Each explanation that comes near the best one is weighed under a noise that is fitted together with it.
  void weigh() {
    Settled settled = settle(first_, null_.noise);
    const CycleNoise still = withoutCycles();
    Settled other = settle(scored(still, model_, competing_).scores(), still);
    if (other.density > settled.density) settled = std::move(other);
    const std::vector<HeldOutScore>& scores = settled.scores;
    const std::size_t best = settled.best;
    closable_ = settled.closable;
    const double least = options_.contender * scores[best].total;
    std::vector<std::size_t> contenders;
    for (std::size_t e = 0; e < explanations_.size(); ++e) {
      Weighed& one = result_.all[e];
      one.closes = 2 * scores[e].total / closable_;
      one.contends = !one.explaining.by_chance && scores[e].total > 0 && scores[e].total >= least &&
                     scores[e].fit.variance > 0;
      if (one.contends) contenders.push_back(e);
    }
    matrix::forEachTaxel(contenders.size(), options_.threads, [&](std::size_t k) {
      Weighed& one = result_.all[contenders[k]];
      weighAlone(one, scores[contenders[k]], settled.start);
      keepBetter(one, scores[contenders[k]], null_.noise);
    });
    shareNoise(contenders);
    compareToNull(contenders);
    rank();
  }

  // The likelihood of the noise has several maxima. An explanation must not win by the maximum that its fit
  // has met, so each fit begins at the best noise, too, and so does that of nothing missing.
  void shareNoise(const std::vector<std::size_t>& contenders) {
    if (contenders.empty()) return;
    const auto& all = result_.all;
    const std::size_t best = *std::max_element(
        contenders.begin(), contenders.end(),
        [&](std::size_t a, std::size_t b) { return meanOf(all[a].density) < meanOf(all[b].density); });
    const CycleNoise start = all[best].noise;
    matrix::forEachTaxel(contenders.size(), options_.threads, [&](std::size_t k) {
      if (contenders[k] == best) return;
      Weighed& one = result_.all[contenders[k]];
      keepBetter(one, one.score, start);
    });
    improveNull(start);
  }

  // Tests again whether anything is missing where a better noise of nothing missing is found.
  void improveNull(const CycleNoise& start) {
    StaticModel nothing = model_;
    const CycleNoise noise = fitNoise(design_, nothing, &start);
    const std::vector<Explaining> any = {explanations_.front()};  // the density of nothing is that beside any
    if (meanOf(densityOfNothing(scored(noise, model_, any))) <= meanOf(null_density_)) return;
    null_.best = noise;
    testNull();
  }

  // Noise with the covariance of a random course, against that of independent cycles. Both noises begin at
  // each other's, because the likelihood has several maxima.
  void weighCourses() {
    for (std::size_t e = 0; e < explanations_.size(); ++e) {
      Weighed& one = result_.all[e];
      if (!explanations_[e].by_chance || one.p > options_.level || first_[e].fit.variance == 0) continue;
      weighAlone(one, first_[e], null_.noise);
      StaticModel nothing = model_;
      const HeldOutScores under = scored(fitNoise(design_, nothing, &one.noise), model_, explanations_);
      std::vector<double> plain = densityOfNothing(under);
      if (meanOf(plain) > meanOf(null_density_)) {
        const NullScores null = under.nullScores(options_.null_draws, options_.seed, options_.threads);
        one.p = correctedChance(null, e, under.scores()[e].total);
      } else {
        plain = null_density_;
      }
      const std::vector<double> more = difference(one.density, plain);
      one.total = meanOf(more) * static_cast<double>(more.size());
      one.z = studentised(more);
      if (one.total > 0 && one.p <= options_.level) tellCourse(e);
    }
  }

  // A trend is no random course: the odds against it must be those of `credible`.
  void tellCourse(std::size_t e) {
    Weighed& one = result_.all[e];
    const Form& chosen = one.explaining.forms[one.score.form];
    const std::vector<Explaining> alone = {one.explaining};
    const HeldOutScores own = scored(one.noise, model_, alone);
    double trend = 0;
    for (const Form& form : one.explaining.forms) {
      if (form.trend) trend = std::max(trend, own.fitAll(form).likelihood);
    }
    const double odds = credibleOdds(options_);
    if (chosen.trend || one.score.fit.likelihood < trend + odds) return;
    if (result_.course && result_.all[result_.course->explanation].total >= one.total) return;
    one.contends = true;
    result_.course = {e, own.varianceOf(chosen), chanceBeyond(beyond(one, always(design_))),
                      notExcluded(result_.credible, e)};
  }

  std::vector<double> densityOfNothing(const HeldOutScores& scores) const {
    std::vector<double> density;
    for (std::size_t c = 0; c < design_.cycles.size(); ++c) density.push_back(scores.density(c, 0));
    return density;
  }

  void weighAlone(Weighed& one, const HeldOutScore& found, const CycleNoise& start) const {
    one.noise = noiseUnder(one.explaining, found, start);
    const std::vector<Explaining> alone = {one.explaining};
    const HeldOutScores own = scored(one.noise, model_, alone);
    one.score = own.scores().front();
    one.density.clear();
    for (std::size_t c = 0; c < design_.cycles.size(); ++c)
      one.density.push_back(own.density(c, one.score.nats[c]));
    if (one.explaining.single()) one.beginning = beginningOf(own, one.explaining);
  }

  // Weighs it again from another start of its noise.
  void keepBetter(Weighed& one, const HeldOutScore& found, const CycleNoise& start) const {
    Weighed again = one;
    weighAlone(again, found, start);
    if (meanOf(again.density) > meanOf(one.density)) one = std::move(again);
  }

  void compareToNull(const std::vector<std::size_t>& contenders) {
    for (const std::size_t e : contenders) {
      Weighed& one = result_.all[e];
      const std::vector<double> more = difference(one.density, null_density_);
      one.total = meanOf(more) * static_cast<double>(more.size());
      one.z = studentised(more);
      one.contends = one.total > 0;
    }
  }

  void rank() {
    std::optional<std::size_t> best;
    for (std::size_t e = 0; e < result_.all.size(); ++e) {
      if (result_.all[e].contends && (!best || result_.all[e].total > result_.all[*best].total)) best = e;
    }
    if (best) result_.best = *best;
  }

  // Rivals that the best explanation does not exclude: step-down by the largest studentised difference,
  // bootstrapped over cycles.
  std::vector<std::size_t> notExcluded(std::vector<std::size_t> rivals, std::size_t best) const {
    std::size_t before = 0;
    while (!rivals.empty() && rivals.size() != before) {
      before = rivals.size();
      const double limit = largestByChance(best, rivals);
      const auto out = [&](std::size_t rival) { return studentised(behind(rival, best)) > limit; };
      rivals.erase(std::remove_if(rivals.begin(), rivals.end(), out), rivals.end());
    }
    return rivals;
  }

  void gatherSet() {
    std::vector<std::size_t> rivals, generic;
    for (std::size_t e = 0; e < result_.all.size(); ++e) {
      if (result_.all[e].contends) (result_.all[e].explaining.generic() ? generic : rivals).push_back(e);
    }
    std::sort(rivals.begin(), rivals.end(),
              [&](std::size_t a, std::size_t b) { return result_.all[a].total > result_.all[b].total; });
    if (rivals.empty()) return;
    const std::size_t best = rivals.front();
    rivals.erase(rivals.begin());
    rivals = notExcluded(rivals, best);
    result_.credible = {best};
    result_.credible.insert(result_.credible.end(), rivals.begin(), rivals.end());
    result_.generic = notExcluded(generic, best);
    keepMinimal();
  }

  // A pair is not needed where one of its effects alone is credible.
  void keepMinimal() {
    auto& set = result_.credible;
    const auto needless = [&](std::size_t pair) {
      const auto& ids = result_.all[pair].explaining.ids;
      return std::any_of(set.begin(), set.end(), [&](std::size_t other) {
        const auto& few = result_.all[other].explaining.ids;
        return few.size() < ids.size() && std::count(ids.begin(), ids.end(), few.front()) > 0;
      });
    };
    std::vector<std::size_t> kept;
    for (const std::size_t e : set) {
      if (!needless(e)) kept.push_back(e);
    }
    set = kept;
  }

  std::vector<double> behind(std::size_t worse, std::size_t better) const {
    return difference(result_.all[better].density, result_.all[worse].density);
  }

  double largestByChance(std::size_t best, const std::vector<std::size_t>& rivals) const {
    std::vector<std::vector<double>> d;
    for (const std::size_t rival : rivals) d.push_back(behind(rival, best));
    const statistics::RandomStream stream =
        statistics::randomStream(options_.seed, "discrepancy.set", rivals.size());
    const std::size_t n = d.front().size();
    std::vector<double> largest, drawn(n);
    for (std::size_t b = 0; b < options_.resamples; ++b) {
      double most = -INFINITY;
      for (const std::vector<double>& one : d) {
        for (std::size_t k = 0; k < n; ++k) drawn[k] = one[stream.bits(b * n + k) % n];
        most = std::max(most, studentised(drawn, meanOf(one)));
      }
      largest.push_back(most);
    }
    std::sort(largest.begin(), largest.end());
    return largest[static_cast<std::size_t>(options_.credible * static_cast<double>(largest.size() - 1))];
  }

  // What is left under the best explanation by effects, against its own null.
  HeldOutScores beyond(const Weighed& first, Chosen chosen) const {
    chosen.add(first.explaining.forms[first.score.form], first.score.fit);
    return scored(first.noise, modelWith(chosen), competing_);
  }
  double chanceBeyond(const HeldOutScores& left) const {
    const NullScores null = left.nullScores(options_.null_draws, options_.seed + 1, options_.threads);
    return chance(null.largest, left.scores()[bestOf(left.scores())].total);
  }

  // What each explanation adds to the best effects.
  void listAdditions() {
    if (result_.credible.empty()) return;
    const HeldOutScores left = beyond(result_.all[result_.credible.front()], always(design_));
    result_.p_beyond = chanceBeyond(left);
    if (result_.p_beyond > options_.level) return;
    for (std::size_t e = 0; e < explanations_.size(); ++e) {
      const double nats = left.scores()[e].total;
      result_.additions.push_back({nats, 2 * nats / closable_, {}});
      if (explanations_[e].ids.size() == 1 && nats > 0)
        result_.additions.back().beginning = beginningOf(left, explanations_[e]);
    }
  }

  // The best generic explanation by covariates that the preferred effects do not depend on, against these
  // effects and against generic terms of their own covariates.
  void compareGeneric() {
    if (result_.credible.empty()) return;
    const std::size_t effect = result_.credible.front();
    std::optional<std::size_t> own, other;
    for (std::size_t e = 0; e < result_.all.size(); ++e) {
      const Weighed& one = result_.all[e];
      if (!one.contends || !one.explaining.generic()) continue;
      auto& best = within(one.explaining.covariates, result_.all[effect].explaining.covariates) ? own : other;
      if (!best || one.total > result_.all[*best].total) best = e;
    }
    if (own) result_.own_form_better = better(*own, effect);
    if (other) result_.generic_better = better(*other, effect) && (!own || better(*other, *own));
  }

  // Whether an explanation closes enough more than another, and more than by chance.
  bool better(std::size_t one, std::size_t than) const {
    return result_.all[one].closes > result_.all[than].closes + options_.generic_better &&
           studentised(behind(than, one)) > largestByChance(one, {than});
  }

  const CycleDesign& design_;
  const DiscrepancyOptions& options_;
  const std::vector<Explaining>& explanations_;
  const std::vector<Explaining> competing_;
  NullFit null_;
  StaticModel model_;
  Appraisal result_;
  std::vector<HeldOutScore> first_;
  std::vector<double> null_density_;
  double closable_ = 1;
};

}  // namespace

double credibleOdds(const DiscrepancyOptions& options) {
  return std::log(options.credible / (1 - options.credible));
}

NullFit fitNull(const CycleDesign& design) {
  const Chosen chosen = always(design);
  StaticModel model(design, chosen.columns, chosen.variances, chosen.bent_only);
  NullFit null;
  null.noise = null.best = fitNoise(design, model);
  null.stiffness = model.stiffness;
  null.visit_gain = model.visit_gain;
  null.visit_offset = model.visit_offset;
  return null;
}

double addedToAnyForm(const CycleDesign& design, const NullFit& null,
                      const std::vector<Explaining>& explanations, std::size_t one, std::size_t to,
                      const DiscrepancyOptions& options) {
  return Appraiser(design, null, explanations, options).addedToAnyForm(one, to);
}

std::vector<Beside> slowBeside(const CycleDesign& design, const NullFit& null,
                               const std::vector<Explaining>& explanations, std::size_t to,
                               const DiscrepancyOptions& options) {
  return Appraiser(design, null, explanations, options).slowBeside(to);
}

Appraisal appraise(const CycleDesign& design, const NullFit& null,
                   const std::vector<Explaining>& explanations, const DiscrepancyOptions& options) {
  return Appraiser(design, null, explanations, options).run();
}

}  // namespace fsr::discrepancy
