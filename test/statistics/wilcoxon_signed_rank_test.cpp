#include "statistics/paired_tests.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/random_stream.h"
#include "statistics/sample_data.h"

namespace {

using namespace sample_data;
using fsr::statistics::PMethod;
using fsr::statistics::WilcoxonMethod;
using fsr::statistics::wilcoxonSignedRank;

void expectWilcoxon(const Values& first, const Values& second, WilcoxonMethod method, double v, double p,
                    PMethod taken) {
  const fsr::statistics::TestResult result = wilcoxonSignedRank(first, second, method);
  EXPECT_EQ(result.statistic, v);
  expectNear(result.p, p);
  EXPECT_EQ(result.method, taken);
}

// r <- wilcox.test(first, second, paired = TRUE); sprintf("%.15g", c(r$statistic, r$p.value))
TEST(WilcoxonSignedRank, AgreesWithRExactlyBelowFiftyWithoutTies) {
  expectWilcoxon(kA, kB, WilcoxonMethod::kAuto, 40, 0.0390625, PMethod::kExact);
  expectWilcoxon(head(kX70, 49), head(kY70, 49), WilcoxonMethod::kAuto, 352, 0.00885282402986221,
                 PMethod::kExact);
  expectWilcoxon({1, 2, 3, 4, 5}, Values(5, 0.1), WilcoxonMethod::kAuto, 15, 0.0625, PMethod::kExact);
  expectWilcoxon({1}, {2}, WilcoxonMethod::kAuto, 0, 1, PMethod::kExact);
}

TEST(WilcoxonSignedRank, AgreesWithRsApproximationFromFiftyOn) {
  expectWilcoxon(kX70, kY70, WilcoxonMethod::kAuto, 773, 0.0060571099400539, PMethod::kNormalApproximation);
  expectWilcoxon(kT70, kU70, WilcoxonMethod::kAuto, 1578.5, 5.10917774688723e-06,
                 PMethod::kNormalApproximation);
}

// ... wilcox.test(..., exact = TRUE) and wilcox.test(..., exact = FALSE)
TEST(WilcoxonSignedRank, AgreesWithRForAGivenMethod) {
  expectWilcoxon(kX70, kY70, WilcoxonMethod::kExact, 773, 0.00555593080661182, PMethod::kExact);
  expectWilcoxon(head(kX70, 49), head(kY70, 49), WilcoxonMethod::kNormal, 352, 0.00970134088867275,
                 PMethod::kNormalApproximation);
  expectWilcoxon(kSleep1, kSleep2, WilcoxonMethod::kNormal, 0, 0.00909069801592506,
                 PMethod::kNormalApproximation);
  expectWilcoxon(head(kT70, 12), head(kU70, 12), WilcoxonMethod::kNormal, 55, 0.00514376422511499,
                 PMethod::kNormalApproximation);
}

// library(exactRankTests); r <- wilcox.exact(first, second, paired = TRUE, exact = TRUE)
TEST(WilcoxonSignedRank, CountsTheConditionalDistributionUnderTiesAndZeros) {
  expectWilcoxon(kSleep1, kSleep2, WilcoxonMethod::kAuto, 0, 0.00390625, PMethod::kExact);
  expectWilcoxon(head(kT70, 12), head(kU70, 12), WilcoxonMethod::kAuto, 55, 0.001953125, PMethod::kExact);
  expectWilcoxon(head(kT70, 40), head(kU70, 40), WilcoxonMethod::kAuto, 504.5, 0.000174481770955026,
                 PMethod::kExact);
}

TEST(WilcoxonSignedRank, DropsDifferencesOfZeroAndCountsThem) {
  const fsr::statistics::TestResult result = wilcoxonSignedRank(kSleep1, kSleep2);
  EXPECT_EQ(result.n, 10u);
  EXPECT_EQ(result.dropped, 1u);
}

TEST(WilcoxonSignedRank, GivesPOneWhereAllDifferencesAreZero) {
  const fsr::statistics::TestResult result = wilcoxonSignedRank(kA, kA);
  EXPECT_EQ(result.p, 1);
  EXPECT_EQ(result.dropped, kA.size());
  EXPECT_EQ(result.method, PMethod::kNothingToTest);
}

TEST(WilcoxonSignedRank, StaysFiniteOnMagnitudesThatAreAllEqual) {
  // Of 2^5 sign patterns only the two extreme ones: p = 2 / 32.
  EXPECT_DOUBLE_EQ(wilcoxonSignedRank(Values(5, 1.0), Values(5, 0.0)).p, 0.0625);
  EXPECT_LT(wilcoxonSignedRank(Values(60, 1.0), Values(60, 0.0)).p, 1e-10);
}

TEST(WilcoxonSignedRank, RefusesUnusableData) {
  EXPECT_THROW(wilcoxonSignedRank({}, {}), fsr::settings::InputError);
  EXPECT_THROW(wilcoxonSignedRank({1, 2}, {1}), fsr::settings::InputError);
  EXPECT_THROW(wilcoxonSignedRank({1, std::nan("")}, {1, 2}), fsr::settings::InputError);
  EXPECT_THROW(wilcoxonSignedRank(uniform(1, 1001), uniform(2, 1001), WilcoxonMethod::kExact),
               fsr::settings::InputError);
}

}  // namespace
