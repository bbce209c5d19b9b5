#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <string>

#include "protocol/board_reader.h"
#include "ros/messages/driver_messages.h"

namespace fsr_ros {

/// A sample of the driver's state, for diagnostics.
struct DriverHealth {
  fsr::protocol::LinkReport link;
  Board board;
  std::uint64_t scans = 0;          ///< received, of the size that the parameters say
  std::uint64_t scan_time = 0;      ///< device time of the last of them [us]
  std::int64_t scan_arrival = 0;    ///< when it arrived [host, ns]
  std::uint64_t published = 0;      ///< of these
  std::uint64_t refused_scans = 0;  ///< scans of another size than the parameters say
  std::uint64_t unclaimed_scans =
      0;                          ///< dropped: the port closed, or too many waited, before the identity came
  std::uint64_t clock_jumps = 0;  ///< small ones included
  std::uint64_t doubtful_stamps = 0;  ///< packets whose stamps a jump made wrong before it was noticed
  std::uint64_t impossible_durations = 0;
  double clock_drift = 0;  ///< how much faster the host's clock runs than the board's (relative)
};

/// What the driver reads: "/dev/ttyACM0" or "replay of /data/run.fsrcap".
std::string sourceName(const DriverSettings& settings);

/// State of the link as one sentence for the log and diagnostics.
std::string linkSentence(const fsr::protocol::LinkReport& report, const DriverSettings& settings);

/// Diagnostics of the link between two samples, one to two seconds apart.
void judgeLink(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings,
               diagnostic_updater::DiagnosticStatusWrapper& status);

/// Diagnostics of the scans between two samples: rate compared with the expected one, lost scans, and damaged
/// packets by cause.
void judgeScans(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings,
                diagnostic_updater::DiagnosticStatusWrapper& status);

/// Why an open port gives no scans, or none with a right stamp, for the log: the sentence of an error in the
/// diagnostics above. Empty if good scans come, or if the port is not open, which linkSentence() says.
std::string complaintOf(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings);

}  // namespace fsr_ros
