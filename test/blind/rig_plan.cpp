#include "blind/rig_plan.h"

#include <algorithm>
#include <cmath>

#include "blind/path_builder.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace blind {

namespace {

// What a class of protocols permits. Ranges are uniform, or log-uniform where times are concerned.
struct Class {
  const char* name;
  std::size_t surfaces_low, surfaces_high;
  std::size_t mounts_low, mounts_high;
  std::size_t cycles_low, cycles_high;  // of one visit
  double lowest_peak;                   // of a cycle, share of the surface's highest pressure
  double most_paces;                    // slowest ramp by fastest ramp; 1 = one pace
  double most_dwell;                    // at the top [shortest ramp]
  double most_left;                     // pressure from which a cycle may start again, share of the peak
  int inner_loops;                      // at most, in a cycle
  double uneven_surfaces;               // probability that surfaces reach different pressures
  bool may_be_exponential;
};

constexpr Class kClasses[] = {
    {"regular", 1, 8, 1, 1, 6, 30, 1.0, 1, 0.1, 0, 0, 0.2, true},
    {"hand_run", 1, 8, 1, 2, 5, 20, 0.4, 10, 3, 0.15, 0, 0.5, true},
    {"partial_loops", 1, 6, 1, 2, 4, 12, 0.6, 4, 0.5, 0, 3, 0.5, true},
    {"dwells", 1, 6, 1, 2, 4, 12, 0.4, 10, 8, 0, 0, 0.5, true},
    {"one_pace", 1, 8, 1, 2, 5, 20, 0.4, 1, 0.1, 0, 0, 0.5, false},
    {"uneven_surfaces", 3, 8, 1, 1, 4, 15, 0.5, 5, 1, 0.05, 0, 1.0, true},
    {"many_mounts", 1, 5, 2, 3, 4, 8, 0.5, 6, 1, 0, 0, 0.4, true},
    {"short", 1, 2, 1, 1, 4, 6, 0.4, 10, 2, 0.1, 1, 0.5, true},
};

const Class& find(const std::string& name) {
  std::string known;
  for (const Class& candidate : kClasses) {
    if (candidate.name == name) return candidate;
    known += (known.empty() ? "" : ", ") + std::string(candidate.name);
  }
  throw fsr::settings::InputError("class is '" + name + "', but must be one of " + known);
}

std::size_t between(Random& random, std::size_t low, std::size_t high) {
  return low + random.below(high - low + 1);
}

// The rig: matrix, converter, chamber, reference.
void drawRig(Random& random, double most_readings, RigPlan& plan) {
  constexpr double kLeastSeconds = 60;
  do {
    plan.matrix.rows = static_cast<std::uint16_t>(between(random, 4, 16));
    plan.matrix.columns = static_cast<std::uint16_t>(between(random, 4, 10));
    plan.scan_rate = random.logUniform(5, 200);
  } while (plan.scan_rate * static_cast<double>(plan.matrix.taxels()) * kLeastSeconds > most_readings);
  plan.pitch = random.uniform(4e-3, 14e-3);
  plan.bits = static_cast<int>(8 + 2 * random.below(5));
  plan.peak = random.logUniform(40e3, 700e3);
}

void drawReference(Random& random, RigPlan& plan) {
  ReferencePlan& reference = plan.reference;
  reference.rate = random.logUniform(std::max(5.0, 8 / plan.fastest), 100);
  reference.averaged = random.chance(0.5) ? 0 : random.uniform(1, 5) / reference.rate;
  reference.averaged = std::min(reference.averaged, 0.1 * plan.fastest);
  reference.noise = random.logUniform(3e-5, 6e-4);
  reference.offset = 1e-3 * random.normal();
  reference.slope = 2e-3 * random.normal();
  reference.bend = 1e-3 * random.normal();
  reference.bits = static_cast<int>(12 + 2 * random.below(3));
}

void drawRoom(Random& random, RigPlan& plan) {
  const char* const shapes[] = {"ramp", "warm_up", "swing", "step"};
  plan.room.base = random.uniform(18, 26);
  plan.room.drift = random.chance(0.25) ? random.uniform(0, 0.5) : random.sign() * random.uniform(0.5, 12);
  plan.room.shape = shapes[random.below(4)];
  plan.room.ripple = random.uniform(0.02, 0.3);
  plan.room.ripple_period = random.logUniform(120, 2400);
  plan.thermometer = random.chance(0.6);
}

void drawCut(Random& random, RigPlan& plan) {
  const double kind = random.uniform();
  plan.cut.kind = kind < 0.5 ? "by_surface" : kind < 0.7 ? "joined" : "odd_places";
  plan.cut.lost = random.chance(0.5) ? 0 : random.logUniform(1e-4, 2e-2);
  plan.cut.longest = random.chance(0.5) ? 1 : between(random, 2, 20);
}

// The cycles of a campaign: what may change from one to the next.
class Cycles {
 public:
  Cycles(const Class& rules, double ramp, Random& random)
      : rules_(rules), random_(random), fastest_(ramp), paces_(rules.most_paces) {
    if (paces_ > 1) paces_ = random.logUniform(2, paces_);
    exponential_ = rules.may_be_exponential && random.chance(0.4);
    two_paces_ = random.chance(0.4);
    dwell_ = rules.most_dwell * random.uniform(0.3, 1);
    inner_ = static_cast<std::size_t>(rules.inner_loops);
  }

  bool exponential() const { return exponential_; }

  ChamberPath visit(std::size_t cycles, double reach, RigPlan& plan) {
    PathBuilder path;
    path.hold(0.3 * fastest_ + 1);
    const std::size_t highest = random_.below(cycles);
    for (std::size_t i = 0; i < cycles; ++i) {
      const double share = i == highest ? 1.0 : random_.uniform(rules_.lowest_peak, 1);
      cycle(path, (rules_.lowest_peak < 1 ? share : 1.0) * reach, i + 1 == cycles, plan);
    }
    path.hold(0.2 * fastest_ + 1);
    return path.take();
  }

 private:
  // Time of a ramp over the whole range [s].
  double pace(RigPlan& plan) {
    double seconds = fastest_;
    if (paces_ > 1)
      seconds *= two_paces_ ? (random_.chance(0.4) ? paces_ : 1.0) : random_.logUniform(1, paces_);
    plan.fastest = plan.fastest > 0 ? std::min(plan.fastest, seconds) : seconds;
    plan.slowest = std::max(plan.slowest, seconds);
    return seconds;
  }
  void move(PathBuilder& path, double share, double seconds) {
    if (exponential_) {
      path.approach(share * kPeak, seconds);
    } else {
      path.ramp(share * kPeak, kPeak / seconds);
    }
  }
  void dwell(PathBuilder& path) {
    const double factor = rules_.most_dwell > 0.2 ? random_.uniform(0.2, 1) : 1.0;
    path.hold(dwell_ * factor * fastest_);
  }
  void cycle(PathBuilder& path, double peak, bool last, RigPlan& plan) {
    path.cycle();
    const double up = pace(plan), down = pace(plan);
    const std::size_t loops = inner_ > 0 ? random_.below(inner_ + 1) : 0;
    for (std::size_t k = 0; k < loops; ++k) {
      const double high = peak * random_.uniform(0.45, 0.95), depth = random_.uniform(0.15, 0.8);
      move(path, high, up);
      move(path, high * (1 - depth), down);
    }
    if (rules_.most_dwell > 4 && random_.chance(0.6)) {  // on the way up
      move(path, peak * random_.uniform(0.3, 0.7), up);
      dwell(path);
    }
    move(path, peak, up);
    dwell(path);
    if (rules_.most_dwell > 4 && random_.chance(0.6)) {  // and down
      move(path, peak * random_.uniform(0.3, 0.7), down);
      dwell(path);
    }
    const bool incomplete = rules_.most_left > 0 && !last && random_.chance(0.5);
    move(path, incomplete ? peak * random_.uniform(0, rules_.most_left) : 0.0, down);
    path.hold(rules_.lowest_peak < 1 && paces_ > 1 ? fastest_ * random_.logUniform(0.05, 2) : 0.1 * fastest_);
  }

  const Class& rules_;
  Random& random_;
  double fastest_, paces_;
  double dwell_;  // [shortest ramp]
  bool exponential_, two_paces_;
  std::size_t inner_;
};

void drawSurfaces(const Class& rules, double ease, Random& random, RigPlan& plan) {
  const std::vector<int> radii_mm = {200, 170, 150, 130, 110, 90, 70, 60, 50};
  const auto most =
      std::max(rules.surfaces_low,
               static_cast<std::size_t>(std::lround(ease * static_cast<double>(rules.surfaces_high))));
  const std::size_t number = between(random, rules.surfaces_low, most);
  plan.radii = {0};
  for (const std::size_t member : random.choose(number - 1, radii_mm.size())) {
    plan.radii.push_back(radii_mm[member]);
  }
  plan.reach.assign(number, 1.0);
  if (!random.chance(rules.uneven_surfaces)) return;
  const std::size_t highest = random.below(number);
  for (std::size_t i = 0; i < number; ++i) {
    if (i != highest) plan.reach[i] = random.uniform(0.4, 1);
  }
}

// Surfaces in random order; those that are mounted again come again in another order.
std::vector<std::size_t> drawOrder(const Class& rules, Random& random, const RigPlan& plan) {
  std::vector<std::size_t> order;
  for (std::size_t round = 0; round < plan.mounts; ++round) {
    for (const std::size_t surface : random.order(plan.radii.size())) {
      const bool again = round == 0 || rules.mounts_low > 1 || random.chance(0.7);
      if (again) order.push_back(surface);
    }
  }
  return order;
}

// One attempt; `ease` < 1 asks for a shorter campaign.
void drawCycles(const Class& rules, double ease, Random& random, RigPlan& plan) {
  drawSurfaces(rules, ease, random, plan);
  plan.mounts = between(random, rules.mounts_low, rules.mounts_high);
  const auto most = std::max<std::size_t>(
      rules.cycles_low, static_cast<std::size_t>(std::lround(ease * static_cast<double>(rules.cycles_high))));
  const std::size_t cycles = between(random, rules.cycles_low, most);
  const double shortest = std::max(1.2, 10 / plan.scan_rate);
  const double ramp = random.logUniform(shortest, std::max(1.01 * shortest, 20 * ease));
  plan.fastest = plan.slowest = 0;
  plan.cycles = 0;
  Cycles path(rules, ramp, random);
  plan.exponential = path.exponential();
  plan.valve_lag = random.uniform(0.03, 0.1) * ramp;
  plan.visits.clear();
  for (const std::size_t surface : drawOrder(rules, random, plan)) {
    PlannedVisit visit{surface, path.visit(cycles, plan.reach[surface], plan), 0, random.logUniform(30, 400)};
    plan.cycles += visit.path.cycle_start.size();
    plan.visits.push_back(std::move(visit));
  }
}

}  // namespace

double RoomPlan::at(double share, double time) const {
  const double fast = ripple * std::sin(2 * M_PI * time / ripple_period);
  if (shape == "ramp") return base + drift * share + fast;
  if (shape == "warm_up") return base + drift * (1 - std::exp(-3 * share)) + fast;
  if (shape == "swing") return base + drift * 0.5 * (1 - std::cos(2 * M_PI * share)) + fast;
  return base + drift / (1 + std::exp(-(share - 0.5) / 0.03)) + fast;
}

double RigPlan::duration() const {
  double seconds = 0;
  for (const PlannedVisit& visit : visits) seconds += visit.path.duration();
  return seconds;
}

double RigPlan::readings() const {
  return duration() * scan_rate * static_cast<double>(matrix.taxels());
}

const std::vector<std::string>& protocolClasses() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Class& rules : kClasses) all.emplace_back(rules.name);
    return all;
  }();
  return names;
}

RigPlan drawPlan(std::uint64_t name_hash, const std::string& protocol_class, double most_readings) {
  RigPlan plan;
  Random class_draw(name_hash, "protocol class");
  const std::size_t drawn = class_draw.below(protocolClasses().size());
  plan.protocol_class = protocol_class.empty() ? protocolClasses()[drawn] : protocol_class;
  const Class& rules = find(plan.protocol_class);
  Random rig(name_hash, "rig"), cycles(name_hash, "cycles of " + plan.protocol_class);
  Random room(name_hash, "room"), reference(name_hash, "reference of the plan"), cut(name_hash, "cut");
  // A rig that is too fast and large for the shortest campaign of its class is drawn again, in the end.
  for (int attempt = 0;; ++attempt) {
    if (attempt % 300 == 0) drawRig(rig, most_readings, plan);
    drawCycles(rules, 1 / (1 + attempt % 300 / 40.0), cycles, plan);
    if (plan.readings() <= most_readings) break;
  }
  drawReference(reference, plan);
  drawRoom(room, plan);
  drawCut(cut, plan);
  return plan;
}

}  // namespace blind
