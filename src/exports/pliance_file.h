#pragma once

#include <string>
#include <vector>

#include "exports/region_readings.h"
#include "settings/replace_file.h"

namespace fsr::exports {

/// Frames in the ASCII format of novel's pliance (*.asc), as a public file of it has them: a line of
/// pressures [kPa] for each frame, a line of force [N] and centre of pressure [cm], and the corners of the
/// sensors [cm]. Row 0 is at the top, where y is largest. Masked taxels are left out; NA = no reading, - = no
/// contact.
class PlianceFile : public ScanSink {
 public:
  PlianceFile(const std::string& path, const StatisticsOptions& options)
      : path_(path), file_(path), reader_(options) {}

  void begin(const ExportSubject& subject) override;
  void add(const ScanRecord& scan) override;
  void finish() override;

 private:
  std::string header(const ScanRecord& first);
  std::string corners() const;

  std::string path_;
  settings::FreshFile file_;
  RegionReader reader_;
  ExportSubject subject_;
  matrix::Layout layout_;
  std::vector<std::size_t> sensors_;  // taxels that are written
  std::string forces_;                // the second block
  double first_ = 0, last_ = 0;       // time of the first and last frame [s]
  std::size_t frames_ = 0;
  std::size_t times_at_ = 0;  // offset in the header of what is known only at the end [bytes]
};

}  // namespace fsr::exports
