#include "regression/isotonic.h"

namespace fsr::regression {

std::vector<IsotonicBlock> isotonicRegression(const std::vector<double>& values,
                                              const std::vector<double>& weights) {
  std::vector<IsotonicBlock> blocks;
  for (std::size_t i = 0; i < values.size(); ++i) {
    IsotonicBlock block{i, i + 1, values[i], weights[i]};
    while (!blocks.empty() && blocks.back().level >= block.level) {
      const IsotonicBlock& before = blocks.back();
      const double weight = before.weight + block.weight;
      const double level = (before.level * before.weight + block.level * block.weight) / weight;
      block = {before.begin, block.end, level, weight};
      blocks.pop_back();
    }
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace fsr::regression
