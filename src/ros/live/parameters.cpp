#include "ros/live/parameters.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "ros/bags/resource_path.h"
#include "settings/text.h"

namespace fsr_ros {

namespace {

using Value = XmlRpc::XmlRpcValue;

std::string textOf(const Value& value) {
  if (value.getType() == Value::TypeString) return static_cast<std::string>(Value(value));
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace

fsr::settings::InputError Parameters::error(const std::string& name, const std::string& complaint) const {
  if (isOfRig(name)) return rig_->error(argumentOf(name), complaint);
  Value value;
  const bool set = handle_.getParam(name, value);
  return fsr::settings::InputError("parameter " + handle_.resolveName(name) +
                                   (set ? " is " + textOf(value) : " is not set") + ", but " + complaint);
}

Parameters::Parameters(const ros::NodeHandle& private_handle, std::map<std::string, std::string> arguments)
    : handle_(private_handle), arguments_(std::move(arguments)) {
  std::string rig, launched;
  if (handle_.getParam("rig", rig) && !rig.empty()) {
    rig_ = fsr::settings::Settings::fromFile(resolveLaunchPath(rig));
  }
  handle_.getParam("launched", launched);
  std::istringstream words(launched);
  for (std::string word; words >> word;) given_.insert(word);
}

std::string Parameters::argumentOf(const std::string& name) const {
  const auto found = arguments_.find(name);
  return found == arguments_.end() ? name : found->second;
}

bool Parameters::isOfRig(const std::string& name) const {
  const std::string argument = argumentOf(name);
  const bool is = rig_ && rig_->has(argument) && given_.count(argument) == 0;
  if (is) asked_.insert(handle_.resolveName(name));
  return is;
}

bool Parameters::isSet(const std::string& name) const {
  asked_.insert(handle_.resolveName(name));
  return handle_.hasParam(name);
}

void Parameters::warnOfUnknown(const std::string& node) const {
  const std::string own = handle_.getNamespace() + "/";
  std::vector<std::string> names;
  handle_.getParamNames(names);
  for (const std::string& name : names) {
    const bool is_own = name.compare(0, own.size(), own) == 0;
    const std::string rest = is_own ? name.substr(own.size()) : "";
    const bool general = rest == "diagnostic_period" || rest == "rig" || rest == "launched";
    if (!is_own || asked_.count(name) > 0 || general) continue;
    ROS_WARN_STREAM("parameter " << name << " is set, but the " << node
                                 << " has no parameter of that name, so it has no effect");
  }
}

double Parameters::number(const std::string& name, double fallback, const fsr::settings::Range& range) const {
  if (isOfRig(name)) return rig_->number(argumentOf(name), range);
  if (!isSet(name)) return fallback;
  double value = 0;
  if (!handle_.getParam(name, value) || !range.contains(value)) {
    throw error(name, "must be a number, " + range.text());
  }
  return value;
}

std::int64_t Parameters::integer(const std::string& name, std::int64_t fallback,
                                 const fsr::settings::Range& range) const {
  if (isOfRig(name)) return rig_->integer(argumentOf(name), range);
  if (!isSet(name)) return fallback;
  int value = 0;
  if (!handle_.getParam(name, value) || !range.contains(value)) {
    throw error(name, "must be a whole number, " + range.text());
  }
  return value;
}

bool Parameters::flag(const std::string& name, bool fallback) const {
  if (isOfRig(name)) return rig_->flag(argumentOf(name), fallback);
  if (!isSet(name)) return fallback;
  bool value = false;
  if (!handle_.getParam(name, value)) throw error(name, "must be true or false");
  return value;
}

std::string Parameters::text(const std::string& name, const std::string& fallback) const {
  if (isOfRig(name)) return rig_->text(argumentOf(name));
  Value value;
  if (!isSet(name) || !handle_.getParam(name, value)) return fallback;
  if (value.getType() == Value::TypeArray || value.getType() == Value::TypeStruct) {
    throw error(name, "must be a text");
  }
  return textOf(value);
}

std::string Parameters::choice(const std::string& name, const std::vector<std::string>& choices,
                               const std::string& fallback) const {
  const std::string value = text(name, fallback);
  if (std::find(choices.begin(), choices.end(), value) != choices.end()) return value;
  if (isOfRig(name)) return rig_->choice(argumentOf(name), choices);  // throws
  throw error(name, "must be one of " + fsr::settings::joined(choices));
}

std::string ownFile(const Parameters& parameters, const std::string& name, const std::string& node,
                    const std::string& what) {
  const std::string given = parameters.text(name, "");
  if (!given.empty()) return resolveLaunchPath(given);
  std::string file = node.substr(node.find_first_not_of('/'));
  std::replace(file.begin(), file.end(), '/', '_');
  return resolveResource("${ROS_HOME}/fsr_pressure_map/" + file + "_" + what + ".yaml");
}

}  // namespace fsr_ros
