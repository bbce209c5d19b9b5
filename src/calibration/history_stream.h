#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "calibration/session/session_rests.h"
#include "compensation/history_fit.h"
#include "dataset/protocols.h"
#include "dataset/sections.h"
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
    std::size_t number = 0;  ///< in the recording
    std::uint32_t curvature_class = 0;
    std::uint32_t protocol = 0;  ///< dataset::Protocols::kOther: of none
    std::uint32_t row = 0;       ///< scans of one row lie within half a second of one protocol
    bool starts = false;         ///< nothing is known of the readings before
    bool settled = false;        ///< counts: the memories no longer depend on the start
    double since_reversal = 0;   ///< time since the chamber changed its direction [s]
  };

  /// The arguments but `grid` must outlive the object. `classes`: of the conditions of this recording.
  /// `sessions`: where the operators meet the static answer after a tare, those of this recording.
  HistoryStream(const dataset::Recording& recording, const std::vector<std::size_t>& classes,
                const dataset::Sections& sections, const std::vector<std::uint32_t>& protocol,
                const compensation::HistoryGrid& grid, std::vector<Session> sessions = {});

  const std::vector<Scan>& scans() const { return scans_; }
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
    for (std::size_t k = 0; k < scans_.size(); ++k) {
      const Scan& scan = scans_[k];
      known = known && !scan.starts;
      const std::uint16_t code = recording_->scan(scan.number)[taxel];
      const StaticAnswer& answer = answers[scan.curvature_class];
      if (answer.pressure.empty() || code >= recording_->full_scale) continue;
      const double x = answer.pressure[code] - zeros[recording_->condition[scan.number]];
      if (known) {
        operators_.advance(last, x, steps_.data() + k * operators_.memories(), state.data());
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
  void markSettled(double settling_time);
  std::vector<double> zerosOf(std::size_t taxel, const std::vector<StaticAnswer>& answers) const;

  const dataset::Recording* recording_;
  const dataset::Sections* sections_;
  compensation::HistoryOperators operators_;
  std::vector<Session> sessions_;
  std::vector<Scan> scans_;
  std::vector<rheology::ExponentialMemory::Step> steps_;  // [scans x memories]
};

/// Sums of readings of the protocols that the tables were trained on, and of the protocol that was left out.
struct LeftOutSums {
  compensation::HistorySums trained, left_out;
};

/// Adds the readings of one taxel in one recording, in means over half a second. `answers` [classes] were
/// trained without the protocol `left_out`. `judged` [scans]: the pressures of that protocol [Pa]; null =
/// those of the recording. finish() must follow the last recording.
void addHistoryRows(const HistoryStream& stream, const compensation::HistoryGrid& grid, std::size_t taxel,
                    const std::vector<StaticAnswer>& answers, std::size_t left_out, LeftOutSums& sums,
                    const std::vector<double>* judged = nullptr);

}  // namespace fsr::calibration
