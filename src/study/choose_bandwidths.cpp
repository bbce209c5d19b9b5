#include <algorithm>
#include <set>

#include "fsr_pressure_map/compensation/fit_scheme.h"
#include "fsr_pressure_map/matrix/for_each_taxel.h"
#include "fsr_pressure_map/study/evaluation.h"

namespace fsr {

namespace {

// A fold's training cells once more divided, one group held out after the other.
std::vector<Fold> innerFolds(const Fold& fold) {
  std::set<std::size_t> groups;
  for (const Cell& cell : fold.train) groups.insert(cell.group);
  std::vector<Fold> folds;
  for (const std::size_t group : groups) {
    Fold inner;
    for (const Cell& cell : fold.train) (cell.group == group ? inner.test : inner.train).push_back(cell);
    if (!inner.train.empty()) folds.push_back(inner);
  }
  return folds;
}

// Squared errors of a table on held-out readings [Pa^2], less what no table can change.
double squares(const std::vector<double>& table, const CodeStatistics& readings) {
  double sum = 0;
  readings.forEach([&](const CodeSums& sums) {
    const double error = table[sums.code] - fromFixed(sums.sum) / sums.count;
    sum += sums.count * error * error;
  });
  return sum;
}

// Adds the errors of every bandwidth in the fold's inner folds.
void addSquares(const StudyMethod& method, const std::vector<Fold>& inner, const std::vector<TestPart>& parts,
                const TaxelReadings& readings, std::size_t taxel, const StudyPlan& plan,
                std::vector<double>& sums) {
  for (std::size_t f = 0; f < inner.size(); ++f) {
    const ClassReadings training = readings.training(inner[f].train, false);
    for (std::size_t b = 0; b < sums.size(); ++b) {
      const std::vector<Fit> fits =
          fitScheme(method.plan, taxel, training, kernels({plan.bandwidths[b]}, plan.grnn).front());
      for (const TestPart& part : parts) {
        if (part.fold != f) continue;
        for (const Cell& cell : inner[f].test) {
          const auto place = std::find(part.tested.begin(), part.tested.end(), cell.curvature_class);
          if (place == part.tested.end()) continue;
          const std::size_t asked = part.asked[static_cast<std::size_t>(place - part.tested.begin())];
          sums[b] += squares(fits[method.plan.model_of_class[asked]].pressure, readings.cell(cell));
        }
      }
    }
  }
}

}  // namespace

std::vector<double> chooseBandwidths(const StudyData& data, const StudyMethod& method,
                                     const Grouping& grouping, const std::vector<Fold>& folds,
                                     const StudyPlan& plan) {
  const std::size_t step = std::max<std::size_t>(1, data.taxels.size() / plan.bandwidth_taxels);
  const std::size_t looked_at = (data.taxels.size() + step - 1) / step;
  std::vector<double> chosen;
  for (const Fold& fold : folds) {
    const std::vector<Fold> inner = innerFolds(fold);
    const std::vector<TestPart> parts = testParts(data, method, grouping, inner);
    std::vector<std::vector<double>> sums(looked_at, std::vector<double>(plan.bandwidths.size(), 0.0));
    forEachTaxel(looked_at, plan.threads, [&](std::size_t t) {
      const TaxelReadings readings(data, grouping, data.taxels[t * step]);
      addSquares(method, inner, parts, readings, data.taxels[t * step], plan, sums[t]);
    });
    std::vector<double> together(plan.bandwidths.size(), 0.0);
    for (const auto& of_taxel : sums) {
      for (std::size_t b = 0; b < together.size(); ++b) together[b] += of_taxel[b];
    }
    chosen.push_back(plan.bandwidths[static_cast<std::size_t>(
        std::min_element(together.begin(), together.end()) - together.begin())]);
  }
  return chosen;
}

}  // namespace fsr
