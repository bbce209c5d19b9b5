#include "calibration/stages/temperature/temperature_training.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "calibration/stages/deviation/held_out_scoring.h"
#include "calibration/stages/memory/history_fit.h"
#include "calibration/stages/memory/history_state.h"
#include "dataset/count_readers.h"
#include "dataset/protocols.h"
#include "matrix/for_each_taxel.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

using Index = Eigen::Index;

constexpr Index kKnots = 17;     // of f
constexpr double kRidge = 1e-6;  // of s, relative to the squares of its feature
constexpr double kPeriod = 0.1;  // scans that follow each other faster are left out [s]

// A scan that counts.
struct Row {
  std::size_t recording = 0, scan = 0, curvature_class = 0, group = 0;
  std::size_t below = 0;           // knot below the pressure
  double share = 0, pressure = 0;  // share of the knot above; [Pa]
  const double* memory = nullptr;  // for each operator: operator - P [Pa]
  const double* above = nullptr;   // for each lag: T_lag above T_0, and above its mean over the cycle [K]
};

// What one lag needs of one taxel, or of all.
struct LagSums {
  Eigen::Matrix2d square = Eigen::Matrix2d::Zero();  // of the two features beside f
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  Eigen::Vector2d raw = Eigen::Vector2d::Zero();    // squares of the features
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  // of the group left out: a + b s + c s^2 [Pa^2]
  double readings = 0;                              // of the group left out

  LagSums& operator+=(const LagSums& other) {
    square += other.square, right += other.right, raw += other.raw, error += other.error;
    readings += other.readings;
    return *this;
  }
  double sensitivity() const {
    Eigen::Matrix2d whole = square;
    whole.diagonal() += kRidge * raw;
    whole.diagonal().array() += 1e-300;
    return whole.ldlt().solve(right)[0];
  }
};

using FoldSums = std::vector<std::vector<LagSums>>;  // [groups + 1][lags], the last of all groups

class TemperatureFit {
 public:
  TemperatureFit(const TemperatureProblem& problem, const TemperatureGrid& grid,
                 const dataset::Protocols& groups)
      : problem_(problem),
        lags_(grid.lags.size()),
        groups_(groups.names.size()),
        highest_(groups.highest),
        operators_(operatorsOf(historyGrid(groups.lowest, groups.highest, groups.longest_hold))),
        base_(kKnots + 1 + Index(operators_.size())) {
    for (std::size_t r = 0; r < problem.recordings.size(); ++r) {
      chooseScans(r);
      readTemperatures(r, grid);
      driveOperators(r);
    }
    for (std::size_t r = 0; r < problem.recordings.size(); ++r) collectRows(r, groups.of_scan[r]);
  }

  FoldSums empty() const { return FoldSums(groups_ + 1, std::vector<LagSums>(lags_)); }
  FoldSums ofTaxel(std::size_t taxel) const;

 private:
  void chooseScans(std::size_t r);
  void readTemperatures(std::size_t r, const TemperatureGrid& grid);
  void driveOperators(std::size_t r);
  void collectRows(std::size_t r, const std::vector<std::uint32_t>& group);
  Eigen::VectorXd curveOf(std::size_t taxel, std::size_t curvature_class) const;
  std::vector<HistorySums> sumsOf(std::size_t taxel, std::size_t curvature_class,
                                  const Eigen::VectorXd& curve) const;
  bool reading(std::vector<dataset::TaxelCounts>& counts, const Row& row, double& code) const;
  void addFold(const Eigen::MatrixXd& gram, const HistorySums* left_out, std::vector<LagSums>& sums) const;

  Index features() const { return base_ + 2 * Index(lags_); }

  const TemperatureProblem& problem_;
  std::size_t lags_, groups_;
  double highest_;  // [Pa]
  HistoryOperators operators_;
  Index base_;  // features beside those of the lags: f, the effect of a constant temperature, the operators
  std::vector<std::vector<std::size_t>> chosen_;  // [recordings], the scans that become rows
  std::vector<std::vector<double>> memory_;       // [recordings][chosen scans x operators]
  std::vector<std::vector<double>> above_;        // [recordings][chosen scans x lags x 2]
  std::vector<Row> rows_;
};

void TemperatureFit::chooseScans(std::size_t r) {
  const dataset::Recording& recording = problem_.recordings[r];
  double next = -INFINITY;
  chosen_.emplace_back();
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (problem_.sections[r].section[i] == dataset::kNoSection || recording.time[i] < next) continue;
    next = recording.time[i] + 0.99 * kPeriod;
    chosen_.back().push_back(i);
  }
}

void TemperatureFit::readTemperatures(std::size_t r, const TemperatureGrid& grid) {
  const dataset::Recording& recording = problem_.recordings[r];
  const std::vector<std::size_t>& chosen = chosen_[r];
  std::vector<double> above(chosen.size() * lags_ * 2);
  for (std::size_t l = 0; l < lags_; ++l) {
    const std::vector<double> sheet = sheetTemperature(recording, grid.lags[l]);
    const std::vector<double> means = cycleMeans(sheet, recording, problem_.sections[r]);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const std::size_t i = chosen[k];
      above[(k * lags_ + l) * 2] = sheet[i] - grid.reference;
      above[(k * lags_ + l) * 2 + 1] = sheet[i] - means[i];
    }
  }
  above_.push_back(std::move(above));
}

// Loop and creep differ from cycle to cycle, as the temperature does. They are driven by the pressure.
void TemperatureFit::driveOperators(std::size_t r) {
  const dataset::Recording& recording = problem_.recordings[r];
  const std::size_t n = operators_.size();
  std::vector<double> memory, state(n), open(n);
  memory.reserve(chosen_[r].size() * n);
  auto chosen = chosen_[r].begin();
  std::vector<rheology::ExponentialMemory::Step> steps(operators_.memories());
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    const double pressure = recording.pressure[i];
    const double duration = i == 0 ? 0 : recording.time[i] - recording.time[i - 1];
    const bool starts = i == 0 || recording.condition[i] != recording.condition[i - 1] || duration < 0 ||
                        duration > kLongestGap;
    if (starts) {
      operators_.start(pressure, state.data(), open.data());
    } else {
      operators_.stepsOver(duration, steps.data());
      operators_.advance(recording.pressure[i - 1], pressure, steps.data(), state.data());
    }
    if (chosen == chosen_[r].end() || *chosen != i) continue;
    ++chosen;
    for (std::size_t k = 0; k < n; ++k) memory.push_back(state[k] - pressure);
  }
  memory_.push_back(std::move(memory));
}

void TemperatureFit::collectRows(std::size_t r, const std::vector<std::uint32_t>& group) {
  const dataset::Recording& recording = problem_.recordings[r];
  for (std::size_t k = 0; k < chosen_[r].size(); ++k) {
    const std::size_t i = chosen_[r][k];
    Row row;
    row.recording = r, row.scan = i;
    row.curvature_class = problem_.classes.class_of[r][recording.condition[i]];
    row.group = group[i] == dataset::Protocols::kOther ? groups_ : group[i];
    row.pressure = recording.pressure[i];
    const auto place = EvenLine::place(row.pressure, 0, double(kKnots - 1) / highest_, std::size_t(kKnots));
    row.below = place.below, row.share = place.share;
    row.memory = &memory_[r][k * operators_.size()];
    row.above = &above_[r][k * lags_ * 2];
    rows_.push_back(row);
  }
}

// Limits are no readings.
bool TemperatureFit::reading(std::vector<dataset::TaxelCounts>& counts, const Row& row, double& code) const {
  const std::uint16_t own = counts[row.recording][row.scan];
  code = own;
  return own > 0 && own < problem_.recordings[row.recording].full_scale;
}

// f at its knots [counts]; empty where there are no readings.
Eigen::VectorXd TemperatureFit::curveOf(std::size_t taxel, std::size_t curvature_class) const {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(kKnots, kKnots);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kKnots);
  double code = 0, scans = 0;
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(problem_.recordings, taxel);
  for (const Row& row : rows_) {
    if (row.curvature_class != curvature_class || !reading(counts, row, code)) continue;
    const Index k = Index(row.below);
    const double lower = 1 - row.share, upper = row.share;
    gram(k, k) += lower * lower, gram(k, k + 1) += lower * upper, gram(k + 1, k + 1) += upper * upper;
    right[k] += lower * code, right[k + 1] += upper * code;
    scans += 1;
  }
  if (scans == 0) return {};
  gram.triangularView<Eigen::Lower>() = gram.transpose();
  // Knots without readings lie on the line of their neighbours.
  for (Index k = 1; k + 1 < kKnots; ++k) {
    Eigen::VectorXd bend = Eigen::VectorXd::Zero(kKnots);
    bend[k - 1] = bend[k + 1] = 1, bend[k] = -2;
    gram += 1e-6 * scans * bend * bend.transpose();
  }
  return gram.ldlt().solve(right);
}

// For each group: f, the effect of a constant temperature, the operators, and two features for each lag.
std::vector<HistorySums> TemperatureFit::sumsOf(std::size_t taxel, std::size_t curvature_class,
                                                const Eigen::VectorXd& curve) const {
  std::vector<HistorySums> sums(groups_ + 1, HistorySums(std::size_t(features())));
  const double per_count = highest_ / (curve[kKnots - 1] - curve[0]);  // [Pa]
  Eigen::VectorXd row_features(features());
  double code = 0;
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(problem_.recordings, taxel);
  for (const Row& row : rows_) {
    if (row.curvature_class != curvature_class || !reading(counts, row, code)) continue;
    const Index k = Index(row.below);
    row_features.setZero();
    row_features[k] = 1 - row.share;
    row_features[k + 1] = row.share;
    const double slope = (curve[k + 1] - curve[k]) * double(kKnots - 1) / highest_;
    const double effect = -per_count * slope * row.pressure;
    row_features[kKnots] = effect / highest_;
    for (std::size_t o = 0; o < operators_.size(); ++o)
      row_features[kKnots + 1 + Index(o)] = per_count * slope * row.memory[o] / highest_;
    for (std::size_t c = 0; c < 2 * lags_; ++c) row_features[base_ + Index(c)] = row.above[c] * effect;
    sums[row.group].add(row_features.data(), per_count * code);
  }
  for (HistorySums& own : sums) own.finish();
  return sums;
}

void TemperatureFit::addFold(const Eigen::MatrixXd& gram, const HistorySums* left_out,
                             std::vector<LagSums>& sums) const {
  const Index n = features();
  Eigen::MatrixXd base = gram.topLeftCorner(base_, base_);
  base.diagonal() *= 1 + 1e-9;
  base.diagonal().array() += 1e-9 * base.diagonal().mean() + 1e-300;
  // Columns of the lags, then the target, each as f explains it.
  const Eigen::MatrixXd explained = base.ldlt().solve(gram.block(0, base_, base_, n + 1 - base_));
  const Eigen::MatrixXd rest = gram.bottomRightCorner(n + 1 - base_, n + 1 - base_) -
                               gram.block(base_, 0, n + 1 - base_, base_) * explained;
  const Index target = n - base_;
  for (std::size_t l = 0; l < lags_; ++l) {
    const Index own = 2 * Index(l);
    LagSums lag;
    lag.square = rest.block(own, own, 2, 2);
    lag.right = rest.block(own, target, 2, 1);
    lag.raw << gram(base_ + own, base_ + own), gram(base_ + own + 1, base_ + own + 1);
    if (left_out != nullptr) {
      // Error = target - f - s feature; f depends on s.
      Eigen::VectorXd constant = Eigen::VectorXd::Zero(n + 1), of_s = constant;
      constant[n] = 1, constant.head(base_) = -explained.col(target);
      of_s[base_ + own] = -1, of_s.head(base_) = explained.col(own);
      const Eigen::VectorXd seen = left_out->gram() * of_s;
      lag.readings = left_out->samples();
      lag.error << constant.dot(left_out->gram() * constant), 2 * constant.dot(seen), of_s.dot(seen);
    }
    sums[l] += lag;
  }
}

FoldSums TemperatureFit::ofTaxel(std::size_t taxel) const {
  FoldSums all = empty();
  for (std::size_t k = 0; k < problem_.classes.classes.size(); ++k) {
    const Eigen::VectorXd curve = curveOf(taxel, k);
    if (curve.size() == 0 || !(curve[kKnots - 1] - curve[0] > 1)) continue;
    const std::vector<HistorySums> sums = sumsOf(taxel, k, curve);
    Eigen::MatrixXd whole = sums.front().gram();
    for (std::size_t g = 1; g <= groups_; ++g) whole += sums[g].gram();
    for (std::size_t g = 0; g < groups_; ++g) {
      // A class that was recorded with this group only has no f without it.
      const bool known = whole(kKnots, kKnots) - sums[g].gram()(kKnots, kKnots) > 0;
      if (known) addFold(whole - sums[g].gram(), &sums[g], all[g]);
    }
    addFold(whole, nullptr, all[groups_]);
  }
  return all;
}

// The sensitivity that the readings show with one lag.
struct TemperatureEstimate {
  double sensitivity = 0;                         // s of TemperatureModel, from all groups [1/K]
  std::vector<TemperatureScore::Group> left_out;  // each predicted without and with the temperature
  // Sums of the squared errors of all groups that were left out [Pa^2].
  double square = 0, square_without_temperature = 0;
};

// Fits s for each lag of the grid. Taxels are added in their order, so that the result does not depend on the
// number of threads.
std::vector<TemperatureEstimate> fitTemperature(const TemperatureProblem& problem,
                                                const TemperatureGrid& grid, const dataset::Protocols& groups,
                                                const std::vector<std::uint8_t>& no_model, unsigned threads) {
  const TemperatureFit fit(problem, grid, groups);
  std::vector<FoldSums> each(no_model.size(), fit.empty());
  matrix::forEachTaxel(no_model.size(), threads, [&](std::size_t taxel) {
    if (no_model[taxel] == 0) each[taxel] = fit.ofTaxel(taxel);
  });
  FoldSums all = fit.empty();
  for (const FoldSums& own : each) {
    for (std::size_t g = 0; g < all.size(); ++g) {
      for (std::size_t l = 0; l < all[g].size(); ++l) all[g][l] += own[g][l];
    }
  }
  std::vector<TemperatureEstimate> estimates(grid.lags.size());
  for (std::size_t l = 0; l < estimates.size(); ++l) {
    TemperatureEstimate& own = estimates[l];
    own.sensitivity = all.back()[l].sensitivity();
    for (std::size_t g = 0; g + 1 < all.size(); ++g) {
      const LagSums& sums = all[g][l];
      if (!(sums.readings > 0)) continue;  // each surface was recorded with this group only
      const double s = sums.sensitivity(), without = sums.error[0];
      const double with = without + s * sums.error[1] + s * s * sums.error[2];
      own.square += with;
      own.square_without_temperature += without;
      own.left_out.push_back({groups.names[g], std::sqrt(std::max(0.0, without) / sums.readings),
                              std::sqrt(std::max(0.0, with) / sums.readings)});
    }
  }
  return estimates;
}

// Each recording is a group.
dataset::Protocols eachRecording(const std::vector<dataset::Recording>& recordings,
                                 const dataset::Protocols& protocols) {
  dataset::Protocols groups;
  groups.longest_hold = protocols.longest_hold;
  groups.lowest = protocols.lowest;
  groups.highest = protocols.highest;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    groups.names.push_back("recording " +
                           (recordings[r].name.empty() ? std::to_string(r + 1) : recordings[r].name));
    groups.of_scan.emplace_back(recordings[r].scans(), static_cast<std::uint32_t>(r));
  }
  return groups;
}

// Groups that are left out, with the estimates of each lag.
struct Trial {
  dataset::Protocols groups;
  std::vector<TemperatureEstimate> estimates;  // [lags]
};

class TemperatureTraining {
 public:
  TemperatureTraining(const TemperatureProblem& problem, const CalibrationOptions& options,
                      Calibration& calibration)
      : problem_(problem),
        options_(options),
        calibration_(calibration),
        grid_(temperatureGrid(problem.recordings, problem.sections)) {}

  TemperatureModel choose();

 private:
  TemperatureScore& score() { return calibration_.scores.temperature; }
  bool told(const std::string& why) {
    score().choice = "Temperature: none, since " + why + ".";
    return false;
  }
  void addTrial(dataset::Protocols groups);
  bool findLag();
  TemperatureModel model() const;
  bool wins();

  const TemperatureProblem& problem_;
  const CalibrationOptions& options_;
  Calibration& calibration_;
  const TemperatureGrid grid_;
  std::vector<Trial> trials_;
  std::size_t lag_ = 0;  // place in the grid
};

void TemperatureTraining::addTrial(dataset::Protocols groups) {
  if (groups.names.size() < 2) return;
  auto estimates = fitTemperature(problem_, grid_, groups, calibration_.no_model, options_.threads);
  // Where each surface has one group only, nothing can be predicted without it.
  if (!(estimates.front().square_without_temperature > 0)) return;
  trials_.push_back({std::move(groups), std::move(estimates)});
}

bool TemperatureTraining::findLag() {
  const dataset::Protocols protocols = dataset::protocolsOf(problem_.recordings, problem_.sections);
  addTrial(protocols);
  addTrial(eachRecording(problem_.recordings, protocols));
  if (trials_.empty())
    return told(
        "no protocol and no recording can be left out; record each surface with two paces and dwells, or in "
        "two bags");
  double least = 0;
  bool found = false;
  for (std::size_t l = 0; l < grid_.lags.size(); ++l) {
    double share = 0;  // of the squares without temperature
    for (const Trial& trial : trials_)
      share += trial.estimates[l].square / trial.estimates[l].square_without_temperature;
    if (!(share < double(trials_.size())) || (found && share >= least)) continue;
    least = share;
    lag_ = l;
    found = true;
  }
  return found || told("it does not explain readings that were left out");
}

TemperatureModel TemperatureTraining::model() const {
  TemperatureModel model{trials_.front().estimates[lag_].sensitivity,
                         grid_.reference,
                         grid_.lags[lag_],
                         grid_.low,
                         grid_.high,
                         0};
  double square = 0, scans = 0;
  for (const dataset::Recording& recording : problem_.recordings) {
    for (const double sheet : sheetTemperature(recording, model.lag)) {
      square += (sheet - model.reference) * (sheet - model.reference);
      scans += 1;
    }
  }
  model.spread = std::sqrt(square / scans);
  return model;
}

bool TemperatureTraining::wins() {
  std::vector<TemperatureScore::Group>& groups = score().groups;
  bool better = true;
  for (const Trial& trial : trials_) {
    double without = 0, with = 0;
    for (const TemperatureScore::Group& group : trial.estimates[lag_].left_out) {
      groups.push_back(group);
      without += group.without * group.without;
      with += group.with * group.with;
    }
    better = better && with <= kWins * kWins * without;
  }
  const auto worse = [](const auto& group) { return group.with > kWorse * group.without; };
  if (std::any_of(groups.begin(), groups.end(), worse))
    return told(
        "with it readings are predicted worse by more than 1 % on a protocol or recording that was left out");
  return better || told(
                       "with it readings are not predicted better by 2 % on protocols and recordings that "
                       "were left out");
}

TemperatureModel TemperatureTraining::choose() {
  if (grid_.lags.empty()) {
    told("the mean temperatures of the cycles differ by " + settings::roundedText(kLeastTemperatureSpan) +
         " K or less");
    return {};
  }
  if (!findLag()) return {};
  if (!wins()) return {};
  const TemperatureModel chosen = model();
  score().choice = "Temperature: " + settings::roundedText(100 * chosen.sensitivity, 3) +
                   " % a kelvin with a lag of " + settings::roundedText(chosen.lag, 3) +
                   " s; it wins on protocols and recordings that were left out.";
  return chosen;
}

}  // namespace

TemperatureModel chooseTemperature(const TemperatureProblem& problem, const CalibrationOptions& options,
                                   Calibration& calibration) {
  if (!options.temperature || !haveTemperature(problem.recordings)) return {};
  return TemperatureTraining(problem, options, calibration).choose();
}

}  // namespace fsr::calibration
