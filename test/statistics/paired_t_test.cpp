#include "statistics/paired_tests.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/random_stream.h"
#include "statistics/sample_data.h"

namespace {

using namespace sample_data;
using fsr::statistics::pairedT;

struct PairedTOfR {
  double t, df, p, mean, low, high;
};

void expectPairedT(const Values& first, const Values& second, const PairedTOfR& r) {
  const fsr::statistics::PairedT result = pairedT(first, second);
  expectNear(result.test.statistic, r.t);
  EXPECT_EQ(result.test.degrees_of_freedom, Values{r.df});
  expectNear(result.test.p, r.p);
  expectNear(result.mean_difference, r.mean);
  expectNear(result.low, r.low);
  expectNear(result.high, r.high);
}

// r <- t.test(first, second, paired = TRUE)
// sprintf("%.15g", c(r$statistic, r$parameter, r$p.value, r$estimate, r$conf.int))
TEST(PairedT, AgreesWithR) {
  expectPairedT(
      kA, kB,
      {3.03537541564859, 8, 0.0161766274349081, 0.431888888888889, 0.103778712272169, 0.759999065505609});
  expectPairedT(kSleep1, kSleep2,
                {-4.06212768338204, 9, 0.00283289019738427, -1.58, -2.45988576327698, -0.700114236723018});
  expectPairedT(
      kX70, kY70,
      {-2.51375140328903, 69, 0.014283140710253, -0.595385347322055, -1.0678908095997, -0.122879885044408});
  expectPairedT(
      kT70, kU70,
      {5.47644543247979, 69, 6.596399014417e-07, 1.95714285714286, 1.24419990578781, 2.67008580849791});
  expectPairedT({1, 2}, {3, 7},
                {-2.33333333333333, 1, 0.257762116818313, -3.5, -22.559307104262, 15.559307104262});
}

TEST(PairedT, KeepsItsPrecisionFarInTheTail) {
  const Values far = mapped(kY70, [](double y) { return y + 20; });  // y70 + 20
  expectPairedT(
      kX70, far,
      {-86.9549092045506, 69, 2.99053659231652e-72, -20.5953853473221, -21.0678908095997, -20.1228798850444});
}

TEST(PairedT, GivesPOneForEqualSamples) {
  const fsr::statistics::PairedT result = pairedT(kA, kA);
  EXPECT_EQ(result.test.p, 1);
  EXPECT_EQ(result.test.statistic, 0);
  EXPECT_EQ(result.test.method, fsr::statistics::PMethod::kNothingToTest);
}

TEST(PairedT, RefusesUnusableData) {
  EXPECT_THROW(pairedT({}, {}), fsr::settings::InputError);
  EXPECT_THROW(pairedT({1}, {2}), fsr::settings::InputError);
  EXPECT_THROW(pairedT({1, 2}, {2}), fsr::settings::InputError);
  EXPECT_THROW(pairedT({1, 2, 3}, {3, 4, 5}), fsr::settings::InputError);  // all differences are -2
  EXPECT_THROW(pairedT({1, std::nan("")}, {3, 4}), fsr::settings::InputError);
}

}  // namespace
