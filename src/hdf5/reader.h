#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace fsr::hdf5 {

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
  std::vector<std::size_t> shape(const std::string& path) const;
  /// `shape`: the shape that the dataset must have.
  template <typename T>
  std::vector<T> dataset(const std::string& path, const std::vector<std::size_t>& shape) const;
  std::vector<std::string> texts(const std::string& path) const;

 private:
  void requireRoom(const std::string& path, const std::vector<std::size_t>& shape, std::size_t bytes) const;

  std::lock_guard<std::mutex> lock_;
  std::int64_t file_;
  std::size_t size_;  // [bytes]
};

}  // namespace fsr::hdf5
