#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace fsr::settings {

/// SHA-256 of bytes that come bit by bit.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;

  void add(const void* bytes, std::size_t size);
  /// Of all that was added, 64 hexadecimal digits in lower case; the last call.
  std::string hexadecimal();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// SHA-256 of `size` bytes, 64 hexadecimal digits in lower case.
std::string sha256(const void* bytes, std::size_t size);

/// SHA-256 of a file's bytes. Throws InputError where it cannot be read.
/// `skip`: bytes at its beginning that are left out.
std::string sha256OfFile(const std::string& path, std::size_t skip = 0);

}  // namespace fsr::settings
