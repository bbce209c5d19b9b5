#include "calibration/stages/memory/history_training.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "calibration/stages/deviation/held_out_scoring.h"
#include "calibration/stages/memory/history_folds.h"
#include "dataset/protocols.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "statistics/bootstrap.h"

namespace fsr::calibration {

namespace {

constexpr HistoryFamily kFamilies[] = {HistoryFamily::kPlays, HistoryFamily::kMemories, HistoryFamily::kBoth};
constexpr char kWhatToRecord[] =
    "record cycles with two paces, with short and long dwells and with partial cycles on each surface";

// No protocol can be left out. A family that the user asked for cannot be tested, so it is refused.
void refuse(std::size_t protocols, const HistoryChoice& choice, Calibration& calibration) {
  const std::string reason = whyNoProtocolIsLeftOut(protocols);
  if (!choice.automatic) throw settings::InputError("history " + historyName(choice.family) + ": " + reason);
  calibration.scores.history.choice = "History: none, since " + reason + ".";
}

// The squared errors of one part of a protocol, by HistoryFamily and at last with the correction c alone
// [Pa^2], summed over its readings.
struct PartErrors {
  std::size_t protocol = 0;
  std::size_t cycles = 0;  // number of the cycles that the part is of
  std::array<double, 5> square = {};
};
using Parts = std::vector<PartErrors>;
constexpr std::size_t kCorrected = 4;

// Coefficients [models] that are fitted to the sums.
std::vector<Eigen::VectorXd> modelsOf(const HistoryGrid& grid, const HistorySums& sums) {
  std::vector<Eigen::VectorXd> models(4, Eigen::VectorXd::Zero(Eigen::Index(grid.features())));
  for (const HistoryFamily family : kFamilies) models[std::size_t(family)] = fitHistory(family, grid, sums);
  models.push_back(fitCorrection(grid, sums));
  return models;
}

PartErrors errorsOf(std::size_t protocol, std::size_t part, const HistorySums& sums,
                    const std::vector<Eigen::VectorXd>& models) {
  PartErrors errors{protocol, part / 2, {}};
  for (std::size_t m = 0; m < models.size(); ++m)
    errors.square[m] = sums.samples() * sums.meanSquare(models[m]);
  return errors;
}

HistorySums allParts(const HistoryGrid& grid, const std::vector<LeftOutSums>& all) {
  HistorySums whole(grid.features());
  for (const LeftOutSums& sums : all) {
    for (const HistorySums& part : sums.left_out) whole.merge(part);
  }
  return whole;
}

// On the protocols, of models that were fitted to all parts.
Parts errorsOfFit(const HistoryGrid& grid, const std::vector<LeftOutSums>& all, std::size_t protocols) {
  const std::vector<Eigen::VectorXd> models = modelsOf(grid, allParts(grid, all));
  Parts parts;
  for (std::size_t g = 0; g < protocols; ++g) {
    for (std::size_t part = 0; part < all[g].left_out.size(); ++part) {
      const HistorySums& own = all[g].left_out[part];
      if (own.samples() > 0) parts.push_back(errorsOf(g, part, own, models));
    }
  }
  return parts;
}

// By how much one model is better than another, as a share of the other's squared errors, with its interval.
struct Gain {
  double share = 0;
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

// Over all parts [Pa^2].
double squareOf(const Parts& parts, std::size_t model) {
  double sum = 0;
  for (const PartErrors& part : parts) sum += part.square[model];
  return sum;
}

// On one protocol, or on all. Readings of one cycle are not independent, so cycles are drawn, and where they
// are too few for an interval, their loading and unloading. Where these are too few, the interval is endless.
Gain gainOf(const Parts& parts, std::size_t model, std::size_t other,
            std::optional<std::size_t> protocol = {}) {
  std::vector<std::array<double, 2>> squares;
  statistics::BootstrapProblem problem{{{"cycle", {}}, {"half a cycle", {}}}, {}};
  for (const PartErrors& part : parts) {
    if (protocol && part.protocol != *protocol) continue;
    problem.levels[0].unit.push_back(part.protocol * dataset::Protocols::kMostCycles + part.cycles);
    problem.levels[1].unit.push_back(squares.size());
    squares.push_back({part.square[model], part.square[other]});
  }
  problem.statistic = [&](const std::vector<std::size_t>& drawn) {
    double own = 0, others = 0;
    for (const std::size_t k : drawn) own += squares[k][0], others += squares[k][1];
    return 1 - own / others;
  };
  Gain result;
  const auto nothing = [](const auto& square) { return square[1] == 0; };
  if (squares.empty() || std::all_of(squares.begin(), squares.end(), nothing)) return result;
  const statistics::BootstrapResult interval = statistics::bootstrap(problem);
  result.share = interval.estimate;
  if (interval.method != statistics::IntervalMethod::kNone)
    result.low = interval.low, result.high = interval.high;
  return result;
}

// The choice of a family, by its errors on protocols that were left out.
class FamilyChoice {
 public:
  /// `names` and `sums`: of each protocol that was left out. `means`: see chooseHistory().
  FamilyChoice(const HistoryGrid& grid, const std::vector<std::string>& names,
               const std::vector<LeftOutSums>& sums, const std::vector<LeftOutSums>& means)
      : means_(errorsOfFit(grid, means, names.size())) {
    scoreFamilies(grid, names, sums);
  }

  bool assessable() const { return !score_.protocols.empty(); }
  HistoryFamily choose(const HistoryChoice& choice);
  /// [protocols], trained without the protocol.
  std::vector<Eigen::VectorXd> coefficients(HistoryFamily family) const;
  const HistoryScore& score() const { return score_; }
  double rmse(HistoryFamily family) const {
    return std::sqrt(squareOf(parts_, std::size_t(family)) / samples_);
  }

 private:
  void scoreFamilies(const HistoryGrid& grid, const std::vector<std::string>& names,
                     const std::vector<LeftOutSums>& all);
  bool nowhereWorse(HistoryFamily family) const;
  bool better(HistoryFamily family) const;
  HistoryFamily best() const;
  std::string gainText(HistoryFamily family) const;

  std::vector<std::vector<Eigen::VectorXd>> coefficients_;  // [protocols][models]
  Parts parts_;                                             // of protocols that were left out
  Parts means_;
  double samples_ = 0;
  HistoryScore score_;
};

void FamilyChoice::scoreFamilies(const HistoryGrid& grid, const std::vector<std::string>& names,
                                 const std::vector<LeftOutSums>& all) {
  for (std::size_t g = 0; g < all.size(); ++g) {
    const LeftOutSums& sums = all[g];
    coefficients_.push_back(modelsOf(grid, sums.trained));
    std::array<double, 5> square = {};
    double samples = 0;
    for (std::size_t part = 0; part < sums.left_out.size(); ++part) {
      const HistorySums& own = sums.left_out[part];
      if (own.samples() == 0) continue;
      parts_.push_back(errorsOf(g, part, own, coefficients_.back()));
      for (std::size_t m = 0; m < square.size(); ++m) square[m] += parts_.back().square[m];
      samples += own.samples();
    }
    // A surface that was recorded with this protocol only has no answer without it.
    if (samples == 0) continue;
    samples_ += samples;
    HistoryScore::Protocol score;
    score.name = names[g];
    for (std::size_t f = 0; f < score.rmse.size(); ++f) score.rmse[f] = std::sqrt(square[f] / samples);
    score.corrected_rmse = std::sqrt(square[kCorrected] / samples);
    score_.protocols.push_back(score);
  }
}

std::vector<Eigen::VectorXd> FamilyChoice::coefficients(HistoryFamily family) const {
  std::vector<Eigen::VectorXd> own;
  for (const auto& families : coefficients_) own.push_back(families[std::size_t(family)]);
  return own;
}

bool FamilyChoice::nowhereWorse(HistoryFamily family) const {
  std::set<std::size_t> protocols;
  for (const PartErrors& part : parts_) protocols.insert(part.protocol);
  return std::all_of(protocols.begin(), protocols.end(), [&](std::size_t protocol) {
    return gainOf(parts_, std::size_t(family), 0, protocol).high >= 0;
  });
}

// Whether the error of a model is smaller by kWins, and beyond chance where that is asked for, than that of
// the static answer, and than that of the correction c without any memory: what c alone mends is no memory.
bool wins(const Parts& parts, HistoryFamily family, bool beyond_chance) {
  const std::size_t none = squareOf(parts, kCorrected) < squareOf(parts, 0) ? kCorrected : 0;
  return squareOf(parts, std::size_t(family)) <= kWins * kWins * squareOf(parts, none) &&
         (!beyond_chance || gainOf(parts, std::size_t(family), none).low > 0);
}

// Both families only if one of them is better by itself in the means: plays and memories that are of use only
// together, with opposite signs, are a filter of noise.
bool FamilyChoice::better(HistoryFamily family) const {
  const bool part = family != HistoryFamily::kBoth || wins(means_, HistoryFamily::kPlays, false) ||
                    wins(means_, HistoryFamily::kMemories, false);
  return part && wins(means_, family, true) && wins(parts_, family, true);
}

// Both families are preferred to one of them only beyond chance.
HistoryFamily FamilyChoice::best() const {
  HistoryFamily best = HistoryFamily::kNone;
  for (const HistoryFamily family : kFamilies) {
    const auto f = std::size_t(family), b = std::size_t(best);
    if (squareOf(parts_, f) >= squareOf(parts_, b) || !better(family) || !nowhereWorse(family)) continue;
    const bool beyond_chance = best == HistoryFamily::kNone || gainOf(parts_, f, b).low > 0;
    if (family != HistoryFamily::kBoth || beyond_chance) best = family;
  }
  return best;
}

// In RMSE.
std::string FamilyChoice::gainText(HistoryFamily family) const {
  const Gain own = gainOf(parts_, std::size_t(family), 0);
  const auto percent = [](double share) {
    return settings::fixedText(100 * (1 - std::sqrt(std::max(1 - share, 0.0))), 0);
  };
  std::string text = "the error falls by " + percent(own.share) + " %";
  if (std::isfinite(own.low)) text += " (95 %: " + percent(own.low) + " to " + percent(own.high) + " %)";
  return text + " on protocols that were left out";
}

HistoryFamily FamilyChoice::choose(const HistoryChoice& choice) {
  const auto wins = [&](HistoryFamily family) { return better(family) && nowhereWorse(family); };
  const auto told = [&](HistoryFamily family, const std::string& why) {
    score_.choice = "History: " + historyName(family) + ", " + why + ".";
    return family;
  };
  if (!choice.automatic) {
    const bool good = wins(choice.family);
    return told(choice.family,
                std::string("as asked for") +
                    (good ? "" : ", although it does not win on protocols that were left out"));
  }
  if (choice.family != HistoryFamily::kNone && wins(choice.family))
    return told(choice.family, "as proposed; " + gainText(choice.family));
  const HistoryFamily taken = best();
  if (taken != HistoryFamily::kNone) return told(taken, gainText(taken));
  const bool none_wins =
      std::none_of(std::begin(kFamilies), std::end(kFamilies), [&](auto family) { return better(family); });
  return told(taken, none_wins
                         ? "since no model of memory is better by 2 % and beyond chance on protocols that "
                           "were left out"
                         : "since every model of memory is worse beyond chance on a protocol that was left "
                           "out");
}

}  // namespace

std::string whyNoProtocolIsLeftOut(std::size_t protocols) {
  const std::string why = protocols < 2 ? "all cycles of the bags have one protocol"
                                        : "no surface was recorded with two protocols";
  return why + ", so that no protocol can be left out; " + kWhatToRecord;
}

HistoryVerdict chooseHistory(const HistoryChoice& choice, const HistoryGrid& grid,
                             const std::vector<std::string>& names, const std::vector<LeftOutSums>& sums,
                             const std::vector<LeftOutSums>& means) {
  FamilyChoice families(grid, names, sums, means.empty() ? sums : means);
  HistoryVerdict verdict;
  if (!families.assessable()) return verdict;
  verdict.family = families.choose(choice);
  verdict.score = families.score();
  verdict.coefficients = families.coefficients(verdict.family);
  verdict.rmse = families.rmse(verdict.family);
  return verdict;
}

void trainHistory(const HistoryProblem& problem, const CalibrationOptions& options,
                  Calibration& calibration) {
  const HistoryChoice& choice = options.history;
  if (!choice.automatic && choice.family == HistoryFamily::kNone) return;
  const dataset::Protocols protocols = dataset::protocolsOf(problem.recordings, problem.sections);
  if (protocols.names.size() < 2) {
    refuse(protocols.names.size(), choice, calibration);
    return;
  }
  const HistoryFolds folds(problem, protocols, options.threads, calibration);
  const HistoryVerdict verdict = chooseHistory(choice, folds.grid(), protocols.names, folds.leaveOneOut(),
                                               folds.withAllTables(HistoryRows::kMeans));
  if (verdict.score.protocols.empty()) {
    refuse(protocols.names.size(), choice, calibration);
    return;
  }
  calibration.scores.history = verdict.score;
  if (verdict.family == HistoryFamily::kNone) return;
  const HistorySums whole = allParts(folds.grid(), folds.withAllTables(HistoryRows::kReadings));
  const std::vector<double> spreads = memorySpreads(folds.grid(), whole);
  const Eigen::VectorXd coefficients = fitHistory(verdict.family, folds.grid(), whole);
  calibration.history = historyModel(verdict.family, folds.grid(), coefficients, spreads);
  folds.setLimits(coefficients, spreads, calibration.history);
  const HistoryErrors errors =
      folds.errors(calibration.history, verdict.coefficients, spreads, verdict.rmse / 2);
  errors.setDeviation(calibration.history);
  calibration.scores.history.parts = errors.parts();
}

}  // namespace fsr::calibration
