#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>

#include "exports/archive.h"
#include "exports/archive_layout.h"
#include "exports/message_table.h"
#include "exports/scan_table.h"
#include "hdf5/writer.h"  // kUserBlock
#include "settings/fresh_file.h"
#include "settings/sha256.h"

namespace fsr::exports {

using hdf5::ColumnWriter;

using hdf5::ColumnPlan;

using hdf5::Handle;
using hdf5::require;

namespace {

hid_t createFile(const std::string& path) {
  hdf5::openLibrary();
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "file");
  require(H5Pset_userblock(creation, hdf5::kUserBlock), "file");
  return H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
}

void makeGroup(hid_t file, const std::string& path) {
  const Handle creation(H5Pcreate(H5P_LINK_CREATE), H5Pclose, path);
  require(H5Pset_create_intermediate_group(creation, 1), path);
  const Handle made(H5Gcreate2(file, path.c_str(), creation, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
}

// Whether a topic's name can be the name of a group: a valid ROS name that is not below /archive or /scans.
bool isGroupName(const std::string& topic) {
  const auto fits = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '/';
  };
  return topic.size() > 1 && topic.front() == '/' && topic.back() != '/' &&
         topic.find("//") == std::string::npos && topic.rfind("/archive", 0) != 0 &&
         topic.rfind("/scans", 0) != 0 && std::all_of(topic.begin(), topic.end(), fits);
}

// Entries "length name=value", as in bags.
std::string headerBytes(const std::map<std::string, std::string>& header) {
  std::string bytes;
  for (const auto& [name, value] : header) {
    const std::string entry = name + '=' + value;
    const auto length = static_cast<std::uint32_t>(entry.size());
    bytes.append(reinterpret_cast<const char*>(&length), sizeof(length)).append(entry);
  }
  return bytes;
}

std::optional<MessageType> typeOf(const ArchivedConnection& connection) {
  try {
    return parseMessageType(connection.type, connection.definition);
  } catch (const settings::InputError&) {
    return {};  // its messages are kept as bytes
  }
}

// The messages of a topic, as bytes.
class ByteTable {
 public:
  ByteTable(hid_t file, const std::string& group)
      : bytes_(file, plan(group + "/bytes", H5T_NATIVE_UINT8, "serialised messages, one after the other")),
        count_(file, plan(group + "/bytes.count", H5T_NATIVE_UINT32, "number of bytes of each message")) {}
  void add(std::string_view message) {
    const auto size = static_cast<std::uint32_t>(message.size());
    count_.append(&size, 1);
    bytes_.append(message.data(), message.size());
  }
  void finish() {
    bytes_.finish();
    count_.finish();
  }

 private:
  static ColumnPlan plan(const std::string& path, hid_t type, const std::string& meaning) {
    ColumnPlan plan;
    plan.path = path;
    plan.type = type;
    plan.meaning = meaning;
    return plan;
  }
  ColumnWriter bytes_, count_;
};

// The messages of one topic and type, of all publishers.
struct Topic {
  ArchivedConnection name;  // of the first publisher
  std::string group;
  std::optional<MessageType> type;
  std::optional<MessageSurvey> survey;
  std::unique_ptr<MessageTableWriter> columns;
  std::unique_ptr<ByteTable> bytes;

  bool plain() const { return type && survey->plain(); }
};

}  // namespace

struct ArchiveWriter::Content {
  Content(const std::string& output, const ArchiveSource& from, std::vector<ArchivedConnection> all)
      : path(output), source(from), connections(std::move(all)), lock(hdf5::hdf5Mutex()), fresh(output) {
    for (const ArchivedConnection& connection : connections) topic_of.push_back(topicOf(connection));
    messages.resize(connections.size());
    digests.resize(connections.size());
  }

  std::size_t topicOf(const ArchivedConnection& connection) {
    const auto same = [&](const auto& topic) {
      return topic->name.topic == connection.topic && topic->name.type == connection.type &&
             topic->name.definition == connection.definition;
    };
    const auto found = std::find_if(topics.begin(), topics.end(), same);
    if (found != topics.end()) return static_cast<std::size_t>(found - topics.begin());
    topics.push_back(std::make_unique<Topic>());
    Topic& topic = *topics.back();
    topic.name = connection;
    topic.type = typeOf(connection);
    if (topic.type) topic.survey.emplace(*topic.type);
    return topics.size() - 1;
  }

  // The topic's own name, unless datasets of another topic could have the same path.
  std::string groupOf(const Topic& topic, std::size_t number) {
    const std::string& name = topic.name.topic;
    const auto under = [&](const auto& other) { return other->name.topic.rfind(name + '/', 0) == 0; };
    const bool free = isGroupName(name) && std::none_of(topics.begin(), topics.end(), under);
    if (free && groups.insert(name).second) return name;
    return "/archive/topic/" + std::to_string(number);
  }

  void begin() {
    if (file) return;
    file.emplace(createFile(fresh.name()), H5Fclose, "file");
    for (std::size_t i = 0; i < topics.size(); ++i) {
      Topic& topic = *topics[i];
      topic.group = groupOf(topic, i);
      makeGroup(*file, topic.group);
      hdf5::setAttribute(*file, topic.group, "topic", topic.name.topic);
      hdf5::setAttribute(*file, topic.group, "type", topic.name.type);
      if (topic.plain()) {
        topic.columns = std::make_unique<MessageTableWriter>(*file, topic.group, *topic.type, *topic.survey);
      } else {
        topic.bytes = std::make_unique<ByteTable>(*file, topic.group);
      }
    }
    makeGroup(*file, "/archive/message");
    makeGroup(*file, "/archive/connection");
    ColumnPlan plan;
    plan.path = "/archive/message/time";
    plan.type = H5T_NATIVE_INT64;
    plan.unit = "ns";
    plan.meaning = "time of reception of each message, since 1970, UTC; in the bag's order";
    time.emplace(*file, plan);
    plan.path = "/archive/message/connection";
    plan.type = H5T_NATIVE_UINT32;
    plan.unit.clear();
    plan.meaning = "row in /archive/connection; the next unread entry of its group is the message";
    sender.emplace(*file, plan);
  }

  void add(std::size_t from, std::int64_t received_ns, std::string_view message) {
    begin();
    Topic& topic = *topics[topic_of[from]];
    if (topic.columns) {
      topic.columns->add(message);
    } else {
      topic.bytes->add(message);
    }
    const auto row = static_cast<std::uint32_t>(from);
    time->append(&received_ns, 1);
    sender->append(&row, 1);
    const auto size = static_cast<std::uint32_t>(message.size());
    digests[from].add(&size, sizeof(size));
    digests[from].add(message.data(), message.size());
    ++messages[from];
  }

  void texts(const std::string& name, const std::vector<std::string>& values) {
    ColumnPlan plan;
    plan.path = "/archive/connection/" + name;
    for (const std::string& value : values) plan.text_size = std::max(plan.text_size, value.size());
    ColumnWriter column(*file, plan);
    for (const std::string& value : values) column.appendText(value);
    column.finish();
  }

  void describe() {
    std::vector<std::string> topic, type, md5sum, definition, group, form, sha;
    ByteTable headers(*file, "/archive/connection");
    for (std::size_t i = 0; i < connections.size(); ++i) {
      const Topic& of = *topics[topic_of[i]];
      topic.push_back(connections[i].topic);
      type.push_back(connections[i].type);
      md5sum.push_back(connections[i].md5sum);
      definition.push_back(connections[i].definition);
      group.push_back(of.group);
      form.push_back(of.plain() ? archive::kColumns : archive::kBytes);
      sha.push_back(digests[i].hexadecimal());
      headers.add(headerBytes(connections[i].header));
    }
    headers.finish();
    texts("topic", topic);
    texts("type", type);
    texts("md5sum", md5sum);
    texts("definition", definition);
    texts("group", group);
    texts("form", form);
    texts("sha256", sha);
    ColumnPlan plan;
    plan.path = "/archive/connection/messages";
    plan.type = H5T_NATIVE_UINT64;
    ColumnWriter count(*file, plan);
    count.append(messages.data(), messages.size());
    count.finish();
    hdf5::setAttribute(*file, "/archive", "schema", archive::kSchema);
    hdf5::setAttribute(*file, "/archive", "bag", source.bag);
    hdf5::setAttribute(*file, "/archive", "sha256", source.sha256);
    hdf5::setAttribute(*file, "/archive", "tool_version", FSR_VERSION);
    hdf5::setAttribute(*file, "/archive", "use", "research use, not for diagnosis or fitting decisions");
  }

  void close() {
    for (auto& topic : topics) {
      if (topic->columns) topic->columns->finish();
      if (topic->bytes) topic->bytes->finish();
      topic->columns.reset();
      topic->bytes.reset();
    }
    if (scans) scans->finish();
    scans.reset();
    time->finish();
    sender->finish();
    describe();
    time.reset();
    sender.reset();
    require(H5Fflush(*file, H5F_SCOPE_GLOBAL), "file");
    file.reset();
  }

  void sign() {
    const std::string line = archive::firstLine(settings::sha256OfFile(fresh.name(), hdf5::kUserBlock));
    std::fstream block(fresh.name(), std::ios::in | std::ios::out | std::ios::binary);
    if (!block.write(line.data(), static_cast<std::streamsize>(line.size())).flush()) {
      throw settings::cannotWrite(path, errno != 0 ? errno : EIO);
    }
  }

  std::string path;
  ArchiveSource source;
  std::vector<ArchivedConnection> connections;
  std::lock_guard<std::mutex> lock;
  settings::FreshPath fresh;
  std::vector<std::size_t> topic_of;  // [connections]
  std::vector<std::unique_ptr<Topic>> topics;
  std::set<std::string> groups;
  std::optional<Handle> file;
  std::optional<ColumnWriter> time, sender;
  std::unique_ptr<ScanTable> scans;
  std::vector<std::uint64_t> messages;    // [connections]
  std::vector<settings::Sha256> digests;  // [connections]
};

ArchiveWriter::ArchiveWriter(const std::string& path, const ArchiveSource& source,
                             std::vector<ArchivedConnection> connections)
    : content_(std::make_unique<Content>(path, source, std::move(connections))) {}

ArchiveWriter::~ArchiveWriter() = default;

void ArchiveWriter::look(std::size_t connection, std::string_view message) {
  Topic& topic = *content_->topics[content_->topic_of[connection]];
  if (topic.type) topic.survey->look(message);
}

void ArchiveWriter::add(std::size_t connection, std::int64_t received_ns, std::string_view message) {
  archive::attempt(content_->path, [&] { content_->add(connection, received_ns, message); });
}

ScanSink& ArchiveWriter::scans() {
  if (!content_->scans) {
    archive::attempt(content_->path, [&] {
      content_->begin();
      makeGroup(*content_->file, "/scans");
    });
    content_->scans = std::make_unique<ScanTable>(*content_->file, content_->path);
  }
  return *content_->scans;
}

void ArchiveWriter::finish() {
  archive::attempt(content_->path, [&] {
    content_->begin();
    content_->close();
  });
  content_->sign();
  content_->fresh.finish();
}

}  // namespace fsr::exports
