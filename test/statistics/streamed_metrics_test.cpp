#include "statistics/streamed_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "statistics/random_stream.h"

namespace fsr::statistics {
namespace {

ErrorSummary streamed(const std::vector<float>& errors) {
  StreamedSummary summary;
  for (const float error : errors) summary.add(error);
  for (const float error : errors) summary.addAgain(error);
  return summary.summarise();
}

void expectSame(double a, double b) {
  EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << a << " and " << b;
}

TEST(StreamedSummary, HasTheDigitsOfTheSummaryOfAList) {
  const RandomStream stream = randomStream(1, "errors", 0);
  for (const std::size_t count : {0u, 1u, 2u, 3u, 19u, 20u, 21u, 22u, 4000u}) {
    std::vector<float> errors;
    // Over many octaves, both signs, and some of one size.
    for (std::size_t i = 0; i < count; ++i)
      errors.push_back(static_cast<float>((stream.uniform(2 * i) - 0.5) *
                                          std::pow(10.0, std::floor(6 * stream.uniform(2 * i + 1)))));
    for (std::size_t i = 0; i < count; i += 7) errors[i] = 1e5F;
    const ErrorSummary own = streamed(errors);
    const ErrorSummary right = summariseErrors({errors.begin(), errors.end()});
    EXPECT_EQ(own.count, right.count);
    expectSame(own.bias, right.bias);
    expectSame(own.rmse, right.rmse);
    expectSame(own.limit_low, right.limit_low);
    expectSame(own.limit_high, right.limit_high);
    expectSame(own.p95_absolute, right.p95_absolute);
  }
}

TEST(ReferenceScatter, GivesTheDigitsOfTheMeasuresOfLists) {
  const RandomStream stream = randomStream(2, "pressures", 0);
  for (const std::size_t count : {0u, 1u, 2u, 500u}) {
    for (const double scale : {0.0, 1e5}) {  // 0: the reference does not vary
      std::vector<double> predicted, reference;
      ReferenceScatter scatter;
      double squares = 0;
      for (std::size_t i = 0; i < count; ++i) {
        reference.push_back(1e3 + scale * stream.uniform(2 * i));
        predicted.push_back(reference.back() + stream.uniform(2 * i + 1));
        squares += (predicted[i] - reference[i]) * (predicted[i] - reference[i]);
        scatter.add(reference[i]);
      }
      for (const double value : reference) scatter.addAgain(value);
      expectSame(scatter.rSquared(squares), rSquared(predicted, reference));
      expectSame(scatter.rmsePercent(squares), rmsePercent(predicted, reference));
    }
  }
}

}  // namespace
}  // namespace fsr::statistics
