#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "regression/code_statistics.h"

// Readings like those of the paper's rig, for timing: six surfaces, five sections of load cycles up to 620
// kPa, a 12-bit converter. A bent sheet has a lower gain and a higher reading at rest.

namespace benchmark_data {

constexpr std::uint16_t kFullScale = 4095;
constexpr std::size_t kConditions = 6;
constexpr std::size_t kSections = 5;
constexpr std::size_t kScansOfCondition = 7500;
constexpr std::size_t kTaxels = 70;

/// Curvature of each condition [1/m]: flat, then cylinders of 13 to 5 cm radius.
extern const std::vector<double> kCurvature;

/// Readings of one taxel on one condition in one section, in time order, with the curvature.
fsr::regression::CodeSamples readings(std::size_t taxel, std::size_t condition, std::size_t section,
                                      std::size_t number);

/// [conditions x sections] of one taxel, kScansOfCondition / kSections each.
std::vector<fsr::regression::CodeSamples> taxelReadings(std::size_t taxel);

/// A training set of `number` readings on all conditions, and a test set of 1,500.
struct TrainAndTest {
  fsr::regression::CodeSamples train, test;
};
TrainAndTest trainAndTest(std::size_t number);

}  // namespace benchmark_data
