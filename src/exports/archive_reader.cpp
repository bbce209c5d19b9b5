#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "exports/archive.h"
#include "exports/archive_layout.h"
#include "exports/message_table.h"
#include "hdf5/writer.h"  // kUserBlock
#include "settings/file_hash.h"
#include "settings/sha256.h"

namespace fsr::exports {

using hdf5::ColumnReader;

using hdf5::Handle;

namespace {

// Refuses a file that is not an archive, before HDF5 reads it.
void verify(const std::string& path, const std::function<void(double share)>& progress) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw settings::InputError("there is no such file");
  std::ifstream file(path, std::ios::binary);
  std::string block(hdf5::kUserBlock, '\0');
  file.read(block.data(), static_cast<std::streamsize>(block.size()));
  const std::string start = std::string(archive::kFormat) + " schema=";
  if (block.compare(0, start.size(), start) != 0) {
    throw settings::InputError("is not an archive; give one that export --to hdf5 has written");
  }
  if (std::strtoull(block.c_str() + start.size(), nullptr, 10) > archive::kSchema) {
    throw settings::InputError("was written by a later version; update the package");
  }
  const std::string line = archive::firstLine(settings::sha256OfFile(path, hdf5::kUserBlock, progress));
  if (block.compare(0, line.size(), line) != 0) {
    throw settings::InputError(
        "is damaged or cut short: its SHA-256 is not the one in its first line; copy the file again");
  }
}

hid_t openFile(const std::string& path) {
  hdf5::openLibrary();
  return H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
}

std::map<std::string, std::string> headerOf(std::string_view bytes) {
  std::map<std::string, std::string> header;
  std::uint32_t length = 0;
  while (message_detail::takeLength(bytes, length) && length <= bytes.size()) {
    const std::string entry(bytes.substr(0, length));
    const std::size_t equals = entry.find('=');
    if (equals != std::string::npos) header[entry.substr(0, equals)] = entry.substr(equals + 1);
    bytes.remove_prefix(length);
  }
  return header;
}

class ByteReader {
 public:
  ByteReader(hid_t file, const std::string& group)
      : bytes_(file, group + "/bytes", H5T_NATIVE_UINT8),
        count_(file, group + "/bytes.count", H5T_NATIVE_UINT32) {}
  void next(std::string& bytes) {
    std::uint32_t size = 0;
    std::memcpy(&size, count_.next(), sizeof(size));
    bytes.append(bytes_.next(size), size);
  }

 private:
  ColumnReader bytes_, count_;
};

struct Topic {
  std::optional<MessageType> type;
  std::unique_ptr<MessageTableReader> columns;
  std::unique_ptr<ByteReader> bytes;
};

}  // namespace

struct ArchiveReader::Content {
  Content(const std::string& from, const std::function<void(double share)>& progress)
      : path(from), lock(hdf5::hdf5Mutex()) {
    verify(path, progress);
    file.emplace(openFile(path), H5Fclose, "file");
    source.bag = hdf5::textAttribute(*file, "/archive", "bag");
    source.sha256 = hdf5::textAttribute(*file, "/archive", "sha256");
    time.emplace(*file, "/archive/message/time", H5T_NATIVE_INT64);
    sender.emplace(*file, "/archive/message/connection", H5T_NATIVE_UINT32);
    readConnections();
    left = time->entries();
  }

  void readConnections() {
    const auto column = [&](const std::string& name) {
      return ColumnReader(*file, "/archive/connection/" + name, 0);
    };
    ColumnReader topic = column("topic"), type = column("type"), md5sum = column("md5sum"),
                 definition = column("definition"), group = column("group"), form = column("form"),
                 sha = column("sha256");
    ByteReader headers(*file, "/archive/connection");
    for (std::size_t i = 0; i < topic.entries(); ++i) {
      ArchivedConnection one;
      one.topic = topic.nextText();
      one.type = type.nextText();
      one.md5sum = md5sum.nextText();
      one.definition = definition.nextText();
      std::string header;
      headers.next(header);
      one.header = headerOf(header);
      topic_of.push_back(open(std::string(group.nextText()), std::string(form.nextText()), one));
      expected.emplace_back(sha.nextText());
      digests.emplace_back();
      connections.push_back(std::move(one));
    }
  }

  Topic* open(const std::string& group, const std::string& form, const ArchivedConnection& connection) {
    std::unique_ptr<Topic>& topic = topics[group];
    if (topic) return topic.get();
    topic = std::make_unique<Topic>();
    if (form == archive::kBytes) {
      topic->bytes = std::make_unique<ByteReader>(*file, group);
    } else {
      topic->type = parseMessageType(connection.type, connection.definition);
      topic->columns = std::make_unique<MessageTableReader>(*file, group, *topic->type);
    }
    return topic.get();
  }

  bool next(ArchivedMessage& message) {
    if (left == 0) {
      verifyMessages();
      return false;
    }
    --left;
    std::uint32_t row = 0;
    std::memcpy(&message.received_ns, time->next(), sizeof(message.received_ns));
    std::memcpy(&row, sender->next(), sizeof(row));
    if (row >= connections.size())
      throw settings::InputError("its /archive/message/connection has a row that does not exist");
    message.connection = row;
    message.bytes.clear();
    Topic& topic = *topic_of[row];
    if (topic.bytes) {
      topic.bytes->next(message.bytes);
    } else {
      topic.columns->next(message.bytes);
    }
    const auto size = static_cast<std::uint32_t>(message.bytes.size());
    digests[row].add(&size, sizeof(size));
    digests[row].add(message.bytes.data(), size);
    return true;
  }

  void verifyMessages() {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (digests[i].hexadecimal() == expected[i]) continue;
      throw settings::InputError("the messages of " + connections[i].topic + " differ from those of the bag");
    }
  }

  std::string path;
  std::lock_guard<std::mutex> lock;
  ArchiveSource source;
  std::optional<Handle> file;
  std::optional<ColumnReader> time, sender;
  std::vector<ArchivedConnection> connections;
  std::map<std::string, std::unique_ptr<Topic>> topics;  // by group
  std::vector<Topic*> topic_of;                          // [connections]
  std::vector<settings::Sha256> digests;
  std::vector<std::string> expected;
  std::size_t left = 0;
};

namespace {

template <typename Act>
auto naming(const std::string& path, Act act) {
  try {
    return act();
  } catch (const settings::InputError& error) {
    throw settings::InputError(path + ": " + error.what());
  }
}

}  // namespace

ArchiveReader::ArchiveReader(const std::string& path, const std::function<void(double share)>& progress)
    : content_(naming(path, [&] { return std::make_unique<Content>(path, progress); })) {}

ArchiveReader::~ArchiveReader() = default;

const ArchiveSource& ArchiveReader::source() const {
  return content_->source;
}

const std::vector<ArchivedConnection>& ArchiveReader::connections() const {
  return content_->connections;
}

std::size_t ArchiveReader::messages() const {
  return content_->time->entries();
}

bool ArchiveReader::next(ArchivedMessage& message) {
  return naming(content_->path, [&] { return content_->next(message); });
}

}  // namespace fsr::exports
