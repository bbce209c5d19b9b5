#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "hdf5/handle.h"

// Only sources include this header: it needs HDF5's own.

namespace fsr::hdf5 {

/// What a column holds in each entry.
struct ColumnPlan {
  std::string path;                ///< of the dataset; its group must be there
  hid_t type = 0;                  ///< of a value, a native HDF5 type; 0 = texts of `text_size` bytes
  std::size_t text_size = 0;       ///< [bytes]
  std::vector<std::size_t> shape;  ///< of an entry; empty = one value
  std::string unit;                ///< attributes, where they are not empty
  std::string meaning;
};

/// Fixed length, padded with zeros, UTF-8: every reader of HDF5 knows it.
hid_t textType(std::size_t size);

/// Attributes of a group or dataset that exists.
void setAttribute(hid_t file, const std::string& path, const std::string& name, const std::string& text);
void setAttribute(hid_t file, const std::string& path, const std::string& name, double value);
void setAttribute(hid_t file, const std::string& path, const std::string& name, hid_t type, hid_t space,
                  const void* values);

/// A dataset [entries x shape] that grows entry by entry; chunked, shuffled and compressed (deflate).
class ColumnWriter {
 public:
  ColumnWriter(hid_t file, const ColumnPlan& plan);
  /// `bytes` of whole entries one after the other; a text is shorter than or as long as planned.
  void append(const void* bytes, std::size_t entries);
  void appendText(std::string_view text);
  /// Writes what is still held back; the last call.
  void finish();

 private:
  void flush();

  Handle type_;
  std::string path_;
  std::vector<std::size_t> shape_;
  std::size_t entry_size_;     // [bytes]
  std::size_t chunk_entries_;  // written at once
  Handle dataset_;
  std::vector<char> waiting_;  // whole entries
  std::size_t written_ = 0;    // entries
};

}  // namespace fsr::hdf5
