#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace fuzz {

/// Reads numbers from the input; zeros after its end.
class Numbers {
 public:
  Numbers(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size) {}
  bool any() const { return size_ > 0; }
  template <typename T>
  T next() {
    T value{};
    const std::size_t taken = size_ < sizeof(T) ? size_ : sizeof(T);
    if (taken > 0) std::memcpy(&value, bytes_, taken);
    bytes_ += taken;
    size_ -= taken;
    return value;
  }

 private:
  const std::uint8_t* bytes_;
  std::size_t size_;
};

/// Returns the HDF5 file `image` (bytes, with its user block) with changes that the numbers choose, without
/// the user block. Objects and attributes are deleted, replaced by others of any type and shape, or get
/// another value. HDF5's own functions make the changes, so the result is still valid HDF5.
std::string damaged(const std::string& image, Numbers& numbers);

}  // namespace fuzz
