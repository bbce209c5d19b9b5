#include "ros/bags/bag_stream.h"

#include <rosbag/constants.h>
#include <rosbag/exceptions.h>

#include <algorithm>
#include <deque>
#include <set>
#include <string_view>

#include "ros/bags/sensor_topics.h"

namespace fsr_ros {

namespace {

using bag_records::damaged;
using bag_records::field;
using bag_records::number;
using bag_records::RecordFile;
using bag_records::takeBlock;

constexpr std::size_t kKeptChunks = 4u << 20;       // unpacked chunks that are kept [bytes]
constexpr std::uint64_t kMessagesOfReport = 10000;  // between two reports of progress

ros::Time timeOf(std::string_view entry) {
  return {number<std::uint32_t>(entry), number<std::uint32_t>(entry.substr(4))};
}

void requireKind(const RecordFile& file, std::uint8_t kind, const std::string& what) {
  if (field<std::uint8_t>(file.header(), rosbag::OP_FIELD_NAME) != kind) damaged(what);
}

StreamedConnection connectionOf(std::string_view header, std::string_view data) {
  StreamedConnection connection;
  connection.id = field<std::uint32_t>(header, rosbag::CONNECTION_FIELD_NAME);
  connection.about = connectionIn(header, data);
  while (!data.empty()) {
    const std::string_view entry = takeBlock(data);
    const std::size_t equals = entry.find('=');
    if (equals == std::string_view::npos) damaged("a header field has no value");
    connection.header.emplace(entry.substr(0, equals), entry.substr(equals + 1));
  }
  return connection;
}

bool asksFor(const StreamQuery& query, const StreamedConnection& connection) {
  const auto& topics = query.topics;
  return topics.empty() || std::find(topics.begin(), topics.end(), connection.about.topic) != topics.end();
}

}  // namespace

// The index entries of one connection in the order of reception; equal times as in the file.
class BagStream::Cursor {
 public:
  struct Entry {
    ros::Time received;
    std::uint64_t chunk;
    std::uint32_t order, offset;
  };

  Cursor(const std::string& path, std::size_t connection, const std::vector<Run>& runs)
      : path_(path), connection_(connection), runs_(runs) {}

  std::size_t connection() const { return connection_; }
  /// nullptr = there is no further one.
  const Entry* front() {
    while (next_ < runs_.size() && (at_ == entries_.size() || runs_[next_].first <= entries_[at_].received)) {
      load(runs_[next_++]);
    }
    return at_ < entries_.size() ? &entries_[at_] : nullptr;
  }
  void advance() { ++at_; }

 private:
  void load(const Run& run) {
    entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ = 0;
    RecordFile file(path_, RecordFile::Hash::kNone);
    file.goTo(run.index);
    file.next();
    for (std::string_view data = file.data(); data.size() >= bag_records::kIndexEntry;
         data.remove_prefix(bag_records::kIndexEntry))
      entries_.push_back({timeOf(data), run.chunk, run.order, number<std::uint32_t>(data.substr(8))});
    const auto before = [](const Entry& a, const Entry& b) {
      return a.received != b.received ? a.received < b.received : a.order < b.order;
    };
    if (!std::is_sorted(entries_.begin(), entries_.end(), before))
      std::stable_sort(entries_.begin(), entries_.end(), before);
  }

  const std::string& path_;
  std::size_t connection_;
  const std::vector<Run>& runs_;
  std::size_t next_ = 0;  // run to load
  std::vector<Entry> entries_;
  std::size_t at_ = 0;
};

// The chunks that were read last.
class BagStream::Chunks {
 public:
  explicit Chunks(const std::string& path) : file_(path, RecordFile::Hash::kNone) {}

  /// The record of a message and the rest of its chunk. Valid until the next call.
  std::pair<char*, std::size_t> from(std::uint64_t position, std::uint32_t offset) {
    std::string& data = chunk(position);
    if (offset > data.size()) damaged("an index points behind its chunk");
    return {data.data() + offset, data.size() - offset};
  }

 private:
  struct Kept {
    std::uint64_t position;
    std::string data;
  };

  std::string& chunk(std::uint64_t position) {
    for (Kept& kept : kept_) {
      if (kept.position == position) return kept.data;
    }
    std::size_t bytes = 0;
    for (const Kept& kept : kept_) bytes += kept.data.size();
    for (; bytes > kKeptChunks; kept_.pop_front()) bytes -= kept_.front().data.size();
    file_.goTo(position);
    file_.next();
    requireKind(file_, rosbag::OP_CHUNK, "a chunk is not where its description says");
    kept_.push_back({position, {}});
    bag_records::unpackChunk(file_, kept_.back().data);
    return kept_.back().data;
  }

  RecordFile file_;
  std::deque<Kept> kept_;
};

BagStream::BagStream(const std::string& path) : path_(path) {
  RecordFile file(path, RecordFile::Hash::kNone);
  readConnections(file);
  for (const auto& [position, records] : chunks_) readRuns(file, position, records);
  for (auto& [id, runs] : runs_) {
    const auto earlier = [](const Run& a, const Run& b) { return a.first < b.first; };
    std::stable_sort(runs.begin(), runs.end(), earlier);
  }
  const auto silent = [&](const StreamedConnection& connection) { return runs_.count(connection.id) == 0; };
  connections_.erase(std::remove_if(connections_.begin(), connections_.end(), silent), connections_.end());
}

void BagStream::readConnections(RecordFile& file) {
  file.next();
  requireKind(file, rosbag::OP_FILE_HEADER, "its first record is not the file's header");
  const auto index = field<std::uint64_t>(file.header(), rosbag::INDEX_POS_FIELD_NAME);
  if (index == 0) throw rosbag::BagUnindexedException();
  std::map<std::uint32_t, StreamedConnection> connections;
  for (file.goTo(index); !file.atEnd();) {
    file.next();
    const auto kind = field<std::uint8_t>(file.header(), rosbag::OP_FIELD_NAME);
    if (kind == rosbag::OP_CONNECTION) {
      StreamedConnection connection = connectionOf(file.header(), file.data());
      const std::uint32_t id = connection.id;
      connections.emplace(id, std::move(connection));
    }
    if (kind == rosbag::OP_CHUNK_INFO) {
      chunks_.emplace_back(field<std::uint64_t>(file.header(), rosbag::CHUNK_POS_FIELD_NAME),
                           field<std::uint32_t>(file.header(), rosbag::COUNT_FIELD_NAME));
    }
  }
  for (auto& [id, connection] : connections) connections_.push_back(std::move(connection));
}

// The index records stand behind their chunk.
void BagStream::readRuns(RecordFile& file, std::uint64_t chunk, std::uint32_t records) {
  file.goTo(chunk);
  file.skip();
  requireKind(file, rosbag::OP_CHUNK, "a chunk is not where its description says");
  for (std::uint32_t r = 0; r < records; ++r) {
    Run run;
    run.chunk = chunk;
    run.index = file.position();
    file.next();
    requireKind(file, rosbag::OP_INDEX_DATA, "an index is missing behind its chunk");
    const auto id = field<std::uint32_t>(file.header(), rosbag::CONNECTION_FIELD_NAME);
    std::string_view data = file.data();
    if (data.size() < bag_records::kIndexEntry) continue;
    run.first = timeOf(data);
    for (; data.size() >= bag_records::kIndexEntry; data.remove_prefix(bag_records::kIndexEntry))
      run.first = std::min(run.first, timeOf(data));
    std::vector<Run>& runs = runs_[id];
    run.order = static_cast<std::uint32_t>(runs.size());
    runs.push_back(run);
  }
}

std::map<std::string, std::string> BagStream::types() const {
  std::map<std::string, std::string> types;
  for (const StreamedConnection& connection : connections_)
    types[connection.about.topic] = connection.about.type;
  return types;
}

ros::Time BagStream::begin() const {
  ros::Time begin = ros::TIME_MAX;
  for (const StreamedConnection& connection : connections_)
    begin = std::min(begin, runs_.at(connection.id).front().first);
  return begin;
}

std::uint64_t BagStream::forEach(const StreamQuery& query, const Take& take) const {
  std::vector<std::unique_ptr<Cursor>> cursors;
  for (std::size_t c = 0; c < connections_.size(); ++c) {
    if (!asksFor(query, connections_[c])) continue;
    cursors.push_back(std::make_unique<Cursor>(path_, c, runs_.at(connections_[c].id)));
    if (cursors.back()->front() == nullptr) cursors.pop_back();
  }
  Chunks chunks(path_);
  // The order of rosbag::View, also of messages with the same time: it sorts its iterators after every
  // message with this comparison, latest first, and takes the last one.
  const auto later = [](const std::unique_ptr<Cursor>& a, const std::unique_ptr<Cursor>& b) {
    return a->front()->received > b->front()->received;
  };
  const std::uint64_t end = chunks_.empty() ? 1 : chunks_.back().first + 1;
  std::uint64_t taken = 0;
  for (std::sort(cursors.begin(), cursors.end(), later); !cursors.empty();
       std::sort(cursors.begin(), cursors.end(), later)) {
    Cursor& cursor = *cursors.back();
    const Cursor::Entry& entry = *cursor.front();
    if (query.progress && taken % kMessagesOfReport == 0)
      query.progress(static_cast<double>(entry.chunk) / static_cast<double>(end));
    const auto [begin, length] = chunks.from(entry.chunk, entry.offset);
    std::string_view rest(begin, length);
    const std::string_view header = takeBlock(rest);
    const std::string_view content = takeBlock(rest);
    const StreamedConnection& connection = connections_[cursor.connection()];
    if (field<std::uint8_t>(header, rosbag::OP_FIELD_NAME) != rosbag::OP_MSG_DATA ||
        field<std::uint32_t>(header, rosbag::CONNECTION_FIELD_NAME) != connection.id) {
      damaged("an index points to no message");
    }
    ++taken;
    auto* const bytes = reinterpret_cast<std::uint8_t*>(begin + (content.data() - begin));
    if (!take({cursor.connection(), connection.about, entry.received, bytes,
               static_cast<std::uint32_t>(content.size())})) {
      break;
    }
    cursor.advance();
    if (cursor.front() == nullptr) cursors.pop_back();
  }
  return taken;
}

void withBagStream(const std::string& path, const std::function<void(const BagStream&)>& use,
                   const BagWalk::ReadProgress& progress) {
  tellingOfDamage(path, [&] {
    requireSoundBag(path, progress);
    use(BagStream(path));
  });
}

}  // namespace fsr_ros
