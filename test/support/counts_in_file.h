#pragma once

#include <memory>
#include <vector>

#include "dataset/count_readers.h"
#include "fsr_pressure_map/dataset/recording.h"

namespace test_support {

/// The same recordings with their counts in files, as those of long bags.
inline std::vector<fsr::dataset::Recording> countsInFiles(std::vector<fsr::dataset::Recording> recordings) {
  for (fsr::dataset::Recording& recording : recordings) {
    const auto file = std::make_shared<fsr::dataset::CountFile>(recording.layout.size.taxels());
    for (std::size_t i = 0; i < recording.scans(); ++i) file->add(recording.scan(i));
    file->finish();
    recording.count_file = file;
    recording.counts = {};
  }
  return recordings;
}

}  // namespace test_support
