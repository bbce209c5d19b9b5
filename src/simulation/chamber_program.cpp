#include "fsr_pressure_map/simulation/chamber_program.h"

#include <cmath>

#include "fsr_pressure_map/simulation/chamber_protocol.h"

namespace fsr {

namespace {

const Range kPressure{0, kChamberRating, "Pa gauge (the chamber is rated at 793 kPa)"};
const Range kRate{1, 1e7, "Pa/s"};
const Range kDuration{0, 1e7, "s"};
const Range kLoops{1, 1e6, "loops"};
constexpr double kUsualRate = 17e3;  // the paper's [Pa/s]

class Program {
 public:
  void append(const Settings& part) {
    const std::vector<std::string> keys = part.keys();
    if (keys.size() != 1) throw part.error(keys.empty() ? "cycles" : keys[1], kOneKey);
    if (std::isinf(profile_.duration())) throw part.error(keys[0], "the part before it never ends");
    if (part.has("cycles")) return cycles(part.section("cycles"));
    if (part.has("hold")) return hold(part.section("hold"));
    if (part.has("loops")) return loops(part.section("loops"));
    if (part.has("rest")) return rest(part.section("rest"));
    throw part.error(keys[0], kOneKey);
  }
  const PressureProfile& profile() const { return profile_; }

 private:
  static constexpr const char* kOneKey = "give exactly one of cycles, hold, loops, rest";

  void stay(double duration) {
    if (duration > 0) profile_.append({{0, pressure_}, {duration, pressure_}});
  }
  void rampTo(double pressure, double rate) {
    if (pressure != pressure_) {
      profile_.append({{0, pressure_}, {std::abs(pressure - pressure_) / rate, pressure}});
    }
    pressure_ = pressure;
  }

  void cycles(const Settings& settings) {
    const ChamberProtocol protocol = readChamberProtocol(settings);
    rampTo(0, protocol.vent_rate);
    profile_.append(cyclePoints(protocol), protocol.cycles);
  }
  void hold(const Settings& settings) {
    const double rate = settings.number("rate", kRate, kUsualRate);
    rampTo(settings.number("pressure", kPressure), rate);
    stay(settings.number("duration", kDuration));
  }
  void loops(const Settings& settings) {
    const double low = settings.number("low", kPressure), high = settings.number("high", kPressure);
    if (high <= low) throw settings.error("high", "must be above low");
    const double rate = settings.number("rate", kRate, kUsualRate);
    const double way = (high - low) / rate;  // [s]
    rampTo(low, rate);
    profile_.append({{0, low}, {way, high}, {2 * way, low}},
                    static_cast<unsigned>(settings.integer("loops", kLoops)));
  }
  void rest(const Settings& settings) {
    rampTo(0, settings.number("rate", kRate, kUsualRate));
    stay(settings.number("duration", kDuration));
  }

  PressureProfile profile_;
  double pressure_ = 0;  // where the chamber stands now [Pa]
};

}  // namespace

PressureProfile readChamberProgram(const std::vector<Settings>& parts) {
  Program program;
  for (const Settings& part : parts) program.append(part);
  return program.profile();
}

}  // namespace fsr
