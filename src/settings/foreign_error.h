#pragma once

#include <exception>
#include <string>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::settings {

/// An exception of a library (std::filesystem, rosbag, ROS, the memory manager) as the sentence that a user
/// reads. An InputError is returned as it is.
InputError sentenceOf(const std::exception& error);

/// The same, with the name of the file before it, unless the sentence begins with it.
InputError sentenceAbout(const std::string& path, const std::exception& error);

/// Calls `run`. Whatever it throws becomes an InputError.
template <typename Run>
auto inSentences(Run&& run) {
  try {
    return std::forward<Run>(run)();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw sentenceOf(error);
  }
}

}  // namespace fsr::settings
