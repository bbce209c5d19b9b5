#include "regression/forest/forest.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "regression/forest/forest_tree.h"
#include "regression/regressors.h"
#include "regression/second_input.h"

namespace fsr::regression {

namespace {

constexpr std::size_t kMostTrees = 100000;

void validate(const ForestOptions& options) {
  if (options.trees < 1 || options.trees > kMostTrees) {
    throw settings::InputError("trees of a forest are " + std::to_string(options.trees) +
                               ", but must be 1 to " + std::to_string(kMostTrees));
  }
  if (options.minimum_leaf < 1)
    throw settings::InputError("minimum_leaf of a forest is 0, but must be 1 or more");
}

Fit zeros(std::size_t table_size) {
  return {std::vector<double>(table_size, 0.0), std::vector<double>(table_size, 0.0)};
}

// Adds a leaf to the sums over trees, in the order of the trees.
void addLeaf(const ForestLeaf& leaf, Fit& sums) {
  for (auto code = static_cast<std::size_t>(leaf.first); code < static_cast<std::size_t>(leaf.end); ++code) {
    sums.pressure[code] += leaf.pressure;
    sums.support[code] += leaf.readings;
  }
}

// Converts sums to means and units to Pa.
void finish(const ForestData& data, std::size_t trees, Fit& fit) {
  const auto number = static_cast<double>(trees);
  for (double& pressure : fit.pressure) pressure = data.centre + data.unit * (pressure / number);
  for (double& support : fit.support) support /= number;
}

std::vector<double> splitsOf(const std::vector<ForestLeaf>& leaves) {
  std::vector<double> splits;
  for (const ForestLeaf& leaf : leaves) {
    if (leaf.low > -INFINITY) splits.push_back(leaf.low);
  }
  std::sort(splits.begin(), splits.end());
  splits.erase(std::unique(splits.begin(), splits.end()), splits.end());
  return splits;
}

}  // namespace

Forest::Forest(const ForestOptions& options) : options_(options) {
  validate(options);
}

Fit Forest::fit(const CodeHistogram&) const {
  refuseSums();
}

Fit Forest::fitSamples(const CodeSamples& training) const {
  const ForestData data(training, false);
  const std::size_t table_size = training.full_scale + 1u;
  TreeGrower grower(data, static_cast<std::int32_t>(table_size), options_);
  Fit fit = zeros(table_size);
  for (std::size_t tree = 0; tree < options_.trees; ++tree) {
    for (const ForestLeaf& leaf : grower.grow(tree)) addLeaf(leaf, fit);
  }
  finish(data, options_.trees, fit);
  return fit;
}

const Fit& CurvatureSteps::at(double curvature) const {
  return fits[static_cast<std::size_t>(std::upper_bound(split.begin(), split.end(), curvature) -
                                       split.begin())];
}

CurvatureSteps fitCurvatureForest(const CodeSamples& training, const ForestOptions& options) {
  validate(options);
  const ForestData data(training, true);
  const std::size_t table_size = training.full_scale + 1u;
  TreeGrower grower(data, static_cast<std::int32_t>(table_size), options);
  std::vector<ForestLeaf> leaves;
  for (std::size_t tree = 0; tree < options.trees; ++tree) {
    const auto& grown = grower.grow(tree);
    leaves.insert(leaves.end(), grown.begin(), grown.end());
  }
  CurvatureSteps steps{splitsOf(leaves), {}};
  steps.fits.assign(steps.split.size() + 1, zeros(table_size));
  const auto intervalFrom = [&](double low) {
    return std::upper_bound(steps.split.begin(), steps.split.end(), low) - steps.split.begin();
  };
  for (const ForestLeaf& leaf : leaves) {
    const auto end =
        std::lower_bound(steps.split.begin(), steps.split.end(), leaf.high) - steps.split.begin();
    for (auto i = intervalFrom(leaf.low); i <= end; ++i)
      addLeaf(leaf, steps.fits[static_cast<std::size_t>(i)]);
  }
  for (Fit& fit : steps.fits) finish(data, options.trees, fit);
  return steps;
}

RegressorEntry forestEntry() {
  RegressorEntry entry;
  entry.name = "forest";
  entry.summary = "random forest of regression trees (Breiman 2001)";
  entry.make = [](const RegressorOptions& options) -> std::unique_ptr<Regressor> {
    return std::make_unique<Forest>(options.forest);
  };
  entry.write = [](const RegressorOptions& options, OptionWriter& writer) {
    writer.integer("trees", options.forest.trees);
    writer.integer("minimum_leaf", options.forest.minimum_leaf);
    writer.text("leaf_rule", leafRuleName(options.forest.leaf_count));
  };
  entry.read = [](const OptionReader& reader, RegressorOptions& options) {
    options.forest.trees = reader.integer("trees");
    options.forest.minimum_leaf = reader.integer("minimum_leaf");
    options.forest.leaf_count = leafRuleFromName(reader.text("leaf_rule"));
  };
  entry.in_every_file = true;
  SecondInput input;
  input.fit = [](const ClassReadings& readings, const ClassInputs& inputs, const RegressorOptions& options) {
    return fitForestOnInput(readings, inputs, options.forest);
  };
  entry.second_input = input;
  return entry;
}

}  // namespace fsr::regression
