#include "hdf5/file.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <type_traits>

#include "hdf5/column.h"
#include "hdf5/handle.h"

namespace fsr::hdf5 {

namespace {

// A new dataset without values.
hid_t createDataset(hid_t file, const std::string& path, hid_t type, hid_t space) {
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path);
  require(H5Pset_obj_track_times(creation, false), path);  // so that equal content gives equal bytes
  return H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
}

hid_t createSpace(const std::vector<hsize_t>& size) {
  return H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr);
}

template <typename T>
using Piece = std::function<std::vector<T>(std::size_t)>;

// Each piece fills the slabs behind those of the piece before it.
template <typename Stored, typename T>
void writePieces(hid_t file, const std::string& path, std::size_t pieces, const Piece<T>& piece,
                 const Shape& shape) {
  const std::vector<hsize_t> size(shape.begin(), shape.end());
  const hsize_t slab = std::accumulate(size.begin() + 1, size.end(), hsize_t{1}, std::multiplies<>());
  const Handle space(createSpace(size), H5Sclose, path);
  const Handle dataset(createDataset(file, path, typeOf<Stored>(), space), H5Dclose, path);
  std::vector<hsize_t> start(size.size(), 0), count = size;
  for (std::size_t i = 0; i < pieces; ++i) {
    const std::vector<T> values = piece(i);
    if (values.empty()) continue;
    const std::vector<Stored> stored(values.begin(), values.end());
    count[0] = stored.size() / slab;
    require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), path);
    const Handle memory(createSpace({stored.size()}), H5Sclose, path);
    require(H5Dwrite(dataset, typeOf<Stored>(), memory, space, H5P_DEFAULT, stored.data()), path);
    start[0] += count[0];
  }
  if (slab > 0 && start[0] != size[0]) throw std::logic_error(path + " is not " + shapeText(shape));
}

hid_t createFile(const std::string& name) {
  hdf5::openLibrary();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file");
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "file");
  require(H5Pset_file_locking(access, false, true), "file");  // not every file system has locks
  require(H5Pset_userblock(creation, kUserBlock), "file");
  return H5Fcreate(name.c_str(), H5F_ACC_TRUNC, creation, access);
}

}  // namespace

Writer::Writer(const std::string& name) : lock_(hdf5Mutex()), file_(createFile(name)) {
  require(file_ < 0 ? -1 : 0, "file");
}

Writer::~Writer() {
  if (file_ >= 0) H5Fclose(file_);
}

void Writer::group(const std::string& path) {
  const Handle made(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
}

void Writer::attribute(const std::string& path, const std::string& name, const std::string& text) {
  setAttribute(file_, path, name, text);
}

void Writer::attribute(const std::string& path, const std::string& name, const std::vector<double>& values) {
  const Handle space(createSpace({values.size()}), H5Sclose, name);
  setAttribute(file_, path, name, H5T_NATIVE_DOUBLE, space, values.data());
}

void Writer::attribute(const std::string& path, const std::string& name, std::uint64_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, name);
  setAttribute(file_, path, name, H5T_NATIVE_UINT64, space, &value);
}

namespace {

// Whether all values fit into Narrow.
template <typename Narrow, typename T>
bool fits(const std::vector<T>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return values.empty() || (*low >= static_cast<T>(std::numeric_limits<Narrow>::min()) &&
                            *high <= static_cast<T>(std::numeric_limits<Narrow>::max()));
}

template <typename Narrow, typename T>
bool fits(std::size_t pieces, const Piece<T>& piece) {
  for (std::size_t i = 0; i < pieces; ++i) {
    if (!fits<Narrow>(piece(i))) return false;
  }
  return true;
}

// The type of half the bytes.
template <typename T>
using Half = std::conditional_t<sizeof(T) == 8, std::uint32_t,
                                std::conditional_t<sizeof(T) == 4, std::uint16_t, std::uint8_t>>;

// In the narrowest type that holds all values, beginning with Stored.
template <typename Stored, typename T>
void writeNarrowest(hid_t file, const std::string& path, std::size_t pieces, const Piece<T>& piece,
                    const Shape& shape) {
  if constexpr (std::is_integral_v<Stored> && sizeof(Stored) > 1) {
    if (fits<Half<Stored>>(pieces, piece)) {
      writeNarrowest<Half<Stored>>(file, path, pieces, piece, shape);
      return;
    }
  }
  writePieces<Stored>(file, path, pieces, piece, shape);
}

}  // namespace

template <typename T>
void Writer::dataset(const std::string& path, std::size_t pieces, const Piece<T>& piece, const Shape& shape,
                     const std::string& unit, const std::string& meaning) {
  writeNarrowest<T>(file_, path, pieces, piece, shape);
  describe(path, unit, meaning);
}

void Writer::describe(const std::string& path, const std::string& unit, const std::string& meaning) {
  if (!unit.empty()) attribute(path, "unit", unit);
  if (!meaning.empty()) attribute(path, "meaning", meaning);
}

void Writer::texts(const std::string& path, const std::vector<std::string>& texts,
                   const std::string& meaning) {
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, text.size());
  std::string padded;
  for (const std::string& text : texts) padded += text + std::string(length - text.size(), '\0');
  const Handle type(textType(length), H5Tclose, path);
  const Handle space(createSpace({texts.size()}), H5Sclose, path);
  const Handle dataset(createDataset(file_, path, type, space), H5Dclose, path);
  if (!texts.empty()) require(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()), path);
  if (!meaning.empty()) attribute(path, "meaning", meaning);
}

void Writer::finish() {
  const herr_t closed = H5Fclose(file_);
  file_ = -1;
  require(closed, "file");
}

template void Writer::dataset(const std::string&, std::size_t, const Piece<std::uint8_t>&, const Shape&,
                              const std::string&, const std::string&);
template void Writer::dataset(const std::string&, std::size_t, const Piece<std::uint16_t>&, const Shape&,
                              const std::string&, const std::string&);
template void Writer::dataset(const std::string&, std::size_t, const Piece<std::uint32_t>&, const Shape&,
                              const std::string&, const std::string&);
template void Writer::dataset(const std::string&, std::size_t, const Piece<std::uint64_t>&, const Shape&,
                              const std::string&, const std::string&);
template void Writer::dataset(const std::string&, std::size_t, const Piece<std::int64_t>&, const Shape&,
                              const std::string&, const std::string&);
template void Writer::dataset(const std::string&, std::size_t, const Piece<float>&, const Shape&,
                              const std::string&, const std::string&);
template void Writer::dataset(const std::string&, std::size_t, const Piece<double>&, const Shape&,
                              const std::string&, const std::string&);

}  // namespace fsr::hdf5
