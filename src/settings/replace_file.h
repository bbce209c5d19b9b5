#pragma once

#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::settings {

/// Writes `content` to a temporary name beside `path`, syncs it to the disk, then renames: at `path`
/// there is the old file or the whole new one, whatever stops the program. Throws InputError that names
/// the path and the cause; the temporary file is gone then.
void replaceFile(const std::string& path, const std::string& content);

/// Throws InputError, in the same words, where replaceFile() would fail for want of a directory or of
/// permission: to be asked before long work, not after it.
void requireReplaceable(const std::string& path);

/// What they throw; `error` is an errno.
InputError cannotWrite(const std::string& path, int error);

}  // namespace fsr::settings
