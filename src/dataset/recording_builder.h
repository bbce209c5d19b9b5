#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dataset/count_readers.h"
#include "dataset/time_series.h"
#include "dataset/unsound_spans.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/scan.h"

namespace fsr::dataset {

/// The surfaces of a matrix over time. A surface is valid from its stamp to the next one's. The first is
/// valid before its stamp too, because surfaces are repeated each second. The result does not depend on the
/// order of the events.
class SurfaceTimeline {
 public:
  using Event = std::pair<std::int64_t, matrix::Surface>;  ///< stamp [ns]

  /// Surfaces of the same name and mount whose curvatures differ by less than `tolerance` [1/m] at every
  /// taxel are one condition. Where no curvature is known, there is one condition of unknown curvature and no
  /// change.
  SurfaceTimeline(std::vector<Event> events, double tolerance);

  /// In the order of their first appearance.
  const std::vector<matrix::Surface>& conditions() const { return conditions_; }
  bool anyKnown() const { return conditions_.size() > 1 || conditions_.front().known(); }
  /// Index of the condition that is valid at a stamp.
  std::size_t at(std::int64_t stamp_ns) const;
  /// Whether the surface changes within `margin_ns` [ns] before or after the stamp.
  bool nearChange(std::int64_t stamp_ns, std::int64_t margin_ns) const;

 private:
  using Entry = std::pair<std::int64_t, std::size_t>;

  std::size_t conditionOf(const matrix::Surface& surface, double tolerance);
  std::vector<Entry>::const_iterator after(std::int64_t stamp_ns) const;

  std::vector<matrix::Surface> conditions_;
  std::vector<Entry> from_;  // where each condition begins; never empty
};

/// Description of a matrix (MatrixInfo.msg).
struct MatrixDescription {
  SensorIdentity sensor;
  matrix::Layout layout;
  std::uint16_t full_scale = 0;
  double ambient_pressure = 0;     ///< where it was recorded; 0 = unknown [Pa]
  std::vector<std::uint8_t> mask;  ///< 1 = ignore this taxel; empty = none
};

struct RecordingOptions {
  std::string name;    ///< base name of the bag
  std::string sha256;  ///< of the bag's bytes
  /// Ambient pressure [Pa]. Where it is not given, that of the matrix's description is used, else
  /// kStandardAmbient with a warning.
  std::optional<double> ambient_pressure;
  double change_margin = 1.0;          ///< scans this close to a change of surface are dropped [s]
  double longest_reference_gap = 2.0;  ///< between chamber readings farther apart nothing is interpolated [s]
  /// Surfaces of the same name and mount whose curvatures differ by less than this at every taxel are one
  /// condition, because a measured curvature scatters [1/m].
  double same_curvature = 0.1;
};

constexpr double kStandardAmbient = 101325.0;  // [Pa]

/// Makes a Recording from raw events of a bag or of live topics. The order of the calls does not matter.
///
/// Events are sorted by their own stamps. Of scans with the same stamp one is kept. The chamber pressure is
/// interpolated to the scans; gauge = absolute - ambient. A surface is valid from its stamp to the next
/// surface's, the first one also before its stamp. Scans close to a change of surface are dropped, and so are
/// those that are not the sheet under the recorded pressure (unsound/unsound_spans.h). Receive times are not
/// used.
class RecordingBuilder {
 public:
  /// Numbers of events that were added.
  struct Events {
    std::uint64_t scans = 0;
    std::uint64_t chamber_pressures = 0;
    std::uint64_t surfaces = 0;
    std::uint64_t temperatures = 0;
    std::uint64_t descriptions = 0;
  };

  /// Throws InputError where the scan is malformed or from another matrix than the scans before it.
  void addScan(std::int64_t stamp_ns, std::uint32_t sequence, const matrix::ScanView& scan);
  void addChamberPressure(std::int64_t stamp_ns, double absolute_pressure);  // [Pa]
  void addSurface(std::int64_t stamp_ns, const matrix::Surface& surface);
  void addTemperature(std::int64_t stamp_ns, double temperature);  // [degree Celsius]
  void addDescription(std::int64_t stamp_ns, const MatrixDescription& description);
  /// An event `step` or `reject`.
  void addAttemptEnd(const AttemptEnd& end) { attempt_ends_.push_back(end); }

  /// From `most` bytes on the counts are kept in a file, also those of the recording that is made from them
  /// (Recording::count_file). Before the first scan.
  explicit RecordingBuilder(std::size_t most = RowSpool<std::uint16_t>::kUnlimited) : counts_(most) {}

  /// So many scans will be added: one allocation instead of growing. `most`: at most these bytes of counts.
  void expectScans(std::uint64_t scans, std::uint64_t most) {
    expected_scans_ = scans;
    most_bytes_ = most;
  }

  /// Adds all events of another builder. Throws as addScan().
  void append(const RecordingBuilder& other);

  const Events& events() const { return events_; }
  void clear() { *this = RecordingBuilder(counts_.most()); }

  /// Throws InputError where there is no scan, or where descriptions, surfaces and scans do not belong to the
  /// same matrix. A recording without chamber pressure or surfaces is accepted; functions that need them
  /// check.
  Recording build(const RecordingOptions& options) const;
  /// The same with the builder's memory instead of a copy of the counts. The builder is empty afterwards.
  Recording take(const RecordingOptions& options);

 private:
  struct ScanEvent {
    std::int64_t stamp_ns;
    std::uint32_t sequence;
    float reading;       // mean of all taxels [counts]
    std::size_t number;  // in counts_
  };
  using DescriptionEvent = std::pair<std::int64_t, MatrixDescription>;

  // Drops the scans of `kept` that are not the sheet under the pressure at them. `kept`: indices into
  // `scans`.
  void dropUnsound(const std::vector<ScanEvent>& scans, std::vector<std::size_t>& kept,
                   Recording& recording) const;
  // Calls keep(number in counts_) for each scan that is kept, in order of time, and returns the recording
  // without counts.
  Recording assemble(const RecordingOptions& options, const std::function<void(std::size_t)>& keep) const;
  // build() where the counts are in a file, and in the recording, too.
  Recording buildFile(const RecordingOptions& options) const;
  bool inOrderOfTime() const;
  std::vector<ScanEvent> sortedScans(RecordingLosses& losses) const;
  // Counts the gaps between scans, and names the longest time without one.
  static void findGaps(const std::vector<ScanEvent>& scans, Recording& recording);
  std::vector<std::size_t> spikesOf(const TimeSeries& reference, const std::vector<ScanEvent>& scans) const;
  // The earliest description; null where there is none. Throws InputError where descriptions and scans
  // differ.
  const MatrixDescription* description() const;
  Recording emptyRecording(const RecordingOptions& options) const;
  double ambient(const RecordingOptions& options, std::vector<std::string>& warnings) const;

  matrix::MatrixSize size_;
  std::uint16_t full_scale_ = 0;
  std::vector<ScanEvent> scans_;
  RowSpool<std::uint16_t> counts_;  // of all scans, in the order of the calls
  TimeSeries chamber_pressure_;
  TimeSeries temperature_;
  std::vector<SurfaceTimeline::Event> surfaces_;
  std::vector<DescriptionEvent> descriptions_;
  std::vector<AttemptEnd> attempt_ends_;
  Events events_;
  std::uint64_t expected_scans_ = 0, most_bytes_ = 0;
};

}  // namespace fsr::dataset
