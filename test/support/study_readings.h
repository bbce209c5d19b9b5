#pragma once

#include <cstdint>
#include <vector>

#include "dataset/count_readers.h"
#include "study/study_data.h"

namespace test_support {

/// One reading of a taxel.
struct ScanReading {
  std::uint16_t count = 0;
  double pressure = 0;  ///< [Pa]
  std::uint32_t section = 0;
};

/// The readings of a taxel at some scans of a study.
inline std::vector<ScanReading> readingsOf(const fsr::study::StudyData& data,
                                           const fsr::study::ScanList& scans, std::size_t taxel) {
  std::vector<fsr::dataset::TaxelCounts> counts = fsr::dataset::taxelCounts(*data.recordings, taxel);
  std::vector<ScanReading> readings;
  scans.forEach([&](const fsr::study::ScanPlace& scan) {
    readings.push_back({counts[scan.recording][scan.number], data.pressure(scan), data.section(scan)});
  });
  return readings;
}

}  // namespace test_support
