// Finds statements of a report that contradict each other, and is tested on reports that say two things.
#include "discrepancy/contradictions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "support/example_discrepancy.h"

namespace test_support {

namespace {

using fsr::discrepancy::CandidateScore;
using fsr::discrepancy::CovariateTest;
using fsr::discrepancy::DiscrepancyReport;
using fsr::discrepancy::Verdict;
using Ids = std::set<std::string>;

class Checker {
 public:
  explicit Checker(const DiscrepancyReport& report) : report_(report), verdict_(name(report.verdict)) {
    for (const auto& effect : report.effects) effects_.insert(effect.id);
    for (const auto& one : report.not_identifiable) hidden_.insert(one.id);
    tested_.insert(report.tested.begin(), report.tested.end());
  }

  std::vector<std::string> run() {
    verdict();
    sentence();
    candidates();
    dependences();
    identifiability();
    gap();
    numbers();
    return std::move(found_);
  }

 private:
  void need(bool holds, const std::string& what) {
    if (!holds) found_.push_back(verdict_ + ": " + what);
  }
  bool nothing() const {
    return report_.verdict == Verdict::kNone || report_.verdict == Verdict::kNotIdentifiable;
  }

  void verdict() {
    const std::size_t sets = report_.credible_set.size();
    switch (report_.verdict) {
      case Verdict::kNone:
        need(sets == 0, "the credible set is not empty");
        break;
      case Verdict::kUnknown:
        need(sets == 0, "the credible set is not empty");
        need(!report_.depends_on.empty(), "it depends on nothing");
        break;
      case Verdict::kNotIdentifiable:
        need(sets > 0, "no effect is named that cannot be shown");
        break;
      case Verdict::kNamed:
      case Verdict::kWrongForm:
        need(sets == 1, "the credible set has " + std::to_string(sets) + " members");
        break;
      case Verdict::kAmbiguous:
        need(sets > 1, "the credible set has " + std::to_string(sets) + " members");
    }
    if (nothing() || report_.verdict == Verdict::kUnknown) {
      need(effects_.empty(), "an effect is listed");
      need(report_.in_use.empty(), "a cost in use is stated for no effect");
      need(std::isnan(report_.gap.closed), "a gap is closed by no effect");
    } else {
      const auto& first = report_.credible_set.front();
      need(effects_ == Ids(first.begin(), first.end()), "the effects are not the first of the credible set");
      need(!std::isnan(report_.gap.before), "a name without a gap");
    }
    if (nothing()) {
      need(report_.depends_on.empty(), "it depends on " + joined(report_.depends_on));
      need(std::isnan(report_.at_map), "a size at the map is stated");
      need(report_.p > report_.options.level || !report_.too_small.empty(), "p is below the level");
    } else {
      need(report_.p <= report_.options.level || byTests(), "p is above the level");
    }
  }

  // Whether something was found without a competition.
  bool byTests() const {
    return std::any_of(report_.covariates.begin(), report_.covariates.end(), [](const CovariateTest& test) {
      return test.depends && test.method != "effect" && test.method != "predictive_density";
    });
  }

  void sentence() {
    if (report_.verdict != Verdict::kNone && report_.verdict != Verdict::kUnknown) {
      for (const auto& ids : report_.credible_set) {
        for (const std::string& id : ids) needInSentence(id);
      }
    }
    if (report_.verdict == Verdict::kNone) needInSentence("show none that is missing");
    if (report_.verdict == Verdict::kUnknown) {
      needInSentence("lacks something");
      for (const std::string& covariate : report_.depends_on) needInSentence(covariate);
    }
    const std::size_t at = report_.sentence.find(" effects tested");
    if (at != std::string::npos) needInSentence(std::to_string(report_.tested.size()) + " effects tested");
  }
  void needInSentence(const std::string& part) {
    need(report_.sentence.find(part) != std::string::npos, "\"" + part + "\" is not in: " + report_.sentence);
  }

  void candidates() {
    Ids held;
    for (const CandidateScore& candidate : report_.candidates) {
      if (candidate.outcome != "named" && candidate.outcome != "credible") continue;
      held.insert(candidate.ids.begin(), candidate.ids.end());
      need(candidate.outcome != "named" || report_.verdict != Verdict::kUnknown, "a candidate is named");
      const Ids ids(candidate.ids.begin(), candidate.ids.end());
      const auto& sets = report_.credible_set;
      need(std::any_of(sets.begin(), sets.end(),
                       [&](const auto& set) {
                         const Ids all(set.begin(), set.end());
                         return std::includes(all.begin(), all.end(), ids.begin(), ids.end());
                       }),
           joined(candidate.ids) + " is " + candidate.outcome + ", but not in the credible set");
    }
    if (report_.verdict == Verdict::kNotIdentifiable) return;
    for (const auto& ids : report_.credible_set) {
      for (const std::string& id : ids) need(held.count(id) > 0, "no candidate with " + id + " is credible");
    }
  }

  void dependences() {
    const auto holds = [](const CovariateTest& test, const std::string& covariate) {
      return (" " + test.covariate + " ").find(" " + covariate + " ") != std::string::npos;
    };
    for (const std::string& covariate : report_.depends_on) {
      bool yes = false;
      for (const CovariateTest& test : report_.covariates) {
        if (test.depends && holds(test, covariate)) yes = true;
        need(test.covariate != covariate || test.depends, "the table says no for " + covariate);
      }
      need(yes, "no row of the table says yes for " + covariate);
    }
    for (const CovariateTest& test : report_.covariates)
      need(!test.depends || !nothing(), "the table says yes for " + test.covariate);
  }

  void identifiability() {
    for (const std::string& id : tested_) need(hidden_.count(id) == 0, id + " is tested and not testable");
    for (const std::string& id : effects_) need(tested_.count(id) > 0, id + " is found, but was not tested");
    for (const auto& seen : report_.smallest_seen) {
      if (std::isnan(seen.at_map)) {
        need(hidden_.count(seen.id) > 0 || effects_.count(seen.id) > 0,
             seen.id + " cannot be seen, but counts as tested");
      } else {
        need(tested_.count(seen.id) > 0, seen.id + " would have been seen, but was not tested");
        need(seen.at_map >= report_.least_gap, seen.id + " would have been seen below the least gap");
      }
    }
    for (const auto& small : report_.too_small)
      need(small.at_map < small.least_gap, small.explanation + " is not too small");
    for (const auto& answer : report_.answers) {
      need((answer.answer == "not_identifiable") == (hidden_.count(answer.id) > 0 && !credible(answer.id)) ||
               report_.verdict == Verdict::kNotIdentifiable,
           "the answer for " + answer.id + " is " + answer.answer);
      need((answer.answer == "found") == (effects_.count(answer.id) > 0), "the answer for " + answer.id);
    }
    need(report_.answers.size() == report_.options.ask.size(), "a question has no answer");
  }
  bool credible(const std::string& id) const {
    const auto& sets = report_.credible_set;
    return std::any_of(sets.begin(), sets.end(),
                       [&](const auto& ids) { return std::count(ids.begin(), ids.end(), id) > 0; });
  }

  void gap() {
    const auto& gap = report_.gap;
    need(std::isnan(gap.before) == std::isnan(gap.after), "only one of before and after is known");
    need(std::isnan(gap.before) == report_.hold_out.empty(), "hold-out scans and the gap disagree");
    need(!std::isnan(gap.before) || report_.recompute.empty(), "a command recomputes no gap");
    if (std::isnan(gap.before)) return;
    need(!effects_.empty() || gap.after == gap.before, "the gap shrank by no effect");
    need(gap.floor_bracket.low <= gap.floor_bracket.high, "the floor's bracket is the wrong way round");
    need(gap.floor >= gap.floor_bracket.low && gap.floor <= gap.floor_bracket.high,
         "the floor is not in its bracket");
  }

  void numbers() {
    for (const auto& scatter : report_.scatter) {
      need(scatter.interval.low <= scatter.size && scatter.size <= scatter.interval.high,
           scatter.part + " is not in its interval");
      need(scatter.of_noise >= 0 && scatter.of_noise <= 1, scatter.part + " is no share of the noise");
    }
    for (const auto& effect : report_.effects) {
      for (const auto& p : effect.parameters)
        need(!(p.interval.low > p.value) && !(p.interval.high < p.value), p.name + " is not in its interval");
    }
  }

  static std::string joined(const std::vector<std::string>& items) {
    std::string all;
    for (const std::string& item : items) all += (all.empty() ? "" : ", ") + item;
    return all;
  }

  const DiscrepancyReport& report_;
  const std::string verdict_;
  Ids effects_, hidden_, tested_;
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> contradictions(const DiscrepancyReport& report) {
  return Checker(report).run();
}

namespace {

TEST(Contradictions, AreNoneInTheExample) {
  for (const std::string& sentence : contradictions(exampleDiscrepancy())) ADD_FAILURE() << sentence;
}

}  // namespace

}  // namespace test_support
