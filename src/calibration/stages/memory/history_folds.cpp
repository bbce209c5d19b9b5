#include "calibration/stages/memory/history_folds.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibration/stages/memory/history_stream.h"
#include "matrix/for_each_taxel.h"

namespace fsr::calibration {

namespace {

constexpr double kWithin = 0.682689492;  // of a normal distribution within one deviation
constexpr double kSmallest = 1e-6;       // of the absolute errors that are told apart, share of `highest`
constexpr std::size_t kTogether = 16;    // taxels whose sums are in memory at one time

}  // namespace

HistoryErrors::HistoryErrors(double highest, double known, std::size_t protocols)
    : highest_(highest), known_(known), parts_(kHistoryParts), known_errors_(protocols) {}

std::size_t HistoryErrors::bin(const Reading& reading) const {
  const double at = reading.answer / highest_ * static_cast<double>(kBins);
  const auto place = static_cast<std::size_t>(std::min(std::max(at, 0.0), static_cast<double>(kBins - 1)));
  return place + (reading.unloading ? kBins : 0);
}

// Upper end of a level [Pa].
double HistoryErrors::level(std::size_t number) const {
  return highest_ * kSmallest *
         std::pow(1 / kSmallest, static_cast<double>(number + 1) / static_cast<double>(kLevels - 1));
}

void HistoryErrors::add(const Reading& reading) {
  const double before = reading.static_answer - reading.truth, error = reading.answer - reading.truth;
  const double beyond = withoutOpen(std::abs(error), reading.open);
  const double share = std::max(beyond / (highest_ * kSmallest), 1.0);
  const double at = std::log(share) / std::log(1 / kSmallest) * static_cast<double>(kLevels - 1);
  const auto place = static_cast<std::size_t>(std::min(at, static_cast<double>(kLevels - 1)));
  const std::size_t own = bin(reading);
  const std::array<std::size_t, 3> parts = historyPartsOf(reading.direction, reading.since_reversal);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (k > 0 && parts[k] == parts[k - 1]) continue;
    Sum& sum = parts_[parts[k]];
    ++sum.readings;
    sum.static_square += before * before;
    sum.square += error * error;
    ++sum.errors[own][place];
  }
  if (reading.open <= known_) ++known_errors_[reading.protocol][own][place];
}

void HistoryErrors::addCounts(const Counts& other, Counts& counts) {
  for (std::size_t b = 0; b < counts.size(); ++b) {
    for (std::size_t l = 0; l < kLevels; ++l) counts[b][l] += other[b][l];
  }
}

void HistoryErrors::merge(const HistoryErrors& other) {
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    parts_[p].readings += other.parts_[p].readings;
    parts_[p].static_square += other.parts_[p].static_square;
    parts_[p].square += other.parts_[p].square;
    addCounts(other.parts_[p].errors, parts_[p].errors);
  }
  for (std::size_t g = 0; g < known_errors_.size(); ++g) addCounts(other.known_errors_[g], known_errors_[g]);
}

// NaN for a bin without readings.
double HistoryErrors::quantile(std::size_t bin) const {
  std::array<double, kLevels> shares = {};  // summed over protocols
  double protocols = 0, below = 0;
  for (const Counts& errors : known_errors_) {
    const double all = std::accumulate(errors[bin].begin(), errors[bin].end(), 0.0);
    if (all == 0) continue;
    protocols += 1;
    for (std::size_t l = 0; l < kLevels; ++l) shares[l] += static_cast<double>(errors[bin][l]) / all;
  }
  if (protocols == 0) return std::numeric_limits<double>::quiet_NaN();
  for (std::size_t l = 0; l < kLevels; ++l) {
    below += shares[l];
    if (below >= kWithin * protocols) return level(l);
  }
  return level(kLevels - 1);
}

std::vector<double> HistoryErrors::deviation(std::size_t first_bin) const {
  std::vector<double> deviation;
  for (std::size_t b = 0; b < kBins; ++b) deviation.push_back(quantile(first_bin + b));
  for (std::size_t b = 1; b < kBins; ++b)
    if (std::isnan(deviation[b])) deviation[b] = deviation[b - 1];
  for (std::size_t b = kBins - 1; b-- > 0;)
    if (std::isnan(deviation[b])) deviation[b] = deviation[b + 1];
  return deviation;
}

void HistoryErrors::setDeviation(HistoryModel& model) const {
  const double width = highest_ / static_cast<double>(kBins);
  model.deviation_knot.clear();
  for (std::size_t b = 0; b < kBins; ++b)
    model.deviation_knot.push_back((static_cast<double>(b) + 0.5) * width);
  model.loading_deviation = deviation(0);
  model.unloading_deviation = deviation(kBins);
  // Readings of one direction only: nothing else is known of the other one.
  if (std::isnan(model.loading_deviation.front())) model.loading_deviation = model.unloading_deviation;
  if (std::isnan(model.unloading_deviation.front())) model.unloading_deviation = model.loading_deviation;
}

std::vector<HistoryScore::Part> HistoryErrors::parts() const {
  std::vector<HistoryScore::Part> parts;
  for (std::size_t p = 0; p < kHistoryParts; ++p) {
    const Sum& sum = parts_[p];
    if (sum.readings == 0) continue;
    const double readings = static_cast<double>(sum.readings);
    std::uint64_t within = 0;
    for (std::size_t b = 0; b < 2 * kBins; ++b) {
      const double deviation = quantile(b);
      for (std::size_t l = 0; l < kLevels && level(l) <= deviation; ++l) within += sum.errors[b][l];
    }
    parts.push_back({historyPartName(p), sum.readings, std::sqrt(sum.static_square / readings),
                     std::sqrt(sum.square / readings), static_cast<double>(within) / readings});
  }
  return parts;
}

namespace {

// Lowest and highest code of the sections but one.
void setTrainedCodes(const std::vector<regression::CodeStatistics>& sections, std::size_t left_out,
                     StaticAnswer& answer) {
  answer.lowest = 0xffff;
  answer.highest = 0;
  for (std::size_t s = 0; s < sections.size(); ++s) {
    if (s == left_out) continue;
    sections[s].forEach([&](const regression::CodeSums& sums) {
      answer.lowest = std::min(answer.lowest, sums.code);
      answer.highest = std::max(answer.highest, sums.code);
    });
  }
}

}  // namespace

HistoryFolds::HistoryFolds(const HistoryProblem& problem, const dataset::Protocols& protocols,
                           unsigned threads, const Calibration& calibration)
    : problem_(problem),
      protocols_(protocols),
      threads_(threads),
      calibration_(calibration),
      grid_(historyGrid(protocols.lowest, protocols.highest, protocols.longest_hold)),
      streams_(historyStreams(problem.recordings, problem.classes.class_of, problem.sections, protocols,
                              grid_, problem.sessions)) {
  std::vector<dataset::Sections> by_protocol = problem.sections;
  for (std::size_t r = 0; r < problem.recordings.size(); ++r) {
    for (std::size_t i = 0; i < problem.recordings[r].scans(); ++i) {
      std::uint32_t& section = by_protocol[r].section[i];
      if (section == dataset::kNoSection) continue;
      const std::uint32_t own = protocols.of_scan[r][i];
      section = own == dataset::Protocols::kOther ? static_cast<std::uint32_t>(count()) : own;
    }
  }
  limits_.assign(count(), Answers(problem.classes.classes.size()));
  for (std::size_t g = 0; g < count(); ++g) setTrainedPressures(streams_, g, limits_[g]);
  scans_ = gatherScans(problem.recordings, problem.classes, by_protocol, problem.zeros);
}

template <typename Work>
void HistoryFolds::forEachModelledTaxel(Work&& work) const {
  matrix::forEachTaxel(calibration_.no_model.size(), threads_, [&](std::size_t taxel) {
    if (calibration_.no_model[taxel] == 0) work(taxel);
  });
}

std::vector<HistoryFolds::Answers> HistoryFolds::answersWithoutEach(std::size_t taxel) const {
  const compensation::SectionedReadings readings =
      sectionedReadings(scans_, count() + 1, calibration_.tables.full_scale, taxel, problem_.regressor);
  const auto models = compensation::crossValidateScheme(problem_.plan, taxel, readings, problem_.regressor,
                                                        regression::HeldOutDeviation::kNo);
  std::vector<Answers> answers = limits_;
  for (std::size_t g = 0; g < count(); ++g) {
    for (std::size_t k = 0; k < readings.sums.size(); ++k) {
      answers[g][k].pressure = models[problem_.plan.model_of_class[k]].held_out[g].pressure;
      setTrainedCodes(readings.sums[k], g, answers[g][k]);
    }
  }
  return answers;
}

HistoryFolds::Answers HistoryFolds::answersOfTables(std::size_t taxel) const {
  Answers answers(problem_.classes.classes.size());
  const bool one = calibration_.tables.classes.size() == 1;
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const auto& table = calibration_.tables.table(taxel, one ? 0 : k).pressure;
    if (!table.empty() && !std::isnan(table.front())) answers[k].pressure.assign(table.begin(), table.end());
  }
  return answers;
}

void HistoryFolds::addRows(std::size_t taxel, const Answers& answers, HistoryRows rows,
                           const SumsOfScan& sums_of) const {
  HistoryCourse course;
  for (const HistoryStream& stream : streams_)
    addHistoryRows(stream, grid_, taxel, answers, rows, course, sums_of);
}

// fill(taxel, sums) fills the sums [number] of one taxel. Taxels are added in their order, so that the result
// does not depend on the number of threads.
template <typename Fill>
std::vector<LeftOutSums> HistoryFolds::sumsOf(std::size_t number, Fill&& fill) const {
  std::vector<LeftOutSums> all(number, LeftOutSums(grid_.features()));
  const std::size_t taxels = calibration_.no_model.size();
  for (std::size_t first = 0; first < taxels; first += kTogether) {
    std::vector<std::vector<LeftOutSums>> each(std::min(kTogether, taxels - first));
    matrix::forEachTaxel(each.size(), threads_, [&](std::size_t t) {
      if (calibration_.no_model[first + t] != 0) return;
      each[t].assign(number, LeftOutSums(grid_.features()));
      fill(first + t, each[t]);
      for (LeftOutSums& own : each[t]) own.finish();
    });
    for (const std::vector<LeftOutSums>& own : each) {
      for (std::size_t k = 0; k < own.size(); ++k) all[k].merge(own[k]);
    }
  }
  for (LeftOutSums& sums : all) sums.finish();
  return all;
}

std::vector<LeftOutSums> HistoryFolds::leaveOneOut() const {
  return sumsOf(count(), [this](std::size_t taxel, std::vector<LeftOutSums>& sums) {
    const std::vector<Answers> answers = answersWithoutEach(taxel);
    for (std::size_t g = 0; g < count(); ++g)
      addRows(taxel, answers[g], HistoryRows::kReadings,
              [&](const auto& scan) -> HistorySums& { return sums[g].of(scan, g); });
  });
}

std::vector<LeftOutSums> HistoryFolds::withAllTables(HistoryRows rows) const {
  return sumsOf(count() + 1, [this, rows](std::size_t taxel, std::vector<LeftOutSums>& sums) {
    addRows(taxel, answersOfTables(taxel), rows, [&](const auto& scan) -> HistorySums& {
      return sums[std::min<std::size_t>(scan.protocol, count())].part(scan.part);
    });
  });
}

// The first operator of the model, among those of the grid.
std::size_t HistoryFolds::firstOperator(const HistoryModel& model) const {
  const bool plays = !model.radius.empty();
  const std::vector<double>& all = plays ? grid_.radii : grid_.time_constants;
  const std::vector<double>& own = plays ? model.radius : model.time_constant;
  const auto place = own.empty() ? all.begin() : std::find(all.begin(), all.end(), own.front());
  return (plays ? 0 : grid_.radii.size()) + static_cast<std::size_t>(place - all.begin());
}

OpenDeviation HistoryFolds::openDeviation(const Eigen::VectorXd& coefficients,
                                          const std::vector<double>& spreads) const {
  return OpenDeviation({coefficients.data() + grid_.knots.size(), coefficients.data() + coefficients.size()},
                       grid_.radii, spreads);
}

// visit(stream, scan, x, change, unknown, state) for each scan that counts: the change p - x without limits,
// and the deviation from what is not known of the operators [Pa].
template <typename Visit>
void HistoryFolds::forEachChange(std::size_t taxel, const Answers& answers,
                                 const Eigen::VectorXd& coefficients, const OpenDeviation& open_deviation,
                                 Visit&& visit) const {
  Eigen::VectorXd features(Eigen::Index(grid_.features()));
  HistoryCourse course;
  for (const HistoryStream& stream : streams_) {
    stream.run(taxel, answers, course,
               [&](const HistoryStream::Scan& scan, double x, const double* state, const double* open) {
                 historyFeatures(grid_, x, state, features.data());
                 const double unknown = open_deviation(open);
                 features.head(Eigen::Index(grid_.knots.size())) *= open_deviation.knownShare(unknown);
                 visit(stream, scan, x, coefficients.dot(features), unknown, state);
               });
  }
}

// The change is limited to that of the protocols that were not left out.
void HistoryFolds::addErrors(std::size_t taxel, const Answers& answers, std::size_t protocol,
                             std::size_t first_operator, const Eigen::VectorXd& coefficients,
                             const OpenDeviation& open_deviation, HistoryErrors& errors) const {
  ChangeRange range(grid_);
  std::vector<HistoryErrors::Reading> left_out;
  forEachChange(taxel, answers, coefficients, open_deviation,
                [&](const HistoryStream& stream, const HistoryStream::Scan& scan, double x, double change,
                    double unknown, const double* state) {
                  if (scan.protocol != protocol) {
                    range.add(x, change);
                    return;
                  }
                  left_out.push_back({x, x + change, stream.recording().pressure[scan.number], unknown,
                                      state[first_operator] > x, stream.sections().direction[scan.number],
                                      scan.since_reversal, protocol});
                });
  range.finish();
  for (HistoryErrors::Reading& reading : left_out) {
    const double x = reading.static_answer;
    reading.answer = x + range.limited(x, reading.answer - x);
    errors.add(reading);
  }
}

void HistoryFolds::setLimits(const Eigen::VectorXd& coefficients, const std::vector<double>& spreads,
                             HistoryModel& model) const {
  const OpenDeviation open = openDeviation(coefficients, spreads);
  std::vector<ChangeRange> each(calibration_.no_model.size(), ChangeRange(grid_));
  forEachModelledTaxel([&](std::size_t taxel) {
    forEachChange(taxel, answersOfTables(taxel), coefficients, open,
                  [&](const HistoryStream&, const HistoryStream::Scan&, double x, double change, double,
                      const double*) { each[taxel].add(x, change); });
  });
  ChangeRange all(grid_);
  for (const ChangeRange& own : each) all.merge(own);
  all.finish();
  model.least_change = all.least();
  model.largest_change = all.largest();
}

HistoryErrors HistoryFolds::errors(const HistoryModel& model,
                                   const std::vector<Eigen::VectorXd>& coefficients,
                                   const std::vector<double>& spreads, double known) const {
  const std::size_t first = firstOperator(model);
  const HistoryErrors none(protocols_.highest, known, count());
  std::vector<OpenDeviation> open;
  for (const Eigen::VectorXd& own : coefficients) open.push_back(openDeviation(own, spreads));
  HistoryErrors all = none;
  const std::size_t taxels = calibration_.no_model.size();
  for (std::size_t begin = 0; begin < taxels; begin += kTogether) {
    std::vector<HistoryErrors> each(std::min(kTogether, taxels - begin), none);
    matrix::forEachTaxel(each.size(), threads_, [&](std::size_t t) {
      if (calibration_.no_model[begin + t] != 0) return;
      const std::vector<Answers> answers = answersWithoutEach(begin + t);
      for (std::size_t g = 0; g < count(); ++g)
        addErrors(begin + t, answers[g], g, first, coefficients[g], open[g], each[t]);
    });
    for (const HistoryErrors& own : each) all.merge(own);
  }
  return all;
}

}  // namespace fsr::calibration
