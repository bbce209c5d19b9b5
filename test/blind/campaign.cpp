#include "blind/campaign.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace blind {

namespace {

// Time constant with which valve and hoses smooth the set pressure [s].
constexpr double kValveLag = 0.3;

double along(const ChamberPath& path, std::size_t& piece, double time) {
  if (time <= 0) return path.pressure.front();
  while (piece + 2 < path.time.size() && path.time[piece + 1] <= time) ++piece;
  const double span = path.time[piece + 1] - path.time[piece];
  const double share = span > 0 ? std::min(1.0, (time - path.time[piece]) / span) : 1.0;
  return path.pressure[piece] + share * (path.pressure[piece + 1] - path.pressure[piece]);
}

std::vector<double> finePressure(const ChamberPath& path, double fine_step, double valve_lag) {
  const auto steps = static_cast<std::size_t>((kLead + path.duration() + kLead) / fine_step);
  std::vector<double> fine(steps);
  double pressure = path.pressure.front();
  std::size_t piece = 0;
  for (std::size_t i = 0; i < steps; ++i) {
    const double target = along(path, piece, static_cast<double>(i) * fine_step - kLead);
    pressure += (target - pressure) * fine_step / valve_lag;
    fine[i] = pressure;
  }
  return fine;
}

// First-order lag of its input.
struct Lag {
  double time_constant;  // [s]
  double value;
  double step(double input, double seconds) {
    value += (input - value) * (1 - std::exp(-seconds / time_constant));
    return value;
  }
};

// Temperatures of room, gas, sheet and thermometer. The gas heats when it is compressed and cools at the
// wall. Sheet and thermometer follow a part of that, each with its own lag.
class Climate {
 public:
  using Room = std::function<double(double time)>;  // temperature [degree Celsius] at a time [s]

  // The usual room; it warms up and swings.
  explicit Climate(Random random)
      : base_(random.uniform(20, 25)),
        warm_up_(random.uniform(1.5, 3)),
        swing_(random.uniform(0.4, 1)),
        period_(random.uniform(900, 2400)),
        phase_(random.uniform(0, 2 * M_PI)),
        sheet_lag_(random.uniform(60, 150)),
        thermometer_lag_(random.uniform(15, 40)) {}

  Climate(Random random, Room room) : Climate(random) { room_ = std::move(room); }

  double room(double time) const {
    if (room_) return room_(time);
    return base_ + warm_up_ * (1 - std::exp(-time / 3000)) +
           swing_ * std::sin(2 * M_PI * time / period_ + phase_);
  }

  void run(const Visit& visit, double ambient_step, Campaign& campaign, Random& random) const {
    const double seconds = campaign.scan_period;
    double gas = 0;  // temperature above the room's [K]
    Lag sheet{sheet_lag_, room(visit.start) + ambient_step};
    Lag thermometer{thermometer_lag_, sheet.value};
    for (std::size_t i = visit.first; i < visit.last; ++i) {
      const double heating =
          0.286 * 295 * campaign.rate[i] / (campaign.ambient() + campaign.pressure[i]);  // [K/s]
      gas += seconds * (heating - gas / 4);
      const double air = room(campaign.time[i]) + ambient_step;
      campaign.temperature.push_back(sheet.step(air + 0.05 * gas, seconds));
      const double reading = thermometer.step(air + 0.08 * gas, seconds) + 0.03 * random.normal();
      campaign.thermometer.push_back(std::round(reading * 16) / 16);  // resolution of 1/16 K
    }
  }

 private:
  double base_, warm_up_, swing_, period_, phase_, sheet_lag_, thermometer_lag_;
  Room room_;
};

void appendScans(const PlannedVisit& plan, Visit& visit, Campaign& campaign) {
  visit.first = campaign.scans();
  const auto number = static_cast<std::size_t>(plan.path.duration() / campaign.scan_period);
  const std::uint32_t cycles_before = campaign.cycle.empty() ? 0 : campaign.cycle.back() + 1;
  for (std::size_t i = 0; i < number; ++i) {
    const double elapsed = static_cast<double>(i) * campaign.scan_period;
    const double time = visit.start + elapsed;
    campaign.time.push_back(time);
    campaign.pressure.push_back(campaign.pressureAt(visit, time));
    const double around = campaign.pressureAt(visit, time + 0.05) - campaign.pressureAt(visit, time - 0.05);
    campaign.rate.push_back(around / 0.1);
    const auto& starts = plan.path.cycle_start;
    const auto after = std::upper_bound(starts.begin(), starts.end(), elapsed) - starts.begin();
    const auto cycle = static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(after - 1, 0));
    campaign.cycle_of_visit.push_back(cycle);
    campaign.cycle.push_back(cycles_before + cycle);
    campaign.visit.push_back(static_cast<std::uint32_t>(campaign.visits.size()));
  }
  visit.last = campaign.scans();
}

// Appends one stay on a surface that begins `plan.pause` after `clock`; returns the clock at its end [s].
double stay(const PlannedVisit& plan, double valve_lag, double clock, const Climate& climate,
            Campaign& campaign, Random& random) {
  Visit visit;
  visit.surface = plan.surface;
  visit.pause = plan.pause;
  visit.start = clock + plan.pause;
  visit.fine_pressure = finePressure(plan.path, campaign.fine_step, valve_lag);
  appendScans(plan, visit, campaign);
  clock = campaign.time.back() + campaign.scan_period;
  climate.run(visit, plan.ambient_step, campaign, random);
  campaign.visits.push_back(std::move(visit));
  return clock;
}

std::vector<fsr::matrix::Surface> surfacesOfRadii(const std::vector<int>& radii_mm) {
  std::vector<fsr::matrix::Surface> surfaces;
  for (const int radius : radii_mm) {
    if (radius == 0) {
      surfaces.push_back({"flat", 0, {fsr::matrix::Curvature{}}, {}});
    } else {
      const fsr::matrix::Curvature curvature{1000.0 / radius, 0, 0};
      surfaces.push_back({"cylinder_" + std::to_string(radius / 10) + "cm", 0, {curvature}, {}});
    }
  }
  return surfaces;
}

}  // namespace

double Campaign::pressureAt(const Visit& at, double time_s) const {
  const double place = (time_s - at.start + kLead) / fine_step;
  const double last = static_cast<double>(at.fine_pressure.size() - 2);
  const auto below = static_cast<std::size_t>(std::clamp(place, 0.0, last));
  const double share = std::clamp(place - static_cast<double>(below), 0.0, 1.0);
  return at.fine_pressure[below] + share * (at.fine_pressure[below + 1] - at.fine_pressure[below]);
}

std::vector<fsr::matrix::Surface> surfacesOf(std::size_t number) {
  const std::vector<int> radii_cm = {13, 11, 9, 7, 5};
  std::vector<fsr::matrix::Surface> surfaces = {{"flat", 0, {fsr::matrix::Curvature{}}, {}}};
  for (std::size_t i = 1; i < number; ++i) {
    // Evenly spaced, always including the smallest radius.
    const std::size_t from_end =
        (number - 1 - i) * (radii_cm.size() - 1) / std::max<std::size_t>(1, number - 2);
    const std::size_t place = radii_cm.size() - 1 - from_end;
    const int radius = radii_cm[place];
    surfaces.push_back(
        {"cylinder_" + std::to_string(radius) + "cm", 0, {fsr::matrix::Curvature{100.0 / radius, 0, 0}}, {}});
  }
  return surfaces;
}

Campaign runCampaign(const fsr::matrix::Layout& layout, const std::vector<std::string>& protocols,
                     const ProtocolSize& size, std::uint64_t seed) {
  Campaign campaign;
  campaign.layout = layout;
  campaign.surfaces = surfacesOf(size.surfaces);
  Random random(seed, "campaign " + protocols.front());
  // The scan rate of a board is accurate to some hundred parts in a million.
  campaign.scan_period = 0.1 * (1 + 2e-4 * random.normal());
  const Climate climate{Random(seed, "climate " + protocols.front())};
  double clock = 0;
  for (const std::string& protocol : protocols) {
    for (const PlannedVisit& plan : planVisits(protocol, size, Random(seed, "order " + protocol))) {
      clock = stay(plan, kValveLag, clock, climate, campaign, random);
    }
    if (campaign.first_visits > 0) continue;
    campaign.first_visits = campaign.visits.size();
    campaign.first_scans = campaign.scans();
  }
  return campaign;
}

Campaign runCampaign(const RigPlan& plan, std::uint64_t seed) {
  Campaign campaign;
  campaign.layout = {plan.matrix, plan.pitch, plan.pitch};
  campaign.surfaces = surfacesOfRadii(plan.radii);
  campaign.pascal = plan.peak / kPeak;
  Random random(seed, "campaign of a plan");
  campaign.scan_period = (1 + 2e-4 * random.normal()) / plan.scan_rate;
  campaign.fine_step = std::min({0.02, campaign.scan_period / 2, plan.valve_lag / 4});
  double length = 0;
  for (const PlannedVisit& visit : plan.visits) length += visit.pause + visit.path.duration();
  const auto room = [&](double time) { return plan.room.at(std::min(1.0, time / length), time); };
  const Climate climate(Random(seed, "climate of a plan"), room);
  double clock = 0;
  for (const PlannedVisit& visit : plan.visits) {
    clock = stay(visit, plan.valve_lag, clock, climate, campaign, random);
  }
  campaign.first_visits = campaign.visits.size();
  campaign.first_scans = campaign.scans();
  return campaign;
}

}  // namespace blind
