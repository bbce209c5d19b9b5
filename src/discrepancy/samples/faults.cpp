#include "discrepancy/samples/faults.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "discrepancy/thresholds.h"
#include "simulation/effects/effect_library.h"
#include "statistics/median.h"

namespace fsr::discrepancy {

namespace {

// Change of the median reading that shows that the other taxels moved [share of full scale].
constexpr double kMoves = 0.02;
constexpr double kStuckFor = 1.0;       // shortest time with one code [s]
constexpr std::size_t kStuckScans = 8;  // fewest scans with one code
constexpr double kDeadBelow = 0.35;     // share of the median reading; a taxel below it may be dead
constexpr double kLoaded = 0.12;       // median reading above which a taxel may be dead [share of full scale]
constexpr double kWellLoaded = 0.25;   // likewise; above it a taxel without a reading is dead
constexpr double kNothing = 0.1;       // share of the median reading; a taxel below it has no reading
constexpr std::size_t kDeadScans = 4;  // fewest scans of a dead taxel or a failing line
// A line fails where its deviation from the other taxels exceeds all three of these limits.
constexpr double kSudden = 0.02;       // [share of full scale]
constexpr double kSuddenShare = 0.12;  // share of the median reading
constexpr double kSuddenNoise = 8;     // in units of the line's usual deviation
constexpr std::size_t kLineScans = 2;  // fewest scans of a line's fault
constexpr double kBlock = 5;           // block length for the slow part of a line's deviation [s]

// The scans of one visit, with the median of the taxels at each scan.
struct Sheet {
  const dataset::Recording& recording;
  const Visit& visit;
  std::vector<double> middle;  // median reading of the taxels at each scan [share of full scale]
  std::vector<double> ratio;   // usual reading of each taxel / the median reading
  double full_scale;

  std::size_t scans() const { return middle.size(); }
  std::size_t scan(std::size_t i) const { return visit.first_scan + i; }
  double time(std::size_t i) const { return recording.time[scan(i)]; }
  double reading(std::size_t i, std::size_t taxel) const {
    return recording.scan(scan(i))[taxel] / full_scale;
  }
  double expected(std::size_t i, std::size_t taxel) const {
    const bool usual = ratio[taxel] > 0.6 && ratio[taxel] < 1.6;  // otherwise the taxel hardly ever worked
    return (usual ? ratio[taxel] : 1) * middle[i];
  }
};

Sheet sheetOf(const Measured& measured, const Visit& visit) {
  Sheet sheet{(*measured.recordings)[visit.recording], visit, {}, {}, measured.full_scale};
  std::vector<double> values;
  for (std::size_t s = visit.first_scan; s < visit.last_scan; ++s) {
    values.clear();
    const std::uint16_t* counts = sheet.recording.scan(s);
    for (std::size_t t = 0; t < measured.taxels(); ++t) {
      if (measured.used[t]) values.push_back(counts[t] / measured.full_scale);
    }
    sheet.middle.push_back(statistics::upperMedian(values, 0));
  }
  const double most = *std::max_element(sheet.middle.begin(), sheet.middle.end());
  for (std::size_t t = 0; t < measured.taxels(); ++t) {
    values.clear();
    for (std::size_t i = 0; i < sheet.scans(); i += 3) {
      if (sheet.middle[i] > 0.4 * most) values.push_back(sheet.reading(i, t) / sheet.middle[i]);
    }
    sheet.ratio.push_back(statistics::upperMedian(values, 0));
  }
  return sheet;
}

// Which scans of which taxels fail, for all visits one after the other.
using Flags = std::vector<std::vector<bool>>;  // [taxel or line][scan]

// Calls use(first, end) for each run of flagged scans; `end` is excluded.
template <typename Use>
void eachRun(const std::vector<bool>& flags, Use use) {
  for (std::size_t from = 0; from < flags.size();) {
    std::size_t to = from;
    while (to < flags.size() && flags[to] == flags[from]) ++to;
    if (flags[from]) use(from, to);
    from = to;
  }
}

void clear(std::vector<bool>& flags, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) flags[i] = false;
}

void dropShort(std::vector<bool>& flags, std::size_t least) {
  const std::vector<bool> before = flags;
  eachRun(before, [&](std::size_t from, std::size_t to) {
    if (to - from < least) clear(flags, from, to);
  });
}

std::vector<bool> stuckScans(const Sheet& sheet, std::size_t taxel) {
  std::vector<bool> stuck(sheet.scans(), false);
  const auto code = [&](std::size_t i) { return sheet.recording.scan(sheet.scan(i))[taxel]; };
  for (std::size_t from = 0; from < sheet.scans();) {
    std::size_t to = from;
    double low = sheet.middle[from], high = low;
    for (; to < sheet.scans() && code(to) == code(from); ++to) {
      low = std::min(low, sheet.middle[to]);
      high = std::max(high, sheet.middle[to]);
    }
    const bool long_enough = to - from >= kStuckScans && sheet.time(to - 1) - sheet.time(from) >= kStuckFor;
    const bool rail = code(from) == 0 || code(from) >= sheet.full_scale;
    if (long_enough && !rail && high - low > kMoves) {
      std::fill(stuck.begin() + static_cast<std::ptrdiff_t>(from),
                stuck.begin() + static_cast<std::ptrdiff_t>(to), true);
    }
    from = to;
  }
  return stuck;
}

std::vector<bool> deadScans(const Sheet& sheet, std::size_t taxel) {
  std::vector<bool> dead(sheet.scans(), false);
  for (std::size_t i = 0; i < sheet.scans(); ++i) {
    dead[i] = sheet.middle[i] > kLoaded && sheet.reading(i, taxel) < kDeadBelow * sheet.middle[i];
  }
  dropShort(dead, kDeadScans);
  // A taxel that is only lifted, or has drifted, reads too little at low pressure. A dead taxel reads nothing
  // at high pressure.
  const std::vector<bool> low = dead;
  eachRun(low, [&](std::size_t from, std::size_t to) {
    bool nothing = false;
    for (std::size_t i = from; i < to; ++i) {
      const double middle = sheet.middle[i];
      nothing = nothing || (middle > kWellLoaded && sheet.reading(i, taxel) < kNothing * middle);
    }
    if (!nothing) clear(dead, from, to);
  });
  return dead;
}

// Median deviation of a line's taxels from their expected readings, at each scan, without its slow part. The
// expected readings follow from the other taxels.
std::vector<double> lineDeviation(const Sheet& sheet, const std::vector<std::size_t>& taxels) {
  std::vector<double> deviation, values;
  for (std::size_t i = 0; i < sheet.scans(); ++i) {
    values.clear();
    for (const std::size_t t : taxels) values.push_back(sheet.reading(i, t) - sheet.expected(i, t));
    deviation.push_back(statistics::upperMedian(values, 0));
  }
  const double period = sheet.scans() > 1 ? (sheet.time(sheet.scans() - 1) - sheet.time(0)) /
                                                static_cast<double>(sheet.scans() - 1)
                                          : 1;
  const auto block = std::max<std::size_t>(4, static_cast<std::size_t>(kBlock / std::max(period, 1e-6)));
  std::vector<double> slow, around;
  for (std::size_t from = 0; from < sheet.scans(); from += block) {
    values.assign(deviation.begin() + static_cast<std::ptrdiff_t>(from),
                  deviation.begin() + static_cast<std::ptrdiff_t>(std::min(from + block, sheet.scans())));
    slow.push_back(statistics::upperMedian(values, 0));
  }
  std::vector<double> fast = deviation;
  for (std::size_t i = 0; i < fast.size(); ++i) {
    around.clear();
    const std::size_t b = i / block;
    for (std::size_t k = b >= 2 ? b - 2 : 0; k <= std::min(b + 2, slow.size() - 1); ++k)
      around.push_back(slow[k]);
    fast[i] -= statistics::upperMedian(around, 0);
  }
  return fast;
}

std::vector<bool> failingScans(const Sheet& sheet, const std::vector<std::size_t>& taxels) {
  const std::vector<double> fast = lineDeviation(sheet, taxels);
  std::vector<double> sizes;
  for (const double x : fast) sizes.push_back(std::abs(x));
  const double usual = 1.48 * statistics::upperMedian(sizes, 0);
  std::vector<bool> failing(sheet.scans(), false);
  for (std::size_t i = 0; i < sheet.scans(); ++i) {
    const double least = std::max({kSudden, kSuddenShare * sheet.middle[i], kSuddenNoise * usual});
    failing[i] = std::abs(fast[i]) > least;
  }
  dropShort(failing, kLineScans);
  const std::vector<bool> before = failing;
  eachRun(before, [&](std::size_t from, std::size_t to) {
    const double jump = from >= 2 ? std::abs(fast[from] - fast[from - 2]) : 0;
    const double least = std::max(kSudden, kSuddenNoise * usual);
    if (jump < least / 2 + 0.25 * std::abs(fast[from])) clear(failing, from, to);
  });
  return failing;
}

class Detectors {
 public:
  explicit Detectors(const Measured& measured) : measured_(measured) {
    for (const Visit& visit : measured.visits) sheets_.push_back(sheetOf(measured, visit));
  }

  Faults run() {
    for (const bool rows : {true, false}) findLine(rows);
    findTaxels(simulation::Detector::kStuckTaxels, stuckScans);
    findTaxels(simulation::Detector::kDeadTaxels, deadScans);
    judgeReadings();
    return std::move(faults_);
  }

 private:
  using Test = std::vector<bool> (*)(const Sheet&, std::size_t);

  bool taken(std::size_t taxel) const {
    return std::any_of(faults_.faults.begin(), faults_.faults.end(), [&](const Fault& fault) {
      return std::count(fault.taxels.begin(), fault.taxels.end(), taxel) > 0;
    });
  }
  void findLine(bool rows);
  void findTaxels(simulation::Detector detector, Test test);
  void keep(Fault& fault, const std::vector<std::vector<bool>>& flags);
  void judgeReadings();

  const Measured& measured_;
  std::vector<Sheet> sheets_;
  Faults faults_;
  std::map<std::size_t, std::vector<std::vector<bool>>> failing_;  // for each faulty taxel: [visit][scan]
};

// Computes the spells, the share and the depth of a fault from the flags of its taxels.
void Detectors::keep(Fault& fault, const std::vector<std::vector<bool>>& flags) {
  double hit = 0, all = 0, lost = 0;
  for (std::size_t v = 0; v < sheets_.size(); ++v) {
    const Sheet& sheet = sheets_[v];
    const double offset = measured_.time[sheet.visit.first] - sheet.time(0);
    for (std::size_t i = 0; i < sheet.scans(); ++i) {
      ++all;
      if (!flags[v][i]) continue;
      ++hit;
      double now = 0;
      for (const std::size_t t : fault.taxels)
        now += 1 - sheet.reading(i, t) / std::max(1e-3, sheet.expected(i, t));
      lost += now / static_cast<double>(fault.taxels.size());
      const double time = sheet.time(i) + offset;
      const bool goes_on = i > 0 && flags[v][i - 1];
      if (!goes_on) fault.times.emplace_back(time, time);
      fault.times.back().second = time;
      fault.longest = std::max(fault.longest, time - fault.times.back().first);
    }
  }
  fault.share = hit / std::max(1.0, all);
  fault.depth = hit > 0 ? lost / hit : 0;
  for (const std::size_t t : fault.taxels) failing_[t] = flags;
}

void Detectors::findLine(bool rows) {
  const std::size_t lines = rows ? measured_.layout.size.rows : measured_.layout.size.columns;
  const std::size_t across = rows ? measured_.layout.size.columns : measured_.layout.size.rows;
  if (lines < 3 || across < 3) return;
  const simulation::Detector detector =
      rows ? simulation::Detector::kRowFaults : simulation::Detector::kColumnFaults;
  Fault best;
  std::vector<std::vector<bool>> best_flags;
  double most = 0;
  for (std::size_t line = 0; line < lines; ++line) {
    std::vector<std::size_t> taxels;
    for (std::size_t t = 0; t < measured_.taxels(); ++t) {
      const std::size_t own = rows ? measured_.layout.row({t}) : measured_.layout.column({t});
      if (own == line && measured_.used[t]) taxels.push_back(t);
    }
    if (taxels.size() < 3) continue;
    std::vector<std::vector<bool>> flags;
    double hit = 0;
    for (const Sheet& sheet : sheets_) {
      flags.push_back(failingScans(sheet, taxels));
      hit += static_cast<double>(std::count(flags.back().begin(), flags.back().end(), true));
    }
    if (hit <= most) continue;
    most = hit;
    best = Fault{detector, simulation::foundBy(detector).id, line, taxels, 0, 0, 0, {}};
    best_flags = flags;
  }
  if (most < static_cast<double>(kDeadScans) || (!best.taxels.empty() && taken(best.taxels.front()))) return;
  keep(best, best_flags);
  faults_.faults.push_back(best);
}

void Detectors::findTaxels(simulation::Detector detector, Test test) {
  Fault fault{detector, simulation::foundBy(detector).id, 0, {}, 0, 0, 0, {}};
  std::vector<std::vector<bool>> together;
  for (std::size_t t = 0; t < measured_.taxels(); ++t) {
    if (!measured_.used[t] || taken(t)) continue;
    std::vector<std::vector<bool>> flags;
    double hit = 0;
    for (const Sheet& sheet : sheets_) {
      flags.push_back(test(sheet, t));
      hit += static_cast<double>(std::count(flags.back().begin(), flags.back().end(), true));
    }
    if (hit == 0) continue;
    fault.taxels.push_back(t);
    failing_[t] = flags;
    if (together.empty()) together = flags;
    for (std::size_t v = 0; v < flags.size(); ++v) {
      for (std::size_t i = 0; i < flags[v].size(); ++i) together[v][i] = together[v][i] || flags[v][i];
    }
  }
  if (fault.taxels.empty()) return;
  const auto own = failing_;
  keep(fault, together);
  failing_ = own;
  faults_.faults.push_back(fault);
}

void Detectors::judgeReadings() {
  FaultyReadings& readings = faults_.readings;
  std::map<long, std::pair<double, double>> bins;  // sum of squares, number of readings
  std::map<std::string, double> by_surface;
  for (std::size_t v = 0; v < sheets_.size(); ++v) {
    const Sheet& sheet = sheets_[v];
    double squares = 0;
    std::size_t sample = sheet.visit.first;
    for (std::size_t i = 0; i < sheet.scans(); ++i) {
      while (sample + 1 < sheet.visit.last && measured_.first_scan[sample + 1] <= sheet.scan(i)) ++sample;
      const bool held_out = measured_.cycles[measured_.cycle[sample]].use == CycleUse::kHoldOut;
      auto& bin =
          bins[static_cast<long>(std::max(0.0, measured_.pressure[sample]) / thresholds::kPressureBin)];
      for (const auto& [t, flags] : failing_) {
        bin.second += 1;
        if (!flags[v][i]) continue;
        const double square = std::pow(sheet.reading(i, t) - sheet.expected(i, t), 2);
        bin.first += square;
        squares += square;
        if (held_out) readings.held_out += square;
      }
      readings.readings += static_cast<double>(measured_.taxels());
      if (held_out) readings.held_out_readings += static_cast<double>(measured_.taxels());
    }
    readings.square += squares;
    by_surface[sheet.visit.surface.name] += squares;
  }
  double most = 0;
  for (const auto& [bin, sums] : bins)
    most = std::max(most, sums.second > 0 ? std::sqrt(sums.first / sums.second) : 0);
  readings.pressure = {INFINITY, 0};
  for (const auto& [bin, sums] : bins) {
    if (sums.second == 0 || std::sqrt(sums.first / sums.second) < thresholds::kPressureShows * most) continue;
    readings.pressure.low =
        std::min(readings.pressure.low, static_cast<double>(bin) * thresholds::kPressureBin);
    readings.pressure.high =
        std::max(readings.pressure.high, static_cast<double>(bin + 1) * thresholds::kPressureBin);
  }
  for (const auto& [surface, squares] : by_surface) {
    if (squares > 0.01 * readings.square) readings.conditions.push_back(surface);
  }
  if (readings.conditions.size() == by_surface.size()) readings.conditions.clear();
}

}  // namespace

Faults findFaults(const Measured& measured) {
  return Detectors(measured).run();
}

simulation::EnabledEffect asEffect(const Fault& fault) {
  simulation::EnabledEffect effect{fault.id, {}};
  for (const simulation::EffectParameter& parameter : simulation::findEffect(fault.id)->info.parameters) {
    effect.values[parameter.name] = parameter.usual;
  }
  const auto set = [&](const char* name, double value) {
    const auto found = effect.values.find(name);
    if (found == effect.values.end()) return;
    const settings::Range& range =
        simulation::parameter(simulation::findEffect(fault.id)->info, name).permitted;
    found->second = std::clamp(value, range.low, range.high);
  };
  set("taxels", static_cast<double>(fault.taxels.size()));
  set("first", fault.taxels.empty() ? -1 : static_cast<double>(fault.taxels.front()));
  set("start", fault.times.empty() ? 0 : fault.times.front().first);
  set("line", static_cast<double>(fault.line));
  set("share", fault.share);
  set("depth", fault.depth);
  double seconds = 0;
  for (const auto& [from, to] : fault.times) seconds += to - from;
  if (!fault.times.empty()) set("burst", seconds / static_cast<double>(fault.times.size()));
  return effect;
}

}  // namespace fsr::discrepancy
