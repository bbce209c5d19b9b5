#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/tare.h"

namespace fsr_ros {

/// Keeps the tare on disk, so that it survives a restart of the node, and drops it together with its file
/// once the calibration, the surface or the mount is another.
class TareKeeper {
 public:
  /// Takes up what an earlier run left in the file; a file that cannot be used is logged and left alone.
  explicit TareKeeper(std::string path);

  /// What is to be taken off now [Pa], empty = nothing. A tare waits while no calibration is loaded (`id`
  /// empty) or no curvature has come yet (`surface` nullptr); it is dropped where it does not hold.
  std::vector<float> review(const std::string& id, const fsr::matrix::Surface* surface);

  /// Writes a tare's file (a matter of a disk's time) without adopting it. Throws fsr::InputError.
  static void write(const fsr::calibration::Tare& tare, const std::string& path);
  /// Takes a tare that was written.
  void adopt(const fsr::calibration::Tare& tare) { tare_ = tare; }

  /// Drops tare and file. False where there was none.
  bool clear();

  const std::optional<fsr::calibration::Tare>& tare() const { return tare_; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::optional<fsr::calibration::Tare> tare_;
};

}  // namespace fsr_ros
