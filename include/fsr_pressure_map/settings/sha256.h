#pragma once

#include <cstddef>
#include <string>

namespace fsr {

/// SHA-256 of `size` bytes, 64 hexadecimal digits in lower case.
std::string sha256(const void* bytes, std::size_t size);

/// SHA-256 of a file's bytes. Throws InputError where it cannot be read.
std::string sha256OfFile(const std::string& path);

}  // namespace fsr
