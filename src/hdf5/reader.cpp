#include "hdf5/file.h"

#include <algorithm>
#include <filesystem>

#include "hdf5/handle.h"

namespace fsr::hdf5 {

namespace {

std::string trimmed(const char* text, std::size_t size) {
  return std::string(text, std::find(text, text + size, '\0'));
}

hid_t openFile(const std::string& path) {
  hdf5::openLibrary();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file");
  require(H5Pset_file_locking(access, false, true), "file");  // not every file system has locks
  return H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
}

hid_t openAttribute(hid_t file, const std::string& path, const std::string& name) {
  return H5Aopen_by_name(file, path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
}

}  // namespace

Reader::Reader(const std::string& path)
    : lock_(hdf5Mutex()), file_(openFile(path)), size_(std::filesystem::file_size(path)) {
  if (file_ < 0) throw settings::InputError("what follows its first 512 bytes is not an HDF5 file");
}

Reader::~Reader() {
  H5Fclose(file_);
}

bool Reader::has(const std::string& path) const {
  return H5Lexists(file_, path.c_str(), H5P_DEFAULT) > 0;
}

std::string Reader::text(const std::string& path, const std::string& name) const {
  const std::string what = path + " " + name;
  const Handle attribute(openAttribute(file_, path, name), H5Aclose, what);
  const Handle type(H5Aget_type(attribute), H5Tclose, what);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) {
    throw settings::InputError("its HDF5 part holds " + what + ", but not as a text of fixed length");
  }
  const Handle space(H5Aget_space(attribute), H5Sclose, what);
  if (H5Sget_simple_extent_npoints(space) != 1) {
    throw settings::InputError("its HDF5 part holds " + what + ", but not as one text");
  }
  std::string text(H5Tget_size(type), '\0');
  require(H5Aread(attribute, type, text.data()), what);
  return trimmed(text.data(), text.size());
}

std::vector<double> Reader::numbers(const std::string& path, const std::string& name,
                                    std::size_t size) const {
  const std::string what = path + " " + name;
  const Handle attribute(openAttribute(file_, path, name), H5Aclose, what);
  const Handle space(H5Aget_space(attribute), H5Sclose, what);
  if (H5Sget_simple_extent_npoints(space) != static_cast<hssize_t>(size)) {
    throw settings::InputError("its HDF5 part holds " + what + ", but not of " + std::to_string(size) +
                               " numbers");
  }
  std::vector<double> values(size);
  require(H5Aread(attribute, H5T_NATIVE_DOUBLE, values.data()), what);
  return values;
}

std::uint64_t Reader::integer(const std::string& path, const std::string& name) const {
  const std::string what = path + " " + name;
  const Handle attribute(openAttribute(file_, path, name), H5Aclose, what);
  const Handle space(H5Aget_space(attribute), H5Sclose, what);
  if (H5Sget_simple_extent_npoints(space) != 1) {
    throw settings::InputError("its HDF5 part holds " + what + ", but not as one number");
  }
  std::uint64_t value = 0;
  require(H5Aread(attribute, H5T_NATIVE_UINT64, &value), what);
  return value;
}

Shape Reader::shape(const std::string& path) const {
  const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose, path);
  const Handle space(H5Dget_space(dataset), H5Sclose, path);
  std::vector<hsize_t> size(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  require(H5Sget_simple_extent_dims(space, size.data(), nullptr), path);
  requireRoom(path, {size.begin(), size.end()}, 1);
  return {size.begin(), size.end()};
}

// A file may claim any shape. Nothing is compressed, so each value takes at least a byte of the file.
void Reader::requireRoom(const std::string& path, const Shape& shape, std::size_t bytes) const {
  std::size_t left = size_ / std::max<std::size_t>(bytes, 1);
  for (const std::size_t length : shape) {
    if (length > left)
      throw settings::InputError("its " + path + " claims more values than the file has bytes");
    left /= std::max<std::size_t>(length, 1);
  }
}

template <typename T>
std::vector<T> Reader::dataset(const std::string& path, const Shape& expected) const {
  const Shape found = shape(path);
  if (found != expected) {
    throw settings::InputError("its " + path + " is " + shapeText(found) + ", but must be " +
                               shapeText(expected));
  }
  const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose, path);
  std::vector<T> values(elements(expected));
  if (values.empty()) return values;
  require(H5Dread(dataset, typeOf<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
  return values;
}

std::vector<std::string> Reader::texts(const std::string& path) const {
  const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose, path);
  const Handle type(H5Dget_type(dataset), H5Tclose, path);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) {
    throw settings::InputError("its " + path + " does not hold texts of fixed length");
  }
  const std::size_t length = H5Tget_size(type);
  const Shape size = shape(path);
  requireRoom(path, size, length);
  std::string padded(length * elements(size), '\0');
  if (!padded.empty()) require(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()), path);
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < padded.size(); at += length) texts.push_back(trimmed(&padded[at], length));
  return texts;
}

template std::vector<std::uint8_t> Reader::dataset(const std::string&, const Shape&) const;
template std::vector<std::uint16_t> Reader::dataset(const std::string&, const Shape&) const;
template std::vector<std::uint32_t> Reader::dataset(const std::string&, const Shape&) const;
template std::vector<std::uint64_t> Reader::dataset(const std::string&, const Shape&) const;
template std::vector<std::int64_t> Reader::dataset(const std::string&, const Shape&) const;
template std::vector<float> Reader::dataset(const std::string&, const Shape&) const;
template std::vector<double> Reader::dataset(const std::string&, const Shape&) const;

}  // namespace fsr::hdf5
