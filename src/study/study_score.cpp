#include "study/study_score.h"

#include <algorithm>

#include "statistics/error_bins.h"

namespace fsr::study {

namespace {

std::string howScored(const StudyMethod& method, const Evaluation& evaluation) {
  if (method.models() == 1) return "one model, its readings pooled";
  const std::string models = std::to_string(method.models()) + " models";
  return evaluation.models == 1 ? "the readings of " + models + " pooled" : "mean of the scores of " + models;
}

void summarise(const Evaluation& evaluation, StudyScore& score) {
  statistics::ErrorBins bins;
  std::vector<double> first, later;
  for (const std::vector<float>& errors : evaluation.errors) {
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const StudyScan& scan = *evaluation.scans[i];
      bins.add(errors[i], regression::fromFixed(scan.pressure), scan.direction);
      (scan.first_cycle ? first : later).push_back(errors[i]);
    }
  }
  score.errors = bins.summarise();
  score.first_cycle = statistics::summariseErrors(first);
  score.later_cycles = statistics::summariseErrors(later);
}

}  // namespace

StudyScore scoreOf(const StudyData& data, const StudyMethod& method, const Evaluation& evaluation) {
  StudyScore score;
  score.id = method.id;
  score.label = method.label;
  score.model = "grnn";
  score.scored = howScored(method, evaluation);
  score.scans = evaluation.scans.size();
  score.r2 = evaluation.r2;
  score.rmse_percent = evaluation.rmse_percent;
  score.r2_spread = statistics::spreadOf(evaluation.r2);
  score.rmse_percent_spread = statistics::spreadOf(evaluation.rmse_percent);
  const auto worst = std::max_element(score.rmse_percent.begin(), score.rmse_percent.end());
  score.worst_rmse_percent = *worst;
  score.worst_taxel = data.taxels[static_cast<std::size_t>(worst - score.rmse_percent.begin())];
  summarise(evaluation, score);
  return score;
}

}  // namespace fsr::study
