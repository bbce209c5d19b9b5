#include <gtest/gtest.h>

#include "regression/regressors.h"

namespace fsr::regression {
namespace {

Fit fit(const std::vector<std::uint16_t>& code, const std::vector<double>& pressure,
        std::uint16_t full_scale = 4095) {
  CodeSamples samples;
  samples.full_scale = full_scale;
  for (std::size_t i = 0; i < code.size(); ++i) samples.add(code[i], toFixed(pressure[i]));
  RegressorOptions linear;
  linear.name = "linear";
  return makeRegressor(linear)->fitSamples(samples);
}

TEST(LinearRegression, AgreesWithScikitLearnAndR) {
  // /usr/bin/python3, scikit-learn 1.2.1:
  // m = LinearRegression().fit([[100], [104], [104], [110], [150]], [1e3, 2e3, 3e3, 5e3, 20e3])
  // m.predict([[0], [100], [127], [4095]])
  const Fit line = fit({100, 104, 104, 110, 150}, {1e3, 2e3, 3e3, 5e3, 20e3});
  EXPECT_NEAR(line.pressure[0], -36945.6419868791, 1e-8);
  EXPECT_NEAR(line.pressure[100], 1034.6766635426466, 1e-9);
  EXPECT_NEAR(line.pressure[127], 11289.362699156518, 1e-9);
  EXPECT_NEAR(line.pressure[4095], 1518348.4067478913, 1e-5);
  // R 4.2.2:
  // x <- c(100, 104, 104, 110, 150); 1 / (1/5 + (c(100, 127, 0) - mean(x))^2 / sum((x - mean(x))^2))
  EXPECT_NEAR(line.support[100], 3.24316109422492493, 1e-12);
  EXPECT_NEAR(line.support[127], 3.27677543186180298, 1e-12);
  EXPECT_NEAR(line.support[0], 0.12888029955308614, 1e-14);
}

TEST(LinearRegression, ANarrowRangeOfLargeCodesLosesNoPrecision) {
  const Fit line = fit({65000, 65001, 65002, 65003}, {1e5, 2e5, 3e5, 4e5}, 65535);
  EXPECT_NEAR(line.pressure[65000], 1e5, 1e-6);
  EXPECT_NEAR(line.pressure[65535], 1e5 + 535e5, 1e-4);
}

TEST(LinearRegression, OfAConstantReadingIsTheMeanPressure) {
  const Fit line = fit({12, 12}, {100.0, 200.0});
  EXPECT_EQ(line.pressure[0], 150.0);
  EXPECT_EQ(line.pressure[4095], 150.0);
  EXPECT_EQ(line.support[12], 2.0);
  EXPECT_EQ(line.support[13], 0.0);
}

}  // namespace
}  // namespace fsr::regression
