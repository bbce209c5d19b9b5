#pragma once

#include "statistics/random_stream.h"
#include "statistics/sample_data.h"
#include "statistics/samples.h"

// Repeated measures for the tests, with their lines in R:
//   m5 <- sapply(1:5, function(j) -log(pm(20 + j, 70)) * (1 + j / 10))
//   mt <- sapply(1:5, function(j) floor(4 * pm(20 + j, 70)^(1 / j)))
//   n3 <- sapply(1:3, function(j) qnorm(pm(40 + j, 30)) + c(0, 0.2, 1)[j])
//   RT <- matrix(c(5.40,5.50,5.55, ...), 22, byrow = TRUE)      # example of ?friedman.test

namespace sample_data {

inline fsr::statistics::RepeatedMeasures measures(const std::vector<Values>& values) {
  fsr::statistics::RepeatedMeasures result;
  result.values = values;
  for (std::size_t j = 0; j < values.size(); ++j) result.treatments.push_back("m" + std::to_string(j + 1));
  return result;
}

inline fsr::statistics::RepeatedMeasures skewed5(double step = 10) {
  std::vector<Values> values;
  for (int j = 1; j <= 5; ++j) values.push_back(exponential(20 + j, 70, 1 + j / step));
  return measures(values);
}

inline fsr::statistics::RepeatedMeasures tied5() {
  std::vector<Values> values;
  for (int j = 1; j <= 5; ++j) {
    values.push_back(
        mapped(uniform(20 + j, 70), [j](double u) { return std::floor(4 * std::pow(u, 1.0 / j)); }));
  }
  return measures(values);
}

/// Times of 22 players to round first base with three methods: Hollander and Wolfe 1999, table 7.1.
inline fsr::statistics::RepeatedMeasures roundingTimes() {
  return measures({{5.40, 5.85, 5.20, 5.55, 5.90, 5.45, 5.40, 5.45, 5.25, 5.85, 5.25,
                    5.65, 5.60, 5.05, 5.50, 5.45, 5.55, 5.45, 5.50, 5.65, 5.70, 6.30},
                   {5.50, 5.70, 5.60, 5.50, 5.85, 5.55, 5.40, 5.50, 5.15, 5.80, 5.20,
                    5.55, 5.35, 5.00, 5.50, 5.55, 5.55, 5.50, 5.45, 5.60, 5.65, 6.30},
                   {5.55, 5.75, 5.50, 5.40, 5.70, 5.60, 5.35, 5.35, 5.00, 5.70, 5.10,
                    5.45, 5.45, 4.95, 5.40, 5.50, 5.35, 5.55, 5.25, 5.40, 5.55, 6.25}});
}

inline fsr::statistics::RepeatedMeasures normal3() {
  std::vector<Values> values;
  for (int j = 0; j < 3; ++j) {
    const double shift = std::vector<double>{0, 0.2, 1}[j];
    values.push_back(mapped(uniform(41 + j, 30),
                            [shift](double u) { return fsr::statistics::normalQuantile(u) + shift; }));
  }
  return measures(values);
}

}  // namespace sample_data
