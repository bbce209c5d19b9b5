#pragma once

#include <fsr_pressure_map/CalibrationInfo.h>
#include <fsr_pressure_map/MatrixInfo.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dataset/time_series.h"
#include "exports/scan_record.h"
#include "ros/bags/bag_stream.h"
#include "ros/bags/sensor_topics.h"

namespace fsr_ros {

/// The topics by which an export finds a sensor: raw, or the maps.
std::vector<SensorTopics::Mark> sensorMarks(const std::string& map = "pressure_map");

/// The data of a bag other than its scans: chamber pressure and its cycles, temperature, board, session,
/// events and calibration. The bag is read once, from its beginning to its end.
class ScanContext {
 public:
  /// `ambient`: ambient pressure [Pa]; none = the value in matrix_info, or 101325 without one. Throws
  /// fsr::InputError.
  ScanContext(const BagStream& bag, const SensorTopics& topics, std::optional<double> ambient);

  const fsr_pressure_map::MatrixInfo& board() const { return board_; }
  const std::shared_ptr<const fsr::matrix::Surface>& firstSurface() const { return first_surface_; }
  /// Layout with the pitch in matrix_info, or the default pitch without one.
  fsr::matrix::Layout layout(fsr::matrix::MatrixSize size) const;
  /// Description of the recording, without its name and `maps`.
  fsr::exports::ExportSubject subject() const;
  static void describe(const fsr_pressure_map::CalibrationInfo& info, fsr::exports::ExportSubject& subject);

  /// Interpolated to a stamp [degree Celsius]; NaN = not known.
  double temperatureAt(std::int64_t stamp_ns) const;
  /// Fills in chamber pressure, session, cycle and event.
  void complete(fsr::exports::ScanRecord& scan) const;

 private:
  using Label = std::pair<std::int64_t, std::string>;  // stamp [ns], text that is valid from then on

  void readBoard(const BagStream& bag, const SensorTopics& topics);
  void readSeries(const BagStream& bag, const SensorTopics& topics);
  void readLabels(const BagStream& bag, const SensorTopics& topics);
  void findCycles(const std::vector<std::pair<std::int64_t, double>>& pressure);
  template <typename Message, typename Take>
  void forEach(const BagStream& bag, const SensorTopics& topics, const std::string& base, Take take);

  fsr_pressure_map::MatrixInfo board_;
  fsr_pressure_map::CalibrationInfo calibration_;
  double ambient_;  // [Pa]
  std::shared_ptr<const fsr::matrix::Surface> first_surface_;
  fsr::dataset::TimeSeries chamber_;  // absolute [Pa]
  fsr::dataset::TimeSeries temperature_;
  std::vector<std::int64_t> cycles_;  // stamp of the start of each cycle [ns]
  std::vector<Label> sessions_;
  std::vector<Label> events_;
};

}  // namespace fsr_ros
