#include "calibration/stages/deviation/held_out_scoring.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fsr::calibration {

namespace {

// The answers to one section of the readings, with the measures of rSquared() and rmsePercent().
class SectionScore {
 public:
  // Both in Pa.
  void add(double answer, double truth) {
    truth_.add(truth);
    squares_ += (answer - truth) * (answer - truth);
    low_ = std::min(low_, truth);
    high_ = std::max(high_, truth);
  }
  void merge(const SectionScore& other) {
    truth_.merge(other.truth_);
    squares_ += other.squares_;
    low_ = std::min(low_, other.low_);
    high_ = std::max(high_, other.high_);
  }
  double rSquared() const {
    return truth_.count > 1 && truth_.squares > 0 ? 1.0 - squares_ / truth_.squares : kNone;
  }
  double rmsePercent() const {
    return high_ > low_ ? 100.0 * std::sqrt(squares_ / truth_.count) / (high_ - low_) : kNone;
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  statistics::RunningMoments truth_;
  double squares_ = 0;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
};

double meanOverSections(const std::vector<SectionScore>& sections, double (SectionScore::*score)() const) {
  std::vector<double> scores;
  for (const SectionScore& section : sections) scores.push_back((section.*score)());
  return statistics::spreadOf(scores).mean;
}

}  // namespace

HeldOutScoring::HeldOutScoring(const TrainingScans& scans, const std::vector<dataset::Sections>& divided,
                               const compensation::SchemePlan& plan, const BudgetInput& budget,
                               std::size_t sections, std::size_t taxels)
    : scans_(scans),
      divided_(divided),
      plan_(plan),
      budget_(budget),
      sections_(sections),
      intervals_(IntervalUnit::kCycles, budget.of_cycles ? budget.cycles.units : 0, taxels,
                 budget.scale.highest),
      taxels_(taxels),
      errors_(scans.of_class.size()) {}

void HeldOutScoring::scoreTaxel(std::size_t taxel,
                                const std::vector<regression::CrossValidatedModel>& models) {
  TaxelScores scored;
  const std::vector<std::vector<TrainingRun>>& scans = scans_.of_class;
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*scans_.recordings, taxel);
  scored.errors.resize(scans.size());
  std::vector<SectionScore> all(sections_);
  const auto add = [&](const std::vector<SectionScore>& sections, std::size_t within) {
    scored.scores.push_back({meanOverSections(sections, &SectionScore::rSquared),
                             meanOverSections(sections, &SectionScore::rmsePercent), within});
  };
  std::size_t all_within = 0;
  IntervalTally::Taxel ratios(intervals_);
  for (std::size_t c = 0; c < scans.size(); ++c) {
    const regression::CrossValidatedModel& model = models[plan_.model_of_class[c]];
    std::vector<SectionScore> of_class(sections_);
    std::size_t within = 0;
    const bool trained = plan_.trainsOn(c);
    BudgetTally budget(budget_.scale, budget_.cycles.of_class[c], model.table);
    for (const TrainingRun& run : scans[c]) {
      const regression::HeldOutModel& held_out = model.held_out[run.section];
      if (held_out.pressure.empty()) continue;
      const double zero = regression::fromFixed(run.zeroOf(taxel));
      scans_.forEachScan(run, counts, divided_, [&](const TrainingScan& scan) {
        const double truth = regression::fromFixed(scan.pressure);
        const double answer = held_out.pressure[scan.code] - zero;
        const double error = answer - truth;
        of_class[run.section].add(answer, truth);
        within += std::abs(error) <= held_out.deviation[scan.code];
        scored.errors[c].add(static_cast<float>(error), truth, scan.direction);
        if (!trained) return;
        budget.add(scan, error);
        if (intervals_.units() == 0) return;
        ratios.add(budget_.cycles.of_class[c][scan.cycle].unit, answer, scan.direction,
                   std::abs(error) / double(held_out.deviation[scan.code]));
      });
    }
    if (trained) addSums(budget.sums(), scored.budget);
    for (std::size_t s = 0; s < sections_; ++s) all[s].merge(of_class[s]);
    all_within += within;
    add(of_class, within);
  }
  add(all, all_within);
  intervals_.add(taxel, ratios);
  addErrors(taxel, std::move(scored));
}

void HeldOutScoring::leaveOut(std::size_t taxel) {
  addErrors(taxel, {});
}

// The errors are added in the order of the taxels, so that the sums do not depend on the number of threads.
void HeldOutScoring::addErrors(std::size_t taxel, TaxelScores scored) {
  const std::lock_guard<std::mutex> lock(adding_);
  taxels_[taxel] = std::move(scored);
  for (; next_ < taxels_.size() && taxels_[next_]; ++next_) {
    std::vector<statistics::ErrorBins> own = std::move(taxels_[next_]->errors);
    for (std::size_t c = 0; c < own.size(); ++c) errors_[c].merge(own[c]);
    addSums(taxels_[next_]->budget, budget_sums_);
  }
}

// Pools entry `entry` of the scores of all taxels, with their errors.
Score HeldOutScoring::pool(const statistics::ErrorBins& errors, std::size_t entry) const {
  Score score;
  std::vector<double> r2, rmse_percent;
  std::size_t within = 0;
  for (std::size_t taxel = 0; taxel < taxels_.size(); ++taxel) {
    if (!taxels_[taxel] || taxels_[taxel]->scores.empty()) continue;
    const TaxelScore& own = taxels_[taxel]->scores[entry];
    r2.push_back(own.r2);
    rmse_percent.push_back(own.rmse_percent);
    within += own.within;
    if (!(own.rmse_percent <= score.worst_rmse_percent)) {  // also true for the initial NaN
      score.worst_rmse_percent = own.rmse_percent;
      score.worst_taxel = taxel;
    }
  }
  score.readings = errors.count();
  score.r2 = statistics::spreadOf(r2);
  score.rmse_percent = statistics::spreadOf(rmse_percent);
  score.errors = errors.summarise();
  score.within_one_deviation = static_cast<double>(within) / static_cast<double>(score.readings);
  return score;
}

CalibrationScores HeldOutScoring::summarise(const std::vector<dataset::CurvatureClass>& classes) const {
  CalibrationScores scores;
  statistics::ErrorBins whole;
  for (std::size_t c = 0; c < classes.size(); ++c) {
    scores.conditions.push_back({classes[c], plan_.trainsOn(c), pool(errors_[c], c)});
    whole.merge(errors_[c]);
  }
  scores.whole = pool(whole, classes.size());
  return scores;
}

}  // namespace fsr::calibration
