#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "exports/scan_record.h"

namespace fsr::exports {

/// An export format that takes the scans of a recording one after another.
struct ScanFormat {
  std::string name;                 ///< as users write it, e.g. "csv"
  std::string summary;              ///< one line for the help
  bool several_recordings = false;  ///< whether one output can hold several recordings
  /// Opens the output. Throws InputError if it cannot be written.
  std::function<std::unique_ptr<ScanSink>(const std::string& output)> open;
};

/// The formats of this package. `export` offers each of them; a new format needs an entry here and nothing
/// else outside its own file.
const std::vector<ScanFormat>& scanFormats();

}  // namespace fsr::exports
