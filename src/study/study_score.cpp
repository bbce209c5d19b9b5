#include "study/study_score.h"

#include <algorithm>
#include <cmath>

#include "dataset/count_readers.h"
#include "statistics/error_bins.h"
#include "statistics/samples.h"

namespace fsr::study {

namespace {

std::string howScored(const StudyMethod& method, const Evaluation& evaluation) {
  if (method.models() == 1) return "one model, its readings pooled";
  const std::string models = std::to_string(method.models()) + " models";
  return evaluation.models == 1 ? "the readings of " + models + " pooled" : "mean of the scores of " + models;
}

void summarise(const StudyData& data, const Evaluation& evaluation, StudyScore& score) {
  statistics::ErrorBins bins;
  statistics::ErrorTally first, later;
  for (std::size_t t = 0; t < data.taxels.size(); ++t) {
    evaluation.forEachError(t, [&](const TestPart&, const ScanPlace& scan, float error) {
      bins.add(error, data.pressure(scan), data.direction(scan));
      (data.inFirstCycle(scan) ? first : later).add(error);
    });
  }
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
  score.scans = evaluation.errors.front().size();
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

namespace {

// The bent class of smallest curvature, as in the paper's figures; the flat class if there is no bent one.
std::size_t gentlestBend(const StudyData& data) {
  std::size_t chosen = 0;
  double gentlest = INFINITY;
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    const double bend = std::abs(data.classes[c].at(0));
    if (dataset::isFlat(data.classes[c]) || bend >= gentlest) continue;
    gentlest = bend;
    chosen = c;
  }
  return chosen;
}

// A figure does not show more scans of a section. A longer section is shown by one scan of several.
constexpr std::size_t kMostScans = 20000;

// Which scans of a section of a class the figure shows: one of some.
class ShownScans {
 public:
  ShownScans(const StudyData& data, std::size_t c, std::uint32_t section) : data_(data), section_(section) {
    std::size_t scans = 0;
    data.scans[c].forEach([&](const ScanPlace& scan) { scans += data.section(scan) == section; });
    one_of_ = std::max<std::size_t>(1, (scans + kMostScans - 1) / kMostScans);
  }
  // Whether the next scan of the class is shown.
  bool operator()(const ScanPlace& scan) {
    return data_.section(scan) == section_ && number_++ % one_of_ == 0;
  }

 private:
  const StudyData& data_;
  std::uint32_t section_;
  std::size_t one_of_ = 1, number_ = 0;
};

TaxelResponse::Curve curveOf(const StudyData& data, std::size_t c, std::size_t taxel, std::uint32_t section) {
  TaxelResponse::Curve curve{data.classes[c].surface, data.classes[c].at(taxel), {}, {}, {}};
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*data.recordings, taxel);
  ShownScans shown(data, c, section);
  data.scans[c].forEach([&](const ScanPlace& scan) {
    if (!shown(scan)) return;
    curve.time.push_back(data.time(scan));
    curve.pressure.push_back(data.pressure(scan));
    curve.counts.push_back(counts[scan.recording][scan.number]);
  });
  return curve;
}

// Held-out predictions for the scans of curveOf() [Pa].
std::vector<double> predictions(const StudyData& data, const Evaluation& evaluation, std::size_t c,
                                std::uint32_t section, std::size_t place) {
  std::vector<double> predicted;
  ShownScans shown(data, c, section);
  evaluation.forEachError(place, [&](const TestPart&, const ScanPlace& scan, float error) {
    if (data.classOf(scan) == c && shown(scan)) predicted.push_back(data.pressure(scan) + error);
  });
  return predicted;
}

}  // namespace

TaxelResponse taxelResponse(const StudyData& data, std::size_t place, const Evaluation& baseline,
                            const Evaluation& per_curvature) {
  const auto section = static_cast<std::uint32_t>(data.sections / 2);
  TaxelResponse response;
  response.taxel = data.taxels[place];
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    response.curves.push_back(curveOf(data, c, response.taxel, section));
  }
  const std::size_t bend = gentlestBend(data);
  const TaxelResponse::Curve& curve = response.curves[bend];
  response.prediction = {curve.surface,
                         curve.curvature,
                         curve.time,
                         curve.pressure,
                         predictions(data, baseline, bend, section, place),
                         predictions(data, per_curvature, bend, section, place)};
  return response;
}

std::size_t figureTaxel(const StudyData& data, const StudyPlan& plan,
                        const std::vector<double>& rmse_percent) {
  const auto asked = std::find(data.taxels.begin(), data.taxels.end(), plan.figure_taxel);
  if (asked != data.taxels.end()) return static_cast<std::size_t>(asked - data.taxels.begin());
  const double middle = statistics::upperMedian(rmse_percent);
  return static_cast<std::size_t>(std::find(rmse_percent.begin(), rmse_percent.end(), middle) -
                                  rmse_percent.begin());
}

}  // namespace fsr::study
