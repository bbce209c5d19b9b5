#include "benchmark/rig_readings.h"

#include <algorithm>
#include <cmath>

#include "statistics/random_stream.h"

namespace benchmark_data {

const std::vector<double> kCurvature = {0.0, 7.69, 9.09, 11.1, 14.3, 20.0};

fsr::regression::CodeSamples readings(std::size_t taxel, std::size_t condition, std::size_t section,
                                      std::size_t number) {
  const std::uint64_t member = (taxel * kConditions + condition) * kSections + section;
  const fsr::statistics::RandomStream noise = fsr::statistics::randomStream(1, "benchmark_noise", member);
  const fsr::statistics::RandomStream sheet = fsr::statistics::randomStream(1, "benchmark_sheet", taxel);
  const double gain =
      (1 + 0.05 * sheet.normal(0)) * (condition == 0 ? 1.0 : 0.88 - 0.005 * kCurvature[condition]);
  const double preload = condition == 0 ? 0.0 : 34e3 + 1e3 * sheet.normal(condition);
  fsr::regression::CodeSamples samples;
  samples.full_scale = kFullScale;
  for (std::size_t i = 0; i < number; ++i) {
    const double phase = std::fmod(2.0 * static_cast<double>(i) / static_cast<double>(number), 1.0);
    const double pressure = std::max(0.0, 640e3 * std::pow(std::sin(M_PI * phase), 2) - 20e3);
    const double loop = 0.015 * (phase < 0.5 ? -1.0 : 1.0) * std::sin(M_PI * phase);
    const double load = std::pow((pressure + preload) / 660e3, 0.7) + loop;
    const double reading =
        60 + 3400 * gain * load * (1 + 0.015 * noise.normal(2 * i)) + 6 * noise.normal(2 * i + 1);
    const auto code = static_cast<std::uint16_t>(std::clamp(std::round(reading), 0.0, double{kFullScale}));
    samples.add(code, fsr::regression::toFixed(pressure + 150 * noise.normal(2 * number + i)));
    samples.curvature.push_back(kCurvature[condition]);
  }
  return samples;
}

std::vector<fsr::regression::CodeSamples> taxelReadings(std::size_t taxel) {
  std::vector<fsr::regression::CodeSamples> cells;
  for (std::size_t condition = 0; condition < kConditions; ++condition) {
    for (std::size_t section = 0; section < kSections; ++section) {
      cells.push_back(readings(taxel, condition, section, kScansOfCondition / kSections));
    }
  }
  return cells;
}

TrainAndTest trainAndTest(std::size_t number) {
  TrainAndTest data;
  data.train.full_scale = data.test.full_scale = kFullScale;
  for (std::size_t condition = 0; condition < kConditions; ++condition) {
    for (std::size_t section = 0; section + 1 < kSections; ++section) {
      data.train.append(readings(0, condition, section, number / kConditions / (kSections - 1)));
    }
    data.test.append(readings(0, condition, kSections - 1, 1500 / kConditions));
  }
  return data;
}

}  // namespace benchmark_data
