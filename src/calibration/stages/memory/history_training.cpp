#include "calibration/stages/memory/history_training.h"

#include <algorithm>
#include <cmath>

#include "calibration/stages/deviation/held_out_scoring.h"
#include "calibration/stages/memory/history_folds.h"
#include "dataset/protocols.h"
#include "fsr_pressure_map/settings/input_error.h"

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

// The choice of a family, by its errors on protocols that were left out.
class FamilyChoice {
 public:
  /// `names` and `sums`: of each protocol that was left out.
  FamilyChoice(const HistoryGrid& grid, const std::vector<std::string>& names,
               const std::vector<LeftOutSums>& sums) {
    scoreFamilies(grid, names, sums);
  }

  bool assessable() const { return !score_.protocols.empty(); }
  HistoryFamily choose(const HistoryChoice& choice);
  /// [protocols], trained without the protocol.
  std::vector<Eigen::VectorXd> coefficients(HistoryFamily family) const;
  const HistoryScore& score() const { return score_; }

 private:
  void scoreFamilies(const HistoryGrid& grid, const std::vector<std::string>& names,
                     const std::vector<LeftOutSums>& all);
  double squareOf(HistoryFamily family) const;
  double correctedSquare() const;
  bool nowhereWorse(HistoryFamily family) const;

  std::vector<std::vector<Eigen::VectorXd>> coefficients_;  // [protocols][families]
  HistoryScore score_;
};

void FamilyChoice::scoreFamilies(const HistoryGrid& grid, const std::vector<std::string>& names,
                                 const std::vector<LeftOutSums>& all) {
  for (std::size_t g = 0; g < all.size(); ++g) {
    const LeftOutSums& sums = all[g];
    coefficients_.emplace_back(4, Eigen::VectorXd::Zero(Eigen::Index(grid.features())));
    for (const HistoryFamily family : kFamilies)
      coefficients_.back()[std::size_t(family)] = fitHistory(family, grid, sums.trained);
    // A surface that was recorded with this protocol only has no answer without it.
    if (sums.left_out.samples() == 0) continue;
    HistoryScore::Protocol score;
    score.name = names[g];
    for (std::size_t f = 0; f < score.rmse.size(); ++f)
      score.rmse[f] = std::sqrt(sums.left_out.meanSquare(coefficients_.back()[f]));
    score.corrected_rmse = std::sqrt(sums.left_out.meanSquare(fitCorrection(grid, sums.trained)));
    score_.protocols.push_back(score);
  }
}

std::vector<Eigen::VectorXd> FamilyChoice::coefficients(HistoryFamily family) const {
  std::vector<Eigen::VectorXd> own;
  for (const auto& families : coefficients_) own.push_back(families[std::size_t(family)]);
  return own;
}

// Sum over the protocols, each with the same weight [Pa^2].
double FamilyChoice::squareOf(HistoryFamily family) const {
  double sum = 0;
  for (const HistoryScore::Protocol& protocol : score_.protocols) {
    const double rmse = protocol.rmse[std::size_t(family)];
    sum += rmse * rmse;
  }
  return sum;
}

double FamilyChoice::correctedSquare() const {
  double sum = 0;
  for (const HistoryScore::Protocol& protocol : score_.protocols)
    sum += protocol.corrected_rmse * protocol.corrected_rmse;
  return sum;
}

bool FamilyChoice::nowhereWorse(HistoryFamily family) const {
  return std::all_of(score_.protocols.begin(), score_.protocols.end(), [&](const auto& protocol) {
    return protocol.rmse[std::size_t(family)] <= kWorse * protocol.rmse[0];
  });
}

// A model must be better by kWins both than the static answer and than the correction c without any memory:
// what c alone mends is no memory. Both families are taken only if one of them is better by itself: plays
// and memories that are of use only together, with opposite signs, are a filter of noise.
HistoryFamily FamilyChoice::choose(const HistoryChoice& choice) {
  const double allowed = kWins * kWins * std::min(squareOf(HistoryFamily::kNone), correctedSquare());
  const auto better = [&](HistoryFamily family) {
    const bool part =
        squareOf(HistoryFamily::kPlays) <= allowed || squareOf(HistoryFamily::kMemories) <= allowed;
    return squareOf(family) <= allowed && (family != HistoryFamily::kBoth || part);
  };
  const auto wins = [&](HistoryFamily family) { return nowhereWorse(family) && better(family); };
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
    return told(choice.family, "as proposed; it wins on protocols that were left out");
  HistoryFamily best = HistoryFamily::kNone;
  for (const HistoryFamily family : kFamilies) {
    if (wins(family) && squareOf(family) < squareOf(best)) best = family;
  }
  if (best != HistoryFamily::kNone) return told(best, "the best on protocols that were left out");
  const bool none_wins = std::none_of(std::begin(kFamilies), std::end(kFamilies), better);
  return told(best, none_wins
                        ? "since no model of memory is better by 2 % on protocols that were left out"
                        : "since every model of memory is worse by more than 1 % on a protocol that was "
                          "left out");
}

}  // namespace

std::string whyNoProtocolIsLeftOut(std::size_t protocols) {
  const std::string why = protocols < 2 ? "all cycles of the bags have one protocol"
                                        : "no surface was recorded with two protocols";
  return why + ", so that no protocol can be left out; " + kWhatToRecord;
}

HistoryVerdict chooseHistory(const HistoryChoice& choice, const HistoryGrid& grid,
                             const std::vector<std::string>& names, const std::vector<LeftOutSums>& sums) {
  FamilyChoice families(grid, names, sums);
  HistoryVerdict verdict;
  if (!families.assessable()) return verdict;
  verdict.family = families.choose(choice);
  verdict.score = families.score();
  verdict.coefficients = families.coefficients(verdict.family);
  return verdict;
}

std::vector<HistoryScore::Protocol> familyErrors(const HistoryFolds& folds) {
  return FamilyChoice(folds.grid(), folds.protocols().names, folds.leaveOneOut()).score().protocols;
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
  const HistoryVerdict verdict = chooseHistory(choice, folds.grid(), protocols.names, folds.leaveOneOut());
  if (verdict.score.protocols.empty()) {
    refuse(protocols.names.size(), choice, calibration);
    return;
  }
  calibration.scores.history = verdict.score;
  if (verdict.family == HistoryFamily::kNone) return;
  calibration.history =
      historyModel(verdict.family, folds.grid(), fitHistory(verdict.family, folds.grid(), folds.whole()));
  const HistoryErrors errors = folds.errors(calibration.history, verdict.coefficients);
  errors.setDeviation(calibration.history);
  calibration.scores.history.parts = errors.parts();
}

}  // namespace fsr::calibration
