#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "exports/scan_record.h"

namespace fsr::exports {

// A bag as one HDF5 file that every program reads and that turns back into the bag, behind a user block of
// 512 bytes, one line of text, as calibration files have it:
//
//     fsr_pressure_map archive schema=1 sha256=<64 hex digits of all that follows byte 512>
//
//     /fsr/raw, /fsr/pressure_map ...  a group for each topic: a dataset for each field (message_table.h)
//     /scans                           the sensor's scans joined with what else is known of them
//     (scan_table.h) /archive/message                 time [messages] received [ns], connection [messages]
//     /archive/connection              topic, type, md5sum, definition, header, group, form, messages, sha256
//                                      (of the topic's messages, one after the other)
//     /archive                         attributes bag, sha256 (of the bag's bytes), tool_version, schema, use
//
// Topics that do not fit into columns (see MessageSurvey::plain()) are kept as `bytes` [all messages' bytes]
// and `bytes.count` [messages]: nothing is lost. docs/exports.md tells readers of the files more.

/// A publisher's connection, as a bag knows it.
struct ArchivedConnection {
  std::string topic, type, md5sum, definition;
  std::map<std::string, std::string> header;  ///< all of it: callerid, latching ...
};

struct ArchiveSource {
  std::string bag;     ///< base name
  std::string sha256;  ///< of its bytes
};

/// Writes an archive in two passes over the messages: first look() at every one, then, in the same order,
/// add() each. Throws InputError where the file cannot be written; without finish() nothing remains.
class ArchiveWriter {
 public:
  ArchiveWriter(const std::string& path, const ArchiveSource& source,
                std::vector<ArchivedConnection> connections);
  ~ArchiveWriter();

  void look(std::size_t connection, std::string_view message);
  void add(std::size_t connection, std::int64_t received_ns, std::string_view message);
  /// Takes the scans of the group /scans, after the last add(); not needed for the way back.
  ScanSink& scans();
  void finish();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

/// One message of an archive.
struct ArchivedMessage {
  std::size_t connection = 0;
  std::int64_t received_ns = 0;
  std::string bytes;
};

/// Reads an archive back. The file's hash is verified before HDF5 sees a byte, that of each connection's
/// messages at the end. Throws InputError that names the file and what is wrong with it.
class ArchiveReader {
 public:
  explicit ArchiveReader(const std::string& path);
  ~ArchiveReader();

  const ArchiveSource& source() const;
  const std::vector<ArchivedConnection>& connections() const;
  /// False behind the last message; then every message was what it was in the bag.
  bool next(ArchivedMessage& message);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace fsr::exports
