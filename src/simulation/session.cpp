#include "simulation/session.h"

#include <cmath>

#include "dataset/recording_builder.h"
#include "simulation/effects/effect_library.h"
#include "simulation/pressure_profile.h"

namespace fsr::simulation {

namespace {

constexpr double kThermometerRate = 1;  // [Hz]

/// Something that is sampled at an even rate from a station's begin.
struct Sampler {
  double begin, rate;  // [s], [Hz]; rate 0 = never
  std::uint64_t number = 0;

  double due() const { return rate > 0 ? begin + static_cast<double>(number) / rate : INFINITY; }
};

std::int64_t nanoseconds(double time) {
  return std::llround(time * 1e9);
}

}  // namespace

Session::Session(const SimulationSettings& settings)
    : settings_(settings), rig_(settings), origin_ns_(nanoseconds(settings.start)) {
  for (const Station& station : settings_.session) {
    if (std::isfinite(pressureProfile(station.program).duration())) continue;
    throw settings::InputError(settings_.origin + ": the cycles on " + station.surface.name +
                               " never end; give `cycles` of 1 or more");
  }
}

double Session::begin() const {
  return next_ == 0 && !resumed_ ? 0 : time_ + station(next_).pause;
}

void Session::resume(const RigState& state) {
  rig_.restore(state);
  origin_ns_ = state.origin_ns;
  time_ = state.time;
  resumed_ = true;
  for (Station& station : settings_.session) station.surface.mount += state.mount;
}

RigState Session::state() const {
  RigState state;
  state.origin_ns = origin_ns_;
  state.time = time_;
  if (next_ > 0) {
    state.mount = station(next_ - 1).surface.mount;
    state.surface = station(next_ - 1).surface.name;
  }
  rig_.save(state);
  return state;
}

void Session::runNext(const RigListener& listener) {
  const Station& now = station(next_);
  const double start = begin();
  const PressureProfile profile = pressureProfile(now.program);
  const PressureCourse course = [&](double time) { return profile.at(time - start); };
  rig_.mount(now.surface, now.load);
  Sampler scan{start, settings_.board.scan_rate}, transducer{start, settings_.board.transducer_rate},
      thermometer{start, kThermometerRate};
  const double end = start + profile.duration();
  while (scan.due() <= end) {
    if (thermometer.due() <= std::min(transducer.due(), scan.due())) {
      const double time = thermometer.due();
      if (listener.temperature) listener.temperature(time, rig_.temperature(time, course));
      ++thermometer.number;
    } else if (transducer.due() <= scan.due()) {
      const double time = transducer.due();
      if (listener.transducer) listener.transducer(time, rig_.transducer(time, course));
      ++transducer.number;
    } else {
      const double time = scan.due();
      const auto& counts = rig_.scan(time, course);
      if (listener.scan) listener.scan(time, counts);
      ++scan.number;
    }
  }
  time_ = end;
  ++next_;
}

dataset::SensorIdentity identity(const SimulationSettings& settings) {
  dataset::SensorIdentity sensor;
  sensor.sensor_id = settings.board.serial;
  sensor.serial = settings.board.serial;
  sensor.firmware = settings.board.firmware;
  sensor.model = settings.board.model;
  return sensor;
}

std::string stationName(const Station& station) {
  return std::to_string(station.surface.mount) + "_" + station.surface.name;
}

std::vector<dataset::Recording> simulateSession(const SimulationSettings& settings) {
  Session session(settings);
  std::vector<dataset::Recording> recordings;
  for (std::size_t i = 0; i < session.stations(); ++i) {
    dataset::RecordingBuilder builder;
    std::uint32_t sequence = 0;
    const auto stamp = [&](double time) { return session.origin() + nanoseconds(time); };
    builder.addDescription(
        stamp(session.begin()),
        {identity(settings), settings.layout, settings.fullScale(), dataset::kStandardAmbient, {}});
    builder.addSurface(stamp(session.begin()), session.station(i).surface);
    session.runNext({[&](double time, const std::vector<std::uint16_t>& counts) {
                       builder.addScan(
                           stamp(time), sequence++,
                           {settings.layout.size, settings.fullScale(), counts.data(), counts.size()});
                     },
                     [&](double time, std::int32_t counts) {
                       const double gauge = settings.transducer.gaugePressure(counts);
                       builder.addChamberPressure(stamp(time), gauge + dataset::kStandardAmbient);
                     },
                     [&](double time, double celsius) { builder.addTemperature(stamp(time), celsius); }});
    dataset::RecordingOptions options;
    options.name = stationName(session.station(i)) + ".bag";
    recordings.push_back(builder.build(options));
  }
  return recordings;
}

}  // namespace fsr::simulation
