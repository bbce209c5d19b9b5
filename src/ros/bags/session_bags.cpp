#include <cmath>
#include <filesystem>
#include <map>

#include "ros/bags/bag_writer.h"
#include "ros/bags/simulated_bags.h"
#include "ros/messages/driver_messages.h"
#include "ros/messages/surface_message.h"
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

}  // namespace

SimulatedRun writeSessionBags(const fsr::simulation::SimulationSettings& settings,
                              const SimulatedBags& bags) {
  fsr::simulation::Session session(settings);
  if (bags.state) session.resume(*bags.state);
  for (std::size_t i = 0; i < session.stations(); ++i) {
    if (bags.wanted && !bags.wanted(i)) {
      session.runNext(noListener());
      continue;
    }
    const fsr::simulation::Station& station = session.station(i);
    const std::string path = std::filesystem::path(bags.output) / (stationName(station) + ".bag");
    if (bags.progress) bags.progress(path);
    StationBag bag(path, settings, station.surface, session.origin());
    session.runNext(bag.listener());
    bag.close();
  }
  return {settings, session.state(), {}};
}

}  // namespace fsr_ros
