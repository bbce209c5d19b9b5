#pragma once

// Shared code of the sources that call HDF5. No other header includes this one, so that nothing else depends
// on HDF5's own header.

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <numeric>
#include <string>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::hdf5 {

inline std::mutex& hdf5Mutex() {
  static std::mutex mutex;
  return mutex;
}

// Call it before any other function of HDF5. It makes errors silent, since this package throws exceptions for
// them. It also disables HDF5's work at exit: HDF5 1.10 would flush a file that a full disk left
// half-written, and crash.
inline void openLibrary() {
  static const herr_t nothing_at_exit = H5dont_atexit();
  static_cast<void>(nothing_at_exit);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

// An HDF5 identifier with the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    if (id < 0) throw settings::InputError("its HDF5 part holds no usable " + what);
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

inline void require(herr_t status, const std::string& what) {
  if (status < 0) throw settings::InputError("its HDF5 part holds no usable " + what);
}

template <typename T>
hid_t typeOf();
template <>
inline hid_t typeOf<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}
template <>
inline hid_t typeOf<std::uint16_t>() {
  return H5T_NATIVE_UINT16;
}
template <>
inline hid_t typeOf<std::uint32_t>() {
  return H5T_NATIVE_UINT32;
}
template <>
inline hid_t typeOf<std::uint64_t>() {
  return H5T_NATIVE_UINT64;
}
template <>
inline hid_t typeOf<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
inline hid_t typeOf<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
inline hid_t typeOf<double>() {
  return H5T_NATIVE_DOUBLE;
}

inline std::size_t elements(const std::vector<std::size_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

inline std::string shapeText(const std::vector<std::size_t>& shape) {
  std::string text;
  for (const std::size_t size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text;
}

}  // namespace fsr::hdf5
