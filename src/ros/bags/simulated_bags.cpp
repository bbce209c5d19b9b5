#include <fsr_pressure_map/MatrixFrame.h>
#include <fsr_pressure_map/MatrixInfo.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "dataset/count_readers.h"
#include "fsr_pressure_map/ros/bag_reader.h"
#include "ros/bags/bag_walk.h"
#include "ros/bags/bag_writer.h"
#include "ros/bags/sensor_topics.h"
#include "ros/bags/simulated_bags.h"
#include "ros/messages/driver_messages.h"
#include "ros/messages/message_reader.h"
#include "ros/messages/surface_message.h"
#include "settings/replace_file.h"
#include "simulation/pressure_profile.h"
#include "simulation/rig.h"
#include "simulation/session.h"

namespace fsr_ros {

namespace {

// The driver's settings for the simulated board.
DriverSettings driverSettings(const fsr::simulation::SimulationSettings& settings) {
  DriverSettings driver;
  driver.pitch_x = settings.layout.pitch_x;
  driver.pitch_y = settings.layout.pitch_y;
  driver.sensor_model = settings.board.model;
  const fsr::simulation::Transducer& transducer = settings.transducer;
  driver.transducer_line.offset = transducer.low;
  driver.transducer_line.slope = transducer.step();
  driver.transducer_line.deviation = 0.0025 * (transducer.high - transducer.low) / std::sqrt(3.0);
  return driver;
}

Board boardOf(const fsr::simulation::SimulationSettings& settings) {
  return {settings.board.serial, settings.board.firmware, settings.board.model,
          settings.layout.size,  settings.fullScale(),    1 / settings.board.scan_rate};
}

fsr_pressure_map::Session simulatedSession() {
  fsr_pressure_map::Session session;
  session.session_id = "simulated";
  session.use = "chamber";
  session.mounted_on = "fixture";
  return session;
}

// Writes the bag of one station with the messages that the driver, the curvature node and the session node
// would publish.
class StationBag {
 public:
  StationBag(const std::string& path, const fsr::simulation::SimulationSettings& settings,
             const fsr::matrix::Surface& surface, std::int64_t origin_ns)
      : settings_(settings),
        origin_ns_(origin_ns),
        driver_(driverSettings(settings)),
        info_(matrixInfo(boardOf(settings), driver_)),
        surface_(toMessage(surface)),
        session_(simulatedSession()),
        bag_(path) {}

  fsr::simulation::RigListener listener() {
    return {[this](double time, const std::vector<std::uint16_t>& counts) { scan(time, counts); },
            [this](double time, std::int32_t counts) {
              publish("chamber_pressure", *pressureMessage(counts, timeOf(time), driver_));
            },
            [this](double time, double temperature) { second(time, temperature); }};
  }
  void close() { bag_.close(); }

 private:
  fsr::protocol::PacketTime timeOf(double time) const {
    return {origin_ns_ + std::llround(time * 1e9), static_cast<std::uint64_t>(std::llround(time * 1e6))};
  }

  void scan(double time, const std::vector<std::uint16_t>& counts) {
    fsr::protocol::PacketHeader header;
    header.sequence = sequence_++;
    fsr::protocol::ScanPacket packet{settings_.layout.size, settings_.fullScale(), 0, counts.data()};
    packet.duration = static_cast<std::uint32_t>(std::lround(settings_.board.scan_duration * 1e6));
    publish("raw", *scanMessage(header, packet, timeOf(time), driver_));
  }

  void second(double time, double temperature) {
    const auto millidegrees = static_cast<std::int32_t>(std::lround(1000 * temperature));
    const auto message = temperatureMessage(millidegrees, timeOf(time), driver_);
    info_.header = surface_.header = message->header;
    session_.header.stamp = message->header.stamp;
    publish("matrix_info", info_);
    publish("curvature", surface_);
    publish("session", session_);
    publish("temperature", *message);
  }

  // Numbers the messages of a topic, as a publisher does.
  template <typename Message>
  void publish(const std::string& topic, Message& message) {
    message.header.seq = published_[topic]++;
    bag_.add(topic, message);
  }

  const fsr::simulation::SimulationSettings& settings_;
  std::int64_t origin_ns_;
  DriverSettings driver_;
  fsr_pressure_map::MatrixInfo info_;
  fsr_pressure_map::SurfaceCurvature surface_;
  fsr_pressure_map::Session session_;
  BagWriter bag_;
  std::uint32_t sequence_ = 0;
  std::map<std::string, std::uint32_t> published_;  // number of messages of each topic
};

// The share of the programs of a session that has run.
class SessionShare {
 public:
  SessionShare(const fsr::simulation::Session& session, const SimulatedBags& bags) : bags_(bags) {
    for (std::size_t i = 0; i < session.stations(); ++i) all_ += durationOf(session.station(i));
  }

  // A listener that also tells the share, once a second of rig time, while a station runs. Its program begins
  // at `begin`.
  fsr::simulation::RigListener telling(fsr::simulation::RigListener listener, const std::string& step,
                                       double begin) const {
    if (!bags_.told) return listener;
    listener.temperature = [this, step, begin, heard = listener.temperature](double time, double celsius) {
      heard(time, celsius);
      bags_.told(step, std::min((before_ + time - begin) / all_, 1.0));
    };
    return listener;
  }
  void ended(const fsr::simulation::Station& station) { before_ += durationOf(station); }

 private:
  static double durationOf(const fsr::simulation::Station& station) {
    return pressureProfile(station.program).duration();
  }

  const SimulatedBags& bags_;
  double all_ = 0, before_ = 0;  // [s]
};

}  // namespace

SimulatedRun writeSessionBags(const fsr::simulation::SimulationSettings& settings,
                              const SimulatedBags& bags) {
  fsr::simulation::Session session(settings);
  if (bags.state) session.resume(*bags.state);
  SessionShare share(session, bags);
  for (std::size_t i = 0; i < session.stations(); ++i) {
    const fsr::simulation::Station& station = session.station(i);
    const std::string path = std::filesystem::path(bags.output) / (stationName(station) + ".bag");
    if (bags.progress) bags.progress(path);
    StationBag bag(path, settings, station.surface, session.origin());
    session.runNext(share.telling(bag.listener(), "simulating " + stationName(station), session.begin()));
    bag.close();
    share.ended(station);
  }
  return {settings, session.state(), {}};
}

namespace {

// The counts of the simulated matrix at each stamp of a recording.
class SimulatedScans {
 public:
  SimulatedScans(fsr::simulation::DrivenRig& rig, const fsr::dataset::Recording& recording,
                 const BagWalk::ReadProgress& progress)
      : taxels_(recording.layout.size.taxels()), counts_(kInMemory), read_(counts_) {
    counts_.begin(taxels_, recording.scans());
    rig.run(recording, [&](std::size_t scan, const fsr::simulation::SensorChain& chain) {
      if (progress) progress(static_cast<double>(scan) / static_cast<double>(recording.scans()));
      stamps_.push_back(recording.start_ns + std::llround(recording.time[scan] * 1e9));
      counts_.add(chain.counts().data());
    });
  }

  // The counts at a stamp, row-major, valid until the next call; nullptr if there is no scan at that stamp.
  const std::uint16_t* find(std::int64_t stamp_ns) {
    const auto found = std::lower_bound(stamps_.begin(), stamps_.end(), stamp_ns - kRounding);
    if (found == stamps_.end() || *found > stamp_ns + kRounding) return nullptr;
    return read_[static_cast<std::size_t>(found - stamps_.begin())];
  }

  std::size_t taxels() const { return taxels_; }

 private:
  static constexpr std::size_t kInMemory = 8u << 20;  // of the counts [bytes]
  static constexpr std::int64_t kRounding = 2;        // rounding error of times kept in seconds [ns]
  std::size_t taxels_;
  std::vector<std::int64_t> stamps_;
  fsr::dataset::RowSpool<std::uint16_t> counts_;
  fsr::dataset::RowSpool<std::uint16_t>::Reader read_;
};

std::string withoutLeadingSlash(const std::string& name) {
  return name.rfind('/', 0) == 0 ? name.substr(1) : name;
}

// Copies the messages of one sensor and replaces its readings.
class Copier {
 public:
  Copier(const fsr::simulation::SimulationSettings& settings, const std::string& topics,
         SimulatedScans& scans, BagWriter& out)
      : settings_(settings), topics_(withoutLeadingSlash(topics)), scans_(scans), out_(out) {}

  void copy(const rosbag::MessageInstance& instance) {
    const std::string topic = withoutLeadingSlash(instance.getTopic());
    const std::size_t slash = topic.rfind('/');
    const std::string name = topic.substr(slash == std::string::npos ? 0 : slash + 1);
    const bool ours = topics_.empty() || topic == topics_ + "/" + name;
    if (!ours) return;
    if (name == "raw") return copyScan(instance);
    if (name == "matrix_info") return copyInfo(instance);
    static const std::set<std::string> kRecorded = {"chamber_pressure", "curvature", "temperature", "session",
                                                    "events"};
    if (kRecorded.count(name) > 0) out_.copy(instance);
  }

 private:
  void copyScan(const rosbag::MessageInstance& instance) {
    auto message = reader_.read<fsr_pressure_map::MatrixFrame>(instance);
    const std::uint16_t* counts = scans_.find(static_cast<std::int64_t>(message.header.stamp.toNSec()));
    if (counts == nullptr || message.counts.size() != scans_.taxels()) return;
    std::copy(counts, counts + message.counts.size(), message.counts.begin());
    out_.replace(instance, message);
  }

  void copyInfo(const rosbag::MessageInstance& instance) {
    auto message = reader_.read<fsr_pressure_map::MatrixInfo>(instance);
    message.serial = message.sensor_id = settings_.board.serial;
    message.firmware = settings_.board.firmware;
    message.sensor_model = settings_.board.model;
    out_.replace(instance, message);
  }

  const fsr::simulation::SimulationSettings& settings_;
  std::string topics_;
  SimulatedScans& scans_;
  BagWriter& out_;
  MessageReader reader_;
};

void copyBag(SimulatedScans& scans, const std::string& from, const std::string& to,
             const fsr::simulation::SimulationSettings& settings, const std::string& topics,
             const BagWalk::ReadProgress& progress) {
  BagWriter out(to);
  withSoundBag(from, [&](const rosbag::Bag& bag) {
    Copier copier(settings, topics, scans, out);
    rosbag::View view(bag);
    const double all = view.size();
    double copied = 0;
    for (const rosbag::MessageInstance& instance : view) {
      copier.copy(instance);
      if (progress) progress(++copied / all);
    }
  });
  out.close();
}

void warn(const fsr::dataset::Recording& recording, std::vector<std::string>& warnings) {
  for (const std::string& warning : recording.warnings) warnings.push_back(recording.name + ": " + warning);
  const auto& surfaces = recording.conditions;
  const bool known = std::all_of(surfaces.begin(), surfaces.end(), [](const auto& s) { return s.known(); });
  if (!known)
    warnings.push_back(recording.name +
                       ": the surface is unknown in parts of it; the simulated matrix lies flat there");
  if (recording.temperature.empty()) {
    warnings.push_back(recording.name + ": holds no temperature; the simulation uses 23 degree Celsius");
  }
}

void warnOfSize(const fsr::dataset::Recording& recording, const fsr::simulation::SimulationSettings& settings,
                std::vector<std::string>& warnings) {
  const fsr::matrix::MatrixSize simulated = settings.layout.size;
  if (recording.layout.size == simulated) return;
  warnings.push_back(recording.name + ": the matrix has " + sizeText(recording.layout.size) +
                     " taxels, but " + settings.origin + " has " + sizeText(simulated) +
                     "; the simulation uses the bag's size");
}

// The bag that is written for each driving bag. Throws before the first is written if one of them would
// replace a driving bag or another output.
std::vector<std::string> outputPaths(const std::vector<std::string>& driving, const std::string& output) {
  std::vector<std::string> paths;
  for (const std::string& bag : driving) {
    const std::string path = std::filesystem::path(output) / std::filesystem::path(bag).filename();
    fsr::settings::requireNoInput(path, driving);
    if (std::find(paths.begin(), paths.end(), path) != paths.end()) {
      throw fsr::settings::InputError(bag + ": another bag of --drive has the same name, and " + path +
                                      " can be only one of them; rename one");
    }
    paths.push_back(path);
  }
  return paths;
}

}  // namespace

fsr::dataset::Recording readWhole(const std::string& path, BagReadOptions how) {
  how.change_margin = 0;
  return readBag(path, how);
}

SimulatedRun writeDrivenBags(const fsr::simulation::SimulationSettings& settings, const DrivingBags& driving,
                             const SimulatedBags& bags) {
  SimulatedRun run{settings, {}, {}};
  std::optional<fsr::simulation::DrivenRig> rig;
  const std::vector<std::string> paths = outputPaths(driving.paths, bags.output);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::string &bag = driving.paths[i], &path = paths[i];
    BagReadOptions how = driving.how;
    how.progress = told("reading " + bag, bags.told);
    const fsr::dataset::Recording recording = readWhole(bag, how);
    if (bags.progress) bags.progress(path);
    warn(recording, run.warnings);
    if (!rig) {
      warnOfSize(recording, settings, run.warnings);
      run.rig = fitted(settings, recording);
      rig.emplace(run.rig);
      if (bags.state) rig->resume(*bags.state);
    }
    SimulatedScans scans(*rig, recording, told("simulating " + bag, bags.told));
    copyBag(scans, bag, path, settings, driving.how.topics, told("writing " + path, bags.told));
    run.state = rig->state();
  }
  return run;
}

}  // namespace fsr_ros
