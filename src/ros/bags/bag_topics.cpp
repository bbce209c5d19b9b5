#include "ros/bags/bag_topics.h"

#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/Session.h>
#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>

#include "ros/bags/bag_walk.h"
#include "ros/bags/sensor_topics.h"
#include "ros/messages/message_reader.h"
#include "settings/number_text.h"
#include "statistics/samples.h"

namespace fsr_ros {

namespace {

// The definition of a stamped type begins with its header, after comments.
bool beginsWithHeader(const std::string& definition) {
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    return line.compare(first, 7, "Header ") == 0 || line.compare(first, 16, "std_msgs/Header ") == 0;
  }
  return false;
}

ros::Time receptionOf(MessageBytes message) {
  return {message.seconds, message.nanoseconds};
}

// Collects the times of one topic.
class Course {
 public:
  explicit Course(const BagConnection& connection) {
    course_.topic = connection.topic;
    course_.type = connection.type;
    course_.stamped = beginsWithHeader(connection.definition);
  }

  void add(MessageBytes message) {
    const double arrival = receptionOf(message).toSec();
    messages_.push_back({arrival, course_.stamped ? stampOf(message) : arrival});
  }

  /// `start`: time of the bag's first message [s].
  TopicCourse finish(double start) {
    // Chunks of a bag may overlap in time.
    const auto earlier = [](const Times& a, const Times& b) { return a.arrival < b.arrival; };
    if (!std::is_sorted(messages_.begin(), messages_.end(), earlier))
      std::stable_sort(messages_.begin(), messages_.end(), earlier);
    course_.messages = messages_.size();
    std::vector<double> times;
    for (const Times& message : messages_) follow(message, times);
    std::sort(times.begin(), times.end());
    std::vector<double> steps;
    for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
    if (steps.empty()) return course_;
    const auto longest = std::max_element(steps.begin(), steps.end());
    course_.longest_gap = *longest;
    course_.gap_at = times[static_cast<std::size_t>(longest - steps.begin())] - start;
    const double usual = fsr::statistics::upperMedian(steps);
    if (usual > 0) course_.rate = 1 / usual;
    return course_;
  }

 private:
  struct Times {
    double arrival, time;  // [s]
  };

  void follow(const Times& message, std::vector<double>& times) {
    if (message.time <= 0) return;  // the publisher set no stamp
    if (!times.empty() && message.time < times.back()) ++course_.backwards;
    if (!times.empty() && message.time == times.back()) ++course_.repeated;
    if (course_.stamped) course_.latest = std::max(course_.latest, message.arrival - message.time);
    times.push_back(message.time);
  }

  // A header is serialised as seq, secs and nsecs, 32 bits each.
  static double stampOf(MessageBytes message) {
    if (message.size < 12) return 0;
    std::uint32_t seconds = 0, nanoseconds = 0;
    std::memcpy(&seconds, message.data + 4, sizeof(seconds));
    std::memcpy(&nanoseconds, message.data + 8, sizeof(nanoseconds));
    return seconds + 1e-9 * nanoseconds;
  }

  TopicCourse course_;
  std::vector<Times> messages_;
};

// Calls `take` for each message whose connection is `wanted`. The index tells where there is none, without a
// walk through the bag.
void forEachWanted(const std::string& path, const std::function<bool(const BagConnection&)>& wanted,
                   const std::function<void(const BagConnection&, MessageBytes)>& take) {
  tellingOfDamage(path, [&] {
    const BagWalk bag(path);
    std::map<std::uint32_t, BagConnection> connections;
    for (const auto& known : bag.connections()) {
      if (wanted(known.second)) connections.insert(known);
    }
    if (connections.empty()) return;
    bag.run([&](std::uint32_t id, MessageBytes message) {
      const auto connection = connections.find(id);
      if (connection != connections.end()) take(connection->second, message);
    });
  });
}

}  // namespace

std::vector<TopicCourse> topicCourses(const std::string& path) {
  std::vector<TopicCourse> result;
  std::map<std::string, Course> courses;
  std::optional<ros::Time> start;
  const auto all = [](const BagConnection&) { return true; };
  forEachWanted(path, all, [&](const BagConnection& connection, MessageBytes message) {
    const ros::Time arrival = receptionOf(message);
    if (!start || arrival < *start) start = arrival;
    courses.try_emplace(connection.topic, connection).first->second.add(message);
  });
  for (auto& [topic, course] : courses) {
    result.push_back(course.finish(start->toSec()));
    course = Course({});  // the times of one topic at a time
  }
  return result;
}

std::string topicsText(const std::vector<TopicCourse>& courses) {
  std::size_t width = 8;
  for (const TopicCourse& course : courses) width = std::max(width, course.topic.size() + 2);
  std::ostringstream out;
  const auto row = [&](const std::string& topic, const std::vector<std::string>& cells) {
    out << std::left << std::setw(static_cast<int>(width)) << topic << std::right;
    for (const std::string& cell : cells) out << std::setw(12) << cell;
    out << '\n';
  };
  row("topic", {"messages", "rate [1/s]", "gap [s]", "at [s]", "backwards", "same stamp", "late [s]"});
  for (const TopicCourse& course : courses) {
    row(course.topic,
        {std::to_string(course.messages), fsr::settings::fixedText(course.rate, 2),
         fsr::settings::fixedText(course.longest_gap, 3), fsr::settings::fixedText(course.gap_at, 1),
         std::to_string(course.backwards), std::to_string(course.repeated),
         course.stamped ? fsr::settings::fixedText(course.latest, 3) : "-"});
  }
  return out.str();
}

std::string sessionUse(const std::string& path) {
  using fsr_pressure_map::Session;
  std::string use;
  std::optional<ros::Time> first;
  const auto isSession = [](const BagConnection& connection) {
    return connection.type == ros::message_traits::datatype<Session>() &&
           connection.md5sum == ros::message_traits::md5sum<Session>();
  };
  forEachWanted(path, isSession, [&](const BagConnection&, MessageBytes message) {
    if (first && receptionOf(message) >= *first) return;
    first = receptionOf(message);
    Session session;
    readMessage(message.data, message.size, session);
    use = session.use;
  });
  return use;
}

std::vector<std::int64_t> eventTimes(const std::string& path, const std::string& kind) {
  using fsr_pressure_map::Event;
  std::vector<std::int64_t> times;
  const auto isEvent = [](const BagConnection& connection) {
    return boost::ends_with(connection.topic, "events") &&
           connection.type == ros::message_traits::datatype<Event>();
  };
  forEachWanted(path, isEvent, [&](const BagConnection& connection, MessageBytes message) {
    requireDefinition<Event>(connection.topic, connection.md5sum);
    Event event;
    readMessage(message.data, message.size, event);
    if (event.kind == kind) times.push_back(stampOf(event.header));
  });
  std::sort(times.begin(), times.end());
  return times;
}

std::vector<bool> conditioningSaid(const std::vector<std::string>& paths) {
  std::vector<bool> said;
  for (const std::string& path : paths) said.push_back(!eventTimes(path, "conditioning").empty());
  return said;
}

}  // namespace fsr_ros
