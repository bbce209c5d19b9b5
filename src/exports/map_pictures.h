#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "exports/scan_record.h"
#include "fsr_pressure_map/view/heat_map.h"

namespace fsr::exports {

/// How maps are drawn for export; every default stands here.
struct PictureOptions {
  view::HeatMapStyle style;  ///< of which the range is `range`'s
  /// Ends of the colours [Pa]; none = 0 to what the calibration was trained on, else to 600 kPa; a tenth of
  /// that for the deviation.
  std::optional<std::pair<double, double>> range;
  double rate = 10;  ///< pictures a second of the recording [Hz]
};

/// Draws each scan's map as a heat map with recording, surface, time, chamber pressure and peak written
/// above. All pictures of a recording are of one size. Scans without a map are left out.
class PictureSink : public ScanSink {
 public:
  explicit PictureSink(const PictureOptions& options) : options_(options), painter_(options.style) {}

  /// Throws InputError where the recording has no maps.
  void begin(const ExportSubject& subject) override;
  /// Throws InputError where the matrix has changed its size.
  void add(const ScanRecord& scan) override;

 protected:
  const PictureOptions& options() const { return options_; }
  /// `since_ns` as the scan's.
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
