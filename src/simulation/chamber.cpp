#include "fsr_pressure_map/simulation/chamber.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "settings/yaml_text.h"
#include "simulation/pressure_profile.h"
#include "simulation/read_settings.h"

namespace fsr::simulation {

namespace {

const settings::Range kPeak{1e3, kChamberRating, "Pa gauge (the chamber is rated at 793 kPa)"};
const settings::Range kRate{1, 1e7, "Pa/s"};
const settings::Range kDwell{0, 86400, "s"};
const settings::Range kCycles{0, 1e6, "cycles (0 = for ever)"};

void require(const std::string& origin, const char* field, double value, const settings::Range& range) {
  if (range.contains(value)) return;
  std::ostringstream sentence;
  sentence << origin << ": " << field << " is " << value << ", but must be " << range.text();
  throw settings::InputError(sentence.str());
}

const settings::Range kCelsius{-40, 125, "degree Celsius"};

std::vector<TemperaturePoint> readRoom(const settings::Settings& settings) {
  if (!settings.isList("room")) return {{0, settings.number("room", kCelsius)}};
  std::vector<TemperaturePoint> room;
  for (const settings::Settings& point : settings.sections("room")) {
    room.push_back({point.number("time", {0, 1e9, "s"}), point.number("temperature", kCelsius)});
    if (room.size() > 1 && room.back().time <= room[room.size() - 2].time) {
      throw point.error("time", "must be later than the time before it");
    }
  }
  return room;
}

}  // namespace

void validate(const ChamberProtocol& protocol, const std::string& origin) {
  require(origin, "peak", protocol.peak, kPeak);
  require(origin, "fill_rate", protocol.fill_rate, kRate);
  require(origin, "vent_rate", protocol.vent_rate, kRate);
  require(origin, "dwell_peak", protocol.dwell_peak, kDwell);
  require(origin, "dwell_rest", protocol.dwell_rest, kDwell);
  require(origin, "cycles", protocol.cycles, kCycles);
}

ChamberProtocol readChamberProtocol(const settings::Settings& settings, const ChamberProtocol& defaults) {
  ChamberProtocol protocol = defaults;
  protocol.peak = settings.number("peak", kPeak, defaults.peak);
  if (settings.has("rate")) {
    protocol.fill_rate = protocol.vent_rate = settings.number("rate", kRate);
  } else {
    protocol.fill_rate = settings.number("fill_rate", kRate, defaults.fill_rate);
    protocol.vent_rate = settings.number("vent_rate", kRate, defaults.vent_rate);
  }
  protocol.dwell_peak = settings.number("dwell_peak", kDwell, defaults.dwell_peak);
  protocol.dwell_rest = settings.number("dwell_rest", kDwell, defaults.dwell_rest);
  protocol.cycles = static_cast<unsigned>(settings.integer("cycles", kCycles, defaults.cycles));
  return protocol;
}

std::string protocolText(const ChamberProtocol& p) {
  return "{peak: " + settings::numberText(p.peak) + ", fill_rate: " + settings::numberText(p.fill_rate) +
         ", vent_rate: " + settings::numberText(p.vent_rate) +
         ", dwell_peak: " + settings::numberText(p.dwell_peak) +
         ", dwell_rest: " + settings::numberText(p.dwell_rest) + ", cycles: " + std::to_string(p.cycles) +
         "}";
}

double cycleDuration(const ChamberProtocol& p) {
  return p.dwell_rest + p.peak / p.fill_rate + p.dwell_peak + p.peak / p.vent_rate;
}

std::vector<PressurePoint> cyclePoints(const ChamberProtocol& p) {
  const double full = p.dwell_rest + p.peak / p.fill_rate;
  return {{0, 0},
          {p.dwell_rest, 0},
          {full, p.peak},
          {full + p.dwell_peak, p.peak},
          {full + p.dwell_peak + p.peak / p.vent_rate, 0}};
}

PressureProfile pressureProfile(const ChamberProtocol& protocol) {
  PressureProfile profile;
  profile.append(cyclePoints(protocol), protocol.cycles);
  return profile;
}

PressureProfile ventingProfile(const ChamberProtocol& protocol, double pressure) {
  PressureProfile profile;
  if (pressure > 0) profile.append({{0, pressure}, {pressure / protocol.vent_rate, 0}});
  return profile;
}

ChamberClimate readChamberClimate(const settings::Settings& settings) {
  ChamberClimate climate;
  if (settings.has("room")) climate.room = readRoom(settings);
  climate.heating = settings.number("heating", {0, 1e-3, "K/Pa"}, climate.heating);
  climate.cooling = settings.number("cooling", {0.1, 1e5, "s"}, climate.cooling);
  return climate;
}

std::int32_t Transducer::counts(double gauge_pressure) const {
  const double unrounded = std::round((gauge_pressure - low) / step());
  return static_cast<std::int32_t>(std::clamp(unrounded, 0.0, static_cast<double>(full_counts)));
}

}  // namespace fsr::simulation
