#include "ros/bags/bag_topics.h"

#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/Session.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <map>
#include <sstream>

#include "ros/bags/sensor_topics.h"
#include "ros/messages/message_reader.h"
#include "settings/number_text.h"
#include "statistics/median.h"

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

// Collects the times of one topic.
class Course {
 public:
  explicit Course(const rosbag::ConnectionInfo& connection) {
    course_.topic = connection.topic;
    course_.type = connection.datatype;
    course_.stamped = beginsWithHeader(connection.msg_def);
  }

  void add(const rosbag::MessageInstance& instance) {
    ++course_.messages;
    const double arrival = instance.getTime().toSec();
    const double time = course_.stamped ? stampOf(instance) : arrival;
    if (time <= 0) return;  // the publisher set no stamp
    if (!times_.empty() && time < times_.back()) ++course_.backwards;
    if (!times_.empty() && time == times_.back()) ++course_.repeated;
    if (course_.stamped) course_.latest = std::max(course_.latest, arrival - time);
    times_.push_back(time);
  }

  TopicCourse finish(double start) {
    std::sort(times_.begin(), times_.end());
    std::vector<double> steps;
    for (std::size_t i = 1; i < times_.size(); ++i) steps.push_back(times_[i] - times_[i - 1]);
    if (steps.empty()) return course_;
    const auto longest = std::max_element(steps.begin(), steps.end());
    course_.longest_gap = *longest;
    course_.gap_at = times_[static_cast<std::size_t>(longest - steps.begin())] - start;
    const double usual = fsr::statistics::upperMedian(steps);
    if (usual > 0) course_.rate = 1 / usual;
    return course_;
  }

 private:
  // A header is serialised as seq, secs and nsecs, 32 bits each.
  double stampOf(const rosbag::MessageInstance& instance) {
    bytes_.resize(instance.size());
    if (bytes_.size() < 12) return 0;
    ros::serialization::OStream into(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    instance.write(into);
    std::uint32_t seconds = 0, nanoseconds = 0;
    std::memcpy(&seconds, bytes_.data() + 4, sizeof(seconds));
    std::memcpy(&nanoseconds, bytes_.data() + 8, sizeof(nanoseconds));
    return seconds + 1e-9 * nanoseconds;
  }

  TopicCourse course_;
  std::vector<double> times_;  // [s]
  std::vector<std::uint8_t> bytes_;
};

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

namespace {

std::vector<TopicCourse> coursesIn(const rosbag::Bag& bag) {
  rosbag::View view(bag);
  std::map<std::string, Course> courses;
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    courses.try_emplace(connection->topic, *connection);
  }
  for (const rosbag::MessageInstance& instance : view) courses.at(instance.getTopic()).add(instance);
  std::vector<TopicCourse> result;
  const double start = view.size() > 0 ? view.getBeginTime().toSec() : 0;
  for (auto& [topic, course] : courses) result.push_back(course.finish(start));
  return result;
}

}  // namespace

std::vector<TopicCourse> topicCourses(const std::string& path) {
  std::vector<TopicCourse> courses;
  withSoundBag(path, [&](const rosbag::Bag& bag) { courses = coursesIn(bag); });
  return courses;
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
        {std::to_string(course.messages), fsr::settings::cellText(course.rate, 2),
         fsr::settings::cellText(course.longest_gap, 3), fsr::settings::cellText(course.gap_at, 1),
         std::to_string(course.backwards), std::to_string(course.repeated),
         course.stamped ? fsr::settings::cellText(course.latest, 3) : "-"});
  }
  return out.str();
}

std::string sessionUse(const std::string& path) {
  std::string use;
  withSoundBag(path, [&](const rosbag::Bag& bag) {
    rosbag::View view(bag, [](const rosbag::ConnectionInfo* connection) {
      return connection->datatype == ros::message_traits::datatype<fsr_pressure_map::Session>() &&
             connection->md5sum == ros::message_traits::md5sum<fsr_pressure_map::Session>();
    });
    if (view.size() > 0) use = MessageReader().read<fsr_pressure_map::Session>(*view.begin()).use;
  });
  return use;
}

std::vector<std::int64_t> eventTimes(const std::string& path, const std::string& kind) {
  std::vector<std::int64_t> times;
  withSoundBag(path, [&](const rosbag::Bag& bag) {
    const auto is_event = [](const rosbag::ConnectionInfo* connection) {
      return endsWith(connection->topic, "events") &&
             connection->datatype == ros::message_traits::datatype<fsr_pressure_map::Event>();
    };
    rosbag::View view(bag, is_event);
    MessageReader reader;
    for (const rosbag::MessageInstance& instance : view) {
      const auto event = reader.read<fsr_pressure_map::Event>(instance);
      if (event.kind == kind) times.push_back(static_cast<std::int64_t>(event.header.stamp.toNSec()));
    }
  });
  std::sort(times.begin(), times.end());
  return times;
}

}  // namespace fsr_ros
