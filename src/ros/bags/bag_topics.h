#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace fsr_ros {

/// How the messages of one topic came.
struct TopicCourse {
  std::string topic, type;
  std::uint64_t messages = 0;
  bool stamped = false;  ///< its type begins with a header; else times are those of their arrival
  double rate = std::numeric_limits<double>::quiet_NaN();         ///< by the median step [1/s]
  double longest_gap = std::numeric_limits<double>::quiet_NaN();  ///< from one to the next [s]
  double gap_at = 0;            ///< where it begins, since the bag's first message [s]
  std::uint64_t backwards = 0;  ///< stamps earlier than the one before, in the order of the recording
  std::uint64_t repeated = 0;   ///< stamps equal to the one before
  double latest = 0;            ///< longest time from stamp to arrival at the recorder [s]
};

/// Topics of a sound bag (see requireSoundBag), by name. Throws rosbag::BagException where it cannot be read.
std::vector<TopicCourse> topicCourses(const std::string& path);

/// A table of them for the terminal.
std::string topicsText(const std::vector<TopicCourse>& courses);

/// Times of the events of one kind [ns], by their stamps, on topics whose name ends with `events`.
std::vector<std::int64_t> eventTimes(const std::string& path, const std::string& kind);

}  // namespace fsr_ros
