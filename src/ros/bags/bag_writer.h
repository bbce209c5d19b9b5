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
#include "settings/replace_file.h"

namespace fsr_ros {

/// Closes a bag whose content is not needed. If the disk is full, rosbag::Bag::close() throws, and so does
/// the destructor, which would end the process. Such a bag is leaked instead of destroyed.
void abandonBag(std::unique_ptr<rosbag::Bag> bag) noexcept;

/// Abandons a bag so that nothing is written to its file any more. Otherwise the C library would write what
/// it still keeps when the process ends, into a file that others may have completed meanwhile.
void releaseFile(std::unique_ptr<rosbag::Bag> bag) noexcept;

/// Writes what the C library still keeps of a bag to its file, so that neither a kill nor a disk that fills
/// later can lose it. Throws rosbag::BagIOException.
void flushBag(rosbag::Bag& bag);

/// A bag to write. It has a temporary name until finish(), so that `path` is either the old file or the
/// complete new one. Throws fsr::InputError, which names the path and the cause, where the bag cannot be
/// written.
class FreshBag {
 public:
  explicit FreshBag(const std::string& path);
  /// Removes the temporary file unless finish() was called.
  ~FreshBag();
  FreshBag(const FreshBag&) = delete;
  FreshBag& operator=(const FreshBag&) = delete;

  /// Calls rosbag::Bag::write() with the arguments.
  template <typename... Arguments>
  void write(const Arguments&... arguments) {
    try {
      bag_->write(arguments...);
    } catch (const rosbag::BagException& error) {
      refuse(error.what());
    }
  }
  /// Closes the bag and gives it its name.
  void finish();

 private:
  [[noreturn]] void refuse(const std::string& why) const;

  std::string path_;
  fsr::settings::FreshPath fresh_;
  std::unique_ptr<rosbag::Bag> bag_;
};

/// Writes a bag of one sensor, with the topics and messages that the nodes publish. The bag has a temporary
/// name until close(), so that `path` is either the old file or the complete new one. Throws fsr::InputError
/// if the bag or a stamp cannot be written.
class BagWriter {
 public:
  /// `topics` is the namespace of the topics, `frame_id` the TF frame of the matrix.
  explicit BagWriter(const std::string& path, const std::string& topics = "fsr",
                     const std::string& frame_id = "fsr_matrix");
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// `stamp_ns` is both the header's stamp and the time of reception; it must be positive [ns]. A bag is
  /// written and read fastest if its messages are in time order.
  void addScan(std::int64_t stamp_ns, std::uint32_t sequence, const fsr::matrix::ScanView& scan);
  void addChamberPressure(std::int64_t stamp_ns, double absolute_pressure, double variance);  // [Pa]
  void addTemperature(std::int64_t stamp_ns, double temperature);  // [degree Celsius]
  void addSurface(std::int64_t stamp_ns, const fsr::matrix::Surface& surface);
  void addMatrixInfo(std::int64_t stamp_ns, fsr_pressure_map::MatrixInfo info);
  void addSession(std::int64_t stamp_ns, fsr_pressure_map::Session session);

  /// Writes a message with its own header. Defined for the message types of record.launch.
  template <typename Message>
  void add(const std::string& topic, const Message& message);

  /// Writes a message of another bag with its topic and time; replace() writes another message instead of it.
  void copy(const rosbag::MessageInstance& instance);
  template <typename Message>
  void replace(const rosbag::MessageInstance& instance, const Message& message);

  /// Closes the bag and gives it its final name.
  void close();

 private:
  template <typename Message>
  void write(const std::string& topic, std::int64_t stamp_ns, Message& message);

  std::string path_;
  std::string topics_;
  std::string frame_id_;
  FreshBag bag_;
};

/// Values that a bag holds in addition to a Recording.
struct BagOptions {
  std::string topics = "fsr";         ///< namespace of the topics
  double ambient_pressure = 101325;   ///< added to the gauge pressures [Pa]
  double pressure_variance = 0;       ///< variance of the chamber's transducer, 0 = unknown [Pa^2]
  double reference_voltage = 0;       ///< reference voltage of the converter, 0 = unknown [V]
  double feedback_resistance = 0;     ///< feedback resistance of the read-out, 0 = unknown [ohm]
  fsr_pressure_map::Session session;  ///< written if it has a session_id
};

/// Writes a recording as a bag. Description, surface and session are written at the first scan and once a
/// second, as the nodes repeat them, the surface also when it changes. Each scan has one chamber pressure and
/// one temperature if the recording has them. Throws fsr::InputError.
void writeBag(const std::string& path, const fsr::dataset::Recording& recording,
              const BagOptions& options = {});

}  // namespace fsr_ros
