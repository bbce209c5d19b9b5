#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "calibration/stages/memory/history_fit.h"
#include "calibration/stages/memory/history_stream.h"
#include "calibration/stages/memory/history_training.h"
#include "calibration/stages/tables/training_scans.h"
#include "dataset/protocols.h"
#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// Errors of the readings of protocols that were left out, of the static answer and with a history model.
class HistoryErrors {
 public:
  /// `highest`: largest pressure of the bags [Pa]. `known`: a reading whose open deviation is not larger
  /// counts for the deviations of the model [Pa]. `protocols`: number of those that were left out.
  HistoryErrors(double highest, double known, std::size_t protocols);

  struct Reading {
    double static_answer = 0;  ///< [Pa]
    double answer = 0;         ///< [Pa]
    double truth = 0;          ///< [Pa]
    double open = 0;           ///< deviation from what is not known of the operators [Pa]
    bool unloading = false;    ///< as the model sees it, see HistoryModel
    statistics::LoadDirection direction = statistics::LoadDirection::kNone;  ///< of the chamber
    double since_reversal = 0;                                               ///< [s]
    std::size_t protocol = 0;  ///< number of the one that was left out
  };
  void add(const Reading& reading);
  void merge(const HistoryErrors& other);

  /// The deviations of a model: in each bin of its answer and each direction the absolute error that, in the
  /// mean over protocols, 68.27 % of the readings do not exceed: a new recording is of one protocol, and the
  /// long ones of training tell no more of it. Bins without readings take that of their neighbour.
  void setDeviation(HistoryModel& model) const;

  /// All readings; loading and unloading; by time since the last reversal. Parts without readings are absent.
  std::vector<HistoryScore::Part> parts() const;

 private:
  static constexpr std::size_t kBins = 12;     // of the answer, in each direction
  static constexpr std::size_t kLevels = 256;  // of the absolute error, evenly spaced in its logarithm

  // Readings by what the error has beyond its open deviation; loading, then unloading.
  using Counts = std::array<std::array<std::uint64_t, kLevels>, 2 * kBins>;
  struct Sum {
    std::uint64_t readings = 0;
    double static_square = 0, square = 0;  // [Pa^2]
    Counts errors = {};
  };
  static void addCounts(const Counts& other, Counts& counts);

  std::size_t bin(const Reading& reading) const;
  std::vector<double> deviation(std::size_t first_bin) const;
  double quantile(std::size_t bin) const;
  double level(std::size_t number) const;

  double highest_, known_;
  std::vector<Sum> parts_;
  std::vector<Counts> known_errors_;  // [protocols], those that count for the deviations
};

/// The bags of a training, divided by protocol: each protocol in turn is answered by tables that were trained
/// without it. The results do not depend on the number of threads.
class HistoryFolds {
 public:
  /// All arguments must outlive the object. `calibration` must have its tables.
  HistoryFolds(const HistoryProblem& problem, const dataset::Protocols& protocols, unsigned threads,
               const Calibration& calibration);

  const HistoryGrid& grid() const { return grid_; }
  const dataset::Protocols& protocols() const { return protocols_; }

  /// The readings of all taxels, [protocols].
  std::vector<LeftOutSums> leaveOneOut() const;
  /// With the tables of the calibration, which know all protocols: no difference between sessions hides what
  /// the readings before do. [protocols + 1], the last of scans of no protocol; nothing is `trained`.
  std::vector<LeftOutSums> withAllTables(HistoryRows rows) const;

  /// Limits the change of a model of these coefficients to that of training.
  void setLimits(const Eigen::VectorXd& coefficients, const std::vector<double>& spreads,
                 HistoryModel& model) const;

  /// Errors of the readings of each protocol, predicted without it. `coefficients` [protocols] were trained
  /// without the protocol, `model` on all of them. `spreads`: see memorySpreads(). `known`: see
  /// HistoryErrors.
  HistoryErrors errors(const HistoryModel& model, const std::vector<Eigen::VectorXd>& coefficients,
                       const std::vector<double>& spreads, double known) const;

 private:
  using Answers = std::vector<StaticAnswer>;  // of one taxel, [classes]

  std::size_t count() const { return protocols_.names.size(); }
  std::vector<Answers> answersWithoutEach(std::size_t taxel) const;
  Answers answersOfTables(std::size_t taxel) const;
  void addRows(std::size_t taxel, const Answers& answers, HistoryRows rows, const SumsOfScan& sums_of) const;
  template <typename Fill>
  std::vector<LeftOutSums> sumsOf(std::size_t number, Fill&& fill) const;
  OpenDeviation openDeviation(const Eigen::VectorXd& coefficients, const std::vector<double>& spreads) const;
  template <typename Visit>
  void forEachChange(std::size_t taxel, const Answers& answers, const Eigen::VectorXd& coefficients,
                     const OpenDeviation& open_deviation, Visit&& visit) const;
  void addErrors(std::size_t taxel, const Answers& answers, std::size_t protocol, std::size_t first_operator,
                 const Eigen::VectorXd& coefficients, const OpenDeviation& open_deviation,
                 HistoryErrors& errors) const;
  std::size_t firstOperator(const HistoryModel& model) const;
  template <typename Work>
  void forEachModelledTaxel(Work&& work) const;

  const HistoryProblem& problem_;
  const dataset::Protocols& protocols_;
  unsigned threads_;
  const Calibration& calibration_;
  HistoryGrid grid_;
  std::vector<HistoryStream> streams_;
  std::vector<Answers> limits_;  // [protocols][classes], the pressures of training alone
  TrainingScans scans_;          // the section of a scan is its protocol; the last one is of no protocol
};

}  // namespace fsr::calibration
