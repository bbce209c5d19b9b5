#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fsr_ros {

/// Keeps a recording for this object, so that nobody else rescues it. The lock ends with the process, however
/// that ends.
class RecordingLock {
 public:
  enum class Open { kNew, kExisting };

  /// Creates the file, or opens it. Throws fsr::InputError if that fails, or if a program has the file open.
  RecordingLock(const std::string& path, Open open);
  ~RecordingLock();
  RecordingLock(const RecordingLock&) = delete;
  RecordingLock& operator=(const RecordingLock&) = delete;

  int file() const { return file_; }  ///< descriptor, to read and to write

 private:
  int file_;
};

/// A recording after rescueBag().
struct RescuedBag {
  std::string file;            ///< its name of now
  std::uint64_t messages = 0;  ///< number of messages in it
  std::string complaint;  ///< why it could not be closed, with the command that will; empty = it is closed
};

/// Closes a recording that was not closed, because its recorder died or its disk was full. The file is cut
/// behind its last whole message, also where a chunk was not finished, and gets its index. FILE.bag.active is
/// renamed as by giveClosedName(); another name stays. If there is no room for the index, the file keeps
/// every whole message and its name, and the call can be repeated.
///
/// `rosbag reindex` needs room for a second file, leaves out the unfinished chunk, and finds no message at
/// all where the disk was full while a connection record was written behind the chunks.
///
/// Throws fsr::InputError, and leaves the file as it is, if a program still records it, if it holds no whole
/// message, or if it is damaged before its end.
RescuedBag rescueBag(const std::string& path);

/// What became of the bags that a session left open when its conductor or the power went.
struct RescuedSession {
  std::vector<std::string> closed;  ///< a sentence for each bag that is closed now, with what it holds
  std::vector<std::string>
      open;  ///< likewise for each that is still open and cannot be used, with the reason
};

/// Closes them, see rescueBag(). `plan`: the name of the session's plan.
RescuedSession rescueSession(const std::string& folder, const std::string& plan);

/// Renames FILE.bag.active to FILE.bag, or to FILE_2.bag, ... where another bag has taken that name. Returns
/// the new name. Throws fsr::InputError.
std::string giveClosedName(const std::string& active);

}  // namespace fsr_ros
