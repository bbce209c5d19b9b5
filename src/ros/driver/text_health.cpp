#include "ros/driver/driver_health.h"

namespace fsr_ros {
namespace {

using Status = diagnostic_updater::DiagnosticStatusWrapper;
using Level = diagnostic_msgs::DiagnosticStatus;

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

}  // namespace

bool speaksText(const DriverSettings& settings) {
  return settings.protocol == "text";
}

std::string lineSentence(const DriverHealth& before, const DriverHealth& now,
                         const DriverSettings& settings) {
  return hasCountsAboveFullScale(before, now) ? fullScaleSentence(now, settings)
                                              : lengthSentence(before, now, settings);
}

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

void addLineCounts(const fsr::protocol::LineCounts& lines, Status& status) {
  status.add("lines without numbers", lines.without_numbers);
  status.add("dropped: line cut by start or end", lines.cut);
  status.add("dropped: line too long", lines.too_long);
  status.add("dropped: line not in ASCII", lines.not_ascii);
  status.add("dropped: line not of whole numbers", lines.not_numbers);
  status.add("dropped: wrong number of counts", lines.wrong_number);
  status.add("dropped: count above full scale", lines.above_full_scale);
}

}  // namespace fsr_ros
