#include "discrepancy/prove/next_experiment.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/signatures.h"
#include "discrepancy/fit/static_fit.h"
#include "discrepancy/prove/wording.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/chamber.h"
#include "simulation/effects/effect_library.h"
#include "simulation/pressure_profile.h"
#include "simulation/read_settings.h"
#include "simulation/session.h"

namespace fsr::discrepancy {

namespace {

constexpr double kScanRate = 2;   // scan rate of the simulated experiments [Hz]
constexpr double kWarmer = 10;    // difference between the two room temperatures [K]
constexpr double kBetween = 300;  // pause between two surfaces [s]

struct Protocol {
  const char* name;
  const char* what;
  const char* program;  // YAML, see readChamberProgram()
  bool two_rates;       // ramps of two speeds, or dwells
  bool twice;           // all surfaces are mounted a second time
  bool warmer;          // the room is warmer the second time
  bool hours = false;   // flat surface only, as in kHoursApart
};

// Cycles on the flat surface, so that clock time, path length, mount and temperature are not proportional.
struct Block {
  double pause;  // before the block [s]
  int cycles;
  bool warmer;
};
const Block kHoursApart[] = {
    {600, 6, false}, {7200, 6, true}, {7200, 6, false}, {300, 60, false}, {10800, 6, false}};

// Protocols for a chamber with a regulator. The names are those in docs/discrepancy.md.
const Protocol kProtocols[] = {
    {"two_speeds", "cycles at 8 and at 40 kPa/s with dwells of some ten seconds at half and full pressure",
     "[{cycles: {peak: 620000, rate: 40000, dwell_peak: 10, cycles: 3}},"
     " {hold: {pressure: 310000, rate: 8000, duration: 15}}, {hold: {pressure: 620000, rate: 8000, duration: "
     "15}},"
     " {rest: {rate: 8000, duration: 30}}, {cycles: {peak: 620000, rate: 40000, dwell_peak: 10, cycles: 2}}]",
     true, false, false},
    {"step_hold", "steps to half and to full pressure, each held for 300 s, with rests of 100 s",
     "[{hold: {pressure: 310000, rate: 60000, duration: 300}}, {rest: {rate: 60000, duration: 100}},"
     " {hold: {pressure: 620000, rate: 60000, duration: 300}}, {rest: {rate: 60000, duration: 100}},"
     " {hold: {pressure: 310000, rate: 60000, duration: 300}}, {rest: {rate: 60000, duration: 100}}]",
     true, false, false},
    {"minor_loops", "loops within loops, of several depths",
     "[{loops: {low: 200000, high: 400000, rate: 17000, loops: 2}}, {rest: {rate: 25000, duration: 5}},"
     " {loops: {low: 100000, high: 550000, rate: 17000, loops: 2}}, {rest: {rate: 25000, duration: 5}},"
     " {cycles: {peak: 620000, rate: 25000, cycles: 2}}]",
     false, false, false},
    {"rest", "200 s without load, cycles, and again 200 s without load",
     "[{rest: {rate: 17000, duration: 200}}, {cycles: {peak: 620000, rate: 17000, cycles: 4}},"
     " {rest: {rate: 17000, duration: 200}}]",
     false, false, false},
    {"two_ambients", "cycles on every surface, then all again in a room some 10 K warmer, with a thermometer",
     "[{cycles: {peak: 620000, rate: 17000, cycles: 4}}]", false, true, true},
    {"random_order",
     "two speeds with dwells, surfaces in random order, each mounted once more, the flat last",
     "[{cycles: {peak: 620000, rate: 40000, dwell_peak: 10, cycles: 2}},"
     " {cycles: {peak: 620000, rate: 8000, dwell_peak: 10, cycles: 1}}]",
     true, true, false},
    {"hours_apart",
     "the flat surface, mounted anew each time, under cycles at 40 kPa/s and beside a thermometer: 6 cycles, "
     "after two hours 6 in a room some 10 K warmer, after two more 6 as at first, at once 60 more, after "
     "three hours 6 (8 hours in all)",
     "[{cycles: {peak: 620000, rate: 40000, cycles: 6}}]", false, false, true, true},
};

simulation::ChamberProgram programOf(const Protocol& protocol) {
  const settings::Settings settings =
      settings::Settings::fromText(std::string("program: ") + protocol.program, protocol.name);
  return simulation::readChamberProgram(settings.sections("program"));
}

simulation::SimulationSettings hoursApart(simulation::SimulationSettings plan,
                                          const simulation::Station& flat) {
  double now = 0;
  plan.session.clear();
  plan.climate = simulation::ChamberClimate();
  plan.climate.room = {{0, simulation::kRoomTemperature}};
  for (const Block& block : kHoursApart) {
    simulation::Station station = flat;
    const std::string program =
        "program: [{cycles: {peak: 620000, rate: 40000, cycles: " + std::to_string(block.cycles) + "}}]";
    station.program = simulation::readChamberProgram(
        settings::Settings::fromText(program, "hours_apart").sections("program"));
    station.pause = block.pause;
    station.surface.mount = static_cast<std::uint32_t>(plan.session.size() + 1);
    plan.session.push_back(station);
    const double starts = now + block.pause,
                 room = simulation::kRoomTemperature + (block.warmer ? kWarmer : 0);
    if (block.pause > kBetween) plan.climate.room.push_back({starts - kBetween, room});
    now = starts + simulation::pressureProfile(station.program).duration();
    plan.climate.room.push_back({now, room});
  }
  return plan;
}

// The simulation of a protocol, with the first and the last surface of the given simulation. The protocol
// hours_apart uses the first surface only.
simulation::SimulationSettings planOf(const Protocol& protocol, const simulation::SimulationSettings& base) {
  simulation::SimulationSettings plan = representative(base);
  plan.board.scan_rate = plan.board.transducer_rate = kScanRate;
  if (protocol.hours) return hoursApart(plan, base.session.front());
  std::vector<simulation::Station> surfaces = {base.session.front()};
  if (base.session.size() > 1) surfaces.push_back(base.session.back());
  plan.session.clear();
  for (int round = 0; round < (protocol.twice ? 2 : 1); ++round) {
    for (simulation::Station station : surfaces) {
      station.program = programOf(protocol);
      station.pause = kBetween;
      station.surface.mount = static_cast<std::uint32_t>(plan.session.size() + 1);
      plan.session.push_back(station);
    }
  }
  plan.climate = simulation::ChamberClimate();
  if (protocol.warmer) {
    double half = 0;
    for (std::size_t i = 0; i < plan.session.size() / 2; ++i) {
      half += kBetween + simulation::pressureProfile(plan.session[i].program).duration();
    }
    plan.climate.room = {{0, simulation::kRoomTemperature},
                         {half, simulation::kRoomTemperature},
                         {half + kBetween, simulation::kRoomTemperature + kWarmer}};
  }
  return plan;
}

// Residual of each explanation after the static curves are fitted, under one protocol.
std::vector<Trace> residualsUnder(const Protocol& protocol, const simulation::SimulationSettings& base,
                                  const std::vector<std::vector<simulation::EnabledEffect>>& explanations) {
  DiscrepancyProblem problem;
  problem.simulation = planOf(protocol, base);
  problem.recordings = simulation::simulateSession(problem.simulation);
  const Measured measured = admit(problem);
  std::vector<Trace> residuals;
  for (const auto& effects : explanations) {
    simulation::SimulationSettings with = base;
    for (const simulation::EnabledEffect& effect : effects) with = withEffect(with, effect);
    const Trace reading = driven(measured, with, true).reading;
    residuals.push_back(StaticFit(measured, CurvePer::kClass, reading).residual(reading));
  }
  return residuals;
}

// Smallest rms difference between `a` and `b` times any factor that is not negative.
double apart(const Trace& a, const Trace& b) {
  const double square = b.squaredNorm();
  const double size = square > 0 ? std::max(0.0, a.dot(b) / square) : 0;
  return std::sqrt((a - size * b).squaredNorm() / static_cast<double>(a.size()));
}

double smallestApart(const std::vector<Trace>& residuals) {
  double smallest = INFINITY;
  for (std::size_t a = 0; a < residuals.size(); ++a) {
    for (std::size_t b = a + 1; b < residuals.size(); ++b) {
      smallest = std::min({smallest, apart(residuals[a], residuals[b]), apart(residuals[b], residuals[a])});
    }
  }
  return smallest;
}

// Whether the recordings and the protocol together contain the evidence that the effects of all explanations
// need to be named alone. Evidence that no protocol provides is not considered.
bool bringsEvidence(const simulation::EffectLibrary& library, const Protocol& protocol,
                    const AvailableEvidence& at_hand,
                    const std::vector<std::vector<simulation::EnabledEffect>>& explanations) {
  AvailableEvidence then = at_hand;
  then.two_rates = then.two_rates || protocol.two_rates;
  then.thermometer = then.thermometer || protocol.warmer;
  then.uneven_pace = then.uneven_pace || protocol.hours;
  for (const auto& effects : explanations) {
    for (const simulation::EnabledEffect& effect : effects) {
      for (const simulation::Evidence need : library.info(effect.id).needs) {
        const bool can = need == simulation::Evidence::kTwoRampRates ||
                         need == simulation::Evidence::kThermometer ||
                         need == simulation::Evidence::kManyCycles;
        if (can && !then.has(need)) return false;
      }
    }
  }
  return true;
}

std::string nameOf(const std::vector<simulation::EnabledEffect>& effects) {
  std::vector<std::string> ids;
  for (const simulation::EnabledEffect& effect : effects) ids.push_back(effect.id);
  return listText(ids, " with ");
}

}  // namespace

std::vector<NextExperiment> nextExperiment(
    const simulation::SimulationSettings& base,
    const std::vector<std::vector<simulation::EnabledEffect>>& explanations, const AvailableEvidence& at_hand,
    double floor) {
  if (explanations.size() < 2) return {};
  const Protocol* best = nullptr;
  double most = -1;
  const auto brings = [&](const Protocol& p) {
    return bringsEvidence(simulation::libraryOf(base), p, at_hand, explanations);
  };
  const bool any_brings = std::any_of(std::begin(kProtocols), std::end(kProtocols), brings);
  for (const Protocol& protocol : kProtocols) {
    if (any_brings && !brings(protocol)) continue;
    double separation = 0;
    try {
      separation = smallestApart(residualsUnder(protocol, base, explanations));
    } catch (const settings::InputError&) {
      continue;  // this rig cannot run the protocol
    }
    if (separation <= most) continue;
    most = separation;
    best = &protocol;
  }
  if (!best) return {};
  NextExperiment next;
  next.protocol = best->name;
  next.separation = floor > 0 ? most / floor : 0;
  std::vector<std::string> names;
  for (const auto& effects : explanations) names.push_back(nameOf(effects));
  for (std::size_t a = 0; a < names.size(); ++a) {
    for (std::size_t b = a + 1; b < names.size(); ++b) next.separates.emplace_back(names[a], names[b]);
  }
  std::ostringstream text;
  text.precision(2);
  text << "Record " << best->what << ": it distinguishes " << listText(names) << " by " << next.separation
       << " times the noise of one reading.";
  next.sentence = text.str();
  return {next};
}

}  // namespace fsr::discrepancy
