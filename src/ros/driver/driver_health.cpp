#include "ros/driver/driver_health.h"

#include <cmath>
#include <optional>

#include "settings/number_text.h"

namespace fsr_ros {
namespace {

using Status = diagnostic_updater::DiagnosticStatusWrapper;
using Level = diagnostic_msgs::DiagnosticStatus;
using fsr::protocol::LinkPhase;

std::string rounded(double value) {
  return fsr::settings::roundedText(value, 3);
}

std::uint64_t packets(const fsr::protocol::DecoderCounts& counts) {
  std::uint64_t sum = 0;
  for (const fsr::protocol::SequenceCounts& sequence : counts.sequences) sum += sequence.packets;
  return sum;
}

// Packets whose checksum is right, but whose content cannot be; lines of text that are not those of this
// matrix.
std::uint64_t impossible(const DriverHealth& health) {
  return health.link.counts.bad_content + health.link.counts.lines.too_long;
}

bool onlyNoise(const DriverHealth& before, const DriverHealth& now) {
  return now.link.counts.bytes > before.link.counts.bytes && impossible(now) == impossible(before) &&
         packets(now.link.counts) == packets(before.link.counts) &&
         now.link.counts.skipped_bytes > before.link.counts.skipped_bytes;
}

bool speaksText(const DriverSettings& settings) {
  return settings.protocol == "text";
}

std::string noiseSentence(const DriverSettings& settings) {
  return sourceName(settings) + " sends bytes, but no valid " +
         (speaksText(settings) ? "line of numbers" : "packet") + ": is serial_baud " +
         std::to_string(settings.serial_baud) + " the baud rate of the board, and is this its port?";
}

std::string silenceSentence(double silence, const DriverSettings& settings) {
  return sourceName(settings) + " has sent nothing for " + rounded(silence) +
         " s: does the board have power, and is its firmware running?";
}

// Scans that waited in a buffer arrive together, so a shorter time of the host says nothing [s].
constexpr double kLeastTime = 0.5;
// About half the digits of 1000, the ratio of the two units, so that neither a late buffer nor a bad
// oscillator looks like the other unit (ratio).
constexpr double kOtherUnit = 30;

bool hasCountsAboveFullScale(const DriverHealth& before, const DriverHealth& now) {
  return now.link.counts.lines.above_full_scale > before.link.counts.lines.above_full_scale;
}

std::string fullScaleSentence(const DriverHealth& now, const DriverSettings& settings) {
  return sourceName(settings) + " sends counts up to " + std::to_string(now.link.counts.lines.highest_count) +
         ", but text_full_scale is " + std::to_string(settings.decoder.full_scale) +
         ": set it to the largest count that the board's converter can give";
}

std::string lengthSentence(const DriverHealth& before, const DriverHealth& now,
                           const DriverSettings& settings) {
  const fsr::protocol::DecoderOptions& decoder = settings.decoder;
  const fsr::protocol::LineCounts& lines = now.link.counts.lines;
  // The numbers of a line that is much too long are not counted.
  const bool counted = lines.wrong_number > before.link.counts.lines.wrong_number;
  return sourceName(settings) + " sends lines with " +
         (counted ? std::to_string(lines.last_number) : std::string("many more")) +
         " numbers behind the time, but rows x columns is " + sizeText(decoder.size) + " = " +
         std::to_string(decoder.size.taxels()) + " counts" +
         (decoder.transducer ? ", and text_transducer adds a reading" : "") +
         ": set rows and columns to those of the matrix";
}

// The unit that the times seem to have, where it is not the one that is set; else empty.
std::string otherUnit(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings) {
  const double host = static_cast<double>(now.scan_arrival - before.scan_arrival) * 1e-9;
  if (before.scans == 0 || now.scan_time <= before.scan_time || host < kLeastTime) return "";
  const double speed = static_cast<double>(now.scan_time - before.scan_time) * 1e-6 / host;
  if (settings.decoder.tick > 1) return speed > kOtherUnit ? "us" : "";
  return speed < 1 / kOtherUnit ? "ms" : "";
}

// Why lines of whole numbers between two samples gave no scan, and which parameter to set.
std::string lineSentence(const DriverHealth& before, const DriverHealth& now,
                         const DriverSettings& settings) {
  return hasCountsAboveFullScale(before, now) ? fullScaleSentence(now, settings)
                                              : lengthSentence(before, now, settings);
}

// Adds to `status` what is wrong with a board whose scans come: times of another unit than the parameter
// says, and scans that are not published because counts are above the full scale.
void judgeLines(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings,
                Status& status) {
  const std::string unit = otherUnit(before, now, settings);
  if (!unit.empty()) {
    status.summary(Level::ERROR, "all stamps are wrong, because the times that " + sourceName(settings) +
                                     " sends do not run as this computer's clock does: set text_time to " +
                                     unit);
  }
  if (hasCountsAboveFullScale(before, now)) {
    status.mergeSummary(Level::WARN, "some scans are not published: " + fullScaleSentence(now, settings));
  }
}

// Lists the lines that gave no scan, by cause.
void addLineCounts(const fsr::protocol::LineCounts& lines, Status& status) {
  status.add("lines without numbers", lines.without_numbers);
  status.add("dropped: line cut by start or end", lines.cut);
  status.add("dropped: line too long", lines.too_long);
  status.add("dropped: line not in ASCII", lines.not_ascii);
  status.add("dropped: line not of whole numbers", lines.not_numbers);
  status.add("dropped: wrong number of counts", lines.wrong_number);
  status.add("dropped: count above full scale", lines.above_full_scale);
}

std::string contentSentence(const DriverHealth& before, const DriverHealth& now,
                            const DriverSettings& settings) {
  if (speaksText(settings)) return "no scan is published: " + lineSentence(before, now, settings);
  return "no scan is published: " + sourceName(settings) +
         " sends scans that cannot be, e.g. counts above the full scale that they state; correct the board's "
         "firmware (docs/wire_format.md)";
}

double expectedRate(const Board& board, const DriverSettings& settings) {
  if (settings.expected_frequency > 0) return settings.expected_frequency;
  return board.scan_period > 0 ? 1 / board.scan_period : 0;
}

// Scan rate in the board's own time [1/s]; none if the two samples are not enough to compute it.
std::optional<double> scanRate(const DriverHealth& before, const DriverHealth& now) {
  if (before.scans == 0 || now.scan_time <= before.scan_time) return std::nullopt;
  return static_cast<double>(now.scans - before.scans) /
         (static_cast<double>(now.scan_time - before.scan_time) * 1e-6);
}

void summarizeRate(std::optional<double> rate, double expected, double tolerance, Status& status) {
  const std::string text = rate ? rounded(*rate) + " scans a second" : "first scans of the board";
  if (rate && expected > 0 && std::abs(*rate - expected) > tolerance * expected) {
    status.summary(Level::WARN, text + ", but " + rounded(expected) + " are expected");
  } else {
    status.summary(Level::OK, text);
  }
}

void addPacketCounts(const fsr::protocol::DecoderCounts& counts, Status& status) {
  status.add("dropped: packet check", counts.bad_packet_check);
  status.add("dropped: header check", counts.bad_header_check);
  status.add("dropped: length", counts.bad_length);
  status.add("dropped: unknown version", counts.unknown_version);
  status.add("dropped: unknown type", counts.unknown_type);
  status.add("dropped: impossible content", counts.bad_content);
}

void addCounts(const DriverHealth& now, const DriverSettings& settings, Status& status) {
  const fsr::protocol::DecoderCounts& counts = now.link.counts;
  const fsr::protocol::SequenceCounts& scans = counts.of(fsr::protocol::PacketType::kScan);
  status.add("scans published", now.published);
  status.add("scans lost", scans.lost);
  status.add("gaps in the scan counter", scans.gaps);
  status.add("duplicate scans", scans.duplicates);
  status.add("restarts of the board", scans.restarts);
  status.add("edges of the trigger lost", counts.of(fsr::protocol::PacketType::kTrigger).lost);
  status.add("scans of another size", now.refused_scans);
  status.add("dropped: board sent no identity", now.unclaimed_scans);
  if (speaksText(settings)) {
    addLineCounts(counts.lines, status);
  } else {
    addPacketCounts(counts, status);
  }
  status.add("skipped bytes", counts.skipped_bytes);
  status.add("failures of the driver", now.link.handler_faults);
}

}  // namespace

std::string sourceName(const DriverSettings& settings) {
  return settings.replay_file.empty() ? settings.serial_port : "replay of " + settings.replay_file;
}

std::string linkSentence(const fsr::protocol::LinkReport& report, const DriverSettings& settings) {
  const std::string source = sourceName(settings);
  switch (report.phase) {
    case LinkPhase::kDisabled:
      return "disabled: " + source + " is closed until ~set_enabled is called with true";
    case LinkPhase::kWaiting:
      return "waiting for the board: " + (report.reason.empty() ? "opening " + source : report.reason);
    case LinkPhase::kReading:
      return "reading " + source;
    case LinkPhase::kNoTime:
      return "waiting for /clock: use_sim_time is true, but no time has been published; if no replay or demo "
             "runs, "
             "call `rosparam set /use_sim_time false` and launch again";
    case LinkPhase::kEnded:
      return source + " has ended" + (report.reason.empty() ? "" : ": " + report.reason);
  }
  return "";
}

void judgeLink(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings,
               Status& status) {
  const fsr::protocol::LinkReport& link = now.link;
  if (link.phase == LinkPhase::kReading && link.silence > settings.read_timeout) {
    status.summary(Level::ERROR, silenceSentence(link.silence, settings));
  } else if (link.phase == LinkPhase::kReading && onlyNoise(before, now)) {
    status.summary(Level::ERROR, noiseSentence(settings));
  } else {
    const bool good = link.phase == LinkPhase::kReading || link.phase == LinkPhase::kEnded;
    const auto bad = link.phase == LinkPhase::kDisabled ? Level::WARN : Level::ERROR;
    status.summary(good ? Level::OK : bad, linkSentence(link, settings));
  }
  if (!link.capture_complaint.empty()) status.mergeSummary(Level::ERROR, link.capture_complaint);
  if (link.handler_faults > before.link.handler_faults) {
    status.mergeSummary(Level::ERROR, link.handler_complaint);
  }
  status.add("serial number", now.board.serial);
  status.add("firmware", now.board.firmware);
  status.add("board", now.board.model);
  status.add("connections", link.connections);
  status.add("bytes", link.counts.bytes);
  status.add("captured bytes", link.captured_bytes);
  status.add("clock drift [ppm]", now.clock_drift * 1e6);
  status.add("clock jumps", now.clock_jumps);
  status.add("packets stamped wrongly before a clock jump was noticed", now.doubtful_stamps);
  status.add("scans with an impossible duration", now.impossible_durations);
}

void judgeScans(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings,
                Status& status) {
  const std::optional<double> rate = scanRate(before, now);
  const double expected = expectedRate(now.board, settings);
  if (now.refused_scans > before.refused_scans) {
    status.summary(Level::ERROR, "the board sends " + sizeText(now.board.size) +
                                     " taxels, but the parameters rows and columns are " +
                                     sizeText(settings.expected) + ": no scan is published");
  } else if (now.scans > before.scans) {
    summarizeRate(rate, expected, settings.frequency_tolerance, status);
    if (speaksText(settings)) judgeLines(before, now, settings, status);
  } else if (impossible(now) > impossible(before)) {
    status.summary(Level::ERROR, contentSentence(before, now, settings));
  } else {
    const bool meant = now.link.phase == LinkPhase::kEnded || now.link.phase == LinkPhase::kDisabled;
    status.summary(meant ? Level::OK : Level::ERROR, "no scans: " + linkSentence(now.link, settings));
  }
  status.add("rate [1/s]", rate.value_or(0));
  status.add("expected rate [1/s]", expected);
  addCounts(now, settings, status);
}

std::string complaintOf(const DriverHealth& before, const DriverHealth& now, const DriverSettings& settings) {
  if (now.link.phase != LinkPhase::kReading) return "";
  Status link, scans;
  judgeLink(before, now, settings, link);
  judgeScans(before, now, settings, scans);
  if (link.level == Level::ERROR) return link.message;
  // Not where scans have not come yet: silence is an error of the link after ~read_timeout.
  const bool sent = now.scans > before.scans || impossible(now) > impossible(before) ||
                    now.refused_scans > before.refused_scans;
  return sent && scans.level == Level::ERROR ? scans.message : "";
}

}  // namespace fsr_ros
