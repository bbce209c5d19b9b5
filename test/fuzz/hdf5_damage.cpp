#include "fuzz/hdf5_damage.h"

#include <hdf5.h>

#include <algorithm>
#include <vector>

namespace fuzz {

namespace {

// Names of all groups and datasets, beginning with the root.
std::vector<std::string> objectsOf(hid_t file) {
  std::vector<std::string> names;
  const auto keep = [](hid_t, const char* name, const H5O_info_t*, void* list) {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return herr_t{0};
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, keep, &names, H5O_INFO_BASIC);
  return names;
}

// One of the types that a field may have.
hid_t typeOf(std::uint8_t choice) {
  const hsize_t three = 3;
  hid_t text = -1;
  switch (choice % 9) {
    case 0:
      return H5Tcopy(H5T_NATIVE_UINT8);
    case 1:
      return H5Tcopy(H5T_NATIVE_UINT64);
    case 2:
      return H5Tcopy(H5T_NATIVE_INT64);
    case 3:
      return H5Tcopy(H5T_NATIVE_FLOAT);
    case 4:
      return H5Tcopy(H5T_NATIVE_DOUBLE);
    case 5:
      text = H5Tcopy(H5T_C_S1);
      H5Tset_size(text, 1u + choice / 9);
      return text;
    case 6:
      text = H5Tcopy(H5T_C_S1);
      H5Tset_size(text, H5T_VARIABLE);
      return text;
    case 7:
      return H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &three);
    default:
      return H5Tcreate(H5T_OPAQUE, 1u + choice / 9);
  }
}

// Any rank up to 3; lengths up to 2^62.
hid_t spaceOf(Numbers& numbers) {
  const auto rank = numbers.next<std::uint8_t>() % 5;
  if (rank == 4) return H5Screate(H5S_NULL);
  if (rank == 0) return H5Screate(H5S_SCALAR);
  std::vector<hsize_t> size;
  for (int i = 0; i < rank; ++i) {
    const auto length = numbers.next<std::uint8_t>();
    size.push_back(length < 192 ? length : hsize_t{1} << (length - 192));
  }
  return H5Screate_simple(rank, size.data(), nullptr);
}

// Enough values for everything that is written.
std::vector<std::uint64_t> valuesOf(Numbers& numbers) {
  std::vector<std::uint64_t> values(8192);
  const auto count = numbers.next<std::uint8_t>();
  for (std::size_t i = 0; i < count && numbers.any(); ++i) values[i] = numbers.next<std::uint64_t>();
  return values;
}

bool isSmall(hid_t type, hid_t space) {
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  return H5Tis_variable_str(type) == 0 && count >= 0 && count <= 1024 && H5Tget_size(type) <= 64;
}

void replaceAttribute(hid_t object, Numbers& numbers) {
  char name[64] = "";
  const auto which = numbers.next<std::uint8_t>();
  if (H5Aget_name_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, which % 8, name, sizeof(name),
                         H5P_DEFAULT) < 0)
    return;
  H5Adelete(object, name);
  if (which >= 240) return;
  const hid_t type = typeOf(numbers.next<std::uint8_t>()), space = spaceOf(numbers);
  const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  if (attribute >= 0 && isSmall(type, space)) H5Awrite(attribute, type, valuesOf(numbers).data());
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
}

void replaceDataset(hid_t file, const std::string& name, Numbers& numbers) {
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  const hid_t type = typeOf(numbers.next<std::uint8_t>()), space = spaceOf(numbers);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk[] = {1, 1, 1};  // so that a large dataset needs no memory
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank > 0 && !isSmall(type, space)) H5Pset_chunk(creation, rank, chunk);
  const hid_t dataset = H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  if (dataset >= 0 && isSmall(type, space))
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, valuesOf(numbers).data());
  H5Dclose(dataset);
  H5Pclose(creation);
  H5Sclose(space);
  H5Tclose(type);
}

// Changes one value of a dataset, or all of them.
void replaceValue(hid_t object, Numbers& numbers) {
  const hid_t space = H5Dget_space(object);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (space >= 0 && count > 0 && count <= 4096) {
    std::vector<double> values(static_cast<std::size_t>(count));
    const auto at = numbers.next<std::uint16_t>();
    const auto value = numbers.next<double>();
    if (H5Dread(object, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0) {
      values[at % values.size()] = value;
      if (at >= 0xF000) std::fill(values.begin(), values.end(), value);
      H5Dwrite(object, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
  }
  H5Sclose(space);
}

void change(hid_t file, const std::vector<std::string>& objects, Numbers& numbers) {
  const auto how = numbers.next<std::uint8_t>();
  const std::string& name = objects[numbers.next<std::uint8_t>() % objects.size()];
  const hid_t object = H5Oopen(file, name.c_str(), H5P_DEFAULT);
  if (object < 0) return;  // deleted by an earlier change
  const bool is_dataset = H5Iget_type(object) == H5I_DATASET;
  if (how % 8 < 3) replaceAttribute(object, numbers);
  if (how % 8 >= 3 && how % 8 < 6 && is_dataset) replaceValue(object, numbers);
  H5Oclose(object);
  if (how % 8 == 6 && is_dataset) replaceDataset(file, name, numbers);
  if (how % 8 == 7) H5Ldelete(file, name.c_str(), H5P_DEFAULT);
}

}  // namespace

std::string damaged(const std::string& image, Numbers& numbers) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, 1 << 16, false);
  H5Pset_file_image(access, const_cast<char*>(image.data()), image.size());  // copied
  const hid_t file = H5Fopen("image", H5F_ACC_RDWR, access);
  const std::vector<std::string> objects = objectsOf(file);
  while (numbers.any()) change(file, objects, numbers);
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  std::string bytes(static_cast<std::size_t>(std::max<ssize_t>(0, H5Fget_file_image(file, nullptr, 0))),
                    '\0');
  H5Fget_file_image(file, bytes.data(), bytes.size());
  H5Fclose(file);
  H5Pclose(access);
  return bytes;
}

}  // namespace fuzz
