#include "fsr_pressure_map/simulation/chamber.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "settings/text.h"
#include "simulation/pressure_profile.h"
#include "simulation/settings_text.h"

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

namespace {

const settings::Range kPressureRange{0, kChamberRating, "Pa gauge (the chamber is rated at 793 kPa)"};
const settings::Range kProgramRate{1, 1e7, "Pa/s"};
const settings::Range kDuration{0, 1e7, "s"};
const settings::Range kLoops{1, 1e6, "loops"};

HoldPart readHold(const settings::Settings& settings) {
  HoldPart hold;
  hold.pressure = settings.number("pressure", kPressureRange);
  hold.rate = settings.number("rate", kProgramRate, hold.rate);
  hold.duration = settings.number("duration", kDuration);
  return hold;
}

LoopsPart readLoops(const settings::Settings& settings) {
  LoopsPart loops;
  loops.low = settings.number("low", kPressureRange);
  loops.high = settings.number("high", kPressureRange);
  if (loops.high <= loops.low) throw settings.error("high", "must be above low");
  loops.rate = settings.number("rate", kProgramRate, loops.rate);
  loops.loops = static_cast<unsigned>(settings.integer("loops", kLoops));
  return loops;
}

RestPart readRest(const settings::Settings& settings) {
  RestPart rest;
  rest.rate = settings.number("rate", kProgramRate, rest.rate);
  rest.duration = settings.number("duration", kDuration);
  return rest;
}

ProgramPart readPart(const settings::Settings& part) {
  const char* const one_key = "give exactly one of cycles, hold, loops, rest";
  const std::vector<std::string> keys = part.keys();
  if (keys.size() != 1) throw part.error(keys.empty() ? "cycles" : keys[1], one_key);
  if (part.has("cycles")) return readChamberProtocol(part.section("cycles"));
  if (part.has("hold")) return readHold(part.section("hold"));
  if (part.has("loops")) return readLoops(part.section("loops"));
  if (part.has("rest")) return readRest(part.section("rest"));
  throw part.error(keys[0], one_key);
}

bool endless(const ProgramPart& part) {
  const auto* cycles = std::get_if<ChamberProtocol>(&part);
  return cycles != nullptr && cycles->cycles == 0;
}

/// Appends parts to a profile; called by std::visit.
class Builder {
 public:
  void operator()(const ChamberProtocol& cycles) {
    rampTo(0, cycles.vent_rate);
    profile_.append(cyclePoints(cycles), cycles.cycles);
  }
  void operator()(const HoldPart& hold) {
    rampTo(hold.pressure, hold.rate);
    stay(hold.duration);
  }
  void operator()(const LoopsPart& loops) {
    const double ramp = (loops.high - loops.low) / loops.rate;  // [s]
    rampTo(loops.low, loops.rate);
    profile_.append({{0, loops.low}, {ramp, loops.high}, {2 * ramp, loops.low}}, loops.loops);
  }
  void operator()(const RestPart& rest) {
    rampTo(0, rest.rate);
    stay(rest.duration);
  }
  const PressureProfile& profile() const { return profile_; }

 private:
  void stay(double duration) {
    if (duration > 0) profile_.append({{0, pressure_}, {duration, pressure_}});
  }
  void rampTo(double pressure, double rate) {
    if (pressure != pressure_) {
      profile_.append({{0, pressure_}, {std::abs(pressure - pressure_) / rate, pressure}});
    }
    pressure_ = pressure;
  }

  PressureProfile profile_;
  double pressure_ = 0;  // where the chamber stands now [Pa]
};

using Fields = std::vector<std::pair<const char*, double>>;

std::string text(const char* key, const Fields& fields) {
  std::string result;
  for (const auto& [name, value] : fields) {
    result += std::string(result.empty() ? "" : ", ") + name + ": " + settings::numberText(value);
  }
  return std::string(key) + ": {" + result + "}";
}

/// Called by std::visit.
struct Writer {
  std::string operator()(const ChamberProtocol& p) const { return "cycles: " + protocolText(p); }
  std::string operator()(const HoldPart& p) const {
    return text("hold", {{"pressure", p.pressure}, {"rate", p.rate}, {"duration", p.duration}});
  }
  std::string operator()(const LoopsPart& p) const {
    return text("loops", {{"low", p.low}, {"high", p.high}, {"rate", p.rate}, {"loops", p.loops}});
  }
  std::string operator()(const RestPart& p) const {
    return text("rest", {{"rate", p.rate}, {"duration", p.duration}});
  }
};

}  // namespace

ChamberProgram readChamberProgram(const std::vector<settings::Settings>& parts) {
  ChamberProgram program;
  for (const settings::Settings& part : parts) {
    if (!program.empty() && endless(program.back())) {
      throw part.error(part.keys().empty() ? "cycles" : part.keys()[0], "the part before it never ends");
    }
    program.push_back(readPart(part));
  }
  return program;
}

PressureProfile pressureProfile(const ChamberProgram& program) {
  Builder builder;
  for (const ProgramPart& part : program) std::visit(builder, part);
  return builder.profile();
}

std::string programText(const ProgramPart& part) {
  return std::visit(Writer{}, part);
}

namespace {

void check(const std::vector<PressurePoint>& points) {
  const auto later = [](const PressurePoint& a, const PressurePoint& b) { return !(a.time <= b.time); };
  if (points.size() < 2 || points.front().time != 0 || !(points.back().time > 0) ||
      std::adjacent_find(points.begin(), points.end(), later) != points.end()) {
    throw std::invalid_argument("a part of a pressure profile needs times that ascend from 0");
  }
}

double interpolate(const std::vector<PressurePoint>& points, double time) {
  const auto next = std::upper_bound(points.begin(), points.end(), time,
                                     [](double t, const PressurePoint& point) { return t < point.time; });
  if (next == points.begin()) return points.front().pressure;
  if (next == points.end()) return points.back().pressure;
  const PressurePoint& from = *(next - 1);
  return from.pressure + (next->pressure - from.pressure) * (time - from.time) / (next->time - from.time);
}

}  // namespace

void PressureProfile::append(const std::vector<PressurePoint>& points, unsigned repeats) {
  check(points);
  const double start = duration();
  if (std::isinf(start)) throw std::invalid_argument("a part cannot follow one that repeats for ever");
  const double period = points.back().time;
  const double end = repeats == 0 ? std::numeric_limits<double>::infinity() : start + period * repeats;
  parts_.push_back({start, period, end, points});
}

double PressureProfile::duration() const {
  return parts_.empty() ? 0 : parts_.back().end;
}

double PressureProfile::at(double time) const {
  if (parts_.empty()) return 0;
  if (time >= duration()) return parts_.back().points.back().pressure;
  const auto part =
      std::find_if(parts_.begin(), parts_.end(), [time](const Part& p) { return time < p.end; });
  const double inside = std::max(time - part->start, 0.0);
  return interpolate(part->points, inside - std::floor(inside / part->period) * part->period);
}

}  // namespace fsr::simulation
