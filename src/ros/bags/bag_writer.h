#pragma once

#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/Session.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>

#include <cstdint>
#include <memory>
#include <string>

#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/matrix/curvature.h"
#include "fsr_pressure_map/matrix/scan.h"

namespace fsr_ros {

/// A bag of one sensor, with the topics and messages that the nodes would have recorded. It is
/// written under a temporary name: at `path` there is the old file or the whole new one. Where a bag
/// or a stamp cannot be written, fsr::InputError says why.
class BagWriter {
 public:
  /// `topics` is the namespace of the topics, `frame_id` the matrix frame.
  explicit BagWriter(const std::string& path, const std::string& topics = "fsr",
                     const std::string& frame_id = "fsr_matrix");
  /// Without close() nothing remains.
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// Stamps are of the header and of the bag alike, and positive [ns]. The bag grows fastest and reads
  /// fastest where they come in time order.
  void addScan(std::int64_t stamp_ns, std::uint32_t sequence, const fsr::matrix::ScanView& scan);
  void addChamberPressure(std::int64_t stamp_ns, double absolute_pressure, double variance);  // [Pa]
  void addTemperature(std::int64_t stamp_ns, double temperature);  // [degree Celsius]
  void addSurface(std::int64_t stamp_ns, const fsr::matrix::Surface& surface);
  void addMatrixInfo(std::int64_t stamp_ns, fsr_pressure_map::MatrixInfo info);
  void addSession(std::int64_t stamp_ns, fsr_pressure_map::Session session);

  /// A message as it stands, with its own header; defined for those of record.launch.
  template <typename Message>
  void add(const std::string& topic, const Message& message);

  /// A message of another bag, with its topic and time; and one in its place.
  void copy(const rosbag::MessageInstance& instance);
  template <typename Message>
  void replace(const rosbag::MessageInstance& instance, const Message& message);

  /// Gives the bag its name.
  void close();

 private:
  template <typename Message>
  void write(const std::string& topic, std::int64_t stamp_ns, Message& message);
  template <typename Write>
  void attempt(Write write);

  std::string path_;
  std::string fresh_;  // the temporary name
  std::string topics_;
  std::string frame_id_;
  std::unique_ptr<rosbag::Bag> bag_;
};

/// What a bag says beside a Recording.
struct BagOptions {
  std::string topics = "fsr";         ///< namespace of the topics
  double ambient_pressure = 101325;   ///< added to the gauge pressures [Pa]
  double pressure_variance = 0;       ///< of the chamber's transducer, 0 = unknown [Pa^2]
  double reference_voltage = 0;       ///< of the converter, 0 = unknown [V]
  double feedback_resistance = 0;     ///< of the read-out, 0 = unknown [ohm]
  fsr_pressure_map::Session session;  ///< written where it has a session_id
};

/// Description, surface and session at the first scan, at each change and once a second, as the nodes
/// repeat them; one chamber pressure and one temperature for each scan, where the Recording has them.
/// Throws fsr::InputError.
void writeBag(const std::string& path, const fsr::dataset::Recording& recording,
              const BagOptions& options = {});

}  // namespace fsr_ros
