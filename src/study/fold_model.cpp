#include "study/fold_model.h"

#include <algorithm>

#include "compensation/effect_law.h"
#include "compensation/fit_scheme.h"
#include "compensation/learn_scheme.h"
#include "matrix/for_each_taxel.h"

namespace fsr::study {

namespace {

// Classes of which the fold has training readings, ascending. A scheme must not learn from other classes,
// since these are held out.
std::vector<std::size_t> trainedClasses(const Grouping& grouping, const Fold& fold) {
  std::vector<std::size_t> trained;
  for (const Cell& cell : fold.train) {
    if (!grouping.scans[cell.curvature_class][cell.group].empty()) trained.push_back(cell.curvature_class);
  }
  std::sort(trained.begin(), trained.end());
  trained.erase(std::unique(trained.begin(), trained.end()), trained.end());
  return trained;
}

std::vector<dataset::CurvatureClass> conditionsOf(const StudyData& data,
                                                  const std::vector<std::size_t>& classes) {
  std::vector<dataset::CurvatureClass> conditions;
  for (const std::size_t c : classes) conditions.push_back(data.classes[c]);
  return conditions;
}

// Statistics of the fold's training cells for some taxels, which are numbered from 0, in the form that
// schemes learn from.
compensation::TrainingStatistics statisticsOf(const StudyData& data, const Grouping& grouping,
                                              const Fold& fold, const std::vector<std::size_t>& classes,
                                              const std::vector<std::size_t>& taxels) {
  compensation::TrainingStatistics statistics;
  statistics.full_scale = data.full_scale;
  statistics.taxels = taxels.size();
  statistics.sections = grouping.groups;
  statistics.classes = conditionsOf(data, classes);
  statistics.cells.resize(taxels.size() * classes.size() * grouping.groups);
  for (std::size_t t = 0; t < taxels.size(); ++t) {
    const TaxelReadings readings(data, grouping, taxels[t]);
    for (const Cell& cell : fold.train) {
      const auto place = std::find(classes.begin(), classes.end(), cell.curvature_class);
      if (place == classes.end()) continue;
      const auto k = static_cast<std::size_t>(place - classes.begin());
      statistics.cells[(t * classes.size() + k) * grouping.groups + cell.group] = readings.cell(cell);
    }
  }
  return statistics;
}

// Applies learned ranges to a plan of all classes. A class without training readings becomes a range of its
// own.
void takeRanges(const compensation::SchemePlan& learned, const std::vector<std::size_t>& trained,
                compensation::SchemePlan& plan) {
  std::vector<std::vector<std::size_t>> ranges;
  for (const compensation::SchemePlan::Model& model : learned.models) {
    ranges.emplace_back();
    for (const std::size_t k : model.trained_on) ranges.back().push_back(trained[k]);
  }
  for (std::size_t c = 0; c < plan.classes.size(); ++c) {
    if (!std::binary_search(trained.begin(), trained.end(), c)) ranges.push_back({c});
  }
  std::sort(ranges.begin(), ranges.end());
  compensation::planRanges(ranges, plan);
}

regression::CodeTable tableOf(const std::vector<double>& pressure,
                              const regression::CodeHistogram& readings) {
  regression::CodeTable table;
  table.pressure.assign(pressure.begin(), pressure.end());
  const auto& count = readings.count();
  const auto occurs = [](std::int64_t number) { return number > 0; };
  const auto first = std::find_if(count.begin(), count.end(), occurs);
  const auto last = std::find_if(count.rbegin(), count.rend(), occurs);
  table.lowest = static_cast<std::uint16_t>(first - count.begin());
  table.highest = static_cast<std::uint16_t>(count.rend() - last - 1);
  return table;
}

compensation::EffectLaw lawOf(const StudyData& data, const Grouping& grouping, const Fold& fold,
                              const FoldModel& model, const std::vector<std::size_t>& trained,
                              unsigned threads) {
  std::vector<compensation::TaxelEffect> effects(data.taxels.size());
  matrix::forEachTaxel(data.taxels.size(), threads, [&](std::size_t t) {
    const TaxelReadings readings(data, grouping, data.taxels[t]);
    const regression::ClassReadings training = readings.training(fold.train, false);
    const std::vector<regression::Fit> fits =
        compensation::fitScheme(model.plan, data.taxels[t], training, model.regressor);
    std::vector<regression::CodeTable> tables;
    for (const std::size_t c : trained) {
      tables.push_back(tableOf(fits[model.plan.model_of_class[c]].pressure, training.sums[c]));
    }
    effects[t] = compensation::effectOf(tables.data(), tables.size());
  });
  return compensation::learnLaw(conditionsOf(data, trained), effects);
}

}  // namespace

regression::RegressorOptions grnnOf(const regression::GrnnOptions& options, double bandwidth) {
  regression::RegressorOptions regressor;
  regressor.grnn = options;
  regressor.grnn.bandwidth = bandwidth;
  return regressor;
}

FoldModel plainModel(const StudyMethod& method, const regression::RegressorOptions& regressor) {
  return {method.plan, regressor, {}};
}

FoldModel learnedModel(const StudyData& data, const StudyMethod& method, const Grouping& grouping,
                       const Fold& fold, double bandwidth, const StudyPlan& plan) {
  FoldModel model = plainModel(method, grnnOf(plan.grnn, bandwidth));
  const compensation::Scheme scheme = method.plan.scheme;
  const std::vector<std::size_t> trained = trainedClasses(grouping, fold);
  if (scheme == compensation::Scheme::kCurvatureMap) {
    model.law = lawOf(data, grouping, fold, model, trained, plan.threads);
  }
  if (scheme != compensation::Scheme::kScaledCurvature && scheme != compensation::Scheme::kCurvatureRanges)
    return model;
  const std::vector<std::size_t> taxels = taxelSample(data, plan);
  const compensation::TrainingStatistics statistics = statisticsOf(data, grouping, fold, trained, taxels);
  std::vector<std::size_t> all(taxels.size());
  for (std::size_t t = 0; t < all.size(); ++t) all[t] = t;
  compensation::SchemePlan learned = compensation::planScheme(scheme, statistics.classes);
  compensation::learnScheme(statistics, model.regressor.grnn, all, plan.threads, learned);
  model.plan.curvature_scale = learned.curvature_scale;
  if (scheme == compensation::Scheme::kCurvatureRanges) takeRanges(learned, trained, model.plan);
  return model;
}

std::vector<std::vector<double>> tablesFor(const FoldModel& model, std::size_t taxel,
                                           const regression::ClassReadings& training,
                                           const std::vector<std::size_t>& classes) {
  const std::vector<regression::Fit> fits =
      compensation::fitScheme(model.plan, taxel, training, model.regressor);
  std::vector<std::vector<double>> tables;
  for (const std::size_t c : classes) {
    tables.push_back(compensation::answerOn(model.plan, taxel, training, fits, c, model.law));
  }
  return tables;
}

std::vector<std::size_t> taxelSample(const StudyData& data, const StudyPlan& plan) {
  const std::size_t step = std::max<std::size_t>(1, data.taxels.size() / plan.bandwidth_taxels);
  std::vector<std::size_t> sample;
  for (std::size_t t = 0; t < data.taxels.size(); t += step) sample.push_back(data.taxels[t]);
  return sample;
}

}  // namespace fsr::study
