#include "regression/forest/forest_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <random>

namespace fsr::regression {
namespace {

// A second, simple implementation: a resampled copy of the readings, and every cut tried at every node.
struct BentReading {
  std::array<double, 2> input;  // code, curvature
  double pressure;              // [Pa]
};
struct Box {
  std::vector<BentReading> readings;
  std::array<double, 2> low, high;
};
struct Cut {
  double gain = 0;
  double at = 0;
};

double squaredErrors(const std::vector<BentReading>& readings) {
  double mean = 0, sum = 0;
  for (const BentReading& reading : readings) mean += reading.pressure / static_cast<double>(readings.size());
  for (const BentReading& reading : readings) sum += (reading.pressure - mean) * (reading.pressure - mean);
  return sum;
}

Cut bestOf(const std::vector<BentReading>& readings, std::size_t input, std::size_t minimum_leaf) {
  std::vector<double> values;
  for (const BentReading& reading : readings) values.push_back(reading.input[input]);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  Cut best;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double at = (values[i - 1] + values[i]) / 2;
    std::vector<BentReading> left, right;
    for (const BentReading& reading : readings) (reading.input[input] < at ? left : right).push_back(reading);
    if (std::min(left.size(), right.size()) < minimum_leaf) continue;
    const double gain = squaredErrors(readings) - squaredErrors(left) - squaredErrors(right);
    if (gain > best.gain * (1 + 1e-9) + 1e-3) best = {gain, at};
  }
  return best;
}

// The readings that tree `tree` draws, from the documented stream over the sorted readings.
std::vector<BentReading> replica(const ForestData& data, std::uint64_t seed, std::uint64_t tree) {
  std::vector<BentReading> all(data.pressure.size());
  std::size_t reading = 0, slot = 0;
  for (const ForestData::SizeClass& size_class : data.classes) {
    for (std::size_t i = 0; i < size_class.readings_each * size_class.entries; ++i, ++reading) {
      const auto entry = static_cast<std::size_t>(
          std::find(data.slot.begin(), data.slot.end(), slot + i % size_class.entries) - data.slot.begin());
      all[reading] = {{data.code[entry], data.curvatures[data.curvature[entry]]},
                      data.centre + data.unit * data.pressure[reading]};
    }
    slot += size_class.entries;
  }
  const statistics::RandomStream stream = statistics::randomStream(seed, "forest", tree);
  std::vector<BentReading> drawn;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::uint64_t bits = stream.bits(i / 2);
    const bool last_of_odd = i + 1 == all.size() && i % 2 == 0;
    bits = i % 2 != 0 || last_of_odd ? bits >> 32 : bits & 0xffffffffu;
    drawn.push_back(all[bits * all.size() >> 32]);
  }
  return drawn;
}

std::vector<Box> plainTree(const ForestData& data, const ForestOptions& options, std::uint64_t tree) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const statistics::RandomStream inputs = statistics::randomStream(options.seed, "forest_input", tree);
  std::deque<Box> open = {
      {replica(data, options.seed, tree), {-kInfinity, -kInfinity}, {kInfinity, kInfinity}}};
  std::vector<Box> leaves;
  for (std::uint64_t node = 0; !open.empty(); ++node) {
    const Box box = open.front();
    open.pop_front();
    std::size_t input = data.curvatures.size() > 1 && inputs.bits(node) >> 63 == 0 ? 1 : 0;
    Cut cut = bestOf(box.readings, input, options.minimum_leaf);
    if (cut.gain == 0 && data.curvatures.size() > 1 && options.sampling == InputSampling::kRetry) {
      input = 1 - input;
      cut = bestOf(box.readings, input, options.minimum_leaf);
    }
    if (cut.gain == 0) {
      leaves.push_back(box);
      continue;
    }
    Box left{{}, box.low, box.high}, right{{}, box.low, box.high};
    left.high[input] = right.low[input] = cut.at;
    for (const BentReading& reading : box.readings) {
      (reading.input[input] < cut.at ? left : right).readings.push_back(reading);
    }
    open.push_back(left);
    open.push_back(right);
  }
  return leaves;
}

CodeSamples noisyCurves(std::size_t number, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  CodeSamples samples;
  samples.full_scale = 255;
  for (std::size_t i = 0; i < number; ++i) {
    const double curvature = static_cast<double>(random() % 4) * 5.0;
    const double code = static_cast<double>(random() % 200);
    samples.add(static_cast<std::uint16_t>(code),
                toFixed(1e3 * code * (1 + 0.02 * curvature) + 15e3 * normal(random)));
    samples.curvature.push_back(curvature);
  }
  return samples;
}

// Answers of both implementations at every code and at curvatures between and beyond those of training.
void expectThePlainTree(bool on_curvature, const ForestOptions& options) {
  const CodeSamples samples = noisyCurves(401, 3);
  const ForestData data(samples, on_curvature);
  TreeGrower grower(data, 256, options);
  for (std::uint64_t tree = 0; tree < 3; ++tree) {
    const auto& leaves = grower.grow(tree);
    const std::vector<Box> plain = plainTree(data, options, tree);
    ASSERT_EQ(leaves.size(), plain.size());
    for (int code = 0; code < 256; ++code) {
      for (const double curvature : {-1.0, 0.0, 3.0, 6.0, 8.0, 11.0, 14.0, 20.0}) {
        const auto mine = std::find_if(leaves.begin(), leaves.end(), [&](const ForestLeaf& leaf) {
          return code >= leaf.first && code < leaf.end && curvature >= leaf.low && curvature < leaf.high;
        });
        const auto theirs = std::find_if(plain.begin(), plain.end(), [&](const Box& box) {
          return code >= box.low[0] && code < box.high[0] && curvature >= box.low[1] &&
                 curvature < box.high[1];
        });
        double mean = 0;
        for (const BentReading& reading : theirs->readings) mean += reading.pressure;
        mean /= static_cast<double>(theirs->readings.size());
        ASSERT_NEAR(data.centre + data.unit * mine->pressure, mean, 1e-6) << code << " " << curvature;
        ASSERT_EQ(mine->readings, static_cast<double>(theirs->readings.size()));
      }
    }
  }
}

TEST(TreeGrower, OnOneInputGrowsTheTreeOfAPlainSearch) {
  expectThePlainTree(false, {});
}

TEST(TreeGrower, OnTwoInputsGrowsTheTreeOfAPlainSearch) {
  expectThePlainTree(true, {});
}

TEST(TreeGrower, WithLeavesForInputsWithoutACutGrowsTheTreeOfAPlainSearch) {
  ForestOptions options;
  options.sampling = InputSampling::kLeaf;
  options.minimum_leaf = 2;
  expectThePlainTree(true, options);
}

TEST(BestCut, OfEqualCutsTakesTheLowest) {
  // two readings each at 0, 1, 1, 0: cutting off the first gains as much as cutting off the last
  std::vector<double> count = {0, 2, 4, 6, 8}, sum = {0, 0, 2, 4, 4}, code = {1, 2, 3, 4};
  for (auto* values : {&count, &sum, &code}) values->resize(4 + kCutLanes, values->back());
  EXPECT_EQ(bestCut({count.data(), count.data(), sum.data(), code.data(), false, 0, 4, 1}), 1u);
  EXPECT_EQ(bestCut({count.data(), count.data(), sum.data(), code.data(), false, 0, 4, 3}), kNoCut);
}

TEST(BestCut, FindsNoCutIfAllPressuresAreEqual) {
  std::vector<double> count, sum, code;
  for (int i = 0; i < 40; ++i) {
    count.push_back(3 * i);
    sum.push_back(7 * 3 * i);
    code.push_back(i);
  }
  EXPECT_EQ(bestCut({count.data(), count.data(), sum.data(), code.data(), false, 0, 30, 5}), kNoCut);
}

}  // namespace
}  // namespace fsr::regression
