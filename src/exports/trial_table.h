#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exports/region_readings.h"
#include "exports/row_table.h"

namespace fsr::exports {

/// Scans first .. last of a step.
using Step = std::pair<std::size_t, std::size_t>;

/// Steps in the course of a force [N], which may have NaN. A step begins where the force reaches `threshold`
/// and ends where it has fallen to the middle between it and the lowest force, so noise makes no step. Steps
/// that the beginning or the end of the recording cuts off, and those shorter than 0.1 s, do not count.
/// `time`: of each scan [s].
std::vector<Step> findSteps(const std::vector<double>& force, const std::vector<double>& time,
                            double threshold);

/// A tenth of the range of a force above its lowest, by the quantiles 1 and 99 % [N]; NaN without a force.
double stepThreshold(const std::vector<double>& force);

/// A table with one row for each region of a recording, step 0, and one for each step that is found in the
/// force on the whole matrix. HDF5 holds units and meanings of the columns. Memory grows by 56 bytes for each
/// region and scan.
class TrialTable : public ScanSink {
 public:
  TrialTable(const std::string& path, const StatisticsOptions& options);

  void begin(const ExportSubject& subject) override;
  void add(const ScanRecord& scan) override;
  void finish() override;

 private:
  struct Moment {  // of a region in a scan
    double peak, peak_deviation, mean, force, area;
    matrix::TaxelIndex taxel;
    bool at_least;
  };

  void writeRecording();
  void writeRow(const std::string& region, const std::vector<Moment>& moments, std::size_t number, Step step,
                double step_force);

  StatisticsOptions options_;
  double factor_;  // of pressures in the table [unit / Pa]
  RegionReader reader_;
  std::unique_ptr<RowTable> table_;
  std::string bag_, sheet_, session_, surface_;
  std::optional<std::uint32_t> mount_;
  matrix::Layout layout_;
  std::vector<double> time_;                  // of each scan [s]
  std::vector<std::string> regions_;          // names
  std::vector<std::vector<Moment>> moments_;  // [regions][scans]
};

}  // namespace fsr::exports
