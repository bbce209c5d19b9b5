#include "compensation/curvature_ranges.h"

#include "compensation/held_out_squares.h"
#include "matrix/for_each_taxel.h"

namespace fsr::compensation {

namespace {

// Squared errors of one model of the classes of `range`, each on the section that it was trained without.
double rangeSquares(const TrainingStatistics& statistics, std::size_t taxel, const regression::Grnn& grnn,
                    const CurvatureRange& range) {
  regression::CodeHistogram training(statistics.full_scale);
  const auto forEachCell = [&](std::size_t section, const auto& use) {
    for (const std::size_t k : range) use(statistics.cell(taxel, k, section));
  };
  for (std::size_t s = 0; s < statistics.sections; ++s) {
    forEachCell(s, [&](const regression::CodeStatistics& cell) { training.add(cell); });
  }
  double squares = 0;
  for (std::size_t s = 0; s < statistics.sections; ++s) {
    forEachCell(s, [&](const regression::CodeStatistics& cell) { training.subtract(cell); });
    if (training.samples() > 0) {
      const std::vector<double> pressure = grnn.fit(training).pressure;
      forEachCell(s,
                  [&](const regression::CodeStatistics& cell) { squares += squaredErrors(cell, pressure); });
    }
    forEachCell(s, [&](const regression::CodeStatistics& cell) { training.add(cell); });
  }
  return squares;
}

// Errors of several ranges, summed over taxels.
std::vector<double> squaresOf(const std::vector<CurvatureRange>& ranges, const TrainingStatistics& statistics,
                              const regression::Grnn& grnn, const std::vector<std::size_t>& taxels,
                              unsigned threads) {
  std::vector<std::vector<double>> of_taxel(taxels.size());
  matrix::forEachTaxel(taxels.size(), threads, [&](std::size_t i) {
    for (const CurvatureRange& range : ranges)
      of_taxel[i].push_back(rangeSquares(statistics, taxels[i], grnn, range));
  });
  return sumOverTaxels(of_taxel);
}

CurvatureRange joined(const CurvatureRange& a, const CurvatureRange& b) {
  CurvatureRange both = a;
  both.insert(both.end(), b.begin(), b.end());
  return both;
}

}  // namespace

std::vector<CurvatureRange> learnRanges(const TrainingStatistics& statistics, const regression::Grnn& grnn,
                                        const std::vector<std::size_t>& taxels, unsigned threads) {
  std::vector<CurvatureRange> ranges;
  for (std::size_t k = 0; k < statistics.classes.size(); ++k) ranges.push_back({k});
  std::vector<double> alone = squaresOf(ranges, statistics, grnn, taxels, threads);
  while (ranges.size() > 1) {
    std::vector<CurvatureRange> pairs;
    for (std::size_t i = 0; i + 1 < ranges.size(); ++i) pairs.push_back(joined(ranges[i], ranges[i + 1]));
    const std::vector<double> merged = squaresOf(pairs, statistics, grnn, taxels, threads);
    const auto cost = [&](std::size_t i) { return merged[i] / (alone[i] + alone[i + 1]); };
    std::size_t best = 0;
    for (std::size_t i = 1; i < pairs.size(); ++i) {
      if (cost(i) < cost(best)) best = i;
    }
    if (!(cost(best) <= 1 + kMergeCost)) break;
    const auto at = static_cast<std::ptrdiff_t>(best);
    ranges[best] = pairs[best];
    alone[best] = merged[best];
    ranges.erase(ranges.begin() + at + 1);
    alone.erase(alone.begin() + at + 1);
  }
  return ranges;
}

}  // namespace fsr::compensation
