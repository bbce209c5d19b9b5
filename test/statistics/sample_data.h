#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

// Data that R and the tests can both compute with identical digits. In R (`n` values from `s`):
//   pm <- function(s, n) sapply(1:n, function(i) (s <<- (s * 16807) %% 2147483647) / 2147483647)
//   x70 <- -log(pm(11, 70)); y70 <- -log(pm(12, 70)) * 1.5
//   t70 <- floor(8 * pm(13, 70)); u70 <- floor(8 * pm(14, 70)^2)
//   a <- c(1.83,0.50,1.62,2.48,1.68,1.88,1.55,3.06,1.30)
//   b <- c(0.878,0.647,0.598,2.05,1.06,1.29,1.06,3.14,1.29)
//   s1 <- sleep$extra[1:10]; s2 <- sleep$extra[11:20]
// All reference values of this room are from R 4.2.2, boot 1.3-28.1, exactRankTests 0.8-35 (Debian 12).

namespace sample_data {

using Values = std::vector<double>;

/// Park and Miller's generator, in (0, 1).
inline Values uniform(double seed, std::size_t n) {
  Values values(n);
  for (double& value : values) {
    seed = std::fmod(seed * 16807, 2147483647);
    value = seed / 2147483647;
  }
  return values;
}

template <typename F>
Values mapped(Values values, F f) {
  std::transform(values.begin(), values.end(), values.begin(), f);
  return values;
}

/// Strongly skewed.
inline Values exponential(double seed, std::size_t n, double scale = 1) {
  return mapped(uniform(seed, n), [scale](double u) { return -std::log(u) * scale; });
}

inline Values head(const Values& values, std::size_t n) {
  return Values(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n));
}

// Hamilton's depression scale, Hollander and Wolfe 1999, table 3.1; R's data set "sleep", with a tie and a
// zero.
const Values kA = {1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
const Values kB = {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
const Values kSleep1 = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
const Values kSleep2 = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
const Values kX70 = exponential(11, 70);
const Values kY70 = exponential(12, 70, 1.5);
const Values kT70 = mapped(uniform(13, 70), [](double u) { return std::floor(8 * u); });
const Values kU70 = mapped(uniform(14, 70), [](double u) { return std::floor(8 * u * u); });

/// R prints 15 digits. The algorithms add in different orders.
constexpr double kAgreement = 1e-9;

inline void expectNear(double value, double reference, double relative = kAgreement) {
  EXPECT_NEAR(value, reference, relative * std::abs(reference)) << "reference " << reference;
}

}  // namespace sample_data
