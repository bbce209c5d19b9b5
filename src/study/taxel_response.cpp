#include <algorithm>
#include <cmath>

#include "statistics/median.h"
#include "study/study_score.h"

namespace fsr::study {

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

TaxelResponse::Curve curveOf(const StudyData& data, std::size_t c, std::size_t taxel, std::uint32_t section) {
  TaxelResponse::Curve curve{data.classes[c].surface, data.classes[c].at(taxel), {}, {}, {}};
  for (const StudyScan& scan : data.scans[c]) {
    if (scan.section != section) continue;
    curve.time.push_back(scan.time);
    curve.pressure.push_back(regression::fromFixed(scan.pressure));
    curve.counts.push_back(scan.counts[taxel]);
  }
  return curve;
}

// Held-out predictions for one section of one class, in time order [Pa].
std::vector<double> predictions(const StudyData& data, const Evaluation& evaluation, std::size_t c,
                                std::uint32_t section, std::size_t place) {
  const StudyScan* const begin = data.scans[c].data();
  const StudyScan* const end = begin + data.scans[c].size();
  std::vector<double> predicted;
  for (std::size_t i = 0; i < evaluation.scans.size(); ++i) {
    const StudyScan* const scan = evaluation.scans[i];
    if (scan < begin || scan >= end || scan->section != section) continue;
    predicted.push_back(regression::fromFixed(scan->pressure) + evaluation.errors[place][i]);
  }
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
