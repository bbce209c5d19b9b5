// Whether anything is missing, and which explanations are not excluded.
#include "discrepancy/decide/appraisal.h"

#include <gtest/gtest.h>

#include "discrepancy/drawn_design.h"

namespace fsr::discrepancy {
namespace {

using simulation::Covariate;

double fading(const drawn::Place& at) {
  return at.share * std::exp(-static_cast<double>(at.cycle) / 6);
}
// The loop, but for one part in a thousand.
double nearlyLoop(const drawn::Place& at) {
  return drawn::loop(at) + 1e-3 * drawn::turning(at);
}
// A loop in another form.
double mixed(const drawn::Place& at) {
  return drawn::loop(at) + 0.5 * drawn::turning(at);
}

constexpr double kSize = 3e-3;  // of what is planted [share of full scale]

enum Column : Eigen::Index { kLoop, kTurning, kFading, kNearlyLoop, kMixed };
CycleDesign emptyDesign() {
  return drawn::design({30, 16, 1, 14, {drawn::loop, drawn::turning, fading, nearlyLoop, mixed}});
}

// The same noise, and a column.
CycleDesign designWith(Eigen::Index column, double coefficient, std::uint64_t seed = 1) {
  CycleDesign design = emptyDesign();
  drawn::addColumn(design, column, coefficient);
  drawn::addNoise(design, drawn::wanderingNoise(), seed);
  return design;
}

Explaining effect(const std::string& id, Eigen::Index column) {
  return {{id}, {{{column}, {false}}}, {Covariate::kDirection, Covariate::kPressure}};
}
Explaining generic(Covariate covariate, std::vector<Eigen::Index> columns) {
  return {{}, {{columns, std::vector<bool>(columns.size(), true)}}, {covariate}};
}

std::vector<Explaining> usual() {
  return {effect("a", kLoop), effect("b", kTurning), effect("c", kFading),
          generic(Covariate::kDirection, {kLoop, kTurning}), generic(Covariate::kCycle, {kFading})};
}

Appraisal appraisalOf(const CycleDesign& design, const std::vector<Explaining>& all) {
  DiscrepancyOptions options;
  options.threads = 1;
  return appraise(design, fitNull(design), all, options);
}

std::vector<std::string> credible(const Appraisal& appraisal) {
  std::vector<std::string> ids;
  for (const std::size_t e : appraisal.credible) ids.push_back(nameOf(appraisal.all[e].explaining));
  return ids;
}

// 10 seeds at a level of 0.01: more than one alarm has a probability of 0.004, 1 - binom.cdf(1, 10, .01),
// SciPy 1.10.1.
TEST(Appraisal, SeesNothingWhereNothingIsHidden) {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Appraisal appraisal = appraisalOf(designWith(kLoop, 0, seed), usual());
    alarms += appraisal.p <= 0.01;
    if (appraisal.p > 0.01) {
      EXPECT_TRUE(appraisal.credible.empty());
    }
  }
  EXPECT_LE(alarms, 1);
}

TEST(Appraisal, FindsAColumnThatWasPlantedAndExcludesItsRivals) {
  for (const auto& [column, id] :
       {std::pair(kLoop, "a"), std::pair(kTurning, "b"), std::pair(kFading, "c")}) {
    const Appraisal appraisal = appraisalOf(designWith(column, kSize), usual());
    EXPECT_LE(appraisal.p, 0.01);
    ASSERT_EQ(credible(appraisal), std::vector<std::string>{id});
    const Weighed& found = appraisal.all[appraisal.credible.front()];
    EXPECT_NEAR(found.score.fit.coefficients[0], kSize, 0.1 * kSize);
    EXPECT_NEAR(found.closes, 1, column == kFading ? 0.3 : 0.05) << "what fades shows in a few cycles";
    EXPECT_GT(found.z, 2.5);
    EXPECT_EQ(found.beginning.column, column);
    EXPECT_NEAR(found.beginning.coefficient, kSize, 0.1 * kSize);
    EXPECT_GT(appraisal.p_beyond, 0.01) << "nothing else was planted";
    EXPECT_FALSE(appraisal.generic_better);
    EXPECT_FALSE(appraisal.own_form_better);
  }
}

TEST(Appraisal, KeepsBothOfTwoColumnsThatCannotBeToldApart) {
  std::vector<Explaining> all = usual();
  all.push_back(effect("d", kNearlyLoop));
  std::vector<std::string> ids = credible(appraisalOf(designWith(kLoop, kSize), all));
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(ids, (std::vector<std::string>{"a", "d"}));
}

// The mixed column resembles the loop (its correlation is 0.89), so it is weighed by itself, and excluded.
TEST(Appraisal, ExcludesARivalThatComesNear) {
  std::vector<Explaining> all = usual();
  all.push_back(effect("m", kMixed));
  const Appraisal appraisal = appraisalOf(designWith(kLoop, kSize), all);
  EXPECT_TRUE(appraisal.all.back().contends);
  EXPECT_EQ(credible(appraisal), std::vector<std::string>{"a"});
}

// A pair counts only where neither of its effects is enough by itself.
TEST(Appraisal, NamesAPairWhereOneEffectIsNotEnough) {
  std::vector<Explaining> all = usual();
  all.push_back({{"a", "c"}, {{{kLoop, kFading}, {false, false}}}, {}});
  CycleDesign both = emptyDesign();
  drawn::addColumn(both, kLoop, kSize);
  drawn::addColumn(both, kFading, 2 * kSize);
  drawn::addNoise(both, drawn::wanderingNoise(), 1);
  EXPECT_EQ(credible(appraisalOf(both, all)), std::vector<std::string>{"a + c"});
  EXPECT_EQ(credible(appraisalOf(designWith(kLoop, kSize), all)), std::vector<std::string>{"a"});
  all.back() = {{"a", "c"}, {{{kLoop}, {false}}}, {}};
  EXPECT_EQ(credible(appraisalOf(designWith(kLoop, kSize), all)), std::vector<std::string>{"a"})
      << "the pair is just as good";
}

TEST(Appraisal, SaysWhatASecondEffectAdds) {
  CycleDesign both = emptyDesign();
  drawn::addColumn(both, kLoop, kSize);
  drawn::addColumn(both, kTurning, kSize / 3);
  drawn::addNoise(both, drawn::wanderingNoise(), 1);
  const Appraisal appraisal = appraisalOf(both, usual());
  ASSERT_EQ(credible(appraisal), std::vector<std::string>{"a"});
  EXPECT_LE(appraisal.p_beyond, 0.01);
  ASSERT_EQ(appraisal.additions.size(), 5u);
  EXPECT_GT(appraisal.additions[1].nats, appraisal.null_score);
  EXPECT_EQ(appraisal.additions[1].beginning.column, kTurning);
  EXPECT_LT(appraisal.additions[2].nats, 5) << "was not planted";
}

// The second effect has the wrong sign, so it explains nothing, and the loop is no error of its form.
TEST(Appraisal, AnEffectAddsToOneThatExplainsNothingByItself) {
  CycleDesign design = designWith(kLoop, kSize);
  drawn::addColumn(design, kTurning, -kSize / 3);
  const std::vector<Explaining> both = {effect("a", kLoop),
                                        {{"b"}, {{{kTurning}, {false}}}, {Covariate::kTemperature}}};
  EXPECT_GT(addedToAnyForm(design, fitNull(design), both, 0, 1, DiscrepancyOptions()), 20);
}

// Noise with a gain of each cycle takes up a course that fades, so that it adds hardly anything to the
// density.
TEST(Appraisal, AGainThatFadesIsSeenBesideALoopOfAnyForm) {
  std::vector<Explaining> all = {effect("a", kLoop), effect("c", kFading),
                                 generic(Covariate::kDirection, {kLoop, kTurning})};
  all[1].slow = true;
  const auto beside = [&](double size, std::uint64_t seed) {
    CycleDesign design = designWith(kMixed, kSize, seed);
    drawn::addColumn(design, kFading, size);
    return slowBeside(design, fitNull(design), all, 0, DiscrepancyOptions());
  };
  const std::vector<Beside> found = beside(kSize, 1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().explanation, 1u);
  EXPECT_EQ(found.front().beginning.column, kFading);
  EXPECT_NEAR(found.front().beginning.coefficient, kSize, 0.2 * kSize);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) EXPECT_TRUE(beside(0, seed).empty()) << seed;
}

// Effect a closes most of the mixed column. Generic terms close all of it.
TEST(Appraisal, SeesThatGenericTermsAreBetter) {
  const std::vector<Explaining> other = {effect("a", kLoop),
                                         generic(Covariate::kPressureRate, {kLoop, kTurning})};
  const Appraisal unknown = appraisalOf(designWith(kMixed, kSize), other);
  ASSERT_EQ(credible(unknown), std::vector<std::string>{"a"});
  EXPECT_LT(unknown.all[0].closes, 0.8);
  EXPECT_GT(unknown.all[1].closes, 0.95);
  EXPECT_TRUE(unknown.generic_better);
  EXPECT_FALSE(unknown.own_form_better);
  const std::vector<Explaining> own = {effect("a", kLoop), generic(Covariate::kDirection, {kLoop, kTurning})};
  const Appraisal wrong = appraisalOf(designWith(kMixed, kSize), own);
  EXPECT_FALSE(wrong.generic_better);
  EXPECT_TRUE(wrong.own_form_better);
  EXPECT_FALSE(appraisalOf(designWith(kLoop, kSize), other).generic_better);
}

// The smallest coefficient that would be seen is found in nine of ten recordings, a quarter of it nearly
// never.
TEST(Appraisal, KnowsWhatItWouldHaveSeen) {
  const Appraisal nothing = appraisalOf(designWith(kLoop, 0), usual());
  ASSERT_TRUE(nothing.least_seen[kLoop].has_value());
  const double least = *nothing.least_seen[kLoop];
  int found = 0, missed = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    found += appraisalOf(designWith(kLoop, least, seed), usual()).p <= 0.01;
    missed += appraisalOf(designWith(kLoop, least / 4, seed), usual()).p > 0.01;
  }
  EXPECT_GE(found, 15);
  EXPECT_GE(missed, 18);
  EXPECT_FALSE(nothing.least_seen[kMixed].has_value()) << "no explanation uses it";
}

}  // namespace
}  // namespace fsr::discrepancy
