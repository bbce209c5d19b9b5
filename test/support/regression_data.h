#pragma once

#include "regression/code_samples.h"

namespace test_support {

/// test/data/regression.csv: readings of one imagined taxel on six surfaces.
struct RegressionData {
  fsr::regression::CodeSamples train, test;  ///< with curvature
};

RegressionData regressionData();

/// RMSE in percent of the range of the test pressures, of an answer for each test reading [Pa].
double rmsePercentOn(const fsr::regression::CodeSamples& test, const std::vector<double>& answers);

}  // namespace test_support
