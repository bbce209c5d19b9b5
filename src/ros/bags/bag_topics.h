#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace fsr_ros {

/// Timing of the messages of one topic.
struct TopicCourse {
  std::string topic, type;
  std::uint64_t messages = 0;
  bool stamped = false;  ///< its type begins with a header; otherwise the times of reception are used
  double rate = std::numeric_limits<double>::quiet_NaN();         ///< from the median interval [1/s]
  double longest_gap = std::numeric_limits<double>::quiet_NaN();  ///< longest interval [s]
  double gap_at = 0;            ///< start of the longest interval, since the bag's first message [s]
  std::uint64_t backwards = 0;  ///< number of stamps earlier than the one before, in the order of recording
  std::uint64_t repeated = 0;   ///< number of stamps equal to the one before
  double latest = 0;            ///< longest time from the stamp to the reception by the recorder [s]
};

/// The topics of a bag, sorted by name. Throws fsr::settings::InputError if it cannot be read.
std::vector<TopicCourse> topicCourses(const std::string& path);

/// The topics as a table for the terminal.
std::string topicsText(const std::vector<TopicCourse>& courses);

/// The use that the first session message of the bag names, e.g. "socket"; empty without one.
std::string sessionUse(const std::string& path);

/// Stamps of the events of one kind [ns], ascending, from topics whose name ends with `events`.
std::vector<std::int64_t> eventTimes(const std::string& path, const std::string& kind);

/// Whether each bag has an event `conditioning`: the operator said that the sheet was conditioned.
std::vector<bool> conditioningSaid(const std::vector<std::string>& paths);

}  // namespace fsr_ros
