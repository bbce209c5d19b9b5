#include "discrepancy/prove/next_experiment.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <variant>

#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/cycle_design.h"
#include "discrepancy/fit/signatures.h"
#include "discrepancy/fit/static_fit.h"
#include "discrepancy/prove/wording.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/chamber.h"
#include "settings/number_text.h"
#include "simulation/effects/effect_library.h"
#include "simulation/pressure_profile.h"
#include "simulation/session.h"
#include "simulation/settings_text.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy {

namespace {

constexpr double kScanRate = 2;       // scan rate of the simulated experiments [Hz]
constexpr double kWarmer = 10;        // difference between the two room temperatures [K]
constexpr double kBetween = 300;      // pause between two surfaces [s]
constexpr double kFullPeak = 620e3;   // of the programs below; they are scaled to the user's chamber [Pa]
constexpr double kFewestCycles = 10;  // on each surface: two in each fold of the comparison
constexpr double kMostCycles = 100;   // on each surface: more is not recommended
constexpr double kDrawsApart = 0.01;  // falls of entropy that differ less differ by the draws [nats]
constexpr double kEnough = 0.95;      // probability of one explanation that is enough

struct Protocol {
  const char* name;
  const char* what;     // [40] stands for 40 kPa/s, scaled
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
    {"two_speeds",
     "cycles at [8] and at [40] kPa/s with dwells of some ten seconds at half and full pressure",
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
     "the flat surface, mounted anew each time, under cycles at [40] kPa/s and beside a thermometer: 6 "
     "cycles, "
     "after two hours 6 in a room some 10 K warmer, after two more 6 as at first, at once 60 more, after "
     "three hours 6 (8 hours in all)",
     "[{cycles: {peak: 620000, rate: 40000, cycles: 6}}]", false, false, true, true},
};

// Multiplies all pressures and rates of a part, so that its times stay.
struct Scale {
  double by;
  void operator()(simulation::ChamberProtocol& part) const {
    part.peak *= by;
    part.fill_rate *= by;
    part.vent_rate *= by;
  }
  void operator()(simulation::HoldPart& part) const {
    part.pressure *= by;
    part.rate *= by;
  }
  void operator()(simulation::LoopsPart& part) const {
    part.low *= by;
    part.high *= by;
    part.rate *= by;
  }
  void operator()(simulation::RestPart& part) const { part.rate *= by; }
};

simulation::ChamberProgram programFrom(const std::string& yaml, double peak) {
  simulation::ChamberProgram program = simulation::readChamberProgram(
      settings::Settings::fromText("program: " + yaml, "protocol").sections("program"));
  for (simulation::ProgramPart& part : program) std::visit(Scale{peak / kFullPeak}, part);
  return program;
}

// What to do, with the rates [kPa/s] for a chamber of this peak.
std::string whatToDo(const Protocol& protocol, double peak) {
  std::string text = protocol.what;
  for (std::size_t at = text.find('['); at != std::string::npos; at = text.find('[', at)) {
    const std::size_t end = text.find(']', at);
    const double rate = std::stod(text.substr(at + 1, end - at - 1)) * peak / kFullPeak;
    text.replace(at, end + 1 - at, settings::roundedText(rate, 2));
  }
  return text + ", up to " + settings::roundedText(peak / 1e3, 3) + " kPa";
}

void runHoursApart(simulation::SimulationSettings& rig, const simulation::Station& flat, double peak) {
  double now = 0;
  for (const Block& block : kHoursApart) {
    simulation::Station station = flat;
    station.program = programFrom(
        "[{cycles: {peak: 620000, rate: 40000, cycles: " + std::to_string(block.cycles) + "}}]", peak);
    station.pause = block.pause;
    station.surface.mount = static_cast<std::uint32_t>(rig.session.size() + 1);
    rig.session.push_back(station);
    const double starts = now + block.pause,
                 room = simulation::kRoomTemperature + (block.warmer ? kWarmer : 0);
    if (block.pause > kBetween) rig.climate.room.push_back({starts - kBetween, room});
    now = starts + simulation::pressureProfile(station.program).duration();
    rig.climate.room.push_back({now, room});
  }
}

void run(const Protocol& protocol, simulation::SimulationSettings& rig, double peak) {
  std::vector<simulation::Station> surfaces = {rig.session.front()};
  if (rig.session.size() > 1) surfaces.push_back(rig.session.back());
  rig.session.clear();
  rig.climate = simulation::ChamberClimate();
  rig.climate.room = {{0, simulation::kRoomTemperature}};
  if (protocol.hours) return runHoursApart(rig, surfaces.front(), peak);
  double half = 0;
  for (int round = 0; round < (protocol.twice ? 2 : 1); ++round) {
    for (simulation::Station station : surfaces) {
      station.program = programFrom(protocol.program, peak);
      station.pause = kBetween;
      station.surface.mount = static_cast<std::uint32_t>(rig.session.size() + 1);
      rig.session.push_back(station);
      if (round == 0) half += kBetween + simulation::pressureProfile(station.program).duration();
    }
  }
  if (!protocol.warmer) return;
  rig.climate.room.push_back({half, simulation::kRoomTemperature});
  rig.climate.room.push_back({half + kBetween, simulation::kRoomTemperature + kWarmer});
}

double durationOf(const simulation::SimulationSettings& plan) {
  double seconds = 0;
  for (const simulation::Station& station : plan.session)
    seconds += station.pause + simulation::pressureProfile(station.program).duration();
  return seconds;
}

// What one run of a protocol tells of the explanations.
struct UnderProtocol {
  const Protocol* protocol = nullptr;
  Eigen::MatrixXd gram;  // of what the explanations add, under the noise, sum over the cycles
  double cycles = 0;     // on each surface
  double duration = 0;   // [s]
};

// Gram matrix of the design's columns under the noise, sum over the cycles.
Eigen::MatrixXd gramOf(const CycleDesign& design, Eigen::Index explanations, const NoiseOfCycles& noise) {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(explanations, explanations);
  for (CycleBins bins : design.cycles) {
    bins.white = noise.white * bins.scans.cwiseInverse();
    const Eigen::LLT<Eigen::MatrixXd> root(noise.noise.covariance(bins, noise.cycle_time));
    const Eigen::MatrixXd columns = root.matrixL().solve(bins.columns.leftCols(explanations));
    gram += columns.transpose() * columns;
  }
  return gram;
}

UnderProtocol explanationsUnder(const Protocol& protocol, const simulation::SimulationSettings& base,
                                const Contest& contest) {
  DiscrepancyProblem problem;
  problem.simulation = representative(base);
  problem.simulation.board.scan_rate = problem.simulation.board.transducer_rate = kScanRate;
  run(protocol, problem.simulation, contest.peak);
  problem.recordings = simulation::simulateSession(problem.simulation);
  Measured measured = admit(problem);
  for (MeasuredCycle& cycle : measured.cycles) cycle.use = CycleUse::kFit;
  const auto explanations = static_cast<Eigen::Index>(contest.explanations.size());
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(measured.samples()), explanations);
  for (Eigen::Index e = 0; e < explanations; ++e) {
    simulation::SimulationSettings with = base;
    for (const auto& effect : contest.explanations[static_cast<std::size_t>(e)])
      with = withEffect(with, effect);
    const Trace reading = driven(measured, with).reading;
    columns.col(e) = StaticFit(measured, CurvePer::kClass, reading).residual(reading);
  }
  const Trace reading = driven(measured, base).reading;
  const CycleDesign design =
      cycleDesign(measured, StaticFit(measured, CurvePer::kClass, reading), reading, columns);
  const auto cycles = static_cast<double>(design.cycles.size());
  return {&protocol, gramOf(design, explanations, contest.noise),
          cycles / static_cast<double>(design.classes), durationOf(problem.simulation)};
}

double entropyOf(const Eigen::VectorXd& probability) {
  double sum = 0;
  for (const double p : probability) sum -= p > 0 ? p * std::log(p) : 0;
  return sum;
}

// Entropy of one explanation that is sure enough, and of all the others together.
double sureEntropy() {
  return entropyOf(Eigen::Vector2d(kEnough, 1 - kEnough));
}

// Smallest distance between two explanations, in standard deviations of the noise, after the size of one was
// fitted to the other.
double smallestDistance(const Eigen::MatrixXd& gram) {
  double least = INFINITY;
  for (Eigen::Index a = 0; a < gram.rows(); ++a) {
    for (Eigen::Index b = 0; b < gram.rows(); ++b) {
      if (a == b) continue;
      const double size = gram(b, b) > 0 ? std::max(0.0, gram(a, b) / gram(b, b)) : 0;
      least = std::min(least, gram(a, a) - 2 * size * gram(a, b) + size * size * gram(b, b));
    }
  }
  return std::sqrt(std::max(0.0, least));
}

AvailableEvidence with(const Protocol& protocol, AvailableEvidence evidence) {
  evidence.two_rates = evidence.two_rates || protocol.two_rates;
  evidence.thermometer = evidence.thermometer || protocol.warmer;
  evidence.uneven_pace = evidence.uneven_pace || protocol.hours;
  return evidence;
}

const Protocol& protocolCalled(const std::string& name) {
  return *std::find_if(std::begin(kProtocols), std::end(kProtocols),
                       [&](const Protocol& one) { return one.name == name; });
}

// A protocol, run as often as it takes.
struct Experiment {
  const Protocol* protocol = nullptr;
  Eigen::MatrixXd gram;  // with that of the experiments before it
  ExpectedKnowledge after;
  double cycles = 0;  // on each surface
  double duration = 0;

  // Whether it leaves less entropy than another, or as little sooner.
  bool betterThan(const Experiment& other) const {
    if (!other.protocol) return true;
    if (std::abs(after.entropy - other.after.entropy) > kDrawsApart)
      return after.entropy < other.after.entropy;
    return duration < other.duration;
  }
};

class Planner {
 public:
  Planner(const simulation::SimulationSettings& base, const Contest& contest)
      : contest_(contest), library_(simulation::libraryOf(base)), at_hand_(contest.at_hand) {
    for (const Protocol& protocol : kProtocols) {
      try {
        all_.push_back(explanationsUnder(protocol, base, contest));
      } catch (const settings::InputError&) {
        continue;  // this rig cannot run the protocol
      }
    }
    const auto size = static_cast<Eigen::Index>(contest.explanations.size());
    known_ = Eigen::MatrixXd::Zero(size, size);
    now_ = expectedKnowledge(known_, contest);
  }

  std::vector<NextExperiment> run() {
    std::vector<NextExperiment> plan;
    for (int round = 0; round < kRounds; ++round) {
      const bool first = plan.empty();
      if (!first && now_.entropy <= sureEntropy() && fewestLacking() == lacks()) break;
      const Experiment best = bestExperiment();
      if (!best.protocol) break;
      const bool needed = lacksAfter(*best.protocol) < lacks();
      if (!needed && now_.entropy - best.after.entropy <= kDrawsApart) break;
      plan.push_back(told(best, first));
      known_ = best.gram;
      now_ = best.after;
      done_.push_back(best.protocol);
      at_hand_ = with(*best.protocol, at_hand_);
    }
    return plan;
  }

 private:
  static constexpr int kRounds = 2;

  // Kinds of evidence that are lacking for naming an effect alone, now and after a protocol.
  std::size_t lacks(const AvailableEvidence& evidence) const {
    std::set<simulation::Evidence> all;
    const auto add = [&](const std::string& id) { all.merge(evidence.lacking(library_.info(id).needs)); };
    for (const auto& effects : contest_.explanations) {
      for (const simulation::EnabledEffect& effect : effects) add(effect.id);
    }
    std::for_each(contest_.untested.begin(), contest_.untested.end(), add);
    return all.size();
  }
  std::size_t lacks() const { return lacks(at_hand_); }
  std::size_t lacksAfter(const Protocol& protocol) const { return lacks(with(protocol, at_hand_)); }
  std::size_t fewestLacking() const {
    std::size_t fewest = lacks();
    for (const UnderProtocol& once : all_) fewest = std::min(fewest, lacksAfter(*once.protocol));
    return fewest;
  }

  Experiment experimentBy(const UnderProtocol& once) const {
    Experiment best;
    best.protocol = once.protocol;
    for (double runs = std::ceil(kFewestCycles / once.cycles);; runs *= 2) {
      if (best.cycles > 0 && runs * once.cycles > kMostCycles) return best;
      best.gram = known_ + runs * once.gram;
      best.after = expectedKnowledge(best.gram, contest_);
      best.cycles = runs * once.cycles;
      best.duration = runs * once.duration;
      if (best.after.entropy <= sureEntropy()) return best;
    }
  }

  // The protocol that leaves the least entropy, among those that bring the most evidence.
  Experiment bestExperiment() const {
    Experiment best;
    const std::size_t fewest = fewestLacking();
    for (const UnderProtocol& once : all_) {
      if (std::count(done_.begin(), done_.end(), once.protocol)) continue;
      if (!(once.cycles > 0) || lacksAfter(*once.protocol) > fewest) continue;
      const Experiment one = experimentBy(once);
      if (one.betterThan(best)) best = one;
    }
    return best;
  }

  NextExperiment told(const Experiment& best, bool first) const {
    NextExperiment next;
    next.protocol = best.protocol->name;
    next.cycles = static_cast<int>(std::lround(best.cycles));
    next.separation = smallestDistance(best.gram);
    next.certainty = best.after.certainty;
    next.entropy_before = now_.entropy;
    next.entropy = best.after.entropy;
    std::vector<std::string> names;
    for (const auto& effects : contest_.explanations) names.push_back(idsOf(effects));
    for (std::size_t a = 0; a < names.size(); ++a) {
      for (std::size_t b = a + 1; b < names.size(); ++b) next.separates.emplace_back(names[a], names[b]);
    }
    next.sentence = std::string(first ? "Record " : "Then record ") +
                    whatToDo(*best.protocol, contest_.peak) + ", until each surface has " +
                    std::to_string(next.cycles) + " cycles: it distinguishes " + listText(names) +
                    ". The true explanation is expected to have a probability of " +
                    settings::roundedText(100 * next.certainty, 3) + " % after it (" +
                    settings::roundedText(100 * now_.certainty, 2) + " % before).";
    return next;
  }

  const Contest& contest_;
  const simulation::EffectLibrary& library_;
  AvailableEvidence at_hand_;
  std::vector<UnderProtocol> all_;
  std::vector<const Protocol*> done_;
  Eigen::MatrixXd known_;
  ExpectedKnowledge now_;
};

}  // namespace

simulation::SimulationSettings onItsSurfaces(simulation::SimulationSettings rig, const Measured& measured) {
  std::vector<simulation::Station> stations;
  for (std::size_t c = 0; c < measured.classes.size(); ++c) {
    const auto on_it = [&](const Visit& visit) { return visit.curvature_class == c; };
    const auto visit = std::find_if(measured.visits.begin(), measured.visits.end(), on_it);
    if (visit == measured.visits.end()) continue;
    simulation::Station station = rig.session.front();
    station.surface = oneTaxel(visit->surface);
    stations.push_back(station);
  }
  if (!stations.empty()) rig.session = stations;
  return rig;
}

std::vector<std::string> protocolNames() {
  std::vector<std::string> names;
  for (const Protocol& protocol : kProtocols) names.push_back(protocol.name);
  return names;
}

simulation::SimulationSettings runProtocol(const std::string& protocol, simulation::SimulationSettings rig,
                                           double peak) {
  run(protocolCalled(protocol), rig, peak);
  return rig;
}

ExpectedKnowledge expectedKnowledge(const Eigen::MatrixXd& gram, const Contest& contest) {
  const Eigen::Index members = gram.rows();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
  const Eigen::MatrixXd root =
      solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> all(gram + Eigen::MatrixXd::Identity(members, members));
  Eigen::VectorXd prior(members + 1), constant(members + 1);
  for (Eigen::Index e = 0; e < members; ++e) {
    prior[e] = (1 - contest.unknown) * contest.weights[static_cast<std::size_t>(e)];
    constant[e] = std::log(prior[e]) - 0.5 * std::log(1 + gram(e, e));
  }
  prior[members] = contest.unknown;
  constant[members] = std::log(contest.unknown) - all.matrixLLT().diagonal().array().log().sum();
  const statistics::RandomStream stream = statistics::randomStream(contest.seed, "discrepancy.next");
  ExpectedKnowledge expected;
  std::uint64_t position = 0;
  const auto normal = [&](Eigen::Index size) {
    Eigen::VectorXd drawn(size);
    for (double& one : drawn) one = stream.normal(position++);
    return drawn;
  };
  for (Eigen::Index truth = 0; truth <= members; ++truth) {
    for (std::size_t draw = 0; draw < contest.draws; ++draw) {
      Eigen::VectorXd sizes = normal(members);
      if (truth < members) sizes = Eigen::VectorXd::Unit(members, truth);
      const Eigen::VectorXd seen = gram * sizes + root * normal(members);
      Eigen::VectorXd posterior = constant;
      for (Eigen::Index e = 0; e < members; ++e) posterior[e] += 0.5 * seen[e] * seen[e] / (1 + gram(e, e));
      posterior[members] += 0.5 * seen.dot(all.solve(seen));
      posterior = (posterior.array() - posterior.maxCoeff()).exp();
      posterior /= posterior.sum();
      const double share = prior[truth] / static_cast<double>(contest.draws);
      expected.entropy += share * entropyOf(posterior);
      expected.certainty += share * posterior[truth];
    }
  }
  return expected;
}

std::vector<NextExperiment> nextExperiment(const simulation::SimulationSettings& base,
                                           const Contest& contest) {
  if (contest.explanations.size() < 2) return {};
  const std::vector<NextExperiment> plan = Planner(base, contest).run();
  if (!plan.empty()) return plan;
  // The weights leave no doubt, but the explanations are not excluded: what they differ by may be chance.
  Contest even = contest;
  even.weights.assign(contest.explanations.size(), 1 / static_cast<double>(contest.explanations.size()));
  return Planner(base, even).run();
}

std::vector<NextExperiment> experimentFor(const std::vector<std::string>& covariates, bool proved,
                                          double peak) {
  using simulation::Covariate;
  static const std::pair<Covariate, const char*> kVaries[] = {
      {Covariate::kTemperature, "two_ambients"},      {Covariate::kMount, "random_order"},
      {Covariate::kClockTime, "hours_apart"},         {Covariate::kCycle, "hours_apart"},
      {Covariate::kAccumulatedChange, "hours_apart"}, {Covariate::kPreviousExtremes, "minor_loops"},
      {Covariate::kTimeSinceReversal, "step_hold"},   {Covariate::kPressureRate, "two_speeds"},
      {Covariate::kDirection, "two_speeds"}};
  const int fewest = static_cast<int>(kFewestCycles);
  NextExperiment next;
  next.cycles = fewest;
  next.separation = NAN;
  if (!proved) {
    next.protocol = "more_cycles";
    next.sentence = "Record at least 10 cycles on each surface, so that some can be held out.";
    return {next};
  }
  for (const auto& [covariate, protocol] : kVaries) {
    const std::string name = simulation::name(covariate);
    if (!std::count(covariates.begin(), covariates.end(), name)) continue;
    next.protocol = protocol;
    next.sentence = "Record " + whatToDo(protocolCalled(protocol), peak) + ": it varies the covariate " +
                    name + " by itself. Repeat it until each surface has " + std::to_string(fewest) +
                    " cycles.";
    return {next};
  }
  return {};
}

}  // namespace fsr::discrepancy
