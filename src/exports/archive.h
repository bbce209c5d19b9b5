#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "exports/scan_record.h"

namespace fsr::exports {

// A bag as one HDF5 file, from which the bag can be restored. As in calibration files, a user block of 512
// bytes with one line of text comes first:
//
//     fsr_pressure_map archive schema=1 sha256=<64 hex digits of all that follows byte 512>
//
//     /fsr/raw, /fsr/pressure_map ...  a group for each topic: a dataset for each field (message_table.h)
//     /scans                           the scans, joined with the other values of their time (scan_table.h)
//     /archive/message                 time [messages] received [ns], connection [messages]
//     /archive/connection              topic, type, md5sum, definition, header, group, form, messages,
//                                      sha256 (of the connection's messages, each with its length)
//     /archive                         attributes bag, sha256 (of the bag's bytes), tool_version, schema, use
//
// Topics that do not fit into columns (see MessageSurvey::plain()) are kept as `bytes` [bytes of all
// messages] and `bytes.count` [messages], so nothing is lost. docs/exports.md describes the file for its
// readers.

/// A publisher's connection, as in a bag.
struct ArchivedConnection {
  std::string topic, type, md5sum, definition;
  std::map<std::string, std::string> header;  ///< all entries: callerid, latching ...
};

struct ArchiveSource {
  std::string bag;     ///< base name
  std::string sha256;  ///< of the bag's bytes
};

/// Writes an archive in two passes over the messages: first look() for each message, then, in the same order,
/// add() for each. Throws InputError if the file cannot be written. Without finish() no file remains.
class ArchiveWriter {
 public:
  ArchiveWriter(const std::string& path, const ArchiveSource& source,
                std::vector<ArchivedConnection> connections);
  ~ArchiveWriter();

  void look(std::size_t connection, std::string_view message);
  void add(std::size_t connection, std::int64_t received_ns, std::string_view message);
  /// Takes the scans for the group /scans, after the last add(). They are not needed to restore the bag.
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

/// Reads an archive back. The file's hash is verified before HDF5 reads the file, the hash of each
/// connection's messages after the last message. Throws InputError that names the file and the defect.
class ArchiveReader {
 public:
  /// `progress` is called with the share of the file whose hash is computed, before any message is read.
  explicit ArchiveReader(const std::string& path, const std::function<void(double share)>& progress = {});
  ~ArchiveReader();

  const ArchiveSource& source() const;
  const std::vector<ArchivedConnection>& connections() const;
  std::size_t messages() const;
  /// Reads the next message. Returns false after the last one; then all messages are those of the bag.
  bool next(ArchivedMessage& message);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace fsr::exports
