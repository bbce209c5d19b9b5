#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exports/scan_record.h"
#include "settings/fresh_file.h"

namespace fsr::exports {

/// Frames as Tekscan's I-Scan and F-Scan save them as ASCII (*.asf): a header of "KEY value" lines up to
/// ASCII_DATA @@, then for each frame a line "Frame N" and one line for each row with values between commas,
/// `B` where there is no sensel or no reading, "@@" at the end; lines end with CR LF. Maps are in kPa (UNITS
/// kPa), recordings without maps in counts (UNITS RAW).
///
/// That format counts on evenly spaced frames; when each was really read stands behind the closing "@@", in
/// lines "FRAME_TIME N seconds", where its readers do not look.
class TekscanFile : public ScanSink {
 public:
  explicit TekscanFile(const std::string& path) : path_(path), file_(path) {}

  void begin(const ExportSubject& subject) override { subject_ = subject; }
  void add(const ScanRecord& scan) override;
  void finish() override;

 private:
  std::string header(const ScanRecord& first);
  void line(const std::string& key, const std::string& value, std::string& text) const;

  std::string path_;
  settings::FreshFile file_;
  ExportSubject subject_;
  matrix::Layout layout_;
  std::vector<std::int64_t> times_;  // of the frames, since the recording's first scan [ns]
  // Where the header says what only the end knows [bytes].
  std::size_t end_frame_at_ = 0;
  std::size_t period_at_ = 0;
};

}  // namespace fsr::exports
