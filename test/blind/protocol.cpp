#include "blind/protocol.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "blind/path_builder.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace blind {

namespace {

constexpr double kPaperRate = 17e3;  // [Pa/s]
constexpr double kSlow = 8e3;        // [Pa/s]
constexpr double kFast = 40e3;       // [Pa/s]

int scaled(int cycles, double share) {
  return std::max(2, static_cast<int>(std::lround(cycles * share)));
}

void paperCycles(PathBuilder& path, int cycles) {
  for (int i = 0; i < cycles; ++i) {
    path.cycle().hold(1).ramp(kPeak, kPaperRate).hold(1).ramp(0, kPaperRate);
  }
}

ChamberPath paperPath(double share) {
  PathBuilder path;
  paperCycles(path, scaled(10, share));
  return path.take();
}

// Up and down at one speed with dwells: creep continues during a dwell, a loop does not.
void dwellCycle(PathBuilder& path, double rate, double dwell) {
  path.cycle().hold(2).ramp(0.5 * kPeak, rate).hold(dwell).ramp(kPeak, rate).hold(dwell);
  path.ramp(0.5 * kPeak, rate).hold(dwell).ramp(0, rate);
}

ChamberPath twoSpeedsPath(double share) {
  PathBuilder path;
  for (int i = 0; i < scaled(8, share); ++i)
    dwellCycle(path, i % 4 == 1 ? kSlow : kFast, i % 4 == 1 ? 15 : 8);
  return path.hold(30).take();
}

ChamberPath minorLoopsPath(double share) {
  PathBuilder path;
  const double depths[] = {0.15, 0.3, 0.5, 0.75};  // share of the peak
  for (int i = 0; i < scaled(8, share); ++i) {
    const double depth = depths[i % 4] * kPeak;
    const double middle = (i / 4 % 2 == 0 ? 0.55 : 0.4) * kPeak;
    path.cycle().hold(1).ramp(middle + depth / 2, 1.5 * kPaperRate);
    for (int k = 0; k < 2; ++k)
      path.ramp(middle - depth / 2, kPaperRate).ramp(middle + depth / 2, kPaperRate);
    path.ramp(kPeak, 1.5 * kPaperRate).hold(1).ramp(0, 1.5 * kPaperRate);
  }
  return path.take();
}

ChamberPath stepHoldPath(double share) {
  PathBuilder path;
  const int steps = scaled(3, share);
  for (int i = 0; i < steps; ++i) {
    path.cycle().hold(10).ramp((i % 2 == 0 ? 0.5 : 1.0) * kPeak, 60e3).hold(300).ramp(0, 60e3).hold(100);
  }
  return path.take();
}

ChamberPath restPath(double share) {
  PathBuilder path;
  path.hold(200);
  paperCycles(path, scaled(5, share));
  return path.hold(200).take();
}

ChamberPath fastPath(double share) {
  PathBuilder path;
  for (int i = 0; i < scaled(6, share); ++i) path.cycle().hold(1).ramp(kPeak, kFast).hold(1).ramp(0, kFast);
  return path.take();
}

using MakePath = ChamberPath (*)(double share);

struct Protocol {
  MakePath path;
  bool twice;           // every surface is mounted a second time
  bool shuffled_first;  // random order in the first round, too
  bool warmer_second;   // the second round is in a warmer room
};

const std::map<std::string, Protocol>& protocols() {
  static const std::map<std::string, Protocol> table = {
      {"paper", {paperPath, false, false, false}},
      {"paper_remounted", {paperPath, true, false, false}},
      {"two_speeds", {twoSpeedsPath, false, false, false}},
      {"minor_loops", {minorLoopsPath, false, false, false}},
      {"step_hold", {stepHoldPath, false, false, false}},
      {"rest", {restPath, false, false, false}},
      {"two_ambients", {paperPath, true, false, true}},
      {"hours_apart", {fastPath, false, false, false}},
      {"random_order", {twoSpeedsPath, true, true, false}},
  };
  return table;
}

const Protocol& find(const std::string& name) {
  const auto found = protocols().find(name);
  if (found != protocols().end()) return found->second;
  std::string known;
  for (const std::string& other : protocolNames()) known += (known.empty() ? "" : ", ") + other;
  throw fsr::settings::InputError("protocol is '" + name + "', but must be one of " + known);
}

std::vector<std::size_t> surfaceOrder(const Protocol& protocol, const std::string& name, std::size_t surfaces,
                                      Random& random) {
  std::vector<std::size_t> order(surfaces);
  for (std::size_t i = 0; i < surfaces; ++i) order[i] = i;
  if (protocol.shuffled_first) order = random.order(surfaces);
  if (protocol.twice) {
    const std::vector<std::size_t> again = random.order(surfaces);
    order.insert(order.end(), again.begin(), again.end());
  }
  if (name == "random_order") order.push_back(0);
  return order;
}

// Clock time, cycles, mounts and temperature vary independently.
std::vector<PlannedVisit> hoursApart(const ProtocolSize& size, Random& random) {
  const double warmer = random.uniform(8, 12);
  std::vector<PlannedVisit> visits;
  for (const double hours : {0.2, 2.0, 2.0, 0.1, 3.0}) {
    PlannedVisit visit{0, fastPath(hours < 0.15 ? 10 * size.cycles : size.cycles), 0, 3600 * hours};
    if (visits.size() == 1) visit.ambient_step = warmer;
    visits.push_back(visit);
  }
  return visits;
}

}  // namespace

const std::vector<std::string>& protocolNames() {
  static const std::vector<std::string> names = {"paper",        "paper_remounted", "two_speeds",
                                                 "minor_loops",  "step_hold",       "rest",
                                                 "two_ambients", "random_order",    "hours_apart"};
  return names;
}

bool remounts(const std::string& protocol) {
  return find(protocol).twice || protocol == "hours_apart";
}

std::vector<PlannedVisit> planVisits(const std::string& name, const ProtocolSize& size, Random random) {
  const Protocol& protocol = find(name);
  if (name == "hours_apart") return hoursApart(size, random);
  const std::vector<std::size_t> order = surfaceOrder(protocol, name, size.surfaces, random);
  const ChamberPath path = protocol.path(protocol.twice ? size.cycles / 2 : size.cycles);
  const double warmer = random.uniform(8, 12);
  std::vector<PlannedVisit> visits;
  for (const std::size_t surface : order) {
    PlannedVisit visit{surface, path, 0, random.uniform(240, 600)};
    const bool second = visits.size() >= size.surfaces;
    if (second && protocol.warmer_second) visit.ambient_step = warmer;
    visits.push_back(visit);
  }
  if (protocol.warmer_second) visits[size.surfaces].pause = 3600;  // time for the room to warm up
  return visits;
}

}  // namespace blind
