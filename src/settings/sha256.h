#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace fsr::settings {

/// SHA-256 of bytes that are added piece by piece.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;

  void add(const void* bytes, std::size_t size);
  /// The sum of all bytes added: 64 hexadecimal digits in lower case. No call may follow.
  std::string hexadecimal();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// SHA-256 of `size` bytes, 64 hexadecimal digits in lower case.
std::string sha256(const void* bytes, std::size_t size);

/// SHA-256 of a file's bytes. Throws InputError where it cannot be read.
/// `skip`: number of bytes at its beginning to leave out.
std::string sha256OfFile(const std::string& path, std::size_t skip = 0);

}  // namespace fsr::settings
