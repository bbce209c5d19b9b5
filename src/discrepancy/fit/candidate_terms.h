#pragma once

#include <string>
#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::discrepancy {

/// Smooth functions of some covariates, independent of the physics behind them. They show how much can be
/// explained at all, and by which covariates. Terms that act like a load are multiplied by the slope of the
/// static curves, terms that act like a gain by their rise.
struct GenericTerms {
  std::vector<simulation::Covariate> covariates;
  std::vector<Trace> columns;  ///< scaled to rms 1, not projected; the sign of each is free
};

/// Returns the terms of each group of covariates. If the recordings have several curvatures, each group
/// except clock time is returned a second time with curvature (`columns` then holds the plain terms as well).
std::vector<GenericTerms> genericTerms(const Measured& measured, const StaticFit& fit);

/// A random course of the reading over clock time: a Gaussian process, as the sum of its first modes.
///
/// The coefficients of the columns are independent and have one variance. Of a walk it is the square of the
/// step in one hour. A fit of the columns by that variance is the likelihood of the process.
/// Source: M. Loeve, Probability Theory, Van Nostrand 1955 (Karhunen-Loeve modes).
struct RandomCourse {
  std::string step;                ///< the effect's parameter; empty = a smooth course, which no walk takes
  simulation::EffectValues shape;  ///< the value of its time constant
  std::vector<Trace> columns;      ///< not projected
};

/// The random walks of an effect, with each tried value of their time constant, and beside each of them a
/// smooth course: the integral of a walk, whose slope is random, too. Where the smooth course explains the
/// readings better, they follow a trend, and no walk is needed. Source of this prior: G. Wahba, Improper
/// priors, spline smoothing and the problem of guarding against model errors in regression, J. Roy. Statist.
/// Soc. B 40 (1978) 364-372. Empty for an effect that does not walk.
std::vector<RandomCourse> randomCourses(const Measured& measured, const StaticFit& fit,
                                        const simulation::EffectInfo& info);

}  // namespace fsr::discrepancy
