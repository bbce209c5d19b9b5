#include "statistics/repeated_measures.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/random_stream.h"
#include "statistics/sample_data.h"
#include "support/holds.h"

namespace {

using namespace sample_data;
using fsr::statistics::shapiroWilk;

void expectShapiroWilk(const Values& sample, double w, double p, double relative = kAgreement) {
  const fsr::statistics::TestResult result = shapiroWilk(sample);
  expectNear(result.statistic, w, relative);
  expectNear(result.p, p, relative);
  EXPECT_EQ(result.n, sample.size());
}

// r <- shapiro.test(...); sprintf("%.15g", c(r$statistic, r$p.value))
TEST(ShapiroWilk, AgreesWithROnSmallSamples) {
  expectShapiroWilk({1, 2, 4}, 0.964285714285714, 0.636886845028963);
  expectShapiroWilk({1, 2, 4, 9}, 0.894686270839335, 0.40514721117389);
  expectShapiroWilk({1, 2, 4, 9, 10}, 0.880964604598245, 0.313705003047611);
  expectShapiroWilk({1, 2, 4, 9, 10, 10.5}, 0.85751886683183, 0.180815122391676);
  expectShapiroWilk(kA, 0.952166587596282, 0.713852047250997);
  expectShapiroWilk({0, 0, 0, 0, 0, 0, 0, 0, 0, 1}, 0.365720627414263, 1.00369281388907e-07);
  expectShapiroWilk({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 1e6}, 0.345000126335123, 2.24393530458965e-08);
}

TEST(ShapiroWilk, AgreesWithRWhereItsFormulaChanges) {
  expectShapiroWilk(head(kX70, 11), 0.57581887040565, 1.27525865185635e-05);  // x70[1:11]
  expectShapiroWilk(head(kX70, 12), 0.566604919901786, 5.72758008927596e-05);
}

TEST(ShapiroWilk, AgreesWithROnSkewedTiedAndLargeSamples) {
  expectShapiroWilk(kX70, 0.640049540293506, 8.07455181988756e-12);
  expectShapiroWilk(kT70, 0.896529191828873, 2.83512325026557e-05);
  const Values q70 = mapped(uniform(15, 70), fsr::statistics::normalQuantile);
  expectShapiroWilk(q70, 0.978587491293275, 0.274113783033309);                       // qnorm(pm(15, 70))
  expectShapiroWilk(exponential(16, 5000), 0.805485414053933, 4.59146572556039e-61);  // -log(pm(16, 5000))
  const Values q5000 = mapped(uniform(16, 5000), fsr::statistics::normalQuantile);
  expectShapiroWilk(q5000, 0.999369312150204, 0.0798703711317994);  // qnorm(pm(16, 5000))
}

TEST(ShapiroWilk, KeepsItsPrecisionFarFromZero) {
  // x <- 1e9 + pm(17, 30); shapiro.test(x - median(x)); without the subtraction R has an error of 5e-8
  expectShapiroWilk(mapped(uniform(17, 30), [](double u) { return 1e9 + u; }), 0.897620712169061,
                    0.00734898981414136);
}

TEST(ShapiroWilk, DoesNotDependOnScaleShiftMirrorOrOrder) {
  const double p = shapiroWilk(kA).p;
  expectNear(shapiroWilk(mapped(kA, [](double x) { return 7 - 3e5 * x; })).p, p);
  expectNear(shapiroWilk(mapped(kA, [](double x) { return 1e-200 * x; })).p, p);
  expectNear(shapiroWilk(Values(kA.rbegin(), kA.rend())).p, p);
}

TEST(ShapiroWilk, RefusesUnusableData) {
  EXPECT_THROW(shapiroWilk({}), fsr::settings::InputError);
  EXPECT_THROW(shapiroWilk({1, 2}), fsr::settings::InputError);
  EXPECT_THROW(shapiroWilk(Values(10, 0.1)), fsr::settings::InputError);
  EXPECT_THROW(shapiroWilk({1, 2, std::nan("")}), fsr::settings::InputError);
  EXPECT_THROW(shapiroWilk({1, 2, HUGE_VAL}), fsr::settings::InputError);
  EXPECT_THROW(shapiroWilk(uniform(1, 5001)), fsr::settings::InputError);
}

TEST(ShapiroWilk, SaysWhichValueIsBad) {
  EXPECT_TRUE(test_support::holds(test_support::refusal([&] {
                                    shapiroWilk({1, std::nan(""), 3});
                                  }),
                                  {"2 of 3", "NaN", "Shapiro-Wilk test"}));
}

}  // namespace
