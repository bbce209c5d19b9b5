#include "statistics/paired_tests.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/random_stream.h"
#include "statistics/sample_data.h"

namespace {

using namespace sample_data;
using fsr::statistics::pairedSignTest;

void expectSigns(const Values& first, const Values& second, double positive, std::size_t signs, double p) {
  const fsr::statistics::TestResult result = pairedSignTest(first, second);
  EXPECT_EQ(result.statistic, positive);
  EXPECT_EQ(result.n - result.dropped, signs);
  expectNear(result.p, p);
}

// d <- first - second; c(sum(d > 0), sum(d != 0)); sprintf("%.15g", binom.test(sum(d > 0), sum(d !=
// 0))$p.value)
TEST(PairedSignTest, AgreesWithR) {
  expectSigns(kA, kB, 7, 9, 0.1796875);
  expectSigns(kSleep1, kSleep2, 0, 9, 0.00390625);
  expectSigns(kX70, kY70, 24, 70, 0.0115264096543635);
  expectSigns(kT70, kU70, 48, 61, 7.66516838044545e-06);
  expectSigns({1, 2, 3, 4}, {2, 1, 4, 3}, 2, 4, 1);
  expectSigns(kX70, mapped(kY70, [](double y) { return y + 20; }), 0, 70, 1.69406589450861e-21);
}

TEST(PairedSignTest, GivesPOneWhereAllDifferencesAreZero) {
  const fsr::statistics::TestResult result = pairedSignTest(kA, kA);
  EXPECT_EQ(result.p, 1);
  EXPECT_EQ(result.method, fsr::statistics::PMethod::kNothingToTest);
}

TEST(PairedSignTest, RefusesUnusableData) {
  EXPECT_THROW(pairedSignTest({}, {}), fsr::settings::InputError);
  EXPECT_THROW(pairedSignTest({1}, {1, 2}), fsr::settings::InputError);
  EXPECT_THROW(pairedSignTest({std::nan("")}, {1}), fsr::settings::InputError);
}

}  // namespace
