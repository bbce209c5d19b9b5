#pragma once

#include <vector>

#include "calibration/stages/temperature/temperature_course.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/condition_classes.h"

namespace fsr::calibration {

/// What a model of the temperature is found from. All must outlive the call.
struct TemperatureProblem {
  const std::vector<dataset::Recording>& recordings;
  const dataset::ConditionClasses& classes;
  const std::vector<dataset::Sections>& sections;
};

/// Chooses a model of the temperature, or none. `calibration` must have the taxels without a model; its
/// scores receive the choice. What follows is trained with the pressures of atReference().
///
/// The readings are the response: code = f(P) - s (T_lag - T_0) P f'(P). A table answers the other way round,
/// from code to pressure: where the pressure of the chamber has its largest value, the table answers with it
/// at any temperature, so that s could not be found from its errors. f is a line of straight pieces with
/// plays and fading memories of P, for each taxel and curvature class, so that no table is needed.
///
/// The gas in a chamber gets warmer with each filling, so that its temperature within a cycle depends on
/// earlier loads as loop and creep do. Therefore s is fitted to the mean temperatures of the cycles:
/// differences within a cycle have a coefficient of their own, which is discarded.
///
/// The lag is that with the smallest error of readings of groups that were left out. The groups are the
/// protocols and, where the bags are several, also the recordings. The model is taken if the readings are
/// predicted worse by more than 1 % on no group, and better by 2 % over all of them.
TemperatureModel chooseTemperature(const TemperatureProblem& problem, const CalibrationOptions& options,
                                   Calibration& calibration);

}  // namespace fsr::calibration
