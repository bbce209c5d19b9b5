#include "ros/live/serve.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureStatisticsArray.h>
#include <ros/node_handle.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "ros/live/parameters.h"
#include "ros/messages/driver_messages.h"
#include "ros/messages/view_messages.h"

namespace fsr_ros {

namespace {

using fsr_pressure_map::PressureStatisticsArray;
using fsr_pressure_map::PressureStatisticsArrayConstPtr;

constexpr std::uint32_t kQueueSize = 100;  // [messages]

std::vector<std::string> words(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream in(text);
  std::vector<std::string> result;
  for (std::string word; in >> word;) result.push_back(word);
  return result;
}

// Region names of all sheets, each once, in the order of their first appearance.
std::vector<std::string> regionNames(const std::vector<PressureStatisticsArrayConstPtr>& arrays) {
  std::vector<std::string> names;
  for (const auto& array : arrays) {
    for (const auto& region : array->regions) {
      if (std::find(names.begin(), names.end(), region.region) == names.end()) names.push_back(region.region);
    }
  }
  return names;
}

fsr::map::RegionStatistics sumOf(const std::string& name,
                                 const std::vector<PressureStatisticsArrayConstPtr>& arrays) {
  std::vector<fsr::map::RegionStatistics> parts;
  for (const auto& array : arrays) {
    for (const auto& region : array->regions) {
      if (region.region == name) parts.push_back(toStatistics(region));
    }
  }
  return fsr::map::sumOfSheets(name, parts);
}

class LimbServer {
 public:
  LimbServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle)
      : handle_(handle), diagnostics_(handle, private_handle, private_handle.getNamespace()) {
    const Parameters parameters(private_handle);
    stale_after_ = parameters.number("stale_after", 1.0, {0.05, 3600, "s"});
    const std::vector<std::string> topics = words(parameters.text("sheets", "statistics"));
    if (topics.empty()) throw parameters.error("sheets", "must name at least one topic of statistics");
    sum_ = handle_.advertise<PressureStatisticsArray>("limb_statistics", kQueueSize);
    sheets_.resize(topics.size());
    for (std::size_t i = 0; i < topics.size(); ++i) {
      const auto keep = [this, i](const PressureStatisticsArrayConstPtr& message) {
        sheets_[i].last = message;
        sheets_[i].received = ros::WallTime::now();
        publish();
      };
      sheets_[i].subscriber = handle_.subscribe<PressureStatisticsArray>(topics[i], kQueueSize, keep);
      const std::string topic = handle_.resolveName(topics[i]);
      const std::string name = sheets_[i].name = topic.substr(0, topic.rfind('/'));
      serials_[name];
      sheets_[i].info = handle_.subscribe<fsr_pressure_map::MatrixInfo>(
          name + "/matrix_info", 1, [this, name](const fsr_pressure_map::MatrixInfoConstPtr& message) {
            serials_[name] = message->serial;
          });
    }
    diagnostics_.setHardwareID("none");
    diagnostics_.add(kSheetsTask, [this](auto& status) { judge(status); });
    const auto look = [this](const ros::WallTimerEvent&) {
      diagnostics_.update();
      if (std::none_of(sheets_.begin(), sheets_.end(),
                       [this](const Sheet& sheet) { return isHeard(sheet); })) {
        publish();
      }
    };
    silence_ = handle_.createWallTimer(ros::WallDuration(0.5 * stale_after_), look);
  }

 private:
  struct Sheet {
    std::string name;  // its namespace
    fsr_pressure_map::PressureStatisticsArrayConstPtr last;
    ros::WallTime received;
    ros::Subscriber subscriber, info;
  };

  void publish() {
    std::vector<PressureStatisticsArrayConstPtr> heard;
    PressureStatisticsArray array;
    for (const Sheet& sheet : sheets_) {
      if (!isHeard(sheet)) continue;
      heard.push_back(sheet.last);
      array.header.stamp = std::max(array.header.stamp, sheet.last->header.stamp);
    }
    std::vector<std::string> names = regionNames(heard);
    if (names.empty()) names = {""};
    for (const std::string& name : names) {
      fsr::map::RegionStatistics sum = sumOf(name, heard);
      const bool silent_sheet = heard.size() < sheets_.size();
      if (silent_sheet && sum.alarm != fsr::map::AlarmState::kAlarm)
        sum.alarm = fsr::map::AlarmState::kUnknown;
      array.regions.push_back(toMessage(sum, {}));
    }
    sum_.publish(array);
  }

  // The panel takes the names of the sheets from the keys.
  void judge(diagnostic_updater::DiagnosticStatusWrapper& status) const {
    std::string silent;
    for (const Sheet& sheet : sheets_) {
      status.add(sheet.name, serials_.at(sheet.name));
      if (!isHeard(sheet)) silent += " " + sheet.name;
    }
    const std::string twice = sameBoardSentence(serials_);
    if (!silent.empty()) {
      status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "no statistics come from" + silent);
    } else {
      status.summary(diagnostic_msgs::DiagnosticStatus::OK, "all sheets are heard");
    }
    if (!twice.empty()) status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, twice);
  }

  bool isHeard(const Sheet& sheet) const {
    return sheet.last && (ros::WallTime::now() - sheet.received).toSec() <= stale_after_;
  }

  ros::NodeHandle handle_;
  double stale_after_;  // [s]
  std::vector<Sheet> sheets_;
  std::map<std::string, std::string> serials_;  // of the boards, by the name of the sheet
  ros::Publisher sum_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer silence_;
};

}  // namespace

Server makeLimbServer(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle) {
  return std::make_shared<LimbServer>(handle, private_handle);
}

}  // namespace fsr_ros
