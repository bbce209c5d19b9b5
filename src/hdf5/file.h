#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace fsr::hdf5 {

/// Length of a dataset in each dimension.
using Shape = std::vector<std::size_t>;

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
  void dataset(const std::string& path, const std::vector<T>& values, const Shape& shape,
               const std::string& unit, const std::string& meaning) {
    dataset<T>(
        path, 1, [&](std::size_t) { return values; }, shape, unit, meaning);
  }
  /// The same from `pieces` pieces, slabs of the first dimension one behind the other, so that only one is in
  /// memory at a time. piece(i) is called several times and must give the same values.
  template <typename T>
  void dataset(const std::string& path, std::size_t pieces,
               const std::function<std::vector<T>(std::size_t)>& piece, const Shape& shape,
               const std::string& unit, const std::string& meaning);
  void texts(const std::string& path, const std::vector<std::string>& texts, const std::string& meaning);

  /// Closes the file. No call may follow.
  void finish();

 private:
  void describe(const std::string& path, const std::string& unit, const std::string& meaning);

  std::lock_guard<std::mutex> lock_;
  std::int64_t file_;
};

/// Reads files of Writer, piece by piece. Every function throws InputError, which names the object, where it
/// is missing, has another shape, or claims more values than the file has bytes. So the values read take at
/// most eight times the file's size.
class Reader {
 public:
  explicit Reader(const std::string& path);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Whether there is a group or dataset at this path. Its parent must exist.
  bool has(const std::string& path) const;
  std::string text(const std::string& path, const std::string& attribute) const;
  std::vector<double> numbers(const std::string& path, const std::string& attribute, std::size_t size) const;
  std::uint64_t integer(const std::string& path, const std::string& attribute) const;
  Shape shape(const std::string& path) const;
  /// `shape`: the shape that the dataset must have.
  template <typename T>
  std::vector<T> dataset(const std::string& path, const Shape& shape) const;
  std::vector<std::string> texts(const std::string& path) const;

 private:
  void requireRoom(const std::string& path, const Shape& shape, std::size_t bytes) const;

  std::lock_guard<std::mutex> lock_;
  std::int64_t file_;
  std::size_t size_;  // [bytes]
};

}  // namespace fsr::hdf5
