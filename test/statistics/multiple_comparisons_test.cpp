#include "statistics/multiple_comparisons.h"

#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/sample_data.h"

namespace {

using namespace sample_data;

void expectAll(const Values& values, const Values& reference) {
  ASSERT_EQ(values.size(), reference.size());
  for (std::size_t i = 0; i < values.size(); ++i) expectNear(values[i], reference[i]);
}

// p.adjust(c(0.01, 0.02, 0.03, 0.04, 0.05, 0.5), "bonferroni")
TEST(MultipleComparisons, BonferroniAgreesWithR) {
  expectAll(fsr::statistics::bonferroni({0.01, 0.02, 0.03, 0.04, 0.05, 0.5}),
            {0.06, 0.12, 0.18, 0.24, 0.3, 1});
}

// p.adjust(c(0.01, 0.02, 0.03, 0.04, 0.05, 0.5), "holm"); p.adjust(c(0.04, 0.001, 0.2, 0.013, 0.9, 0.013),
// "holm")
TEST(MultipleComparisons, HolmAgreesWithRAndKeepsTheOrderGiven) {
  expectAll(fsr::statistics::holm({0.01, 0.02, 0.03, 0.04, 0.05, 0.5}), {0.06, 0.1, 0.12, 0.12, 0.12, 0.5});
  expectAll(fsr::statistics::holm({0.04, 0.001, 0.2, 0.013, 0.9, 0.013}),
            {0.12, 0.006, 0.4, 0.065, 0.9, 0.065});
}

// p.adjust(c(0.01, 0.02, 0.03, 0.04, 0.05, 0.5), "BY"); p.adjust(c(0.04, 0.001, 0.2, 0.013, 0.9, 0.013),
// "BY")
TEST(MultipleComparisons, BenjaminiYekutieliAgreesWithRAndKeepsTheOrderGiven) {
  expectAll(fsr::statistics::benjaminiYekutieli({0.01, 0.02, 0.03, 0.04, 0.05, 0.5}),
            {0.147, 0.147, 0.147, 0.147, 0.147, 1});
  expectAll(fsr::statistics::benjaminiYekutieli({0.04, 0.001, 0.2, 0.013, 0.9, 0.013}),
            {0.147, 0.0147, 0.588, 0.0637, 1, 0.0637});
}

TEST(MultipleComparisons, HolmIsNeverAboveBonferroni) {
  const Values p = uniform(3, 40);
  const Values strict = fsr::statistics::bonferroni(p), stepped = fsr::statistics::holm(p);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_LE(stepped[i], strict[i]);
}

TEST(MultipleComparisons, ReturnOneOrNoTestUnchanged) {
  EXPECT_EQ(fsr::statistics::bonferroni({0.3}), Values{0.3});
  EXPECT_EQ(fsr::statistics::holm({0.3}), Values{0.3});
  EXPECT_TRUE(fsr::statistics::bonferroni({}).empty());
  EXPECT_TRUE(fsr::statistics::holm({}).empty());
}

TEST(MultipleComparisons, RefuseValuesThatAreNotProbabilities) {
  for (const double p : {std::nan(""), -0.1, 1.1}) {
    EXPECT_THROW(fsr::statistics::bonferroni({0.1, p}), fsr::settings::InputError);
    EXPECT_THROW(fsr::statistics::holm({0.1, p}), fsr::settings::InputError);
  }
}

}  // namespace
