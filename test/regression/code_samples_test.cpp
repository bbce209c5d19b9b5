#include "regression/code_statistics.h"

#include <gtest/gtest.h>

#include <random>

#include "fsr_pressure_map/settings/input_error.h"
#include "regression/cross_validation.h"
#include "regression/grnn/grnn.h"

namespace fsr::regression {
namespace {

CodeSamples randomSamples(std::size_t number, unsigned seed) {
  std::mt19937 random(seed);
  CodeSamples samples;
  samples.full_scale = 4095;
  for (std::size_t i = 0; i < number; ++i) {
    const auto code = static_cast<std::uint16_t>(100 + random() % 800);
    samples.add(code, toFixed(100.0 * code + static_cast<double>(random() % 5000)));
  }
  return samples;
}

TEST(CodeSamples, RefuseVectorsThatDoNotFit) {
  CodeSamples samples = randomSamples(3, 1);
  EXPECT_NO_THROW(validate(samples));
  samples.curvature = {1.0};
  EXPECT_THROW(validate(samples), settings::InputError);
  samples.curvature = {1.0, 2.0, 3.0};
  EXPECT_NO_THROW(validate(samples));
  samples.code[1] = 4096;
  EXPECT_THROW(validate(samples), settings::InputError);
}

}  // namespace
}  // namespace fsr::regression
