#pragma once

#include <cstddef>
#include <vector>

#include "calibration/history_errors.h"
#include "calibration/history_stream.h"
#include "calibration/history_training.h"
#include "calibration/training_scans.h"
#include "compensation/history_fit.h"
#include "dataset/protocols.h"

namespace fsr::calibration {

/// The bags of a training, divided by protocol: each protocol in turn is answered by tables that were trained
/// without it. The results do not depend on the number of threads.
class HistoryFolds {
 public:
  /// All arguments but `judged` must outlive the object. `calibration` must have its tables. `judged`: the
  /// pressures that scans have where their protocol is left out [recordings][scans] [Pa]; empty = those of
  /// the recordings.
  HistoryFolds(const HistoryProblem& problem, const dataset::Protocols& protocols, unsigned threads,
               const Calibration& calibration, std::vector<std::vector<double>> judged = {});

  const compensation::HistoryGrid& grid() const { return grid_; }
  const dataset::Protocols& protocols() const { return protocols_; }

  using Sums = LeftOutSums;
  /// Of all taxels, [protocols].
  std::vector<Sums> leaveOneOut() const;
  /// With the tables of the calibration, which were trained on all protocols.
  compensation::HistorySums whole() const;

  /// Errors of the readings of each protocol, predicted without it. `coefficients` [protocols] were trained
  /// without the protocol, `model` on all of them.
  HistoryErrors errors(const compensation::HistoryModel& model,
                       const std::vector<Eigen::VectorXd>& coefficients) const;

 private:
  using Answers = std::vector<StaticAnswer>;  // of one taxel, [classes]

  std::size_t count() const { return protocols_.names.size(); }
  std::vector<Answers> answersWithoutEach(std::size_t taxel) const;
  Answers answersOfTables(std::size_t taxel) const;
  void addRows(std::size_t taxel, const Answers& answers, std::size_t left_out, Sums& sums) const;
  void addErrors(std::size_t taxel, const Answers& answers, std::size_t protocol, std::size_t first_operator,
                 const Eigen::VectorXd& coefficients, HistoryErrors& errors) const;
  std::size_t firstOperator(const compensation::HistoryModel& model) const;
  template <typename Work>
  void forEachModelledTaxel(Work&& work) const;

  const HistoryProblem& problem_;
  const dataset::Protocols& protocols_;
  unsigned threads_;
  const Calibration& calibration_;
  std::vector<std::vector<double>> judged_;
  compensation::HistoryGrid grid_;
  std::vector<HistoryStream> streams_;
  TrainingScans scans_;  // the section of a scan is its protocol; the last one is of no protocol
};

}  // namespace fsr::calibration
