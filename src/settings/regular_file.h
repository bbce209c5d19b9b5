#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::settings {

/// A file that was opened for reading. Nothing else is opened: a pipe would block its reader for ever, and a
/// device has no end. Throws InputError, "PATH: " and the reason, where there is no file at `path`, where it
/// may not be read, or where it is larger than `largest` [bytes].
class RegularFile {
 public:
  explicit RegularFile(const std::string& path,
                       std::uint64_t largest = std::numeric_limits<std::uint64_t>::max());
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  std::uint64_t size() const { return size_; }  ///< when it was opened [bytes]
  /// Reads up to `size` bytes; fewer at the end of the file only.
  std::size_t read(void* bytes, std::size_t size);
  /// The bytes that were not read yet.
  std::string rest();
  /// The descriptor, which the caller closes from now on.
  int release();

 private:
  std::string path_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

/// Throws InputError as RegularFile does. For libraries that open files by their names.
void requireRegularFile(const std::string& path,
                        std::uint64_t largest = std::numeric_limits<std::uint64_t>::max());

/// What a file is, as its first bytes tell: "a bag", "a calibration", "a JSON file". A YAML file is told by
/// its first key, or by `format`: "a YAML file of the kind plan", "a fsr_pressure_map tare". Empty where
/// there is no byte.
std::string kindOf(std::string_view beginning);

/// The same of a file. Empty where there is none, or nothing in it.
std::string kindOfFile(const std::string& path);

/// Kinds that tools write. What is written later can be checked against them before a long computation.
namespace file_kind {
constexpr char kBag[] = "a bag";
constexpr char kCalibration[] = "a calibration";
constexpr char kJson[] = "a JSON file";
constexpr char kTable[] = "a table of values";
constexpr char kPage[] = "a web page";
constexpr char kPicture[] = "a picture";
constexpr char kCompressed[] = "a compressed file";
}  // namespace file_kind

}  // namespace fsr::settings
