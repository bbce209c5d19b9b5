#pragma once

#include <stdexcept>

namespace fsr::settings {

/// Unusable input: a file, a setting, an option, a recording.
/// what() is one sentence for the user that names the file, the field, the value and what would be right.
/// Tools print it and exit with status 2. Nodes log it and continue with what they had.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fsr::settings
