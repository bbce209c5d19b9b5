#include "statistics/paper_rule.h"

#include <algorithm>

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/repeated_measures.h"

namespace fsr::statistics {

namespace {

void requireProbabilities(const std::vector<double>& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] >= 0 && p[i] <= 1) continue;
    throw settings::InputError("correction for multiple tests: p value " + std::to_string(i + 1) + " is " +
                               std::to_string(p[i]) + "; it must lie between 0 and 1");
  }
}

}  // namespace

std::vector<double> bonferroni(const std::vector<double>& p) {
  requireProbabilities(p);
  std::vector<double> adjusted;
  for (const double value : p) adjusted.push_back(std::min(1.0, static_cast<double>(p.size()) * value));
  return adjusted;
}

namespace {

constexpr std::size_t kFewestForSymmetry = 5;
constexpr std::size_t kMostForNormality = 5000;

/// Applies the rule and notes each decision.
class Walk {
 public:
  Walk(const RepeatedMeasures& measures, const PaperRuleOptions& options)
      : measures_(measures), options_(options) {}

  PaperRuleResult run() {
    const bool parametric = isNormal() && differencesScatter();
    decide("all treatments", {}, parametric ? "tests of means" : "tests of ranks");
    if (measures_.values.size() == 2) {
      result_.test = comparePair(0, 1, parametric);
      result_.p = result_.test.p;
    } else {
      parametric ? compareMeans() : compareRanks();
    }
    result_.differ = result_.p < options_.level;
    if (result_.differ && measures_.values.size() > 2) compareAllPairs(parametric);
    return result_;
  }

 private:
  void decide(const std::string& subject, const TestResult& test, const std::string& conclusion) {
    result_.decisions.push_back({subject, test, conclusion});
  }

  std::string pairName(std::size_t i, std::size_t j) const {
    return measures_.treatments[i] + " - " + measures_.treatments[j];
  }

  std::vector<double> differences(std::size_t i, std::size_t j) const {
    return pairedDifferences(measures_.values[i], measures_.values[j], "paper's rule");
  }

  template <typename Visit>
  void forEachPair(Visit visit) const {
    for (std::size_t i = 0; i < measures_.values.size(); ++i) {
      for (std::size_t j = i + 1; j < measures_.values.size(); ++j) visit(i, j);
    }
  }

  bool isNormal(const std::string& subject, const std::vector<double>& sample) {
    if (isConstant(sample)) {
      decide(subject, {}, "no scatter: not normal");
      return false;
    }
    if (sample.size() > kMostForNormality) {
      decide(subject, {}, "more values than the Shapiro-Wilk test takes: not normal");
      return false;
    }
    const TestResult test = shapiroWilk(sample);
    const bool normal = test.p >= options_.level;
    decide(subject, test, normal ? "normal" : "not normal");
    return normal;
  }

  bool isNormal() {
    bool normal = true;  // every sample is tested, so that the report can show all
    if (options_.normality == NormalityOf::kDifferences) {
      forEachPair(
          [&](std::size_t i, std::size_t j) { normal &= isNormal(pairName(i, j), differences(i, j)); });
    } else {
      for (std::size_t i = 0; i < measures_.values.size(); ++i) {
        normal &= isNormal(measures_.treatments[i], measures_.values[i]);
      }
    }
    return normal;
  }

  bool differencesScatter() {
    bool scatter = true;
    forEachPair([&](std::size_t i, std::size_t j) {
      if (!isConstant(differences(i, j))) return;
      decide(pairName(i, j), {}, "differences all the same: no test of means");
      scatter = false;
    });
    return scatter;
  }

  TestResult comparePair(std::size_t i, std::size_t j, bool parametric) {
    const auto& first = measures_.values[i];
    const auto& second = measures_.values[j];
    if (parametric) return pairedT(first, second).test;
    return isSymmetric(i, j) ? wilcoxonSignedRank(first, second) : pairedSignTest(first, second);
  }

  bool isSymmetric(std::size_t i, std::size_t j) {
    const std::vector<double> d = differences(i, j);
    if (d.size() < kFewestForSymmetry) {
      decide(pairName(i, j), {}, "too few to judge symmetry: paired sign test");
      return false;
    }
    const TestResult test = triplesTest(d);
    const bool symmetric = test.p >= options_.level;
    decide(pairName(i, j), test,
           symmetric ? "symmetric: Wilcoxon signed-rank test" : "not symmetric: paired sign test");
    return symmetric;
  }

  void compareMeans() {
    const RepeatedMeasuresAnova anova = repeatedMeasuresAnova(measures_);
    const bool spherical = anova.mauchly.p >= options_.level;  // false for NaN
    decide("all treatments", anova.mauchly,
           spherical ? "spherical: F as it stands" : "not spherical: Greenhouse-Geisser");
    result_.test = anova.test;
    result_.p = spherical ? anova.test.p : anova.greenhouse_geisser.p;
  }

  void compareRanks() {
    result_.test = friedman(measures_);
    result_.p = result_.test.p;
  }

  void compareAllPairs(bool parametric) {
    std::vector<double> p;
    forEachPair([&](std::size_t i, std::size_t j) {
      result_.pairs.push_back({i, j, comparePair(i, j, parametric), 0, false});
      p.push_back(result_.pairs.back().test.p);
    });
    const std::vector<double> adjusted = bonferroni(p);
    for (std::size_t i = 0; i < adjusted.size(); ++i) {
      result_.pairs[i].adjusted_p = adjusted[i];
      result_.pairs[i].differ = adjusted[i] < options_.level;
    }
  }

  const RepeatedMeasures& measures_;
  const PaperRuleOptions& options_;
  PaperRuleResult result_;
};

}  // namespace

PaperRuleResult paperRule(const RepeatedMeasures& measures, const PaperRuleOptions& options) {
  requireMeasures(measures, 2, 3, "paper's rule");
  if (!(options.level > 0 && options.level < 1)) {
    throw settings::InputError("paper's rule: level is " + std::to_string(options.level) +
                               "; it must lie between 0 and 1");
  }
  return Walk(measures, options).run();
}

}  // namespace fsr::statistics
