#include <algorithm>
#include <set>

#include "compensation/held_out_squares.h"
#include "matrix/for_each_taxel.h"
#include "study/evaluation.h"

namespace fsr::study {

namespace {

// Divides a fold's training cells again: every second group is held out, then the others.
std::vector<Fold> innerFolds(const Fold& fold) {
  std::set<std::size_t> groups;
  for (const Cell& cell : fold.train) groups.insert(cell.group);
  std::vector<Fold> folds(2);
  for (const Cell& cell : fold.train) {
    const auto place = static_cast<std::size_t>(std::distance(groups.begin(), groups.find(cell.group)));
    folds[place % 2].test.push_back(cell);
    folds[1 - place % 2].train.push_back(cell);
  }
  return folds;
}

// Sum of squared errors of each bandwidth on one taxel [Pa^2].
std::vector<double> squaresOf(const StudyMethod& method, const std::vector<Fold>& inner,
                              const std::vector<TestPart>& parts, const TaxelReadings& readings,
                              std::size_t taxel, const StudyPlan& plan) {
  std::vector<double> squares(plan.bandwidths.size(), 0.0);
  for (const TestPart& part : parts) {
    const Fold& fold = inner[part.fold];
    const regression::ClassReadings training = readings.training(fold.train, false);
    for (std::size_t b = 0; b < squares.size(); ++b) {
      const FoldModel model = plainModel(method, grnnOf(plan.grnn, plan.bandwidths[b]));
      const auto tables = tablesFor(model, taxel, training, part.tested);
      for (const Cell& cell : fold.test) {
        const auto place = std::find(part.tested.begin(), part.tested.end(), cell.curvature_class);
        const auto k = static_cast<std::size_t>(place - part.tested.begin());
        squares[b] += compensation::squaredErrors(readings.cell(cell), tables[k]);
      }
    }
  }
  return squares;
}

}  // namespace

std::vector<double> chooseBandwidths(const StudyData& data, const StudyMethod& method,
                                     const Validation& validation, const StudyPlan& plan) {
  const std::vector<std::size_t> taxels = taxelSample(data, plan);
  std::vector<double> chosen;
  for (const Fold& fold : validation.folds) {
    const std::vector<Fold> inner = innerFolds(fold);
    const std::vector<TestPart> parts = testParts(method, {validation.grouping, inner, Scoring::kPooled});
    std::vector<std::vector<double>> of_taxel(taxels.size());
    matrix::forEachTaxel(taxels.size(), plan.threads, [&](std::size_t t) {
      const TaxelReadings readings(data, validation.grouping, taxels[t]);
      of_taxel[t] = squaresOf(method, inner, parts, readings, taxels[t], plan);
    });
    std::vector<double> sums(plan.bandwidths.size(), 0.0);
    for (const auto& squares : of_taxel) {
      for (std::size_t b = 0; b < sums.size(); ++b) sums[b] += squares[b];
    }
    const auto least = static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin());
    chosen.push_back(parts.empty() ? plan.grnn.bandwidth : plan.bandwidths[least]);
  }
  return chosen;
}

}  // namespace fsr::study
