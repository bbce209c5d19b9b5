#include "ros/tools/scrub_tool.h"

#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/Session.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Temperature.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/abandon_bag.h"
#include "ros/bags/bag_walk.h"
#include "settings/command_line.h"
#include "settings/replace_file.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kNewStart = 946684800;  // 2000-01-01 00:00 UTC [s]

// What was removed, and how often.
using Ledger = std::map<std::string, std::uint64_t>;

class Scrubber {
 public:
  Scrubber(const rosbag::Bag& from, rosbag::Bag& to) : from_(from), to_(to) {}

  Ledger run() {
    rosbag::View view(from_);
    if (view.size() == 0) throw fsr::settings::InputError("holds no message");
    shift_ = ros::Duration(static_cast<double>(kNewStart)) - ros::Duration(view.getBeginTime().sec, 0);
    for (const rosbag::MessageInstance& message : view) {
      const bool kept =
          copy<fsr_pressure_map::MatrixFrame>(message) || copy<sensor_msgs::FluidPressure>(message) ||
          copy<sensor_msgs::Temperature>(message) || copy<fsr_pressure_map::SurfaceCurvature>(message) ||
          copy<fsr_pressure_map::PressureMap>(message) || copy<fsr_pressure_map::MatrixInfo>(message) ||
          copy<fsr_pressure_map::Session>(message) || copy<fsr_pressure_map::Event>(message);
      if (!kept) ++ledger_["messages of " + message.getTopic() + " (" + message.getDataType() + ")"];
      if (kept && !message.getCallerId().empty()) ++ledger_["names of the nodes that published"];
    }
    ledger_["absolute times"] = view.size();
    return ledger_;
  }

 private:
  template <typename Message>
  bool copy(const rosbag::MessageInstance& instance) {
    const boost::shared_ptr<Message> message = instance.instantiate<Message>();
    if (message == nullptr) return false;
    if (!message->header.stamp.isZero()) message->header.stamp += shift_;
    clean(*message);
    to_.write(instance.getTopic(), instance.getTime() + shift_, *message);
    return true;
  }

  template <typename Message>
  void clean(Message& /*message*/) {}
  void clean(fsr_pressure_map::Session& session) {
    take(session.session_id, "session ids");
    take(session.operator_code, "operator codes");
    take(session.ethics_reference, "ethics references");
    if (!session.notes.empty()) ++ledger_["notes of the session"];
    session.notes.clear();
  }
  void clean(fsr_pressure_map::Event& event) {
    if (event.kind == "note" || event.kind == "reject")
      take(event.label, "labels of events of kind " + event.kind);
  }

  void take(std::string& field, const std::string& what) {
    if (!field.empty()) ++ledger_[what];
    field.clear();
  }

  const rosbag::Bag& from_;
  rosbag::Bag& to_;
  ros::Duration shift_;
  Ledger ledger_;
};

Ledger scrub(const std::string& path, const std::string& fresh) {
  auto to = std::make_unique<rosbag::Bag>();
  try {
    requireSoundBag(path);
    const rosbag::Bag from(path, rosbag::bagmode::Read);
    to->open(fresh, rosbag::bagmode::Write);
    const Ledger ledger = Scrubber(from, *to).run();
    to->close();
    return ledger;
  } catch (const rosbag::BagFormatException& error) {
    throw fsr::settings::InputError(path + ": is not a complete bag (" + error.what() + ")");
  } catch (const rosbag::BagException& error) {
    abandonBag(std::move(to));
    throw fsr::settings::InputError(path + ": cannot be copied (" + error.what() +
                                    "); is the bag complete, and is there enough space for --output?");
  } catch (const fsr::settings::InputError& error) {
    throw fsr::settings::InputError(path + ": " + error.what());
  }
}

}  // namespace

int scrubTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line(
      "scrub", "BAG --output BAG",
      "Copies a bag without notes, session id, operator, ethics reference, names of nodes and hosts, "
      "/rosout and other topics that are not known. The times are moved so that the copy begins on "
      "2000-01-01. "
      "Prints what was removed.");
  line.option("output", "BAG", "bag to write");
  if (!line.parse(argc, argv)) {
    out << line.help();
    return 0;
  }
  const std::string output = line.requiredText("output");
  if (line.files().size() != 1)
    throw fsr::settings::InputError("give one bag, and --output with another name");
  const std::string& input = line.files().front();
  std::error_code error;
  if (!fs::is_regular_file(input, error)) throw fsr::settings::InputError(input + ": there is no such file");
  if (fs::equivalent(input, output, error))
    throw fsr::settings::InputError("--output is the bag itself; give another name");
  fsr::settings::requireReplaceable(output);

  const std::string fresh = output + ".new-" + std::to_string(::getpid());
  Ledger ledger;
  try {
    ledger = scrub(input, fresh);
  } catch (...) {
    fs::remove(fresh, error);
    throw;
  }
  fs::rename(fresh, output);
  out << "Removed:\n";
  for (const auto& [what, count] : ledger) out << "  " << count << " x " << what << '\n';
  out << "The scrubbed bag is " << fs::absolute(output).lexically_normal().string()
      << "\nCheck the file name yourself, and keep the list of subject codes confidential.\n";
  return 0;
}

}  // namespace fsr_ros
