#include "study/study_score.h"

#include <algorithm>

#include "statistics/error_bins.h"
#include "statistics/streamed_metrics.h"

namespace fsr::study {

namespace {

std::string howScored(const StudyMethod& method, const Evaluation& evaluation) {
  if (method.models() == 1) return "one model, its readings pooled";
  const std::string models = std::to_string(method.models()) + " models";
  return evaluation.models == 1 ? "the readings of " + models + " pooled" : "mean of the scores of " + models;
}

void summarise(const StudyData& data, const Evaluation& evaluation, StudyScore& score) {
  statistics::ErrorBins bins;
  statistics::StreamedSummary first, later;
  const auto forEach = [&](const auto& visit) {
    for (std::size_t t = 0; t < data.taxels.size(); ++t) {
      evaluation.forEachError(
          t, [&](const TestPart&, const ScanPlace& scan, float error) { visit(scan, error); });
    }
  };
  forEach([&](const ScanPlace& scan, float error) {
    bins.add(error, data.pressure(scan), data.direction(scan));
    (data.inFirstCycle(scan) ? first : later).add(error);
  });
  forEach(
      [&](const ScanPlace& scan, float error) { (data.inFirstCycle(scan) ? first : later).addAgain(error); });
  score.errors = bins.summarise();
  score.first_cycle = first.summarise();
  score.later_cycles = later.summarise();
}

}  // namespace

StudyScore scoreOf(const StudyData& data, const StudyMethod& method, const Evaluation& evaluation) {
  StudyScore score;
  score.id = method.id;
  score.label = method.label;
  score.model = "grnn";
  score.scored = howScored(method, evaluation);
  score.scans = evaluation.errors.length();
  score.r2 = evaluation.r2;
  score.rmse_percent = evaluation.rmse_percent;
  score.r2_spread = statistics::spreadOf(evaluation.r2);
  score.rmse_percent_spread = statistics::spreadOf(evaluation.rmse_percent);
  const auto worst = std::max_element(score.rmse_percent.begin(), score.rmse_percent.end());
  score.worst_rmse_percent = *worst;
  score.worst_taxel = data.taxels[static_cast<std::size_t>(worst - score.rmse_percent.begin())];
  summarise(data, evaluation, score);
  return score;
}

}  // namespace fsr::study
