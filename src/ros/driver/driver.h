#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <std_srvs/SetBool.h>

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "protocol/board_reader.h"
#include "protocol/device_clock.h"
#include "ros/driver/driver_health.h"
#include "ros/live/parameters.h"
#include "ros/messages/driver_messages.h"

namespace fsr_ros {

/// Reads a board and publishes `raw`, `chamber_pressure`, `temperature`, `events` (edges at its trigger
/// input), `matrix_info` (latched and repeated each second) and diagnostics. The service `~set_enabled`
/// closes and opens the port. Parameters: DriverSettings.
///
/// Packets are published from the thread of the link as they come, as shared pointers, so that nodelets of
/// one manager receive them without a copy. Everything else runs in the callback queue of the node.
///
/// In simulated time the host time is the last value of /clock. Stamps are then rig time, as evenly spaced as
/// the board made the scans, and early by about half a tick of /clock (see fsr::protocol::DeviceClock).
class Driver : private fsr::protocol::LinkHandler {
 public:
  /// Throws fsr::InputError for parameters and files that cannot be used. If the port does not exist, the
  /// driver waits for it.
  Driver(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle);

 private:
  void onScan(const fsr::protocol::PacketHeader& header, const fsr::protocol::ScanPacket& scan) override;
  void onTransducer(const fsr::protocol::PacketHeader& header, std::int32_t counts) override;
  void onTemperature(const fsr::protocol::PacketHeader& header, std::int32_t millidegrees) override;
  void onIdentity(const fsr::protocol::PacketHeader& header,
                  const fsr::protocol::IdentityPacket& identity) override;
  void onTrigger(const fsr::protocol::PacketHeader& header,
                 const fsr::protocol::TriggerPacket& trigger) override;
  void onOpen(std::uint32_t baud) override;
  void onBytes(std::int64_t receive_time) override;
  void onChange(const fsr::protocol::LinkReport& report) override;

  bool isExpected(fsr::matrix::MatrixSize size) const;
  void publishScan(const fsr_pressure_map::MatrixFramePtr& message);
  void releaseHeld();
  void reportJump(const fsr::protocol::ClockJump& jump);
  void doubtBoard();
  void note(const Board& board);
  void publishInfo();
  bool setEnabled(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  void look();
  void logComplaint();
  Board board() const;
  DriverHealth health() const;

  ros::NodeHandle handle_;
  ros::NodeHandle private_handle_;
  DriverSettings settings_;
  ros::Publisher raw_;
  ros::Publisher pressure_;
  ros::Publisher temperature_;
  ros::Publisher events_;
  ros::Publisher info_;
  // Used by the thread of the link only:
  fsr::protocol::PacketStamper stamper_;
  fsr::protocol::BoardGate gate_;
  std::vector<fsr_pressure_map::MatrixFramePtr> held_;  // scans of a board that has not sent its identity
  std::uint64_t all_jumps_ = 0;                         // small ones included
  std::uint64_t jumps_ = 0;                             // jumps of the board's clock so far
  bool fault_logged_ = false;                           // an exception of this handler was logged
  std::int64_t arrival_ = 0;                            // time of arrival of the current bytes [ns]

  mutable std::mutex mutex_;  // guards health_, which both threads use
  DriverHealth health_;

  diagnostic_updater::Updater diagnostics_;
  // Diagnostics compare now_ with before_, which is one to two seconds older.
  DriverHealth before_;
  DriverHealth last_second_;
  DriverHealth now_;
  int looks_ = 0;
  double complained_ = 0;  // when the log last said why no scans come (monotonic clock [s]); 0 = scans come
  ros::ServiceServer service_;
  ros::WallTimer timer_;
  std::unique_ptr<fsr::protocol::BoardReader> reader_;  // last: its thread uses everything above
};

/// Reads and checks the driver's private parameters, and warns of unknown ones. Throws
/// fsr::settings::InputError.
DriverSettings readDriverSettings(const Parameters& parameters);

}  // namespace fsr_ros
