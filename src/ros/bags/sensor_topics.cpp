#include "ros/bags/sensor_topics.h"

#include <ros/serialization.h>
#include <rosbag/view.h>

#include <algorithm>
#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/foreign_error.h"
#include "settings/text.h"

namespace fsr_ros {

namespace {

std::string withoutSlashes(const std::string& name) {
  const std::size_t first = name.find_first_not_of('/');
  return first == std::string::npos ? "" : name.substr(first, name.find_last_not_of('/') - first + 1);
}

void requireFile(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw fsr::settings::InputError("there is no such file");
  if (std::filesystem::file_size(path, error) == 0) {
    throw fsr::settings::InputError("the file is empty; give a bag recorded with record.launch");
  }
}

}  // namespace

void tellingOfDamage(const std::string& path, const std::function<void()>& read) {
  const std::string close = "rosrun fsr_pressure_map close_bag " + path;
  const std::string remedy = "; copy it again, or save what is left with: " + close;
  try {
    requireFile(path);
    read();
  } catch (const rosbag::BagUnindexedException&) {
    throw fsr::settings::InputError(path + ": the bag was not closed and has no index; run: " + close);
  } catch (const rosbag::BagException& error) {
    throw fsr::settings::InputError(path + ": is not a complete bag (" + error.what() + ")" + remedy);
  } catch (const ros::serialization::StreamOverrunException&) {
    throw fsr::settings::InputError(path + ": a message in it is cut short" + remedy);
  } catch (const std::exception& error) {
    throw fsr::settings::sentenceAbout(path, error);
  }
}

void withSoundBag(const std::string& path, const std::function<void(const rosbag::Bag&)>& use,
                  const BagWalk::ReadProgress& progress) {
  tellingOfDamage(path, [&] {
    requireSoundBag(path, progress);
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    use(bag);
  });
}

void forEachMessage(const rosbag::Bag& bag, const std::vector<std::string>& topics,
                    const std::function<bool(const rosbag::MessageInstance& message)>& take,
                    const BagWalk::ReadProgress& progress) {
  constexpr std::uint64_t kMessagesOfReport = 10000;  // between two reports of progress
  rosbag::View view;
  if (topics.empty()) {
    view.addQuery(bag);
  } else {
    view.addQuery(bag, rosbag::TopicQuery(topics));
  }
  std::uint64_t taken = 0;
  for (const rosbag::MessageInstance& message : view) {
    if (progress && taken % kMessagesOfReport == 0)
      progress(static_cast<double>(taken) / static_cast<double>(view.size()));
    ++taken;
    if (!take(message)) return;
  }
}

std::map<std::string, std::string> typesIn(const rosbag::Bag& bag) {
  std::map<std::string, std::string> types;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* const connection : view.getConnections())
    types[connection->topic] = connection->datatype;
  return types;
}

std::map<std::string, std::string> typesOf(const BagWalk& bag) {
  std::map<std::string, std::string> types;
  for (const auto& [id, connection] : bag.connections()) types[connection.topic] = connection.type;
  return types;
}

SensorTopics::SensorTopics(Types types, const std::string& topics, const std::vector<Mark>& marks)
    : types_(std::move(types)) {
  prefix_ = withoutSlashes(topics);
  if (prefix_.empty()) prefix_ = findNamespace(marks);
  for (const Mark& mark : marks) {
    if (!find(mark.base).empty()) return;
  }
  throw fsr::settings::InputError("holds no topic /" + (prefix_.empty() ? "" : prefix_ + "/") +
                                  marks.front().base + ", but " + list() +
                                  "; choose the sensor with --namespace");
}

std::set<std::string> SensorTopics::namespaces(const Types& types, const std::vector<Mark>& marks) {
  std::set<std::string> first, found;  // by the first mark, by another
  for (const auto& [topic, type] : types) {
    const std::string name = "/" + withoutSlashes(topic);
    const std::size_t base = name.rfind('/') + 1;
    for (std::size_t i = 0; i < marks.size(); ++i) {
      if (name.substr(base) != marks[i].base || type != marks[i].type) continue;
      (i == 0 ? first : found).insert(withoutSlashes(name.substr(0, base)));
    }
  }
  for (const std::string& name : found) {
    const auto inside = [&](const std::string& of) { return name.compare(0, of.size() + 1, of + "/") == 0; };
    if (std::none_of(first.begin(), first.end(), inside)) first.insert(name);
  }
  return first;
}

std::string SensorTopics::findNamespace(const std::vector<Mark>& marks) const {
  const std::set<std::string> found = namespaces(types_, marks);
  if (found.empty()) {
    throw fsr::settings::InputError("holds no topic " + marks.front().base + " of type " +
                                    marks.front().type + ", but " + list() + "; record with record.launch");
  }
  if (found.size() > 1) {
    throw fsr::settings::InputError("holds several sensors: " + fsr::settings::joined(found) +
                                    "; choose one with --namespace");
  }
  return *found.begin();
}

std::string SensorTopics::find(const std::string& base) const {
  const std::string wanted = prefix_.empty() ? base : prefix_ + "/" + base;
  for (const auto& entry : types_) {
    if (withoutSlashes(entry.first) == wanted) return entry.first;
  }
  return "";
}

std::string SensorTopics::findShared(const std::string& base, const std::string& type) const {
  std::string found = find(base);
  if (!found.empty()) return found;
  for (const auto& [topic, its_type] : types_) {
    if (its_type != type || ("/" + topic).substr(("/" + topic).rfind('/') + 1) != base) continue;
    if (!found.empty()) return "";
    found = topic;
  }
  return found;
}

std::string SensorTopics::list() const {
  if (types_.empty()) return "none";
  return fsr::settings::joinedTexts(types_, [](const auto& entry) { return entry.first; });
}

void SensorTopics::requireType(const std::string& topic, const std::string& type) const {
  if (types_.at(topic) == type) return;
  throw fsr::settings::InputError(topic + " is of type " + types_.at(topic) + ", but must be " + type);
}

}  // namespace fsr_ros
