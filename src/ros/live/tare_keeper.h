#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/tare.h"

namespace fsr_ros {

/// Stores the tare on disk, so that it survives a restart of the node. Drops the tare and its file when the
/// calibration, the surface or the mount changes.
class TareKeeper {
 public:
  /// Reads the tare that an earlier run stored. If the file cannot be read, logs an error and leaves the
  /// file.
  explicit TareKeeper(std::string path);

  /// The offset to subtract from each taxel, row-major [Pa]; empty = none. The tare is not used yet while no
  /// calibration is loaded (`id` empty) or no curvature has come (`surface` nullptr). It is dropped if
  /// calibration, surface or mount are not those it was measured with.
  std::vector<float> review(const std::string& id, const fsr::matrix::Surface* surface);

  /// Writes the file of a tare, which may take long, without using the tare. Throws fsr::InputError, also if
  /// the file that is there is no tare.
  static void write(const fsr::calibration::Tare& tare, const std::string& path);
  /// Uses a tare that was written.
  void adopt(const fsr::calibration::Tare& tare) { tare_ = tare; }

  /// Drops the tare and its file, if that is a tare. Returns false if there was neither. Throws
  /// fsr::InputError, after the tare was dropped, if the file is something else or cannot be removed.
  bool clear();

  const std::optional<fsr::calibration::Tare>& tare() const { return tare_; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::optional<fsr::calibration::Tare> tare_;
};

}  // namespace fsr_ros
