#include "support/memory_rig.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <string>

namespace test_support {

namespace {

constexpr double kSpan = 600e3;  // [Pa]
constexpr double kCountsPerPascal = 5.8e-3;

std::vector<double> courseOf(const MemoryRig& rig) {
  std::vector<double> course = {0};
  const auto go = [&](double to, double rate, double dwell) {
    const double from = course.back();
    const int steps = std::max(1, int(std::abs(to - from) / rate * rig.frequency));
    for (int i = 1; i <= steps; ++i) course.push_back(from + (to - from) * i / steps);
    for (int i = 0; i < int(dwell * rig.frequency); ++i) course.push_back(to);
  };
  for (const MemoryCycles& part : rig.program) {
    for (int k = 0; k < part.cycles; ++k) {
      go(part.peak, part.rate, part.dwell_peak);
      go(0, part.rate, part.dwell_rest);
    }
  }
  return course;
}

// z follows the sign of the rate: Y. K. Wen, J. Eng. Mech. 102 (1976) 249-263, with n = 1.
std::vector<double> loopOf(const std::vector<double>& course) {
  std::vector<double> z = {0};
  for (std::size_t i = 1; i < course.size(); ++i) {
    const double step = (course[i] - course[i - 1]) / (0.1 * kSpan);
    z.push_back(std::clamp(z.back() + step - std::abs(step) * z.back(), -1.0, 1.0));
  }
  return z;
}

// Rise of the load with a stretched exponential of time as a sum over all steps of the course, thinned to one
// a second (R. Kohlrausch, Ann. Phys. 167 (1854) 179-214).
std::vector<double> creepOf(const std::vector<double>& course, double frequency) {
  const auto stride = std::size_t(frequency);
  std::vector<double> rise(course.size(), 0);
  for (std::size_t i = 0; i < course.size(); ++i) {
    for (std::size_t j = stride; j <= i; j += stride) {
      const double since = double(i - j + stride / 2) / frequency;
      rise[i] += (course[j] - course[j - stride]) * (1 - std::exp(-std::pow(since / 8, 0.7)));
    }
  }
  return rise;
}

}  // namespace

std::vector<MemoryCycles> variedProgram() {
  return {{3, 600e3, 20e3, 2, 2}, {3, 600e3, 60e3, 20, 20}, {3, 350e3, 60e3, 2, 5}, {2, 600e3, 20e3, 20, 10}};
}

fsr::dataset::Recording memoryRecording(const MemoryRig& rig) {
  const std::vector<double> course = courseOf(rig), z = loopOf(course);
  const std::vector<double> rise =
      rig.creep > 0 ? creepOf(course, rig.frequency) : std::vector<double>(course.size(), 0);
  std::mt19937 random(rig.seed);
  std::normal_distribution<double> noise(0, rig.noise);
  fsr::dataset::Recording recording;
  recording.name = "memory.bag";
  recording.layout.size = rig.size;
  recording.full_scale = 4095;
  recording.conditions = {{"flat", 1, {{0, 0, 0}}, {}}};
  for (std::size_t i = 0; i < course.size(); ++i) {
    recording.time.push_back(double(i) / rig.frequency);
    recording.pressure.push_back(course[i]);
    recording.condition.push_back(0);
    const double load = course[i] - rig.loop * kSpan / 2 * z[i] + rig.creep * rise[i] + 30e3;
    for (std::size_t taxel = 0; taxel < rig.size.taxels(); ++taxel) {
      const double counts = load * kCountsPerPascal * (0.9 + 0.05 * double(taxel)) + noise(random);
      recording.counts.push_back(std::uint16_t(std::clamp(counts, 0.0, 4095.0)));
    }
  }
  return recording;
}

fsr::dataset::Recording memorySession(std::size_t number, double offset, MemoryRig rig) {
  constexpr double kOffsets[] = {1.2, -1.2, 0.4, 1.15, -0.3, -1.15, 0.9};  // times `offset`
  rig.size = {2, 3};
  rig.seed = static_cast<unsigned>(number);
  rig.program = {{1, 0, 20e3, 2, 2}, {2, 500e3, 30e3, 2, 2}, {1, 400e3, 60e3, 8, 3}};
  fsr::dataset::Recording recording = memoryRecording(rig);
  recording.name = "session_" + std::to_string(number) + ".bag";
  const std::size_t taxels = rig.size.taxels();
  for (std::size_t i = 0; i < recording.counts.size(); ++i) {
    const double share = kOffsets[(number + 3 * (i % taxels)) % std::size(kOffsets)];
    const double counts = recording.counts[i] + share * offset * 5e-3;
    recording.counts[i] = static_cast<std::uint16_t>(std::max(0.0, counts));
  }
  return recording;
}

fsr::dataset::Recording partOf(const fsr::dataset::Recording& whole, std::size_t first, std::size_t last) {
  fsr::dataset::Recording part = whole;
  const auto cut = [&](auto& values, std::size_t each = 1) {
    values.erase(values.begin() + std::ptrdiff_t(last * each), values.end());
    values.erase(values.begin(), values.begin() + std::ptrdiff_t(first * each));
  };
  cut(part.time);
  cut(part.pressure);
  cut(part.condition);
  cut(part.counts, whole.layout.size.taxels());
  for (double& time : part.time) time -= whole.time[first];
  part.start_ns = whole.start_ns + std::llround(1e9 * whole.time[first]);
  return part;
}

}  // namespace test_support
