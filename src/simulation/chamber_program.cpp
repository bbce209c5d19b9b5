#include "fsr_pressure_map/simulation/chamber.h"

#include <cmath>

#include "settings/yaml_text.h"
#include "simulation/pressure_profile.h"
#include "simulation/read_settings.h"

namespace fsr::simulation {

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

}  // namespace fsr::simulation
