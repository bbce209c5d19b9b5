#include "compensation/unseen_curvature.h"

#include <algorithm>
#include <cmath>

namespace fsr::compensation {

namespace {

// The tables of one taxel in the form that blendTable() needs.
struct Entries {
  std::vector<std::vector<TableEntry>> of_class;
  TaxelTables tables;

  Entries(const CurvatureTables& source, std::size_t taxel) {
    tables.codes = source.full_scale + 1u;
    for (std::size_t k = 0; k < source.classes.size(); ++k) {
      const regression::CodeTable& table = source.table(taxel, k);
      std::vector<TableEntry>& entries = of_class.emplace_back(tables.codes);
      for (std::size_t code = 0; code < tables.codes; ++code) {
        entries[code] = {table.pressure[code], table.deviation[code]};
      }
      tables.curvature.push_back(source.classes[k].at(taxel));
      tables.log_weight.push_back(table.log_weight.data());
    }
    for (const std::vector<TableEntry>& entries : of_class) tables.table.push_back(entries.data());
  }
};

bool isInner(const std::vector<double>& curvature, std::size_t k) {
  const auto [low, high] = std::minmax_element(curvature.begin(), curvature.end());
  return curvature[k] > *low && curvature[k] < *high;
}

// Sum of the squared distances of a code's readings from their mean [Pa^2].
double spreadOf(const regression::CodeSums& sums) {
  if (sums.count == 1) return 0.0;
  const regression::Int128 spread =
      sums.sum_of_squares * sums.count - regression::Int128{sums.sum} * sums.sum;
  return static_cast<double>(spread) / sums.count * regression::kFixedPressureUnit *
         regression::kFixedPressureUnit;
}

}  // namespace

void addErrors(const regression::CodeStatistics& readings, const std::vector<TableEntry>& answer,
               const std::vector<TableEntry>& own, UnseenErrors& errors) {
  readings.forEach([&](const regression::CodeSums& sums) {
    const double count = sums.count, mean = sums.count == 1 ? regression::fromFixed(sums.sum)
                                                            : regression::fromFixed(sums.sum) / count;
    const double error = answer[sums.code].pressure - mean, deviation = own[sums.code].deviation;
    UnseenErrors::Bin& bin = errors.bins[statistics::pressureBin(answer[sums.code].pressure)];
    bin.readings += count;
    bin.squares += count * error * error + spreadOf(sums);
    bin.stated += count * deviation * deviation;
    bin.pressure += count * answer[sums.code].pressure;
    errors.lowest = std::min(errors.lowest, mean);
    errors.highest = std::max(errors.highest, mean);
  });
}

double UnseenErrors::readings() const {
  double sum = 0;
  for (const Bin& bin : bins) sum += bin.readings;
  return sum;
}

double UnseenErrors::rmse() const {
  double squares = 0;
  for (const Bin& bin : bins) squares += bin.squares;
  return std::sqrt(squares / readings());
}

UnseenErrors leaveClassesOut(const CurvatureTables& tables, std::size_t taxel,
                             const TrainingStatistics& statistics,
                             const std::vector<EffectLaw>& law_without) {
  UnseenErrors errors;
  Entries entries(tables, taxel);
  const std::vector<double> curvature = entries.tables.curvature;
  const double scale = tables.rule.blend == BlendRule::kKernel ? tables.rule.lengthScale(taxel) : 0;
  std::vector<TableEntry> answer(entries.tables.codes);
  for (std::size_t k = 0; k < curvature.size(); ++k) {
    if (!isInner(curvature, k)) continue;
    entries.tables.curvature[k] = std::nan("");
    CurvatureRule rule;
    rule.blend = tables.rule.blend;
    if (!law_without.empty()) rule.law = law_without[k];
    const CurvaturePlace place = placeOf(curvature[k], entries.tables.curvature);
    blendTable(rule, scale, entries.tables, curvature[k], place.share > 0.5 ? place.above : place.below,
               answer.data());
    entries.tables.curvature[k] = curvature[k];
    for (std::size_t section = 0; section < statistics.sections; ++section) {
      addErrors(statistics.cell(taxel, k, section), answer, entries.of_class[k], errors);
    }
  }
  return errors;
}

UnseenSummary summaryOf(const std::vector<UnseenErrors>& taxels) {
  UnseenSummary summary;
  std::vector<double> percent;
  double squares = 0, readings = 0;
  for (const UnseenErrors& taxel : taxels) {
    if (taxel.readings() == 0) continue;
    readings += taxel.readings();
    squares += taxel.rmse() * taxel.rmse() * taxel.readings();
    percent.push_back(100 * taxel.rmse() / (taxel.highest - taxel.lowest));
  }
  if (readings == 0) return summary;
  summary.readings = static_cast<std::uint64_t>(readings);
  summary.rmse = std::sqrt(squares / readings);
  summary.rmse_percent = statistics::spreadOf(percent);
  return summary;
}

UnseenDeviation unseenDeviation(const std::vector<UnseenErrors>& taxels) {
  UnseenDeviation unseen;
  for (std::size_t b = 0; b < statistics::kPressureBins; ++b) {
    UnseenErrors::Bin sum;
    for (const UnseenErrors& taxel : taxels) {
      sum.readings += taxel.bins[b].readings;
      sum.squares += taxel.bins[b].squares;
      sum.stated += taxel.bins[b].stated;
      sum.pressure += taxel.bins[b].pressure;
    }
    if (sum.readings == 0) continue;
    unseen.pressure.push_back(sum.pressure / sum.readings);
    unseen.deviation.push_back(std::sqrt(std::max(0.0, (sum.squares - sum.stated) / sum.readings)));
  }
  return unseen;
}

}  // namespace fsr::compensation
