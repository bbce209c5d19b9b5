#include "statistics/paper_rule.h"

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

TEST(MultipleComparisons, ReturnOneOrNoTestUnchanged) {
  EXPECT_EQ(fsr::statistics::bonferroni({0.3}), Values{0.3});
  EXPECT_TRUE(fsr::statistics::bonferroni({}).empty());
}

TEST(MultipleComparisons, RefuseValuesThatAreNotProbabilities) {
  for (const double p : {std::nan(""), -0.1, 1.1}) {
    EXPECT_THROW(fsr::statistics::bonferroni({0.1, p}), fsr::settings::InputError);
  }
}

}  // namespace
