#include "ros/bags/bag_archive.h"

#include <rosbag/bag.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "exports/archive.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_stream.h"
#include "ros/bags/fresh_bag.h"
#include "ros/bags/scan_context.h"
#include "ros/bags/scan_source.h"
#include "ros/bags/sensor_topics.h"
#include "settings/file_hash.h"

namespace fsr_ros {

/// A serialised message and its connection, written to a bag without deserialising it.
struct SerialisedMessage {
  const fsr::exports::ArchivedConnection& connection;
  const std::string& bytes;
};

}  // namespace fsr_ros

// The traits through which rosbag asks a message for its type and bytes.
namespace ros {
namespace message_traits {
template <>
struct MD5Sum<fsr_ros::SerialisedMessage> {
  static const char* value(const fsr_ros::SerialisedMessage& m) { return m.connection.md5sum.c_str(); }
};
template <>
struct DataType<fsr_ros::SerialisedMessage> {
  static const char* value(const fsr_ros::SerialisedMessage& m) { return m.connection.type.c_str(); }
};
template <>
struct Definition<fsr_ros::SerialisedMessage> {
  static const char* value(const fsr_ros::SerialisedMessage& m) { return m.connection.definition.c_str(); }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<fsr_ros::SerialisedMessage> {
  template <typename Stream>
  static void write(Stream& stream, const fsr_ros::SerialisedMessage& m) {
    std::copy(m.bytes.begin(), m.bytes.end(), stream.advance(static_cast<std::uint32_t>(m.bytes.size())));
  }
  static std::uint32_t serializedLength(const fsr_ros::SerialisedMessage& m) {
    return static_cast<std::uint32_t>(m.bytes.size());
  }
};
}  // namespace serialization
}  // namespace ros

namespace fsr_ros {

namespace {

// Full names of the topics to keep; empty = all.
std::vector<std::string> topicsToKeep(const SensorTopics& topics, const std::vector<std::string>& wanted) {
  std::vector<std::string> names;
  for (const std::string& name : wanted) {
    const std::string topic = topics.has(name) ? name : topics.find(name);
    if (topic.empty()) throw fsr::settings::InputError("holds no topic " + name + ", but " + topics.list());
    names.push_back(topic);
  }
  return names;
}

// The messages of the selection, in the bag's order.
class Selected {
 public:
  Selected(const BagStream& bag, const ArchiveSelection& selection) : bag_(bag) {
    const SensorTopics topics(bag.types(), selection.topics, sensorMarks());
    const ros::Time begin = bag.begin();
    query_.from = begin + ros::Duration(selection.from);
    // ros::Duration cannot hold larger values.
    if (selection.until < 1e9) query_.until = begin + ros::Duration(selection.until);
    query_.topics = topicsToKeep(topics, selection.wanted);
    for (const std::size_t c : bag.connectionsOf(query_)) {
      const StreamedConnection& connection = bag.connections()[c];
      row_[c] = connections_.size();
      connections_.push_back({connection.about.topic,
                              connection.about.type,
                              connection.about.md5sum,
                              connection.about.definition,
                              {connection.header.begin(), connection.header.end()}});
    }
    if (connections_.empty()) {
      throw fsr::settings::InputError("holds no message between --from and --until; widen them");
    }
  }

  const std::vector<fsr::exports::ArchivedConnection>& connections() const { return connections_; }

  /// Calls take(connection, received [ns], bytes) for each message.
  template <typename Take>
  std::uint64_t forEach(const BagWalk::ReadProgress& progress, Take take) {
    query_.progress = progress;
    return bag_.forEach(query_, [&](const StreamedMessage& message) {
      take(row_.at(message.connection), static_cast<std::int64_t>(message.received.toNSec()),
           std::string_view(reinterpret_cast<const char*>(message.data), message.size));
      return true;
    });
  }

 private:
  const BagStream& bag_;
  StreamQuery query_;
  std::map<std::size_t, std::size_t> row_;
  std::vector<fsr::exports::ArchivedConnection> connections_;
};

// Adds the group /scans. Returns why it is incomplete; empty = it is complete. A full disk raises an error
// later, in ArchiveWriter::finish().
std::string joinScans(const std::string& path, const ArchiveSelection& from,
                      fsr::exports::ArchiveWriter& archive) {
  ScanSelection selection;
  selection.topics = from.topics;
  selection.progress = from.progress;
  fsr::exports::ScanSink& scans = archive.scans();
  try {
    sendScans(path, selection, scans);
    return "";
  } catch (const fsr::settings::InputError& error) {
    return error.what();
  }
}

}  // namespace

ArchiveResult archiveBag(const std::string& path, const ArchiveSelection& selection,
                         const std::string& output) {
  ArchiveResult result;
  withBagStream(
      path,
      [&](const BagStream& bag) {
        Selected selected(bag, selection);
        const fsr::exports::ArchiveSource source{
            std::filesystem::path(path).filename().string(),
            fsr::settings::sha256OfFile(path, 0, told("checking " + path, selection.progress))};
        fsr::exports::ArchiveWriter archive(output, source, selected.connections());
        selected.forEach(told("surveying " + path, selection.progress),
                         [&](std::size_t connection, std::int64_t, std::string_view bytes) {
                           archive.look(connection, bytes);
                         });
        result.messages =
            selected.forEach(told("exporting " + path, selection.progress),
                             [&](std::size_t connection, std::int64_t received_ns, std::string_view bytes) {
                               archive.add(connection, received_ns, bytes);
                             });
        if (selection.whole()) result.complaint = joinScans(path, selection, archive);
        archive.finish();
      },
      told("checking " + path, selection.progress));
  return result;
}

namespace {

// Writes an archive's messages into a bag.
class Restorer {
 public:
  Restorer(fsr::exports::ArchiveReader& archive, FreshBag& bag) : archive_(archive), bag_(bag) {
    for (const fsr::exports::ArchivedConnection& connection : archive.connections()) {
      headers_.push_back(
          boost::make_shared<ros::M_string>(connection.header.begin(), connection.header.end()));
    }
  }

  std::uint64_t run(const BagWalk::ReadProgress& progress) {
    const auto all = static_cast<double>(archive_.messages());
    for (fsr::exports::ArchivedMessage message; archive_.next(message); ++messages_) {
      if (progress) progress(static_cast<double>(messages_) / all);
      if (!together_.empty() && together_.front().received_ns != message.received_ns) write();
      together_.push_back(message);
    }
    write();
    return messages_;
  }

 private:
  // rosbag numbers connections in the order of their first message, and replays messages with the same time
  // in the order of these numbers. Messages with the same time are therefore written in the order of the old
  // numbers.
  void write() {
    std::stable_sort(together_.begin(), together_.end(),
                     [](const auto& a, const auto& b) { return a.connection < b.connection; });
    for (const fsr::exports::ArchivedMessage& message : together_) {
      const fsr::exports::ArchivedConnection& connection = archive_.connections()[message.connection];
      bag_.write(connection.topic, receivedAt(message), SerialisedMessage{connection, message.bytes},
                 headers_[message.connection]);
    }
    together_.clear();
  }

  static ros::Time receivedAt(const fsr::exports::ArchivedMessage& message) {
    constexpr std::int64_t kEnd = std::int64_t{1} << 32;  // end of the range of ros::Time [s]
    if (message.received_ns < 0 || message.received_ns / 1000000000 >= kEnd) {
      throw fsr::settings::InputError("a message was received at " + std::to_string(message.received_ns) +
                                      " ns, but a bag holds the years 1970 to 2106");
    }
    ros::Time time;
    return time.fromNSec(static_cast<std::uint64_t>(message.received_ns));
  }

  fsr::exports::ArchiveReader& archive_;
  FreshBag& bag_;
  std::vector<boost::shared_ptr<ros::M_string>> headers_;
  std::vector<fsr::exports::ArchivedMessage> together_;  // messages with the same time of reception
  std::uint64_t messages_ = 0;
};

}  // namespace

std::uint64_t restoreBag(const std::string& path, const std::string& output,
                         const std::function<void(const std::string& step, double share)>& progress) {
  fsr::exports::ArchiveReader archive(path, told("checking " + path, progress));
  FreshBag bag(output);
  const std::uint64_t messages = Restorer(archive, bag).run(told("writing " + output, progress));
  bag.finish();
  return messages;
}

}  // namespace fsr_ros
