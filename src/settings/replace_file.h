#pragma once

#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::settings {

/// Writes `content` to a temporary file beside `path`, syncs it to the disk and renames it. At `path` there
/// is either the old or the complete new file, even where the program is killed. Throws InputError, which
/// names the path and the cause, and removes the temporary file.
void replaceFile(const std::string& path, const std::string& content);

/// Throws the InputError of replaceFile() where the directory or the permission to write is missing. Call it
/// before a long computation.
void requireReplaceable(const std::string& path);

/// The InputError that both throw; `error` is an errno.
InputError cannotWrite(const std::string& path, int error);

}  // namespace fsr::settings
