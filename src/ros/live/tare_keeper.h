#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/stages/session/tare.h"

namespace fsr_ros {

/// The tare in use, and its file, with which it survives a restart of the node. The tare is dropped when the
/// calibration, the surface or the mount changes. Only the static functions and the constructor touch the
/// file, which may take long. An empty path stands for no file.
class TareKeeper {
 public:
  /// Reads the tare that an earlier run stored. If the file cannot be read, logs an error and leaves the
  /// file.
  explicit TareKeeper(const std::string& path);

  /// The offset to subtract from each taxel, row-major [Pa]; empty = none. The tare is not used yet while no
  /// calibration is loaded (`id` empty) or no curvature has come (`surface` nullptr). It is dropped if
  /// calibration, surface or mount are not those it was measured with.
  std::vector<float> review(const std::string& id, const fsr::matrix::Surface* surface);

  /// Writes the file of a tare without using the tare. Throws fsr::InputError, also if the file that is there
  /// is no tare.
  static void write(const fsr::calibration::Tare& tare, const std::string& path);
  /// Uses a tare that was written.
  void adopt(const fsr::calibration::Tare& tare) {
    tare_ = tare;
    dropped_ = false;
  }

  /// Drops the tare; its file is there until remove(). Returns false if there was none.
  bool drop();
  /// Whether a tare was dropped since the last call, and none was adopted: its file is to be removed.
  bool takeDropped() { return std::exchange(dropped_, false); }
  /// Removes the file of a tare that is not used any more. Returns false if there is none. Throws
  /// fsr::InputError if the file is something else or cannot be removed.
  static bool remove(const std::string& path);

  const std::optional<fsr::calibration::Tare>& tare() const { return tare_; }

 private:
  std::optional<fsr::calibration::Tare> tare_;
  bool dropped_ = false;
};

}  // namespace fsr_ros
