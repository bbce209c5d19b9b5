#include "fsr_pressure_map/simulation/chamber_climate.h"

#include "simulation/read_settings.h"

namespace fsr::simulation {

namespace {

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

ChamberClimate readChamberClimate(const settings::Settings& settings) {
  ChamberClimate climate;
  if (settings.has("room")) climate.room = readRoom(settings);
  climate.heating = settings.number("heating", {0, 1e-3, "K/Pa"}, climate.heating);
  climate.cooling = settings.number("cooling", {0.1, 1e5, "s"}, climate.cooling);
  return climate;
}

}  // namespace fsr::simulation
