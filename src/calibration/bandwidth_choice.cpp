#include "calibration/bandwidth_choice.h"

#include <algorithm>
#include <memory>

#include "compensation/training_statistics.h"
#include "matrix/for_each_taxel.h"
#include "regression/bandwidth_search.h"
#include "settings/step_progress.h"

namespace fsr::calibration {

namespace {

std::vector<regression::CodeStatistics> sectionsOf(const std::vector<std::size_t>& classes,
                                                   const compensation::TrainingStatistics& statistics,
                                                   std::size_t taxel) {
  std::vector<regression::CodeStatistics> sections(statistics.sections);
  for (std::size_t section = 0; section < sections.size(); ++section) {
    for (const std::size_t k : classes) sections[section].merge(statistics.cell(taxel, k, section));
  }
  return sections;
}

// Errors of all models of one taxel.
regression::BandwidthErrors errorsOf(const regression::GrnnOptions& options,
                                     const compensation::SchemePlan& plan,
                                     const compensation::TrainingStatistics& statistics, std::size_t taxel) {
  regression::GrnnOptions alike = options;
  alike.weighting = regression::SampleWeighting::kEachSample;
  const auto errors = [&](std::size_t model) {
    return regression::BandwidthErrors(sectionsOf(plan.testedOn(model), statistics, taxel),
                                       statistics.full_scale, alike, regression::bandwidthGrid());
  };
  regression::BandwidthErrors all = errors(0);
  for (std::size_t model = 1; model < plan.models.size(); ++model) all.add(errors(model));
  return all;
}

}  // namespace

std::vector<std::size_t> taxelsOfSearch(const std::vector<std::uint8_t>& no_model) {
  std::vector<std::size_t> taxels;
  for (std::size_t taxel = 0; taxel < no_model.size(); ++taxel) {
    if (no_model[taxel] == 0) taxels.push_back(taxel);
  }
  const std::size_t number = std::min(taxels.size(), kTaxelsOfSearch);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < number; ++i) chosen.push_back(taxels[i * taxels.size() / number]);
  return chosen;
}

bool choosesBandwidth(const CalibrationOptions& options) {
  return options.choose_bandwidth && options.regressor.name == "grnn";
}

compensation::FoldRegressors chooseRegressor(const CalibrationOptions& options,
                                             const compensation::SchemePlan& plan,
                                             const compensation::TrainingStatistics& statistics,
                                             const std::vector<std::uint8_t>& no_model,
                                             const CalibrationProgress& progress) {
  compensation::FoldRegressors regressors{options.regressor, {}};
  regressors.whole.forest.seed = options.seed;
  if (!choosesBandwidth(options)) return regressors;
  const std::vector<std::size_t> taxels = taxelsOfSearch(no_model);
  std::vector<std::unique_ptr<regression::BandwidthErrors>> errors(taxels.size());
  settings::StepProgress search(progress, "choosing the bandwidth", taxels.size());
  matrix::forEachTaxel(taxels.size(), options.threads, [&](std::size_t i) {
    errors[i] = std::make_unique<regression::BandwidthErrors>(
        errorsOf(options.regressor.grnn, plan, statistics, taxels[i]));
    search.partDone();
  });
  for (std::size_t i = 1; i < errors.size(); ++i) errors.front()->add(*errors[i]);  // always in this order
  regressors.whole.grnn.bandwidth = errors.front()->best();
  regressors.without.assign(statistics.sections, regressors.whole);
  for (std::size_t section = 0; section < statistics.sections; ++section) {
    regressors.without[section].grnn.bandwidth = errors.front()->best(section);
  }
  return regressors;
}

}  // namespace fsr::calibration
