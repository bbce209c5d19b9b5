#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exports/scan_record.h"
#include "settings/fresh_file.h"

namespace fsr::exports {

/// Frames in the ASCII format of Tekscan's I-Scan and F-Scan (*.asf). A header of "KEY value" lines ends with
/// ASCII_DATA @@. Each frame has a line "Frame N" and one line for each row, with values separated by commas;
/// `B` means no sensel or no reading. The line "@@" ends the frames. Lines end with CR LF. Maps are in kPa
/// (UNITS kPa), recordings without maps in counts (UNITS RAW).
///
/// The format assumes evenly spaced frames. The true time of each frame is in lines "FRAME_TIME N seconds"
/// after the final "@@", which readers of the format ignore.
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
  // Offsets in the header of numbers that are known only at the end [bytes].
  std::size_t end_frame_at_ = 0;
  std::size_t period_at_ = 0;
};

}  // namespace fsr::exports
