#pragma once

#include <vector>

#include "regression/code_statistics.h"

namespace fsr::regression {

constexpr std::uint16_t kFullScale = 4095;

struct Reading {
  std::uint16_t code;
  double pressure;  // [Pa]
};

inline CodeStatistics statisticsOf(const std::vector<Reading>& readings,
                                   std::uint16_t full_scale = kFullScale) {
  CodeAccumulator accumulator(full_scale);
  for (const Reading& reading : readings) accumulator.add(reading.code, toFixed(reading.pressure));
  return accumulator.take();
}

}  // namespace fsr::regression
