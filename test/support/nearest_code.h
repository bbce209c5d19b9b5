#pragma once

#include "regression/regressors.h"

namespace test_support {

/// A regressor that is not part of the package: the answer at a code is the mean pressure of the nearest code
/// of training, plus the option "offset" [Pa]. Takes no second input. It shows what a new regressor consists
/// of.
fsr::regression::RegressorEntry nearestCodeEntry();

/// The package's regressors and this one.
const fsr::regression::RegressorTable& regressorsWithNearestCode();

}  // namespace test_support
