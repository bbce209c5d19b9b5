#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace fsr::hdf5 {

/// Bytes in front of HDF5's own.
constexpr std::size_t kUserBlock = 512;

/// Writes the part of HDF5 that a calibration needs: groups, attributes, datasets of numbers and of texts.
/// The file begins with kUserBlock bytes of zeros that the caller may fill. T is one of uint8_t, uint16_t,
/// uint32_t, uint64_t, int64_t, float, double. HDF5 is not thread-safe, so a process has one writer or reader
/// at a time; the constructors of others wait.
class Writer {
 public:
  /// Overwrites the file of this name. All members throw InputError where it cannot be written.
  explicit Writer(const std::string& name);
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void group(const std::string& path);
  /// Sets an attribute of an existing group or dataset; "/" is the file itself.
  void attribute(const std::string& path, const std::string& name, const std::string& text);
  void attribute(const std::string& path, const std::string& name, const std::vector<double>& values);
  void attribute(const std::string& path, const std::string& name, std::uint64_t value);
  /// `values` are row-major. `unit` and `meaning` become attributes where they are not empty. Integers are
  /// stored in the narrowest type that holds all of them; readers return the same values.
  template <typename T>
  void dataset(const std::string& path, const std::vector<T>& values, const std::vector<std::size_t>& shape,
               const std::string& unit, const std::string& meaning);
  /// The same from `pieces` pieces, slabs of the first dimension one behind the other, so that only one is in
  /// memory at a time. piece(i) is called twice and must give the same values.
  template <typename T>
  void dataset(const std::string& path, std::size_t pieces,
               const std::function<std::vector<T>(std::size_t)>& piece, const std::vector<std::size_t>& shape,
               const std::string& unit, const std::string& meaning);
  void texts(const std::string& path, const std::vector<std::string>& texts, const std::string& meaning);

  /// Closes the file. No call may follow.
  void finish();

 private:
  void describe(const std::string& path, const std::string& unit, const std::string& meaning);

  std::lock_guard<std::mutex> lock_;
  std::int64_t file_;
};

}  // namespace fsr::hdf5
