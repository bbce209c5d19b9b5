#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "calibration/stages/memory/history_fit.h"
#include "calibration/stages/session/session_rests.h"
#include "dataset/count_readers.h"
#include "dataset/protocols.h"
#include "dataset/sections.h"
#include "dataset/unnamed_file.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace fsr::calibration {

/// The static answers of one taxel on one curvature class.
struct StaticAnswer {
  std::vector<double> pressure;  ///< of each code [Pa]; empty = the class has no answer
  std::uint16_t lowest = 0;      ///< code of training
  std::uint16_t highest = 0xffff;
};

/// The scans of one recording in the order of time, as the operators of a history model meet them.
class HistoryStream {
 public:
  struct Scan {
    std::uint32_t number = 0;    ///< in the recording
    std::uint32_t protocol = 0;  ///< dataset::Protocols::kOther: of none
    std::uint32_t row = 0;       ///< scans of one row lie within half a second of one protocol
    std::uint16_t curvature_class = 0;
    bool starts = false;        ///< nothing is known of the readings before
    bool settled = false;       ///< counts: the memories no longer depend on the start
    double since_reversal = 0;  ///< time since the chamber changed its direction [s]
  };

  /// The arguments but `grid` must outlive the object. `classes`: of the conditions of this recording.
  /// `sessions`: where the operators meet the static answer after a tare, those of this recording.
  HistoryStream(const dataset::Recording& recording, const std::vector<std::size_t>& classes,
                const dataset::Sections& sections, const std::vector<std::uint32_t>& protocol,
                const HistoryGrid& grid, std::vector<Session> sessions = {});

  const dataset::Recording& recording() const { return *recording_; }
  const dataset::Sections& sections() const { return *sections_; }

  /// Drives the operators with the static answers of one taxel and calls visit(scan, x, state) for each scan
  /// that counts. Codes at full scale are left out. Codes beyond those of training drive the operators, but
  /// do not count: a table says nothing there.
  template <typename Visit>
  void run(std::size_t taxel, const std::vector<StaticAnswer>& answers, Visit&& visit) const {
    std::vector<double> state(operators_.size());
    const std::vector<double> zeros = zerosOf(taxel, answers);
    double last = 0;
    bool known = false;
    dataset::TaxelCounts counts(*recording_, taxel);
    Spool<Scan>::Reader scans(scans_);
    Spool<Step>::Reader steps(steps_);
    for (std::size_t k = 0; k < scans_.rows(); ++k) {
      const Scan& scan = *scans[k];
      known = known && !scan.starts;
      const std::uint16_t code = counts[scan.number];
      const StaticAnswer& answer = answers[scan.curvature_class];
      if (answer.pressure.empty() || code >= recording_->full_scale) continue;
      const double x = answer.pressure[code] - zeros[recording_->condition[scan.number]];
      if (known) {
        operators_.advance(last, x, operators_.memories() > 0 ? steps[k] : nullptr, state.data());
      } else {
        operators_.start(x, state.data());
      }
      known = true;
      last = x;
      const bool trained = code >= answer.lowest && code <= answer.highest;
      if (scan.settled && trained) visit(scan, x, state.data());
    }
  }

 private:
  template <typename T>
  using Spool = dataset::RowSpool<T>;
  using Step = rheology::ExponentialMemory::Step;

  bool starts(std::size_t scan, std::size_t before) const;
  std::vector<double> countsFrom(double settling_time) const;
  std::vector<double> zerosOf(std::size_t taxel, const std::vector<StaticAnswer>& answers) const;

  const dataset::Recording* recording_;
  const dataset::Sections* sections_;
  HistoryOperators operators_;
  std::vector<Session> sessions_;
  Spool<Scan> scans_;
  Spool<Step> steps_;  // [scans x memories]
};

/// Sums of readings of the protocols that the tables were trained on, and of the protocol that was left out.
struct LeftOutSums {
  HistorySums trained, left_out;
};

/// Adds the readings of one taxel in one recording, in means over half a second. `answers` [classes] were
/// trained without the protocol `left_out`. `judged` [scans]: the pressures of that protocol [Pa]; null =
/// those of the recording. finish() must follow the last recording.
void addHistoryRows(const HistoryStream& stream, const HistoryGrid& grid, std::size_t taxel,
                    const std::vector<StaticAnswer>& answers, std::size_t left_out, LeftOutSums& sums,
                    const std::vector<double>* judged = nullptr);

}  // namespace fsr::calibration
