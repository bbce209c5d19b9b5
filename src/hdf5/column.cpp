#include "hdf5/column.h"

#include <algorithm>
#include <cstring>

namespace fsr::hdf5 {

namespace {

constexpr std::size_t kChunk = 1 << 16;  // [bytes]; a column buffers as much
constexpr unsigned kDeflate = 4;         // level

std::vector<hsize_t> dimensions(std::size_t entries, const std::vector<std::size_t>& shape) {
  std::vector<hsize_t> all = {entries};
  all.insert(all.end(), shape.begin(), shape.end());
  return all;
}

// Columns are written chunk by chunk, so HDF5's own cache of a megabyte each is not needed.
hid_t accessPlan() {
  const hid_t plan = H5Pcreate(H5P_DATASET_ACCESS);
  H5Pset_chunk_cache(plan, 7, 4 * kChunk, 1.0);
  return plan;
}

hid_t makeDataset(hid_t file, const ColumnPlan& plan, hid_t type, std::size_t chunk_entries) {
  const std::vector<hsize_t> none = dimensions(0, plan.shape);
  const std::vector<hsize_t> any = dimensions(H5S_UNLIMITED, plan.shape);
  const std::vector<hsize_t> chunk = dimensions(chunk_entries, plan.shape);
  const int rank = static_cast<int>(none.size());
  const Handle space(H5Screate_simple(rank, none.data(), any.data()), H5Sclose, plan.path);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, plan.path);
  require(H5Pset_obj_track_times(creation, false), plan.path);  // so that equal content gives equal bytes
  require(H5Pset_chunk(creation, rank, chunk.data()), plan.path);
  require(H5Pset_shuffle(creation), plan.path);
  require(H5Pset_deflate(creation, kDeflate), plan.path);
  const Handle access(accessPlan(), H5Pclose, plan.path);
  return H5Dcreate2(file, plan.path.c_str(), type, space, H5P_DEFAULT, creation, access);
}

std::size_t chunkEntries(std::size_t entry_size) {
  return std::max<std::size_t>(1, kChunk / entry_size);
}

}  // namespace

hid_t textType(std::size_t size) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(size, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

void setAttribute(hid_t file, const std::string& path, const std::string& name, hid_t type, hid_t space,
                  const void* values) {
  const Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, path);
  const Handle made(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
  require(H5Awrite(made, type, values), name);
}

void setAttribute(hid_t file, const std::string& path, const std::string& name, const std::string& text) {
  const Handle type(textType(text.size()), H5Tclose, name);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, name);
  setAttribute(file, path, name, type, space, text.c_str());
}

void setAttribute(hid_t file, const std::string& path, const std::string& name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, name);
  setAttribute(file, path, name, H5T_NATIVE_DOUBLE, space, &value);
}

ColumnWriter::ColumnWriter(hid_t file, const ColumnPlan& plan)
    : type_(plan.type != 0 ? H5Tcopy(plan.type) : textType(plan.text_size), H5Tclose, plan.path),
      path_(plan.path),
      shape_(plan.shape),
      entry_size_(H5Tget_size(type_) * elements(plan.shape)),
      chunk_entries_(chunkEntries(entry_size_)),
      dataset_(makeDataset(file, plan, type_, chunk_entries_), H5Dclose, plan.path) {
  if (!plan.unit.empty()) setAttribute(file, path_, "unit", plan.unit);
  if (!plan.meaning.empty()) setAttribute(file, path_, "meaning", plan.meaning);
}

void ColumnWriter::append(const void* bytes, std::size_t entries) {
  const char* from = static_cast<const char*>(bytes);
  while (entries > 0) {
    const std::size_t room = chunk_entries_ - waiting_.size() / entry_size_;
    const std::size_t now = std::min(room, entries);
    waiting_.insert(waiting_.end(), from, from + now * entry_size_);
    from += now * entry_size_;
    entries -= now;
    if (now == room) flush();
  }
}

void ColumnWriter::appendText(std::string_view text) {
  waiting_.insert(waiting_.end(), text.begin(), text.end());
  waiting_.resize(waiting_.size() + entry_size_ - text.size(), '\0');
  if (waiting_.size() == chunk_entries_ * entry_size_) flush();
}

// Writes whole chunks only, except the last, so that none is compressed twice.
void ColumnWriter::flush() {
  const std::size_t entries = waiting_.size() / entry_size_;
  if (entries == 0) return;
  const std::vector<hsize_t> size = dimensions(written_ + entries, shape_);
  require(H5Dset_extent(dataset_, size.data()), path_);
  std::vector<hsize_t> start(size.size(), 0);
  start[0] = written_;
  const std::vector<hsize_t> count = dimensions(entries, shape_);
  const Handle space(H5Dget_space(dataset_), H5Sclose, path_);
  require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), path_);
  const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose,
                      path_);
  require(H5Dwrite(dataset_, type_, memory, space, H5P_DEFAULT, waiting_.data()), path_);
  written_ += entries;
  waiting_.clear();
}

void ColumnWriter::finish() {
  flush();
}

}  // namespace fsr::hdf5
