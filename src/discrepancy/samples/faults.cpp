#include "discrepancy/samples/faults.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "discrepancy/samples/measured.h"
#include "discrepancy/samples/taxel_courses.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

using Flags = std::vector<std::vector<bool>>;  // [visits][scans]

// Share of the squared deviations of a line that the direction explains at the same reading. A line that does
// the same in every cycle has a loop or a lag; a contact fails at any time.
constexpr double kLoop = 0.5;
constexpr double kReadingBin = 0.1;  // of the taxel's range

class Detectors {
 public:
  Detectors(const Measured& measured, const DiscrepancyOptions& options)
      : measured_(measured), options_(options), courses_(taxelCourses(measured)) {
    for (const std::uint8_t used : measured.used) sound_.push_back(used != 0);
    const auto [low, high] = std::minmax_element(measured.pressure.begin(), measured.pressure.end());
    range_ = *high - *low;
    least_gap_ = leastGap(measured, options);
  }

  Faults run(const FaultProgress& progress) {
    const auto tell = [&](double share) {  // as measured on sound bags
      if (progress) progress(share);
    };
    tell(0.3);
    findLines();
    tell(0.8);
    findTaxels();
    tell(0.95);
    judgeReadings();
    tell(1);
    return std::move(faults_);
  }

 private:
  void findLines();
  void joinLine(bool rows, std::vector<TaxelFault>& found);
  void findTaxels();
  void keep(Fault fault, const std::map<std::size_t, Flags>& flags);
  void judgeReadings();
  bool isLoop(const std::map<std::size_t, Flags>& flags) const;
  // Calls use(scan, sample) for the scans of a visit in order.
  template <typename Use>
  void eachScan(std::size_t visit, Use use) const {
    std::size_t sample = measured_.visits[visit].first;
    for (std::size_t i = 0; i < courses_[visit].scans(); ++i) {
      while (sample + 1 < measured_.visits[visit].last &&
             measured_.first_scan[sample + 1] <= measured_.visits[visit].first_scan + i)
        ++sample;
      use(i, sample);
    }
  }

  const Measured& measured_;
  const DiscrepancyOptions& options_;
  std::vector<VisitCourses> courses_;
  std::vector<bool> sound_;
  double range_ = 0, least_gap_ = 0;  // [Pa]
  Faults faults_;
  std::map<std::size_t, Flags> failing_;  // of each faulty taxel
};

// Whether the taxels do the same in every cycle: rise and fall differ at the same reading.
bool Detectors::isLoop(const std::map<std::size_t, Flags>& flags) const {
  struct Sums {
    double number[2] = {0, 0}, sum[2] = {0, 0};
  };
  double squares = 0, between = 0;
  for (const auto& [t, of_taxel] : flags) {
    const std::size_t taxel = t;
    for (std::size_t v = 0; v < courses_.size(); ++v) {
      std::map<long, Sums> bins;
      TaxelCourse course(courses_[v], taxel);
      eachScan(v, [&](std::size_t i, std::size_t sample) {
        const double deviation = course.deviation(i);
        Sums& bin = bins[std::lround(static_cast<double>(course.expected(i)) / kReadingBin)];
        const bool rises = measured_.direction[sample] > 0;
        bin.number[rises] += 1;
        bin.sum[rises] += deviation;
        squares += deviation * deviation;
      });
      for (const auto& [at, bin] : bins) {
        const double a = bin.number[0], b = bin.number[1];
        if (a > 0 && b > 0) between += a * b / (a + b) * std::pow(bin.sum[0] / a - bin.sum[1] / b, 2);
      }
    }
  }
  return between > kLoop * squares;
}

// Computes the spells, the share, the depth and the size of a fault from the flags of its taxels, and keeps
// it where its size matters.
void Detectors::keep(Fault fault, const std::map<std::size_t, Flags>& flags) {
  double hit = 0, all = 0, lost = 0, lost_of = 0, square = 0;
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    const VisitCourses& visit = courses_[v];
    std::vector<std::pair<const std::vector<bool>*, TaxelCourse>> failing;
    for (const auto& [t, of_taxel] : flags) failing.emplace_back(&of_taxel[v], TaxelCourse(visit, t));
    bool before = false;
    for (std::size_t i = 0; i < visit.scans(); ++i) {
      bool now = false;
      for (auto& [fails, course] : failing) {
        if (!(*fails)[i]) continue;
        now = true;
        square += std::pow(course.deviation(i), 2);
        lost -= course.deviation(i);
        lost_of += static_cast<double>(course.expected(i));
      }
      ++all;
      if (now) {
        ++hit;
        if (!before) fault.times.emplace_back(visit.time(i), visit.time(i));
        fault.times.back().second = visit.time(i);
        fault.longest = std::max(fault.longest, visit.time(i) - fault.times.back().first);
      }
      before = now;
    }
  }
  fault.share = hit / std::max(1.0, all);
  fault.depth = lost_of > 0 ? lost / lost_of : 0;
  fault.at_map = range_ * std::sqrt(square / (std::max(1.0, all) * static_cast<double>(flags.size())));
  if (hit == 0 || fault.at_map < least_gap_) return;
  if (fault.isLine() && isLoop(flags)) return;
  for (const auto& [t, of_taxel] : flags) {
    fault.taxels.push_back(t);
    failing_[t] = of_taxel;
    sound_[t] = false;
  }
  faults_.faults.push_back(std::move(fault));
}

simulation::Detector detectorOf(bool rows) {
  return rows ? simulation::Detector::kRowFaults : simulation::Detector::kColumnFaults;
}

Fault faultOf(bool rows, std::size_t line, double p) {
  Fault fault;
  fault.detector = detectorOf(rows);
  fault.id = simulation::foundBy(fault.detector).id;
  fault.line = line;
  fault.p = p;
  return fault;
}

void Detectors::findLines() {
  for (int round = 0; round < 2; ++round) {
    LineFault best;
    bool best_rows = false;
    for (const bool rows : {true, false}) {
      const simulation::Detector detector = detectorOf(rows);
      const auto& faults = faults_.faults;
      if (std::any_of(faults.begin(), faults.end(), [&](const Fault& f) { return f.detector == detector; }))
        continue;
      LineFault found = findLineFault(measured_, courses_, rows, sound_, options_);
      if (!found.found || (best.found && best.p <= found.p)) continue;
      best = std::move(found);
      best_rows = rows;
    }
    if (!best.found) return;
    std::map<std::size_t, Flags> flags;
    for (const std::size_t t : best.taxels) flags[t] = best.failing;
    const std::size_t before = faults_.faults.size();
    keep(faultOf(best_rows, best.line, best.p), flags);
    if (faults_.faults.size() == before) return;
  }
}

// Share of the scans in which one of two taxels fails that both fail in.
double together(const Flags& a, const Flags& b) {
  double both = 0, any = 0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    for (std::size_t i = 0; i < a[v].size(); ++i) {
      both += a[v][i] && b[v][i];
      any += a[v][i] || b[v][i];
    }
  }
  return any > 0 ? both / any : 0;
}

// Taxels that fail together and make up a line have one cause. On a small sheet no permutation of the taxels
// can show this, because so many of them make up a line.
void Detectors::joinLine(bool rows, std::vector<TaxelFault>& found) {
  constexpr std::size_t kFewest = 3;  // taxels of a line
  constexpr double kTogether = 0.5;
  const matrix::Layout& layout = measured_.layout;
  const std::size_t lines = rows ? layout.size.rows : layout.size.columns;
  for (std::size_t line = 0; line < lines; ++line) {
    std::map<std::size_t, Flags> flags;
    std::size_t members = 0;
    double p = 1;
    for (std::size_t t = 0; t < measured_.taxels(); ++t) {
      if (!sound_[t] || (rows ? layout.row({t}) : layout.column({t})) != line) continue;
      ++members;
      for (const TaxelFault& one : found) {
        if (one.taxel != t) continue;
        if (!flags.empty() && together(flags.begin()->second, one.failing) < kTogether) continue;
        flags[t] = one.failing;
        p = std::min(p, one.p);
      }
    }
    if (members < kFewest || flags.size() < members) continue;
    const std::size_t before = faults_.faults.size();
    keep(faultOf(rows, line, p), flags);
    if (faults_.faults.size() == before) continue;
    found.erase(std::remove_if(found.begin(), found.end(),
                               [&](const TaxelFault& one) { return flags.count(one.taxel) > 0; }),
                found.end());
  }
}

void Detectors::findTaxels() {
  std::vector<TaxelFault> found = findTaxelFaults(measured_, courses_, sound_, options_);
  joinLine(true, found);
  joinLine(false, found);
  for (const auto& [kind, detector] :
       {std::pair{TaxelFault::Kind::kStuck, simulation::Detector::kStuckTaxels},
        std::pair{TaxelFault::Kind::kDead, simulation::Detector::kDeadTaxels}}) {
    Fault fault;
    fault.detector = detector;
    fault.id = simulation::foundBy(detector).id;
    std::map<std::size_t, Flags> flags;
    for (const TaxelFault& one : found) {
      if (one.kind != kind) continue;
      flags[one.taxel] = one.failing;
      fault.p = std::min(fault.p, one.p);
    }
    if (!flags.empty()) keep(std::move(fault), flags);
  }
}

void Detectors::judgeReadings() {
  FaultyReadings& readings = faults_.readings;
  std::map<long, std::pair<double, double>> bins;  // sum of squares, number of readings
  std::map<std::string, double> by_surface;
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    const Visit& visit = measured_.visits[v];
    double squares = 0;
    std::vector<TaxelCourse> courses;  // of the failing taxels
    for (const auto& [t, flags] : failing_) courses.emplace_back(courses_[v], t);
    eachScan(v, [&](std::size_t i, std::size_t sample) {
      const bool held_out = measured_.cycles[measured_.cycle[sample]].use == CycleUse::kHoldOut;
      auto& bin =
          bins[static_cast<long>(std::max(0.0, measured_.pressure[sample]) / thresholds::kPressureBin)];
      auto course = courses.begin();
      for (const auto& [t, flags] : failing_) {
        TaxelCourse& of_taxel = *course++;
        bin.second += 1;
        if (!flags[v][i]) continue;
        const double square =
            std::pow(of_taxel.deviation(i) * courses_[v].unit[t], 2);  // [share of full scale]
        bin.first += square;
        squares += square;
        if (held_out) readings.held_out += square;
      }
      readings.readings += static_cast<double>(measured_.taxels());
      if (held_out) readings.held_out_readings += static_cast<double>(measured_.taxels());
    });
    readings.square += squares;
    by_surface[visit.surface.name] += squares;
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

double leastGap(const Measured& measured, const DiscrepancyOptions& options) {
  if (!std::isnan(options.least_gap)) return options.least_gap;
  const auto [low, high] = std::minmax_element(measured.pressure.begin(), measured.pressure.end());
  return options.least_gap_share * (*high - *low);
}

Faults findFaults(const Measured& measured, const DiscrepancyOptions& options,
                  const FaultProgress& progress) {
  return Detectors(measured, options).run(progress);
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
