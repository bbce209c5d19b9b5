#include "calibration/history_training.h"

#include <algorithm>
#include <cmath>

#include "calibration/history_errors.h"
#include "calibration/history_stream.h"
#include "calibration/training_scans.h"
#include "dataset/protocols.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/for_each_taxel.h"
#include "regression/regressors.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

using compensation::HistoryFamily;
using compensation::HistorySums;

constexpr HistoryFamily kFamilies[] = {HistoryFamily::kPlays, HistoryFamily::kMemories, HistoryFamily::kBoth};
// A model may be worse than the static answer by this much on no protocol. On all together it must be better
// by kWins in root mean square, both than the static answer and than the correction c without any memory:
// what c alone mends is no memory.
constexpr double kWorse = 1.01;
constexpr double kWins = 0.98;

constexpr char kWhatToRecord[] =
    "record cycles with two paces, with short and long dwells and with partial cycles on each surface";

using Answers = std::vector<StaticAnswer>;  // of one taxel, [classes]

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

// No protocol can be left out. A family that the user asked for cannot be tested, so it is refused.
void refuse(const std::string& why, const HistoryChoice& choice, Calibration& calibration) {
  const std::string reason = why + ", so that no protocol can be left out; " + kWhatToRecord;
  if (!choice.automatic)
    throw settings::InputError("history " + compensation::historyName(choice.family) + ": " + reason);
  calibration.scores.history.choice = "History: none, since " + reason + ".";
}

class HistoryTraining {
 public:
  HistoryTraining(const HistoryProblem& problem, const dataset::Protocols& protocols, unsigned threads,
                  const Calibration& calibration);

  void run(const HistoryChoice& choice, Calibration& calibration);

 private:
  // Sums of a pass: tables without a protocol, or with all of them.
  struct Sums {
    HistorySums trained, left_out;
  };

  Answers answersWithout(std::size_t protocol, std::size_t taxel) const;
  Sums sumsWithout(std::size_t protocol) const;
  void addSums(std::size_t protocol, std::size_t taxel, Sums& sums) const;
  void scoreFamilies();
  double squareOf(HistoryFamily family) const;
  double correctedSquare() const;
  bool nowhereWorse(HistoryFamily family) const;
  HistoryFamily choose(const HistoryChoice& choice);
  std::size_t firstOperator(const compensation::HistoryModel& model) const;
  void addErrors(std::size_t protocol, std::size_t taxel, const compensation::HistoryModel& model,
                 HistoryErrors& errors) const;
  HistoryErrors errorsOf(const compensation::HistoryModel& model) const;
  std::size_t protocols() const { return protocols_.names.size(); }

  const HistoryProblem& problem_;
  const dataset::Protocols& protocols_;
  unsigned threads_;
  const Calibration& calibration_;
  compensation::HistoryGrid grid_;
  std::vector<HistoryStream> streams_;
  TrainingScans scans_;                                     // the section of a scan is its protocol
  std::vector<std::vector<Eigen::VectorXd>> coefficients_;  // [protocols][families], without the protocol
  HistoryScore score_;
};

HistoryTraining::HistoryTraining(const HistoryProblem& problem, const dataset::Protocols& protocols,
                                 unsigned threads, const Calibration& calibration)
    : problem_(problem),
      protocols_(protocols),
      threads_(threads),
      calibration_(calibration),
      grid_(compensation::historyGrid(protocols.highest, protocols.longest_hold)) {
  std::vector<dataset::Sections> by_protocol = problem.sections;
  for (std::size_t r = 0; r < problem.recordings.size(); ++r) {
    streams_.emplace_back(problem.recordings[r], problem.classes.class_of[r], problem.sections[r],
                          protocols.of_scan[r], grid_);
    for (std::size_t i = 0; i < problem.recordings[r].scans(); ++i) {
      std::uint32_t& section = by_protocol[r].section[i];
      if (section == dataset::kNoSection) continue;
      const std::uint32_t own = protocols.of_scan[r][i];
      section = own == dataset::Protocols::kOther ? static_cast<std::uint32_t>(protocols.names.size()) : own;
    }
  }
  scans_ = gatherScans(problem.recordings, problem.classes, by_protocol);
}

// The static answers of a taxel that was trained without a protocol; protocols() = with all of them.
Answers HistoryTraining::answersWithout(std::size_t protocol, std::size_t taxel) const {
  const std::size_t sections = protocols() + 1, classes = problem_.classes.classes.size();
  Answers answers(classes);
  if (protocol == protocols()) {
    for (std::size_t k = 0; k < classes; ++k) {
      const auto& table =
          calibration_.tables.table(taxel, calibration_.tables.classes.size() == 1 ? 0 : k).pressure;
      if (!table.empty() && !std::isnan(table.front()))
        answers[k].pressure.assign(table.begin(), table.end());
    }
    return answers;
  }
  const auto cells = statisticsOfTaxel(scans_, sections, calibration_.tables.full_scale, taxel);
  compensation::SectionedReadings readings;
  readings.full_scale = calibration_.tables.full_scale;
  for (std::size_t k = 0; k < classes; ++k) {
    const auto first = cells.begin() + static_cast<std::ptrdiff_t>(k * sections);
    readings.sums.emplace_back(first, first + static_cast<std::ptrdiff_t>(sections));
  }
  if (!regression::makeRegressor(problem_.regressor)->mergeable())
    readings.samples = samplesOfTaxel(scans_, sections, readings.full_scale, taxel);
  const auto models = compensation::crossValidateScheme(problem_.plan, taxel, readings, problem_.regressor,
                                                        regression::HeldOutDeviation::kNo);
  for (std::size_t k = 0; k < classes; ++k) {
    answers[k].pressure = models[problem_.plan.model_of_class[k]].held_out[protocol].pressure;
    setTrainedCodes(readings.sums[k], protocol, answers[k]);
  }
  return answers;
}

// A row is the mean of the scans within half a second.
void HistoryTraining::addSums(std::size_t protocol, std::size_t taxel, Sums& sums) const {
  const Answers answers = answersWithout(protocol, taxel);
  const std::size_t n = grid_.features();
  std::vector<double> features(n), mean(n);
  for (const HistoryStream& stream : streams_) {
    double target = 0, count = 0;
    HistoryStream::Scan row;
    const auto close = [&] {
      if (count == 0) return;
      for (double& value : mean) value /= count;
      (row.protocol == protocol ? sums.left_out : sums.trained).add(mean.data(), target / count);
      std::fill(mean.begin(), mean.end(), 0.0);
      target = count = 0;
    };
    stream.run(taxel, answers, [&](const HistoryStream::Scan& scan, double x, const double* state) {
      if (scan.row != row.row) close();
      row = scan;
      compensation::historyFeatures(grid_, x, state, features.data());
      for (std::size_t k = 0; k < n; ++k) mean[k] += features[k];
      target += stream.recording().pressure[scan.number] - x;
      count += 1;
    });
    close();
  }
  sums.trained.finish();
  sums.left_out.finish();
}

// Taxels are added in their order, so that the result does not depend on the number of threads.
HistoryTraining::Sums HistoryTraining::sumsWithout(std::size_t protocol) const {
  const Sums none{HistorySums(grid_.features()), HistorySums(grid_.features())};
  std::vector<Sums> each(calibration_.no_model.size(), none);
  matrix::forEachTaxel(each.size(), threads_, [&](std::size_t taxel) {
    if (calibration_.no_model[taxel] == 0) addSums(protocol, taxel, each[taxel]);
  });
  Sums all = none;
  for (const Sums& own : each) {
    all.trained.merge(own.trained);
    all.left_out.merge(own.left_out);
  }
  return all;
}

void HistoryTraining::scoreFamilies() {
  for (std::size_t g = 0; g < protocols(); ++g) {
    const Sums sums = sumsWithout(g);
    HistoryScore::Protocol score;
    score.name = protocols_.names[g];
    coefficients_.emplace_back(4, Eigen::VectorXd::Zero(Eigen::Index(grid_.features())));
    for (const HistoryFamily family : kFamilies)
      coefficients_.back()[std::size_t(family)] = compensation::fitHistory(family, grid_, sums.trained);
    // A surface that was recorded with this protocol only has no answer without it.
    if (sums.left_out.samples() == 0) continue;
    for (std::size_t f = 0; f < score.rmse.size(); ++f)
      score.rmse[f] = std::sqrt(sums.left_out.meanSquare(coefficients_.back()[f]));
    score.corrected_rmse =
        std::sqrt(sums.left_out.meanSquare(compensation::fitCorrection(grid_, sums.trained)));
    score_.protocols.push_back(score);
  }
}

// Mean over the protocols, each with the same weight.
double HistoryTraining::squareOf(HistoryFamily family) const {
  double sum = 0;
  for (const HistoryScore::Protocol& protocol : score_.protocols) {
    const double rmse = protocol.rmse[std::size_t(family)];
    sum += rmse * rmse;
  }
  return sum;
}

double HistoryTraining::correctedSquare() const {
  double sum = 0;
  for (const HistoryScore::Protocol& protocol : score_.protocols)
    sum += protocol.corrected_rmse * protocol.corrected_rmse;
  return sum;
}

bool HistoryTraining::nowhereWorse(HistoryFamily family) const {
  return std::all_of(score_.protocols.begin(), score_.protocols.end(), [&](const auto& protocol) {
    return protocol.rmse[std::size_t(family)] <= kWorse * protocol.rmse[0];
  });
}

HistoryFamily HistoryTraining::choose(const HistoryChoice& choice) {
  const double allowed = kWins * kWins * std::min(squareOf(HistoryFamily::kNone), correctedSquare());
  const auto wins = [&](HistoryFamily family) { return nowhereWorse(family) && squareOf(family) <= allowed; };
  const auto told = [&](HistoryFamily family, const std::string& why) {
    score_.choice = "History: " + compensation::historyName(family) + ", " + why + ".";
    return family;
  };
  if (!choice.automatic) {
    const bool good = wins(choice.family);
    return told(choice.family,
                std::string("as asked for") +
                    (good ? "" : ", although it does not win on protocols that were left out"));
  }
  if (choice.family != HistoryFamily::kNone && wins(choice.family))
    return told(choice.family, "as proposed; it wins on protocols that were left out");
  HistoryFamily best = HistoryFamily::kNone;
  for (const HistoryFamily family : kFamilies) {
    if (wins(family) && squareOf(family) < squareOf(best)) best = family;
  }
  if (best != HistoryFamily::kNone) return told(best, "the best on protocols that were left out");
  const bool none_wins = std::none_of(std::begin(kFamilies), std::end(kFamilies),
                                      [&](HistoryFamily family) { return squareOf(family) <= allowed; });
  return told(best, none_wins
                        ? "since no model of memory is better by 2 % on protocols that were left out"
                        : "since every model of memory is worse by more than 1 % on a protocol that was "
                          "left out");
}

// The first operator of the model, among those of the grid.
std::size_t HistoryTraining::firstOperator(const compensation::HistoryModel& model) const {
  const bool plays = !model.radius.empty();
  const std::vector<double>& all = plays ? grid_.radii : grid_.time_constants;
  const std::vector<double>& own = plays ? model.radius : model.time_constant;
  const auto place = own.empty() ? all.begin() : std::find(all.begin(), all.end(), own.front());
  return (plays ? 0 : grid_.radii.size()) + static_cast<std::size_t>(place - all.begin());
}

void HistoryTraining::addErrors(std::size_t protocol, std::size_t taxel,
                                const compensation::HistoryModel& model, HistoryErrors& errors) const {
  const Answers answers = answersWithout(protocol, taxel);
  const Eigen::VectorXd& coefficients = coefficients_[protocol][std::size_t(model.family)];
  const std::size_t first = firstOperator(model);
  Eigen::VectorXd features(Eigen::Index(grid_.features()));
  for (const HistoryStream& stream : streams_) {
    stream.run(taxel, answers, [&](const HistoryStream::Scan& scan, double x, const double* state) {
      if (scan.protocol != protocol) return;
      compensation::historyFeatures(grid_, x, state, features.data());
      errors.add({x, x + coefficients.dot(features), stream.recording().pressure[scan.number],
                  state[first] > x, stream.sections().direction[scan.number], scan.since_reversal});
    });
  }
}

// Of every protocol, predicted without it.
HistoryErrors HistoryTraining::errorsOf(const compensation::HistoryModel& model) const {
  std::vector<HistoryErrors> each(calibration_.no_model.size(), HistoryErrors(protocols_.highest));
  matrix::forEachTaxel(each.size(), threads_, [&](std::size_t taxel) {
    if (calibration_.no_model[taxel] != 0) return;
    for (std::size_t g = 0; g < protocols(); ++g) addErrors(g, taxel, model, each[taxel]);
  });
  HistoryErrors all(protocols_.highest);
  for (const HistoryErrors& own : each) all.merge(own);
  return all;
}

void HistoryTraining::run(const HistoryChoice& choice, Calibration& calibration) {
  scoreFamilies();
  if (score_.protocols.empty()) {
    refuse("no surface was recorded with two protocols", choice, calibration);
    return;
  }
  const HistoryFamily family = choose(choice);
  if (family != HistoryFamily::kNone) {
    const Sums sums = sumsWithout(protocols());
    calibration.history =
        compensation::historyModel(family, grid_, compensation::fitHistory(family, grid_, sums.trained));
    const HistoryErrors errors = errorsOf(calibration.history);
    errors.setDeviation(calibration.history);
    score_.parts = errors.parts();
  }
  calibration.scores.history = score_;
}

}  // namespace

void trainHistory(const HistoryProblem& problem, const CalibrationOptions& options,
                  Calibration& calibration) {
  const HistoryChoice& choice = options.history;
  if (!choice.automatic && choice.family == HistoryFamily::kNone) return;
  const dataset::Protocols protocols = dataset::protocolsOf(problem.recordings, problem.sections);
  if (protocols.names.size() < 2) {
    refuse("all cycles of the bags have one protocol", choice, calibration);
    return;
  }
  HistoryTraining(problem, protocols, options.threads, calibration).run(choice, calibration);
}

}  // namespace fsr::calibration
