#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "dataset/count_readers.h"
#include "dataset/sections.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "simulation/effects/effect_library.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy {

namespace {

constexpr std::size_t kFewestCycles = 3;
constexpr std::size_t kFewestScans = 200;
constexpr std::uint64_t kFewRestarts = 2;  // restarts of the board that one bag may contain
// A taxel responds to the pressure if the standard deviation of its readings reaches both of these limits.
constexpr double kAnswers = 0.05;        // share of the usual standard deviation
constexpr double kLeastAnswer = 0.0005;  // [share of full scale]
constexpr double kBetween = 60;          // pause that is assumed between bags whose stamps overlap [s]
constexpr double kHoldOutShare = 0.2;    // share of the cycles that is held out
constexpr double kVented = 0.25;         // of a cycle's height; a cycle that ends above it was cut off

void requireWhole(const dataset::Recording& recording) {
  const auto refuse = [&](const std::string& what) {
    throw settings::InputError(recording.name + ": " + what);
  };
  if (recording.scans() == 0) refuse("it has no scan");
  if (recording.pressure.empty()) {
    refuse("no chamber pressure is recorded, but without the topic chamber_pressure nothing can be compared");
  }
  const bool whole = dataset::countsAreWhole(recording) && recording.pressure.size() == recording.scans() &&
                     recording.condition.size() == recording.scans() &&
                     (recording.mask.empty() || recording.mask.size() == recording.layout.size.taxels()) &&
                     (recording.temperature.empty() || recording.temperature.size() == recording.scans());
  if (!whole) refuse("counts, pressure, temperature, condition and mask do not fit each other");
  for (std::size_t i = 1; i < recording.scans(); ++i) {
    if (recording.time[i] > recording.time[i - 1]) continue;
    refuse("its stamps run backwards at " + settings::roundedText(recording.time[i]) + " s, but must ascend");
  }
  if (recording.losses.counter_back > kFewRestarts) {
    refuse("its stamps run backwards, or the board restarted, " +
           std::to_string(recording.losses.counter_back) +
           " times; was a clock set while it was recorded? Record it again");
  }
}

void requireFinite(const dataset::Recording& recording) {
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (std::isfinite(recording.pressure[i])) continue;
    throw settings::InputError(recording.name + ": chamber pressure at " +
                               settings::roundedText(recording.time[i]) + " s is not a number");
  }
}

void requireFit(const dataset::Recording& recording, const simulation::SimulationSettings& simulation) {
  if (recording.layout.size != simulation.layout.size) {
    throw settings::InputError(simulation.origin + ": matrix is " + matrix::sizeText(simulation.layout.size) +
                               ", but " + recording.name + " has " + matrix::sizeText(recording.layout.size));
  }
}

// All recordings must be of one sheet. No scans may be given twice: hold-out cycles could then also be among
// the cycles that are fitted.
void requireTogether(const std::vector<dataset::Recording>& recordings) {
  const dataset::Recording& first = recordings.front();
  for (auto r = recordings.begin(); r != recordings.end(); ++r) {
    if (r->layout.size != first.layout.size || r->full_scale != first.full_scale) {
      throw settings::InputError(r->name + ": is of a matrix of " + matrix::sizeText(r->layout.size) +
                                 " up to " + std::to_string(r->full_scale) + " counts, but " + first.name +
                                 " of " + matrix::sizeText(first.layout.size) + " up to " +
                                 std::to_string(first.full_scale) + "; give bags of one sheet");
    }
    const auto same = std::find_if(recordings.begin(), r, [&](const dataset::Recording& other) {
      return other.start_ns == r->start_ns && other.time == r->time && dataset::sameCounts(other, *r);
    });
    if (same != r)
      throw settings::InputError(r->name + ": holds the same scans as " + same->name +
                                 "; give every bag once");
  }
}

void requireKnown(const simulation::EffectLibrary& library, const std::vector<std::string>& ids,
                  const std::string& option) {
  for (const std::string& id : ids) {
    if (!library.find(id)) throw settings::InputError(option + ": no effect is called " + id);
  }
}

// The scans of one visit before they are pooled into samples.
struct VisitCourse {
  std::vector<double> time, pressure, rate;
  dataset::Cycles cycles;
};

VisitCourse courseOf(const dataset::Recording& recording, const Visit& visit, double start) {
  VisitCourse course;
  const auto at = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
  for (std::size_t i = visit.first_scan; i < visit.last_scan; ++i) {
    course.time.push_back(start + recording.time[i]);
  }
  const std::vector<double> pressure(recording.pressure.begin() + at(visit.first_scan),
                                     recording.pressure.begin() + at(visit.last_scan));
  course.pressure = smoothCourse(course.time, pressure, course.rate);
  course.cycles = dataset::findCycles(course.pressure);
  if (course.cycles.first.empty()) {
    course.cycles.first = {0};
    course.cycles.direction.assign(pressure.size(), statistics::LoadDirection::kNone);
  }
  return course;
}

double mean(const std::vector<double>& values, std::size_t first, std::size_t last) {
  const auto at = [&](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
  return std::accumulate(at(first), at(last), 0.0) / static_cast<double>(last - first);
}

int sign(statistics::LoadDirection direction) {
  return direction == statistics::LoadDirection::kLoading     ? 1
         : direction == statistics::LoadDirection::kUnloading ? -1
                                                              : 0;
}

// Adds scans first .. last - 1 of a visit as one sample.
void appendSample(Measured& measured, const VisitCourse& course, std::size_t first, std::size_t last) {
  const Visit& visit = measured.visits.back();
  const dataset::Recording& recording = (*measured.recordings)[visit.recording];
  const std::vector<double>& temperature = recording.temperature;
  measured.time.push_back(mean(course.time, first, last));
  measured.pressure.push_back(mean(course.pressure, first, last));
  measured.raw_pressure.push_back(
      mean(recording.pressure, visit.first_scan + first, visit.first_scan + last));
  measured.rate.push_back(mean(course.rate, first, last));
  measured.direction.push_back(static_cast<std::int8_t>(sign(course.cycles.direction[first])));
  measured.visit.push_back(static_cast<std::uint32_t>(measured.visits.size() - 1));
  measured.cycle.push_back(static_cast<std::uint32_t>(measured.cycles.size() - 1));
  measured.first_scan.push_back(visit.first_scan + first);
  measured.scans.push_back(static_cast<std::uint32_t>(last - first));
  if (!temperature.empty()) {
    measured.temperature.push_back(mean(temperature, visit.first_scan + first, visit.first_scan + last));
  }
}

void appendVisit(Measured& measured, double start, std::size_t pooled) {
  Visit& visit = measured.visits.back();
  const VisitCourse course = courseOf((*measured.recordings)[visit.recording], visit, start);
  visit.first = measured.samples();
  for (std::size_t c = 0; c < course.cycles.count(); ++c) {
    const bool last = c + 1 == course.cycles.count();
    const std::size_t end = last ? course.time.size() : course.cycles.first[c + 1];
    measured.cycles.push_back({measured.visits.size() - 1, measured.samples(), 0, CycleUse::kFit});
    for (std::size_t i = course.cycles.first[c]; i < end; i += pooled) {
      appendSample(measured, course, i, std::min(i + pooled, end));
    }
    measured.cycles.back().last = measured.samples();
  }
  visit.last = measured.samples();
}

std::size_t scansPooled(const std::vector<dataset::Recording>& recordings) {
  std::size_t scans = 0;
  double shortest = INFINITY;  // mean time from scan to scan [s]
  for (const dataset::Recording& recording : recordings) {
    scans += recording.scans();
    if (recording.scans() < 2) continue;
    const double seconds = recording.time.back() - recording.time.front();
    shortest = std::min(shortest, seconds / static_cast<double>(recording.scans() - 1));
  }
  const double most = std::max(1.0, std::floor(Measured::kLongestSample / shortest));
  const double wanted = static_cast<double>(scans) / static_cast<double>(Measured::kManySamples);
  return static_cast<std::size_t>(std::clamp(std::round(wanted), 1.0, most));
}

void appendRecording(Measured& measured, const dataset::ConditionClasses& classes, std::size_t r,
                     std::size_t pooled) {
  const dataset::Recording& recording = (*measured.recordings)[r];
  double start = static_cast<double>(recording.start_ns - (*measured.recordings)[0].start_ns) * 1e-9;
  if (!measured.time.empty() && start + recording.time.front() <= measured.time.back()) {
    start = measured.time.back() + kBetween - recording.time.front();
    measured.limitations.push_back(recording.name +
                                   " overlaps another bag in time; it is treated as if it followed it.");
  }
  for (std::size_t from = 0, to = 0; from < recording.scans(); from = to) {
    while (to < recording.scans() && recording.condition[to] == recording.condition[from]) ++to;
    const std::size_t condition = recording.condition[from];
    Visit visit{r, recording.conditions.at(condition), classes.class_of[r][condition], 0, 0, from, to};
    visit.reference_interval = recording.reference_interval;
    if (!visit.surface.known()) visit.surface.curvature = {matrix::Curvature{}};
    measured.visits.push_back(visit);
    appendVisit(measured, start, pooled);
  }
}

// Whether the recording ended before the chamber was vented again, as Ctrl-C does.
bool isStump(const Measured& measured, const MeasuredCycle& cycle) {
  const Visit& visit = measured.visits[cycle.visit];
  const bool ends_recording =
      cycle.last == visit.last && visit.last_scan == (*measured.recordings)[visit.recording].scans();
  if (!ends_recording || cycle.first == cycle.last) return false;
  const auto first = measured.pressure.begin() + static_cast<std::ptrdiff_t>(cycle.first);
  const auto last = measured.pressure.begin() + static_cast<std::ptrdiff_t>(cycle.last);
  const auto [low, high] = std::minmax_element(first, last);
  return *(last - 1) - *low > kVented * (*high - *low);
}

// Chooses the hold-out cycles by the seed. Every visit gives about the same share of its cycles. A cycle that
// was cut off is never held out.
void partCycles(Measured& measured, std::uint64_t seed) {
  const statistics::RandomStream stream = statistics::randomStream(seed, "discrepancy.split");
  std::vector<std::vector<std::size_t>> of_visit(measured.visits.size());
  for (std::size_t c = 0; c < measured.cycles.size(); ++c) of_visit[measured.cycles[c].visit].push_back(c);
  double owed = 0;
  for (std::size_t v = 0; v < of_visit.size(); ++v) {
    std::vector<std::size_t>& cycles = of_visit[v];
    owed += kHoldOutShare * static_cast<double>(cycles.size());
    if (!cycles.empty() && isStump(measured, measured.cycles[cycles.back()])) cycles.pop_back();
    for (; owed >= 1 && cycles.size() > 1; owed -= 1) {
      const std::size_t drawn = stream.bits(v * 1000 + cycles.size()) % cycles.size();
      measured.cycles[cycles[drawn]].use = CycleUse::kHoldOut;
      cycles.erase(cycles.begin() + static_cast<std::ptrdiff_t>(drawn));
    }
  }
}

void maskTaxels(Measured& measured) {
  measured.used.assign(measured.taxels(), 1);
  for (const dataset::Recording& recording : *measured.recordings) {
    for (std::size_t i = 0; i < recording.mask.size(); ++i) {
      if (recording.mask[i]) measured.used[i] = 0;
    }
  }
  if (!thresholds::enoughUsable(measured.usedTaxels(), measured.taxels())) {
    throw settings::InputError(
        (*measured.recordings)[0].name + ": " + std::to_string(measured.taxels() - measured.usedTaxels()) +
        " of " + std::to_string(measured.taxels()) + " taxels are masked, but at least half must be usable");
  }
}

void sumCounts(Measured& measured) {
  const std::size_t taxels = measured.taxels();
  auto sums = std::make_shared<std::vector<std::uint32_t>>(measured.samples() * taxels, 0);
  std::vector<dataset::ScanCounts> counts(measured.recordings->begin(), measured.recordings->end());
  for (std::size_t m = 0; m < measured.samples(); ++m) {
    dataset::ScanCounts& own = counts[measured.visits[measured.visit[m]].recording];
    std::uint32_t* const sum = sums->data() + m * taxels;
    for (std::size_t s = 0; s < measured.scans[m]; ++s) {
      const std::uint16_t* const scan = own[measured.first_scan[m] + s];
      for (std::size_t t = 0; t < taxels; ++t) sum[t] += scan[t];
    }
  }
  measured.sums = sums;
}

// Standard deviation of each taxel's readings [share of full scale].
std::vector<double> movements(const Measured& measured) {
  std::vector<double> sum(measured.taxels()), squares(measured.taxels()), readings;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    measured.recorded(i, readings);
    for (std::size_t t = 0; t < readings.size(); ++t) {
      sum[t] += readings[t];
      squares[t] += readings[t] * readings[t];
    }
  }
  const auto samples = static_cast<double>(measured.samples());
  for (std::size_t t = 0; t < sum.size(); ++t) {
    squares[t] = std::sqrt(std::max(0.0, squares[t] / samples - std::pow(sum[t] / samples, 2)));
  }
  return squares;
}

// Detectors compare a taxel with the others. If most taxels are dead, a dead taxel does not differ from them.
void requireAnswers(const Measured& measured) {
  const std::vector<double> answer = movements(measured);
  std::vector<double> sorted = answer;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() * 9 / 10];
  const double least = std::max(kLeastAnswer, kAnswers * usual);
  std::size_t usable = 0;
  for (std::size_t t = 0; t < answer.size(); ++t) usable += measured.used[t] && answer[t] >= least;
  if (thresholds::enoughUsable(usable, answer.size())) return;
  throw settings::InputError(
      (*measured.recordings)[0].name + ": " + std::to_string(answer.size() - usable) + " of " +
      std::to_string(answer.size()) +
      " taxels are masked or do not answer to the pressure, but at least half must be usable");
}

// An effect is told from the static curve of a surface by cycles that the curve was not fitted to.
void requireComparedCycles(const Measured& measured) {
  std::vector<std::size_t> cycles(measured.classes.size(), 0);
  for (const MeasuredCycle& cycle : measured.cycles) {
    if (++cycles[measured.visits[cycle.visit].curvature_class] > 1) return;
  }
  throw TooFewCycles((*measured.recordings)[0].name +
                     ": no surface has more than one cycle of filling and venting, but cycles on the "
                     "same surface are compared; record at least 5 on each, better 10");
}

void requireJudgeable(const Measured& measured) {
  const std::string name = (*measured.recordings)[0].name;
  const auto [low, high] = std::minmax_element(measured.pressure.begin(), measured.pressure.end());
  if (*high - *low < thresholds::kLeastRange) {
    throw settings::InputError(name + ": chamber pressure covers " +
                               settings::roundedText((*high - *low) * 1e-3) + " kPa, but at least " +
                               settings::roundedText(thresholds::kLeastRange * 1e-3) +
                               " kPa are needed; chamber_pressure must be in Pa");
  }
  if (measured.cycles.size() < kFewestCycles) {
    throw TooFewCycles(name + ": " + std::to_string(measured.cycles.size()) +
                       (measured.cycles.size() == 1 ? " cycle" : " cycles") +
                       " of filling and venting, but at least 3 are needed: some of them are held out");
  }
  requireComparedCycles(measured);
  if (measured.samples() < kFewestScans) {
    throw settings::InputError(name + ": " + std::to_string(measured.samples()) +
                               " scans, but at least 200 are needed");
  }
}

}  // namespace

const simulation::EffectInfo& Measured::info(const std::string& effect) const {
  return effects().info(effect);
}

const simulation::EffectLibrary& Measured::effects() const {
  return library ? *library : simulation::EffectLibrary::shipped();
}

double Measured::range() const {
  const auto [low, high] = std::minmax_element(pressure.begin(), pressure.end());
  return *high - *low;
}

std::size_t Measured::usedTaxels() const {
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
}

const std::vector<double>& Measured::loads() const {
  return load.empty() ? pressure : load;
}

std::size_t Measured::fitCycles() const {
  return static_cast<std::size_t>(std::count_if(
      cycles.begin(), cycles.end(), [](const MeasuredCycle& one) { return one.use == CycleUse::kFit; }));
}

std::vector<std::size_t> Measured::mounts() const {
  std::vector<std::size_t> number(classes.size());
  std::vector<std::set<std::uint32_t>> labels(classes.size());
  for (const Visit& one : visits) {
    const bool known = one.surface.mount > 0 && !labels[one.curvature_class].insert(one.surface.mount).second;
    if (!known) ++number[one.curvature_class];
  }
  return number;
}

void Measured::recorded(std::size_t sample, std::vector<double>& result) const {
  const auto first = sums->begin() + static_cast<std::ptrdiff_t>(sample * taxels());
  result.assign(first, first + static_cast<std::ptrdiff_t>(taxels()));
  for (double& reading : result) reading /= full_scale * static_cast<double>(scans[sample]);
}

void Measured::readings(std::size_t sample, std::vector<double>& result) const {
  recorded(sample, result);
  if (gain.empty()) return;
  for (double& reading : result) reading = (reading - added[sample] - unloaded) / gain[sample] + unloaded;
}

void validate(const DiscrepancyProblem& problem) {
  if (problem.recordings.empty()) throw settings::InputError("discrepancy: no bag was given");
  for (const dataset::Recording& recording : problem.recordings) {
    requireWhole(recording);
    requireFinite(recording);
  }
  requireTogether(problem.recordings);
  requireFit(problem.recordings.front(), problem.simulation);
  requireKnown(simulation::libraryOf(problem.simulation), problem.options.ask, "--ask");
  requireKnown(simulation::libraryOf(problem.simulation), problem.options.leave_out, "--without");
}

Measured admit(const DiscrepancyProblem& problem) {
  Measured measured;
  measured.recordings = &problem.recordings;
  if (!problem.whole.empty()) measured.whole = &problem.whole;
  const dataset::Recording& first = problem.recordings.front();
  measured.layout = first.layout;
  measured.full_scale = first.full_scale;
  const dataset::ConditionClasses classes = dataset::poolConditions(problem.recordings);
  measured.classes = classes.classes;
  bool thermometer = true;
  const std::size_t pooled = scansPooled(problem.recordings);
  for (const std::size_t r : dataset::inOrderOfTime(problem.recordings)) {
    appendRecording(measured, classes, r, pooled);
    for (const std::string& warning : problem.recordings[r].warnings)
      measured.limitations.push_back(problem.recordings[r].name + ": " + warning + ".");
    thermometer = thermometer && !problem.recordings[r].temperature.empty();
  }
  if (!thermometer) {
    measured.temperature.clear();
    measured.limitations.push_back("No temperature was recorded, so slow effects cannot be told apart.");
  }
  const double start = measured.time.front();
  for (double& time : measured.time) time -= start;
  measured.path_length.assign(measured.samples(), 0);
  for (std::size_t i = 1; i < measured.samples(); ++i) {
    measured.path_length[i] =
        measured.path_length[i - 1] + std::abs(measured.pressure[i] - measured.pressure[i - 1]);
  }
  measured.library = simulation::libraryOf(problem.simulation).forRange(measured.range());
  sumCounts(measured);
  partCycles(measured, problem.options.seed);
  maskTaxels(measured);
  requireJudgeable(measured);
  requireAnswers(measured);
  requireReference(measured);
  return measured;
}

}  // namespace fsr::discrepancy
