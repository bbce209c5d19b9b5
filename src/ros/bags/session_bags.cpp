#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "ros/bags/bag_writer.h"
#include "ros/bags/simulated_bags.h"
#include "ros/messages/driver_messages.h"
#include "ros/messages/surface_message.h"
#include "simulation/pressure_profile.h"
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

// Hears all and keeps nothing, so that the rig runs as if a bag were written.
fsr::simulation::RigListener noListener() {
  return {[](double, const std::vector<std::uint16_t>&) {}, [](double, std::int32_t) {},
          [](double, double) {}};
}

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
    std::optional<StationBag> bag;
    if (!bags.wanted || bags.wanted(i)) {
      const std::string path = std::filesystem::path(bags.output) / (stationName(station) + ".bag");
      if (bags.progress) bags.progress(path);
      bag.emplace(path, settings, station.surface, session.origin());
    }
    session.runNext(share.telling(bag ? bag->listener() : noListener(), "simulating " + stationName(station),
                                  session.begin()));
    if (bag) bag->close();
    share.ended(station);
  }
  return {settings, session.state(), {}};
}

}  // namespace fsr_ros
