#pragma once

#include <stdexcept>

namespace fsr::settings {

/// Input that cannot be used: a file, a setting, an option, a recording.
/// what() is one sentence for the user that names file, field, value and what would be right.
/// Tools print it and leave with exit status 2; nodes log it and go on with what they had.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fsr::settings
