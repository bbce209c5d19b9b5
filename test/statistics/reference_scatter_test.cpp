#include "statistics/error_bins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fsr_pressure_map/statistics/metrics.h"
#include "statistics/random_stream.h"

namespace fsr::statistics {
namespace {

void expectSame(double a, double b) {
  EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << a << " and " << b;
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
