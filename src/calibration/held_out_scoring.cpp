#include "calibration/held_out_scoring.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fsr::calibration {

namespace {

// Predictions and truth of one section [Pa].
struct Predictions {
  std::vector<double> predicted;
  std::vector<double> reference;

  void add(double prediction, double truth) {
    predicted.push_back(prediction);
    reference.push_back(truth);
  }
};

double meanOverSections(const std::vector<Predictions>& sections,
                        double (*score)(const std::vector<double>&, const std::vector<double>&)) {
  std::vector<double> scores;
  for (const Predictions& section : sections) scores.push_back(score(section.predicted, section.reference));
  return statistics::spreadOf(scores).mean;
}

}  // namespace

HeldOutScoring::HeldOutScoring(const TrainingScans& scans, const compensation::SchemePlan& plan,
                               std::size_t sections, std::size_t taxels)
    : scans_(scans), plan_(plan), sections_(sections), taxels_(taxels) {}

void HeldOutScoring::scoreTaxel(std::size_t taxel,
                                const std::vector<regression::CrossValidatedModel>& models) {
  TaxelScores scored;
  std::vector<Predictions> all(sections_);
  std::size_t all_within = 0;
  for (std::size_t c = 0; c < scans_.size(); ++c) {
    const regression::CrossValidatedModel& model = models[plan_.model_of_class[c]];
    std::vector<Predictions> of_class(sections_);
    std::vector<float> errors(scans_[c].size(), std::numeric_limits<float>::quiet_NaN());
    std::size_t within = 0;
    for (std::size_t i = 0; i < scans_[c].size(); ++i) {
      const TrainingScan& scan = scans_[c][i];
      const regression::HeldOutModel& held_out = model.held_out[scan.section];
      if (held_out.pressure.empty()) continue;
      const std::uint16_t code = scan.counts[taxel];
      const double truth = regression::fromFixed(scan.pressure);
      const double answer = held_out.pressure[code] - regression::fromFixed(scan.zeroOf(taxel));
      const double error = answer - truth;
      of_class[scan.section].add(answer, truth);
      all[scan.section].add(answer, truth);
      within += std::abs(error) <= held_out.deviation[code];
      errors[i] = static_cast<float>(error);
    }
    all_within += within;
    scored.scores.push_back({meanOverSections(of_class, statistics::rSquared),
                             meanOverSections(of_class, statistics::rmsePercent), within});
    scored.errors.push_back(std::move(errors));
  }
  scored.scores.push_back({meanOverSections(all, statistics::rSquared),
                           meanOverSections(all, statistics::rmsePercent), all_within});
  taxels_[taxel] = std::move(scored);
}

// Pools entry `entry` of the scores of all taxels and the errors of `classes`.
Score HeldOutScoring::pool(const std::vector<std::size_t>& classes, std::size_t entry) const {
  Score score;
  std::vector<double> r2, rmse_percent;
  std::size_t within = 0;
  statistics::ErrorBins bins;
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) {
    if (taxels_[taxel].scores.empty()) continue;
    const TaxelScore& own = taxels_[taxel].scores[entry];
    r2.push_back(own.r2);
    rmse_percent.push_back(own.rmse_percent);
    within += own.within;
    if (!(own.rmse_percent <= score.worst_rmse_percent)) {  // also true for the initial NaN
      score.worst_rmse_percent = own.rmse_percent;
      score.worst_taxel = taxel;
    }
    for (const std::size_t c : classes) {
      for (std::size_t i = 0; i < scans_[c].size(); ++i) {
        const float error = taxels_[taxel].errors[c][i];
        if (!std::isnan(error))
          bins.add(error, regression::fromFixed(scans_[c][i].pressure), scans_[c][i].direction);
      }
    }
  }
  score.readings = bins.count();
  score.r2 = statistics::spreadOf(r2);
  score.rmse_percent = statistics::spreadOf(rmse_percent);
  score.errors = bins.summarise();
  score.within_one_deviation = static_cast<double>(within) / static_cast<double>(score.readings);
  return score;
}

CalibrationScores HeldOutScoring::summarise(const std::vector<dataset::CurvatureClass>& classes) const {
  CalibrationScores scores;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const auto& trained_on = plan_.models[plan_.model_of_class[c]].trained_on;
    const bool trained = std::find(trained_on.begin(), trained_on.end(), c) != trained_on.end();
    scores.conditions.push_back({classes[c], trained, pool({c}, c)});
  }
  std::vector<std::size_t> all(classes.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  scores.whole = pool(all, classes.size());
  return scores;
}

}  // namespace fsr::calibration
