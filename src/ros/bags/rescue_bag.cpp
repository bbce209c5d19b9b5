// A bag is a file header, then chunks, each with the index records of its messages, then the connection
// records and one record for each chunk (http://wiki.ros.org/Bags/Format/2.0). A chunk says its size once it
// is finished. The records in it look like those of the file itself.

#include "ros/bags/rescue_bag.h"

#include <fcntl.h>
#include <rosbag/constants.h>
#include <rosbag/exceptions.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_records.h"
#include "ros/bags/bag_walk.h"
#include "session/session_files.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"

namespace fsr_ros {

namespace {

using bag_records::damaged;
using bag_records::field;
using bag_records::number;
using bag_records::RecordFile;
using bag_records::takeBlock;

constexpr char kActive[] = ".active";
constexpr std::uint64_t kPiece = 1u << 20;  // of a file that is searched [bytes]
constexpr std::uint64_t kChunkHeader = 64;  // at most [bytes]; its three fields take 50
// Where the first chunk begins: behind #ROSBAG V2.0 and the file's header with its two lengths.
constexpr std::uint64_t kFirstChunk = 13 + 8 + rosbag::FILE_HEADER_LENGTH;

template <typename Number>
std::string bytesOf(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

std::string blockOf(std::string_view content) {
  return bytesOf(static_cast<std::uint32_t>(content.size())).append(content);
}

std::string fieldOf(const std::string& name, const std::string& value) {
  return blockOf(name + "=" + value);
}

// Bytes of the file that are overwritten.
struct Patch {
  std::uint64_t position;
  std::string bytes;
};

// Patches a field in the header of a record.
Patch patchOf(std::uint64_t record, std::string_view header, const std::string& name,
              const std::string& value) {
  const std::string_view old = bag_records::fieldBytes(header, name);
  if (old.size() != value.size()) damaged("a number has another length");
  return {record + sizeof(std::uint32_t) + static_cast<std::uint64_t>(old.data() - header.data()), value};
}

// Returns 0 or an errno.
int write(int file, const std::vector<Patch>& patches) {
  for (const Patch& patch : patches) {
    for (std::size_t done = 0; done < patch.bytes.size();) {
      const ssize_t now = ::pwrite(file, patch.bytes.data() + done, patch.bytes.size() - done,
                                   static_cast<off_t>(patch.position + done));
      if (now < 0 && errno == EINTR) continue;
      if (now <= 0) return now < 0 ? errno : EIO;
      done += static_cast<std::size_t>(now);
    }
  }
  return ::fsync(file) == 0 ? 0 : errno;
}

// The messages of one chunk.
struct ChunkContent {
  std::uint64_t position = 0;
  std::uint64_t messages = 0;
  std::pair<std::uint32_t, std::uint32_t> first{~0u, ~0u}, last{0, 0};  // times [s, ns]
  std::map<std::uint32_t, std::string> entries;                         // of the index, by connection

  std::uint32_t count(const std::string& of) const { return static_cast<std::uint32_t>(of.size() / 12); }

  void add(std::string_view header, std::uint32_t offset) {
    const auto time = field<std::string_view>(header, rosbag::TIME_FIELD_NAME);
    const std::pair<std::uint32_t, std::uint32_t> stamp{number<std::uint32_t>(time),
                                                        number<std::uint32_t>(time.substr(4))};
    first = std::min(first, stamp);
    last = std::max(last, stamp);
    entries[field<std::uint32_t>(header, rosbag::CONNECTION_FIELD_NAME)]
        .append(time.substr(0, 8))
        .append(bytesOf(offset));
    ++messages;
  }

  std::string indexRecords() const {
    std::string text;
    for (const auto& [connection, data] : entries) {
      text += blockOf(fieldOf(rosbag::OP_FIELD_NAME, bytesOf(rosbag::OP_INDEX_DATA)) +
                      fieldOf(rosbag::CONNECTION_FIELD_NAME, bytesOf(connection)) +
                      fieldOf(rosbag::VER_FIELD_NAME, bytesOf(rosbag::INDEX_VERSION)) +
                      fieldOf(rosbag::COUNT_FIELD_NAME, bytesOf(count(data)))) +
              blockOf(data);
    }
    return text;
  }

  std::string infoRecord() const {
    std::string counts;
    for (const auto& [connection, data] : entries) counts += bytesOf(connection) + bytesOf(count(data));
    return blockOf(fieldOf(rosbag::OP_FIELD_NAME, bytesOf(rosbag::OP_CHUNK_INFO)) +
                   fieldOf(rosbag::VER_FIELD_NAME, bytesOf(rosbag::CHUNK_INFO_VERSION)) +
                   fieldOf(rosbag::CHUNK_POS_FIELD_NAME, bytesOf(position)) +
                   fieldOf(rosbag::START_TIME_FIELD_NAME, bytesOf(first.first) + bytesOf(first.second)) +
                   fieldOf(rosbag::END_TIME_FIELD_NAME, bytesOf(last.first) + bytesOf(last.second)) +
                   fieldOf(rosbag::COUNT_FIELD_NAME, bytesOf(static_cast<std::uint32_t>(entries.size())))) +
           blockOf(counts);
  }
};

// What is whole in a file.
class BagRemains {
 public:
  explicit BagRemains(const std::string& path) : file_(path, RecordFile::Hash::kNone) {
    header_at_ = file_.position();
    file_.next();
    header_ = file_.header();
    if (field<std::uint8_t>(header_, rosbag::OP_FIELD_NAME) != rosbag::OP_FILE_HEADER)
      damaged("its first record is not the file's header");
    end_ = seen_ = file_.position();
    try {
      while (!file_.atEnd() && takeChunk()) {
      }
    } catch (const rosbag::BagException&) {
      // Here the whole part of the file ends.
    }
    requireEnd();
  }

  std::uint64_t messages() const { return messages_; }

  // Cuts the file, and completes it. Returns 0 or an errno; the file is then cut only.
  int complete(int file) const {
    const std::string index = connectionRecords() + infos_;
    std::vector<Patch> patches = patches_;
    patches.push_back({end_, last_index_ + index});
    int error = write(file, {headerPatch(rosbag::INDEX_POS_FIELD_NAME, std::uint64_t{0})});
    if (error == 0 && ::ftruncate(file, static_cast<off_t>(end_)) != 0) error = errno;
    if (error == 0) error = write(file, patches);
    if (error == 0) {
      error = write(file, {headerPatch(rosbag::INDEX_POS_FIELD_NAME, end_ + last_index_.size()),
                           headerPatch(rosbag::CONNECTION_COUNT_FIELD_NAME, countOf(connections_.size())),
                           headerPatch(rosbag::CHUNK_COUNT_FIELD_NAME, countOf(chunks_))});
    }
    if (error != 0 && ::ftruncate(file, static_cast<off_t>(end_)) != 0) return errno;
    return error;
  }

 private:
  static std::uint32_t countOf(std::size_t size) { return static_cast<std::uint32_t>(size); }

  // Returns false behind the last chunk that is worth keeping. Throws where a record is damaged.
  bool takeChunk() {
    const std::uint64_t start = file_.position();
    seen_ = std::min(file_.size(), start + kChunkHeader);
    const std::uint32_t length = file_.nextHeader();
    const std::string header = file_.header();
    if (field<std::uint8_t>(header, rosbag::OP_FIELD_NAME) != rosbag::OP_CHUNK) return false;
    const std::uint64_t data = file_.position();
    const bool plain =
        field<std::string_view>(header, rosbag::COMPRESSION_FIELD_NAME) == rosbag::COMPRESSION_NONE;
    const bool finished = length > 0 && length <= file_.size() - data;
    if (!finished && !plain) return false;
    file_.take(finished ? length : file_.size() - data, file_.data());
    std::string content;
    if (finished)
      bag_records::unpackChunk(file_, content);
    else
      content = std::move(file_.data());
    ChunkContent chunk;
    chunk.position = start;
    const std::size_t whole = takeRecords(content, chunk);
    if (chunk.messages == 0 || (!plain && whole < content.size())) return false;
    ++chunks_;
    messages_ += chunk.messages;
    infos_ += chunk.infoRecord();
    const bool sound = finished && whole == content.size();
    if (!sound) {
      patches_ = {patchOf(start, header, rosbag::SIZE_FIELD_NAME, bytesOf(countOf(whole))),
                  {data - sizeof(length), bytesOf(countOf(whole))}};
    }
    end_ = seen_ = sound ? file_.position() : data + whole;
    if (sound && isIndexed(chunk)) return true;
    last_index_ = chunk.indexRecords();
    return false;
  }

  // Takes the records of a chunk, and returns where the last whole one ends.
  std::size_t takeRecords(std::string_view content, ChunkContent& chunk) {
    std::string_view rest = content;
    const auto position = [&] { return static_cast<std::size_t>(rest.data() - content.data()); };
    std::size_t whole = 0;
    try {
      while (!rest.empty()) {
        const std::string_view header = takeBlock(rest);
        takeBlock(rest);
        const auto kind = field<std::uint8_t>(header, rosbag::OP_FIELD_NAME);
        if (kind != rosbag::OP_CONNECTION && kind != rosbag::OP_MSG_DATA) break;
        const auto id = field<std::uint32_t>(header, rosbag::CONNECTION_FIELD_NAME);
        if (kind == rosbag::OP_CONNECTION)
          connections_.emplace(id, content.substr(whole, position() - whole));
        else if (connections_.count(id) == 0)
          break;
        else
          chunk.add(header, countOf(whole));
        whole = position();
      }
    } catch (const rosbag::BagException&) {
      // Here the chunk is cut.
    }
    return whole;
  }

  // Whether all index records stand behind the chunk.
  bool isIndexed(const ChunkContent& chunk) {
    std::map<std::uint32_t, std::string> missing = chunk.entries;
    try {
      while (!missing.empty()) {
        file_.next();
        if (field<std::uint8_t>(file_.header(), rosbag::OP_FIELD_NAME) != rosbag::OP_INDEX_DATA) return false;
        const auto found = missing.find(field<std::uint32_t>(file_.header(), rosbag::CONNECTION_FIELD_NAME));
        if (found == missing.end() || found->second.size() != file_.data().size()) return false;
        missing.erase(found);
      }
    } catch (const rosbag::BagException&) {
      return false;
    }
    end_ = seen_ = file_.position();
    return true;
  }

  // Cutting at damage in the middle would lose the chunks behind it.
  void requireEnd() {
    static const std::string chunk = fieldOf(rosbag::OP_FIELD_NAME, bytesOf(rosbag::OP_CHUNK));
    std::string rest;
    for (file_.goTo(seen_); !file_.atEnd();) {
      if (rest.size() >= chunk.size()) rest.erase(0, rest.size() - chunk.size() + 1);
      std::string piece;
      file_.take(std::min<std::uint64_t>(kPiece, file_.size() - file_.position()), piece);
      if ((rest += piece).find(chunk) != std::string::npos)
        damaged("it is damaged after " + std::to_string(end_) + " bytes, and more follows");
    }
  }

  std::string connectionRecords() const {
    std::string text;
    for (const auto& [id, record] : connections_) text += record;
    return text;
  }

  template <typename Number>
  Patch headerPatch(const std::string& name, Number value) const {
    return patchOf(header_at_, header_, name, bytesOf(value));
  }

  RecordFile file_;
  std::uint64_t header_at_ = 0;
  std::string header_;
  std::map<std::uint32_t, std::string> connections_;  // records, by number
  std::string infos_;                                 // records of the chunks
  std::size_t chunks_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t end_ = 0;       // of what is kept of the file
  std::uint64_t seen_ = 0;      // behind it there should be no chunk
  std::vector<Patch> patches_;  // finish the last chunk
  std::string last_index_;      // records that are missing behind it
};

// Whether another program has the file open, e.g. `rosbag record`, which takes no lock.
bool isOpenElsewhere(int file) {
  ::fcntl(file, F_SETSIG, SIGURG);  // which is ignored, should somebody open the file just now
  if (::fcntl(file, F_SETLEASE, F_WRLCK) != 0) return errno == EAGAIN;
  ::fcntl(file, F_SETLEASE, F_UNLCK);
  return false;
}

bool isComplete(const std::string& path) {
  try {
    requireSoundBag(path);
    return true;
  } catch (const rosbag::BagException&) {
    return false;
  }
}

}  // namespace

RecordingLock::RecordingLock(const std::string& path, Open open)
    : file_(::open(path.c_str(), O_RDWR | O_CLOEXEC | (open == Open::kNew ? O_CREAT | O_EXCL : 0), 0644)) {
  if (file_ < 0) throw fsr::settings::cannotWrite(path, errno);
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0 && !isOpenElsewhere(file_)) return;
  ::close(file_);
  throw fsr::settings::InputError(path + ": a program has this recording open; end that program first");
}

RecordingLock::~RecordingLock() {
  ::close(file_);
}

RescuedBag rescueBag(const std::string& path) {
  RescuedBag rescued{path, 0, {}};
  fsr::settings::requireRegularFile(path);
  const RecordingLock lock(path, RecordingLock::Open::kExisting);
  const fsr::settings::InputError nothing(path + ": holds no whole message; remove it");
  if (std::filesystem::file_size(path) <= kFirstChunk) throw nothing;
  try {
    const BagRemains remains(path);
    rescued.messages = remains.messages();
    if (rescued.messages == 0) throw nothing;
    int error = 0;
    if (!isComplete(path)) {
      error = remains.complete(lock.file());
      if (error == 0) requireSoundBag(path);
    }
    if (error != 0) {
      rescued.complaint = path + ": the recording has no index yet (" + std::strerror(error) + "), but its " +
                          std::to_string(rescued.messages) +
                          " messages are whole; make room, then run: rosrun fsr_pressure_map close_bag " +
                          path;
    }
  } catch (const rosbag::BagException& error) {
    throw fsr::settings::InputError(path + ": cannot be closed (" + error.what() +
                                    "); save what is left with: rosbag reindex " + path);
  }
  if (rescued.complaint.empty() && boost::ends_with(path, kActive)) rescued.file = giveClosedName(path);
  return rescued;
}

std::string giveClosedName(const std::string& active) {
  const std::string wanted = active.substr(0, active.size() - (sizeof(kActive) - 1));
  const std::string stem = wanted.substr(0, wanted.rfind(".bag"));
  std::string name = wanted;
  int error = 0;
  for (int number = 2; (error = fsr::settings::renameToNew(active, name)) == EEXIST; ++number)
    name = stem + "_" + std::to_string(number) + ".bag";
  if (error != 0) throw fsr::settings::cannotWrite(name, error);
  return name;
}

RescuedSession rescueSession(const std::string& folder, const std::string& plan) {
  RescuedSession session;
  for (const std::string& file : fsr::session::openBags(folder, plan)) {
    try {
      const RescuedBag bag = rescueBag((std::filesystem::path(folder) / file).string());
      if (!bag.complaint.empty()) {
        session.open.push_back(bag.complaint);
        continue;
      }
      session.closed.push_back(file + " had not been closed, e.g. because the power went; it is " +
                               std::filesystem::path(bag.file).filename().string() + " now and holds " +
                               std::to_string(bag.messages) + " messages");
    } catch (const fsr::settings::InputError& error) {
      session.open.push_back(error.what());
    }
  }
  return session;
}

}  // namespace fsr_ros
