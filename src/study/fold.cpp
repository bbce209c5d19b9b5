#include "study/fold.h"

#include <algorithm>
#include <set>

#include "compensation/effect_law.h"
#include "compensation/fit_scheme.h"
#include "compensation/learn_scheme.h"
#include "dataset/count_readers.h"
#include "matrix/for_each_taxel.h"

namespace fsr::study {

namespace {

// The cells that contain scans.
std::vector<Cell> occupied(const Grouping& grouping) {
  std::vector<Cell> cells;
  for (std::size_t c = 0; c < grouping.scans.size(); ++c) {
    for (std::size_t g = 0; g < grouping.groups; ++g) {
      if (!grouping.scans[c][g].empty()) cells.push_back({c, g});
    }
  }
  return cells;
}

template <typename HeldOut>
Fold foldOf(const std::string& name, const std::vector<Cell>& cells, HeldOut held_out) {
  Fold fold{name, {}, {}};
  for (const Cell& cell : cells) (held_out(cell) ? fold.test : fold.train).push_back(cell);
  return fold;
}

bool everyClassMountedTwice(const Grouping& mounts) {
  return std::all_of(mounts.scans.begin(), mounts.scans.end(), [](const auto& of_class) {
    return std::count_if(of_class.begin(), of_class.end(), [](const auto& list) { return !list.empty(); }) >
           1;
  });
}

}  // namespace

Split leaveSectionOut(const StudyData& data) {
  Split split{"five_sections",
              std::to_string(data.sections) +
                  " sections of each condition, contiguous in time and divided between cycles; each section "
                  "is predicted by the earlier and later ones",
              bySection(data),
              {}};
  const std::vector<Cell> cells = occupied(split.grouping);
  for (std::size_t k = 0; k < data.sections; ++k) {
    split.folds.push_back(
        foldOf("section " + std::to_string(k + 1), cells, [&](const Cell& cell) { return cell.group == k; }));
  }
  return split;
}

Split pastToFuture(const StudyData& data) {
  const std::size_t past = std::max<std::size_t>(1, data.sections * 3 / 5);
  Split split{"past_to_future",
              "the first " + std::to_string(past) + " of " + std::to_string(data.sections) +
                  " sections of each condition predict the later ones",
              bySection(data),
              {}};
  split.folds.push_back(foldOf("later sections", occupied(split.grouping),
                               [&](const Cell& cell) { return cell.group >= past; }));
  return split;
}

Split leaveProtocolOut(const StudyData& data) {
  Split split{kProtocolSplit,
              "each protocol (pace, dwell and peak of the cycles) is predicted by the other protocols",
              byHalfProtocol(data),
              {}};
  const std::vector<Cell> cells = occupied(split.grouping);
  for (std::size_t p = 0; p < data.protocols.names.size(); ++p) {
    Fold fold = foldOf(data.protocols.names[p], cells, [&](const Cell& cell) { return cell.group / 2 == p; });
    // A class that was recorded with this protocol only would be another curvature that is left out.
    const auto alone = [&](const Cell& cell) {
      return std::none_of(fold.train.begin(), fold.train.end(),
                          [&](const Cell& other) { return other.curvature_class == cell.curvature_class; });
    };
    fold.test.erase(std::remove_if(fold.test.begin(), fold.test.end(), alone), fold.test.end());
    if (!fold.test.empty()) split.folds.push_back(fold);
  }
  return split;
}

std::size_t protocolOf(const Fold& fold) {
  return fold.test.front().group / 2;
}

Split leaveCurvatureOut(const StudyData& data) {
  Split split{"leave_curvature_out",
              "each curvature is predicted by models trained on the other curvatures",
              bySection(data),
              {}};
  if (data.classes.size() < 3) return split;
  const std::vector<Cell> cells = occupied(split.grouping);
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    split.folds.push_back(
        foldOf(data.classes[c].surface, cells, [&](const Cell& cell) { return cell.curvature_class == c; }));
  }
  return split;
}

Split leaveMountOut(const StudyData& data) {
  Split split{
      "leave_mount_out", "each mount is predicted by the other mounts of the matrix", byMount(data), {}};
  if (!everyClassMountedTwice(split.grouping)) return split;
  const std::vector<Cell> cells = occupied(split.grouping);
  for (std::size_t mount = 0; mount < data.mounts; ++mount) {
    split.folds.push_back(foldOf("mount " + std::to_string(mount + 1), cells,
                                 [&](const Cell& cell) { return cell.group == mount; }));
  }
  return split;
}

TaxelReadings::TaxelReadings(const StudyData& data, const Grouping& grouping, std::size_t taxel)
    : data_(data), grouping_(grouping), taxel_(taxel) {
  regression::CodeAccumulator accumulator(data.full_scale);
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*data.recordings, taxel);
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    for (std::size_t g = 0; g < grouping.groups; ++g) {
      grouping.scans[c][g].forEach([&](const ScanPlace& scan) {
        accumulator.add(counts[scan.recording][scan.number], data.fixedPressure(scan));
      });
      cells_.push_back(accumulator.take());
    }
  }
}

regression::ClassReadings TaxelReadings::training(const std::vector<Cell>& cells, bool by_samples) const {
  regression::ClassReadings readings;
  readings.full_scale = data_.full_scale;
  if (!by_samples) {
    readings.sums.assign(data_.classes.size(), regression::CodeHistogram(data_.full_scale));
    for (const Cell& part : cells) readings.sums[part.curvature_class].add(cell(part));
    return readings;
  }
  readings.samples.resize(data_.classes.size());
  for (regression::CodeSamples& samples : readings.samples) samples.full_scale = data_.full_scale;
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*data_.recordings, taxel_);
  for (const Cell& part : cells) {
    regression::CodeSamples& samples = readings.samples[part.curvature_class];
    grouping_.scans[part.curvature_class][part.group].forEach([&](const ScanPlace& scan) {
      samples.add(counts[scan.recording][scan.number], data_.fixedPressure(scan));
    });
  }
  return readings;
}

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
