#pragma once

#include <cstddef>
#include <vector>

#include "calibration/stages/memory/history_training.h"
#include "calibration/stages/temperature/temperature_course.h"
#include "dataset/protocols.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// The sensitivity that the readings show with one lag.
struct TemperatureEstimate {
  double sensitivity = 0;       ///< s of TemperatureModel, from all groups [1/K]
  std::vector<double> without;  ///< likewise, from all groups but one [1/K]
  /// Sum of the squared errors of readings of groups that were left out, predicted from pressure and
  /// temperature, and from pressure alone [Pa^2].
  double square = 0;
  double square_without_temperature = 0;
};

/// Fits s for each lag of the grid.
///
/// The readings are the response: code = f(P) - s (T_lag - T_0) P f'(P). A table answers the other way round,
/// from code to pressure: where the pressure of the chamber has its largest value, the table answers with it
/// at any temperature, so that s could not be found from its errors. f is a line of straight pieces with
/// plays and fading memories of P, for each taxel and curvature class.
///
/// The gas in a chamber gets warmer with each filling, so that its temperature within a cycle depends on
/// earlier loads as loop and creep do. Therefore s is fitted to the mean temperatures of the cycles:
/// differences within a cycle have a coefficient of their own, which is discarded.
///
/// `groups`: protocols or recordings. Taxels with `no_model` are left out. The result does not depend on the
/// number of threads.
std::vector<TemperatureEstimate> fitTemperature(const HistoryProblem& problem, const TemperatureGrid& grid,
                                                const dataset::Protocols& groups,
                                                const std::vector<std::uint8_t>& no_model, unsigned threads);

/// Chooses a model of the temperature, or none. `calibration` was trained without one; its scores receive the
/// choice. The lag is that with the smallest error of readings that were left out, see fitTemperature(). The
/// model is taken by the rule of trainHistory(), for protocols and, where the bags are several, also for
/// recordings: on each one that was left out, the answer of the family in use is worse by more than 1 % on
/// none and better by 2 % over all of them. A model that is present() must be trained: see atReference().
TemperatureModel chooseTemperature(const HistoryProblem& problem, const CalibrationOptions& options,
                                   Calibration& calibration);

}  // namespace fsr::calibration
