#include "statistics/paper_rule.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/random_stream.h"
#include "statistics/repeated_data.h"

namespace {

using namespace sample_data;
using fsr::statistics::paperRule;
using fsr::statistics::PaperRuleResult;

std::vector<std::string> conclusions(const PaperRuleResult& result) {
  std::vector<std::string> list;
  for (const fsr::statistics::Decision& decision : result.decisions)
    list.push_back(decision.subject + ": " + decision.conclusion);
  return list;
}

using Lines = std::vector<std::string>;

// t.test(n3[, 1], n3[, 3], paired = TRUE)$p.value
TEST(PaperRule, TakesThePairedTTestForTwoNormalTreatments) {
  const fsr::statistics::RepeatedMeasures all = normal3();
  const PaperRuleResult result = paperRule({{"flat", "bent"}, {all.values[0], all.values[2]}});
  EXPECT_EQ(conclusions(result), (Lines{"flat: normal", "bent: normal", "all treatments: tests of means"}));
  EXPECT_EQ(result.test.test, "paired t");
  expectNear(result.p, 0.00463399242769667);
  EXPECT_TRUE(result.differ);
  EXPECT_TRUE(result.pairs.empty());
}

// anova(lm(n3 ~ 1), X = ~1, test = "Spherical")[1, c("F", "Pr(>F)")]
// p.adjust(c(t.test(n3[,1], n3[,2], paired = TRUE)$p.value, ... 1,3 ... 2,3), "bonferroni")
TEST(PaperRule, TakesAnovaThenPairedTTestsForMoreNormalTreatments) {
  const PaperRuleResult result = paperRule(normal3());
  EXPECT_EQ(conclusions(result),
            (Lines{"m1: normal", "m2: normal", "m3: normal", "all treatments: tests of means",
                   "all treatments: spherical: F as it stands"}));
  EXPECT_EQ(result.test.test, "repeated-measures ANOVA");
  expectNear(result.test.statistic, 7.68297844903738);
  expectNear(result.p, 0.00109665193601302);
  ASSERT_EQ(result.pairs.size(), 3u);
  expectNear(result.pairs[0].adjusted_p, 1);
  expectNear(result.pairs[1].adjusted_p, 0.01390197728309);
  expectNear(result.pairs[2].adjusted_p, 0.00290320712843461);
  EXPECT_FALSE(result.pairs[0].differ);
  EXPECT_TRUE(result.pairs[2].differ);
  EXPECT_EQ(result.pairs[2].first, 1u);
  EXPECT_EQ(result.pairs[2].second, 2u);
}

// m5 <- sapply(1:5, function(j) -log(pm(20 + j, 70)) * (1 + j / 5)); friedman.test(m5)
// 10 * wilcox.test(m5[,i], m5[,j], paired = TRUE)$p.value, 10 * binom.test(sum(m5[,i] > m5[,j]), 70)$p.value
TEST(PaperRule, TakesFriedmanThenWilcoxonOrSignTestsForSkewedTreatments) {
  const PaperRuleResult result = paperRule(skewed5(5));
  EXPECT_EQ(result.test.test, "Friedman");
  EXPECT_NEAR(result.test.statistic, 9.8286, 5e-5);
  ASSERT_EQ(result.pairs.size(), 10u);
  const Values wilcoxon = {3.34239303147309, 0.161615356827382, 0.0735562840135832, 0.0748525044458809,
                           2.81568909300307, 0.399644561271671, 1.84030991492287,   5.38898730098897,
                           8.46863402692698, 8.46863402692698};
  const Values sign = {7.20202772352865, 0.413914286739155, 0.722379271917629, 0.224628954925094,
                       2.81978921793657, 0.413914286739155, 7.20202772352865,  7.20202772352865,
                       9.04974526459463, 7.20202772352865};
  const std::size_t steps_before = 6;  // five treatments and one choice of a test
  for (std::size_t i = 0; i < 10; ++i) {
    const bool symmetric =
        result.decisions[steps_before + i].conclusion == "symmetric: Wilcoxon signed-rank test";
    expectNear(result.pairs[i].adjusted_p, std::min(1.0, symmetric ? wilcoxon[i] : sign[i]));
    EXPECT_EQ(result.pairs[i].test.test, symmetric ? "Wilcoxon signed-rank" : "paired sign");
  }
}

TEST(PaperRule, TestsTheSymmetryOfTheDifferences) {
  const Values skewed = kX70, zero(70, 0.0);
  const Values flat = mapped(uniform(3, 70), [](double u) { return u - 0.4; });
  const PaperRuleResult sign = paperRule({{"a", "b"}, {skewed, zero}});
  EXPECT_EQ(sign.test.test, "paired sign");
  EXPECT_EQ(conclusions(sign),
            (Lines{"a: not normal", "b: no scatter: not normal", "all treatments: tests of ranks",
                   "a - b: not symmetric: paired sign test"}));
  const PaperRuleResult ranks = paperRule({{"a", "b"}, {flat, zero}});
  EXPECT_EQ(ranks.test.test, "Wilcoxon signed-rank");
  EXPECT_EQ(conclusions(ranks).back(), "a - b: symmetric: Wilcoxon signed-rank test");
}

TEST(PaperRule, CorrectsForViolatedSphericity) {
  fsr::statistics::RepeatedMeasures data = normal3();
  for (double& x : data.values[2]) x = 5 * x;
  const PaperRuleResult result = paperRule(data);
  EXPECT_EQ(conclusions(result).at(4), "all treatments: not spherical: Greenhouse-Geisser");
  EXPECT_GT(result.p, result.test.p);
}

TEST(PaperRule, ComparesNoPairsWhereTheTreatmentsTogetherDoNotDiffer) {
  const PaperRuleResult result = paperRule(skewed5());  // Friedman: p = 0.24
  EXPECT_FALSE(result.differ);
  EXPECT_TRUE(result.pairs.empty());
}

TEST(PaperRule, CanTestTheNormalityOfTheDifferencesInstead) {
  fsr::statistics::PaperRuleOptions options;
  options.normality = fsr::statistics::NormalityOf::kDifferences;
  // Both treatments have the same skewed levels; their differences are normal.
  const Values noise = mapped(uniform(15, 70), fsr::statistics::normalQuantile);
  Values shifted = kX70;
  for (std::size_t i = 0; i < shifted.size(); ++i) shifted[i] += noise[i] - 1;
  const fsr::statistics::RepeatedMeasures data{{"a", "b"}, {kX70, shifted}};
  EXPECT_EQ(paperRule(data).test.test, "Wilcoxon signed-rank");
  EXPECT_EQ(paperRule(data, options).test.test, "paired t");
  EXPECT_EQ(conclusions(paperRule(data, options)).front(), "a - b: normal");
}

TEST(PaperRule, HandlesDegenerateDataAsDocumented) {
  const PaperRuleResult same = paperRule({{"a", "b"}, {kA, kA}});
  EXPECT_EQ(same.p, 1);
  EXPECT_FALSE(same.differ);
  EXPECT_EQ(paperRule({{"a", "b", "c"}, {kA, kA, kA}}).p, 1);

  const Values apart = mapped(kA, [](double x) { return x + 2; });
  const PaperRuleResult constant = paperRule({{"a", "b"}, {kA, apart}});
  EXPECT_TRUE(constant.differ);

  const PaperRuleResult few = paperRule({{"a", "b"}, {{0, 0, 1e6, 0}, {1, 2, 3, 4}}});
  EXPECT_EQ(conclusions(few).back(), "a - b: too few to judge symmetry: paired sign test");
}

TEST(PaperRule, RefusesUnusableData) {
  EXPECT_THROW(paperRule(measures({kA})), fsr::settings::InputError);
  EXPECT_THROW(paperRule(measures({{1, 2}, {2, 3}})), fsr::settings::InputError);
  EXPECT_THROW(paperRule(measures({{1, 2, 3}, {2, 3}})), fsr::settings::InputError);
  EXPECT_THROW(paperRule(measures({{1, 2, 3}, {2, 3, std::nan("")}})), fsr::settings::InputError);
  fsr::statistics::PaperRuleOptions options;
  options.level = 5;
  EXPECT_THROW(paperRule(measures({kA, kB}), options), fsr::settings::InputError);
}

}  // namespace
