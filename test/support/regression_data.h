#pragma once

#include "regression/code_statistics.h"

namespace test_support {

/// test/data/regression.csv: readings of an invented taxel on six surfaces.
struct RegressionData {
  fsr::regression::CodeSamples train, test;  ///< with curvature
};

RegressionData regressionData();

/// RMSE of the predictions for the test readings [Pa], in per cent of the range of the test pressures.
double rmsePercentOn(const fsr::regression::CodeSamples& test, const std::vector<double>& answers);

}  // namespace test_support
