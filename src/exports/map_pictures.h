#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "exports/scan_record.h"
#include "fsr_pressure_map/view/heat_map.h"

namespace fsr::exports {

/// Options of exported pictures, with all defaults.
struct PictureOptions {
  view::HeatMapStyle style;  ///< its scale's range is replaced by `range`
  /// Ends of the colours [Pa]. None = from 0 to the highest pressure that the calibration was trained on, or
  /// to 600 kPa if it is unknown; a tenth of that for the deviation.
  std::optional<std::pair<double, double>> range;
  double rate = 10;  ///< pictures per second of the recording [Hz]
};

/// Draws each scan's map as a heat map with recording, surface, time, chamber pressure and peak above it. All
/// pictures of a recording have the same size. Scans without a map are left out.
class PictureSink : public ScanSink {
 public:
  explicit PictureSink(const PictureOptions& options) : options_(options), painter_(options.style) {}

  /// Throws InputError if the recording has no maps.
  void begin(const ExportSubject& subject) override;
  /// Throws InputError if the size of the matrix has changed.
  void add(const ScanRecord& scan) override;

 protected:
  const PictureOptions& options() const { return options_; }
  /// Takes the next picture; `since_ns` as in ScanRecord.
  virtual void picture(std::int64_t since_ns, const view::Image& image) = 0;

 private:
  std::string fitted(const std::string& line) const;

  PictureOptions options_;
  view::HeatMap painter_;
  std::string name_;
  matrix::MatrixSize size_;
  int width_ = 0;  // of the pictures [pixels]
};

}  // namespace fsr::exports
