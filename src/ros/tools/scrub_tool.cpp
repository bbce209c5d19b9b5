#include "ros/tools/tools.h"

#include <fsr_pressure_map/Event.h>
#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <fsr_pressure_map/PressureMap.h>
#include <fsr_pressure_map/Session.h>
#include <fsr_pressure_map/SurfaceCurvature.h>
#include <rosbag/view.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Temperature.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_writer.h"
#include "ros/bags/sensor_topics.h"
#include "ros/messages/message_reader.h"
#include "ros/tools/tool_options.h"
#include "settings/command_line.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"

namespace fsr_ros {

namespace {

constexpr std::int64_t kSecond = 1000000000;                      // [ns]
constexpr std::int64_t kNewStart = 946684800 * kSecond;           // 2000-01-01 00:00 UTC [ns]
constexpr std::int64_t kEnd = (std::int64_t{1} << 32) * kSecond;  // end of the range of ros::Time [ns]
constexpr std::size_t kShown = 5;                                 // values of a field that are listed

// What was removed, and how often.
using Ledger = std::map<std::string, std::uint64_t>;
// The values of texts that were kept.
using Kept = std::map<std::string, std::set<std::string>>;

class Scrubber {
 public:
  Scrubber(const rosbag::Bag& from, FreshBag& to) : from_(from), to_(to) {}

  void run(const BagWalk::ReadProgress& progress) {
    rosbag::View view(from_);
    if (view.size() == 0) throw fsr::settings::InputError("holds no message");
    shift_ = kNewStart - view.getBeginTime().sec * kSecond;
    removed_["absolute times"] = view.size();
    const auto copyOrCount = [&](const rosbag::MessageInstance& message) {
      const bool kept =
          copy<fsr_pressure_map::MatrixFrame>(message) || copy<sensor_msgs::FluidPressure>(message) ||
          copy<sensor_msgs::Temperature>(message) || copy<fsr_pressure_map::SurfaceCurvature>(message) ||
          copy<fsr_pressure_map::PressureMap>(message) || copy<fsr_pressure_map::MatrixInfo>(message) ||
          copy<fsr_pressure_map::Session>(message) || copy<fsr_pressure_map::Event>(message);
      if (!kept) ++removed_["messages of " + message.getTopic() + " (" + message.getDataType() + ")"];
      if (kept && !message.getCallerId().empty()) ++removed_["names of the nodes that published"];
      return true;
    };
    forEachMessage(from_, {}, copyOrCount, progress);
  }

  const Ledger& removed() const { return removed_; }
  const Kept& kept() const { return kept_; }

 private:
  template <typename Message>
  bool copy(const rosbag::MessageInstance& instance) {
    if (!isReadable<Message>(instance.getMD5Sum())) return false;
    auto message = reader_.read<Message>(instance);
    const std::string& topic = instance.getTopic();
    if (!message.header.stamp.isZero()) message.header.stamp = moved(message.header.stamp, topic);
    keep(message.header.frame_id, "frame of " + topic);
    clean(message);
    to_.write(topic, moved(instance.getTime(), topic), message);
    return true;
  }

  ros::Time moved(const ros::Time& time, const std::string& topic) const {
    const std::int64_t now = static_cast<std::int64_t>(time.toNSec()) + shift_;
    if (now <= 0 || now >= kEnd) {
      throw fsr::settings::InputError(
          topic + ": a stamp of " + std::to_string(time.sec) +
          " s is more than 30 years before or 100 years after the bag's first message, so it cannot be moved "
          "with it; leave this message out with rosbag filter");
    }
    return ros::Time().fromNSec(static_cast<std::uint64_t>(now));
  }

  template <typename Message>
  void clean(Message& /*message*/) {}
  void clean(fsr_pressure_map::Session& session) {
    take(session.session_id, "session ids");
    take(session.operator_code, "operator codes");
    take(session.ethics_reference, "ethics references");
    if (!session.notes.empty()) ++removed_["notes of the session"];
    session.notes.clear();
    keep(session.subject_code, "subject code");
    keep(session.sensor_id, "sensor id");
    keep(session.use, "use");
    keep(session.mounted_on, "mounted on");
    keep(session.trial, "trial");
    keep(session.protocol, "protocol");
  }
  void clean(fsr_pressure_map::Event& event) {
    if (event.kind == "note" || event.kind == "reject")
      take(event.label, "labels of events of kind " + event.kind);
    keep(event.label, "label of an event of kind " + event.kind);
  }
  void clean(fsr_pressure_map::MatrixInfo& info) {
    keep(info.sensor_id, "sensor id");
    keep(info.serial, "serial number");
    keep(info.firmware, "firmware");
    keep(info.sensor_model, "sensor model");
    keep(info.sealing, "sealing");
    keep(info.transducer, "transducer");
  }
  void clean(fsr_pressure_map::SurfaceCurvature& curvature) { keep(curvature.surface, "surface"); }
  void clean(fsr_pressure_map::PressureMap& map) { keep(map.calibration, "calibration"); }

  void take(std::string& field, const std::string& what) {
    if (!field.empty()) ++removed_[what];
    field.clear();
  }
  void keep(const std::string& field, const std::string& what) {
    if (!field.empty()) kept_[what].insert(field);
  }

  const rosbag::Bag& from_;
  FreshBag& to_;
  std::int64_t shift_ = 0;  // [ns]
  MessageReader reader_;
  Ledger removed_;
  Kept kept_;
};

void print(const Scrubber& scrubber, std::ostream& out) {
  out << "Removed:\n";
  for (const auto& [what, count] : scrubber.removed()) out << "  " << count << " x " << what << '\n';
  out << "Kept; check that nothing in it points to a person:\n";
  for (const auto& [what, values] : scrubber.kept()) {
    out << "  " << what << ": ";
    std::size_t shown = 0;
    for (const std::string& value : values) {
      if (shown < kShown) out << (shown == 0 ? "" : ", ") << value;
      ++shown;
    }
    if (shown > kShown) out << " and " << shown - kShown << " more";
    out << '\n';
  }
}

}  // namespace

int scrubTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line(
      "scrub", "BAG --output BAG",
      "Copies a bag without notes, session id, operator, ethics reference, names of nodes and hosts, "
      "/rosout and other topics that are not known. The times are moved so that the copy begins on "
      "2000-01-01. "
      "Prints what was removed, and the texts that were kept.");
  line.output("output", "BAG", "bag to write");
  if (!line.parse(argc, argv, out)) return 0;
  const std::string output = line.requiredText("output");
  if (line.files().size() != 1)
    throw fsr::settings::InputError("give one bag, and --output with another name");
  fsr::settings::requireReplaceable(output, fsr::settings::file_kind::kBag);
  const std::string& bag = line.files().front();
  const auto progress = toolProgress();
  withSoundBag(
      bag,
      [&](const rosbag::Bag& from) {
        FreshBag to(output);
        Scrubber scrubber(from, to);
        scrubber.run(told("copying " + bag, progress));
        to.finish();
        print(scrubber, out);
      },
      told("checking " + bag, progress));
  out << "The scrubbed bag is " << std::filesystem::absolute(output).lexically_normal().string()
      << "\nCheck the file name yourself, and keep the list of subject codes confidential.\n";
  return 0;
}

}  // namespace fsr_ros
