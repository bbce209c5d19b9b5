#pragma once

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"

namespace fsr::discrepancy {

/// Whether the fit cycles want an effect in one size, at whatever pace v [Pa/s] and whenever they were run.
/// `part`: what the effect adds to the common trace; `wanted`: what it should explain.
///
/// The size of a delay goes with v^0. Friction shifts the reading by a pressure and not by a time, so a delay
/// that imitates it goes with 1/v. Between them lies v^-0.5. The exponent is the slope of the cycles' sizes
/// over ln v by weighted least squares, with its 95 % interval after H. White, Econometrica 48, 1980, 817.
/// Over the clock time t the size must not change by more than its mean from the first cycle to the last.
/// Paces that do not differ tell nothing; fewer than 3 cycles are taken for constant.
bool isConstant(const Measured& measured, const Trace& part, const Trace& wanted);

}  // namespace fsr::discrepancy
