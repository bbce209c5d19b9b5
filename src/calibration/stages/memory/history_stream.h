#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "calibration/stages/memory/history_fit.h"
#include "calibration/stages/session/session_rests.h"
#include "dataset/count_readers.h"
#include "dataset/protocols.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::calibration {

/// The parts in which errors of a model of the sheet's memory are stated: all readings, loading, unloading,
/// and seven by the time since the chamber last changed its direction.
constexpr std::size_t kHistoryParts = 10;

/// The parts of a reading: all, its direction (where that is unknown, its time twice) and its time.
std::array<std::size_t, 3> historyPartsOf(statistics::LoadDirection direction, double since_reversal);

/// "all readings", "loading", "1 to 3 s since the reversal" ...
std::string historyPartName(std::size_t part);

/// The static answers of one taxel on one curvature class.
struct StaticAnswer {
  std::vector<double> pressure;  ///< of each code [Pa]; empty = the class has no answer
  std::uint16_t lowest = 0;      ///< code of training
  std::uint16_t highest = 0xffff;
  double lowest_pressure = -std::numeric_limits<double>::infinity();  ///< of training [Pa]
  double highest_pressure = std::numeric_limits<double>::infinity();

  bool trained(std::uint16_t code, double chamber) const {
    return code >= lowest && code <= highest && chamber >= lowest_pressure && chamber <= highest_pressure;
  }
};

/// The operators of one taxel along the recordings of a training, see HistoryStream::run().
struct HistoryCourse {
  std::vector<double> state, open;  ///< [operators]
  HistoryTaxel taxel;
  double before = 0;          ///< time of the scan before [s]
  std::int64_t start_ns = 0;  ///< of the recording whose time it is
  double zero = 0;            ///< that a tare subtracts on the last surface [Pa]
};

/// The scans of one recording in the order of time, as the operators of a history model meet them.
class HistoryStream {
  template <typename T>
  using Spool = dataset::RowSpool<T>;
  using Step = HistoryOperators::Step;

 public:
  struct Scan {
    std::uint32_t number = 0;    ///< in the recording
    std::uint32_t protocol = 0;  ///< dataset::Protocols::kOther: of none
    std::uint8_t part = 0;       ///< of the protocol, see dataset::Protocols
    std::uint32_t row = 0;       ///< scans of one row lie within half a second of one protocol
    bool sampled = false;        ///< at least one scan in 0.1 s is
    std::uint16_t curvature_class = 0;
    bool starts = false;        ///< nothing is known of the readings before
    double since_reversal = 0;  ///< time since the chamber changed its direction [s]
  };

  /// The arguments but `grid` and `protocols` must outlive the object. `number`: of the recording among those
  /// of `protocols`. `classes`: of the conditions of this recording.
  /// `lies_on`: since the recording before, see dataset::sheetLayOn().
  /// `sessions`: where the operators meet the static answer after a tare, those of this recording.
  HistoryStream(const dataset::Recording& recording, std::size_t number,
                const std::vector<std::size_t>& classes, const dataset::Sections& sections,
                const dataset::Protocols& protocols, const HistoryGrid& grid, bool lies_on,
                std::vector<Session> sessions = {});

  const dataset::Recording& recording() const { return *recording_; }
  std::size_t number() const { return number_; }
  const dataset::Sections& sections() const { return *sections_; }
  template <typename Visit>
  void forEachScan(Visit&& visit) const {
    Spool<Scan>::Reader scans(scans_);
    for (std::size_t k = 0; k < scans_.rows(); ++k) visit(*scans[k]);
  }

  /// Drives the operators with the static answers of one taxel, as the live map does, and calls
  /// visit(scan, x, state, open) for each scan that counts; see HistoryOperators for `state` and `open`.
  /// Codes at full scale are left out. Codes and pressures beyond those of training drive the operators, but
  /// do not count: a table says nothing there. `course`: that of the taxel in the stream before, with the
  /// same answers; it goes on where the sheet lay on.
  template <typename Visit>
  void run(std::size_t taxel, const std::vector<StaticAnswer>& answers, HistoryCourse& course,
           Visit&& visit) const {
    begin(course);
    auto& [state, open, own, before, start_ns, zero] = course;
    std::vector<Step> spell(operators_.memories());
    const std::vector<double> zeros = zerosOf(taxel, answers, zero);
    const auto over = [&](double duration) {
      operators_.stepsOver(duration, spell.data());
      return spell.data();
    };
    dataset::TaxelCounts counts(*recording_, taxel);
    Spool<Scan>::Reader scans(scans_);
    Spool<Step>::Reader steps(steps_);
    for (std::size_t k = 0; k < scans_.rows(); ++k) {
      const Scan& scan = *scans[k];
      if (scan.starts) own.known = HistoryTaxel::Known::kNothing;
      const double time = recording_->time[scan.number], pressure = recording_->pressure[scan.number];
      const std::uint16_t code = counts[scan.number];
      const StaticAnswer& answer = answers[scan.curvature_class];
      const double last_time = std::exchange(before, time);
      if (answer.pressure.empty()) continue;
      const double x = answer.pressure[code] - zeros[recording_->condition[scan.number]];
      if (code >= recording_->full_scale) {
        own.limit = x;
        own.limited_at = time;
        continue;
      }
      const Step* step = operators_.memories() > 0 ? steps[k] : nullptr;
      if (k == 0) step = over(time - own.at);  // its scan before is one of another recording
      operators_.meet(own, x, time, last_time, step, over, state.data(), open.data());
      if (!own.open) std::fill(open.begin(), open.end(), 0.0);
      if (answer.trained(code, pressure)) visit(scan, x, state.data(), open.data());
    }
  }

 private:
  bool starts(std::size_t scan, std::size_t before) const;
  void begin(HistoryCourse& course) const;
  std::vector<double> zerosOf(std::size_t taxel, const std::vector<StaticAnswer>& answers,
                              double& last) const;

  const dataset::Recording* recording_;
  std::size_t number_;
  const dataset::Sections* sections_;
  HistoryOperators operators_;
  bool lies_on_;
  std::vector<Session> sessions_;
  Spool<Scan> scans_;
  Spool<Step> steps_;  // [scans x memories]
};

/// The streams of all recordings in the order of time. The arguments are those of HistoryStream, for each
/// recording.
std::vector<HistoryStream> historyStreams(const std::vector<dataset::Recording>& recordings,
                                          const std::vector<std::vector<std::size_t>>& classes,
                                          const std::vector<dataset::Sections>& sections,
                                          const dataset::Protocols& protocols, const HistoryGrid& grid,
                                          const Sessions* sessions = nullptr);

/// Limits the answers of each class [classes] to the pressures of the scans that are not of `left_out`.
void setTrainedPressures(const std::vector<HistoryStream>& streams, std::size_t left_out,
                         std::vector<StaticAnswer>& answers);

/// Sums of readings of the protocols that the tables were trained on, and of each part of the protocol that
/// was left out.
struct LeftOutSums {
  explicit LeftOutSums(std::size_t features) : trained(features) {}

  HistorySums trained;
  std::vector<HistorySums> left_out;  ///< [parts], see dataset::Protocols

  /// The sums of the part, which is made if it is not there.
  HistorySums& part(std::size_t number);
  /// Those of a scan.
  HistorySums& of(const HistoryStream::Scan& scan, std::size_t protocol_left_out) {
    return scan.protocol == protocol_left_out ? part(scan.part) : trained;
  }
  void finish();
  /// Both must be finished.
  void merge(const LeftOutSums& other);
};

/// What the sums of a training hold: readings, one in 0.1 s, with the noise that a weight lets through; or
/// their means over half a second, in which white noise, which is no memory, counts little.
enum class HistoryRows { kReadings, kMeans };

/// The sums to which a scan is added.
using SumsOfScan = std::function<HistorySums&(const HistoryStream::Scan&)>;

/// Adds the readings of one taxel in one recording. `answers` [classes]; `course`: see HistoryStream::run().
/// finish() must follow the last recording.
void addHistoryRows(const HistoryStream& stream, const HistoryGrid& grid, std::size_t taxel,
                    const std::vector<StaticAnswer>& answers, HistoryRows rows, HistoryCourse& course,
                    const SumsOfScan& sums_of);

}  // namespace fsr::calibration
