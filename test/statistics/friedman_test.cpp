#include "statistics/repeated_measures.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/random_stream.h"
#include "statistics/repeated_data.h"
#include "support/holds.h"

namespace {

using namespace sample_data;
using fsr::statistics::friedman;

void expectFriedman(const fsr::statistics::RepeatedMeasures& data, double chi2, double df, double p) {
  const fsr::statistics::TestResult result = friedman(data);
  expectNear(result.statistic, chi2);
  EXPECT_EQ(result.degrees_of_freedom, Values{df});
  expectNear(result.p, p);
}

// r <- friedman.test(...); sprintf("%.15g", c(r$statistic, r$parameter, r$p.value))
TEST(Friedman, AgreesWithR) {
  expectFriedman(roundingTimes(), 11.1428571428571, 2, 0.00380504077551136);
  expectFriedman(skewed5(), 5.45142857142857, 4, 0.244032052963709);
  expectFriedman(tied5(), 54.828, 4, 3.53007107175577e-11);
  expectFriedman(measures({kA, kB}), 2.77777777777778, 1, 0.0955807045456288);
  expectFriedman(measures({{1, 2}, {2, 3}, {3, 1}}), 1, 2, 0.606530659712633);
}

TEST(Friedman, GivesPOneWhereEveryUnitIsTied) {
  const fsr::statistics::TestResult result = friedman(measures({kA, kA, kA}));
  EXPECT_EQ(result.p, 1);
  EXPECT_EQ(result.statistic, 0);
  EXPECT_EQ(result.method, fsr::statistics::PMethod::kNothingToTest);
}

TEST(Friedman, RefusesUnusableData) {
  EXPECT_THROW(friedman({}), fsr::settings::InputError);
  EXPECT_THROW(friedman(measures({kA})), fsr::settings::InputError);
  EXPECT_THROW(friedman(measures({{1}, {2}})), fsr::settings::InputError);
  EXPECT_THROW(friedman(measures({{1, 2}, {2, std::nan("")}})), fsr::settings::InputError);
  EXPECT_THROW(friedman({{"one"}, {{1, 2}, {2, 3}}}), fsr::settings::InputError);
}

TEST(Friedman, SaysWhichTreatmentLacksUnits) {
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] {
                                    friedman({{"flat", "curved"}, {{1, 2, 3}, {1, 2}}});
                                  }),
                                  {"2 values", "Friedman test of 'curved'"}));
}

}  // namespace
