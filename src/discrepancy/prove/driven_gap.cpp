#include "discrepancy/prove/driven_gap.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "dataset/count_readers.h"
#include "discrepancy/fit/signatures.h"
#include "discrepancy/prove/gap.h"

namespace fsr::discrepancy {

namespace {

constexpr double kFlattestSlope = 0.05;  // share of the steepest slope; a flatter curve tells no pressure
constexpr double kBins = 40;             // of pressure, in which readings of different cycles are compared
constexpr double kOfDifferences = 6;     // variance of a second difference of white noise / that of the noise

// Sums over the readings of one hold-out cycle [share of full scale, squared], [Pa^2].
struct Sums {
  double before = 0, after = 0, number = 0;
  double before_pressure = 0, after_pressure = 0, in_pressure = 0;
  double differences = 0, triples = 0;  // of neighbouring scans
  double repeated = 0, compared = 0;    // with other cycles

  void operator+=(const Sums& o) {
    before += o.before, after += o.after, number += o.number;
    before_pressure += o.before_pressure, after_pressure += o.after_pressure, in_pressure += o.in_pressure;
    differences += o.differences, triples += o.triples;
    repeated += o.repeated, compared += o.compared;
  }
};

double rootOfMean(double sum, double number) {
  return number > 0 ? std::sqrt(sum / number) : NAN;
}

// Only the numbers of the gap; intervals, surfaces and sentences are not set.
Gap numbersOf(const Sums& sums, bool explained) {
  Gap numbers;
  numbers.before = rootOfMean(sums.before, sums.number);
  numbers.after = rootOfMean(sums.after, sums.number);
  numbers.before_pressure = rootOfMean(sums.before_pressure, sums.in_pressure);
  numbers.after_pressure = rootOfMean(sums.after_pressure, sums.in_pressure);
  numbers.floor_bracket = {rootOfMean(sums.differences, sums.triples),
                           rootOfMean(sums.repeated, sums.compared)};
  if (numbers.floor_bracket.high < numbers.floor_bracket.low)
    std::swap(numbers.floor_bracket.low, numbers.floor_bracket.high);
  numbers.floor = noiseFloor(numbers.floor_bracket);
  const double open = std::pow(numbers.before, 2) - std::pow(numbers.floor, 2);
  numbers.closed =
      explained && open > 0 ? (std::pow(numbers.before, 2) - std::pow(numbers.after, 2)) / open : NAN;
  return numbers;
}

// Readings at the same surface, direction and pressure.
using Place = std::tuple<std::size_t, int, long>;
struct Mean {
  std::vector<double> sum, number;  // [taxels]
  double squares = 0;               // over all taxels
};

class DrivenGap {
 public:
  DrivenGap(const FitView& fit, const HoldOutView& hold_out, const Trace& slope)
      : fit_(fit),
        hold_out_(hold_out),
        slope_(slope),
        steepest_(slope.maxCoeff()),
        sums_(hold_out.cycles()) {}

  void drive(const simulation::SimulationSettings& simulation, bool after);
  void copyBefore();
  // Sums of the cycles with hold-out scans.
  std::vector<Sums> cycles() const;
  std::vector<SurfaceGap> surfaces() const;

 private:
  void subtract(const std::uint16_t* measured, const std::vector<std::uint16_t>& simulated);
  void addErrors(std::uint32_t sample, bool after);
  void addDifferences(std::size_t recording, std::size_t scan, std::uint32_t sample);
  Place placeOf(std::uint32_t sample, double pressure) const;
  void addToMean(Mean& mean) const;
  void addRepeats();

  const FitView& fit_;
  const HoldOutView& hold_out_;
  const Trace& slope_;
  double steepest_;
  std::vector<Sums> sums_;                               // of each cycle
  std::vector<double> error_, last_, last_but_one_;      // of three scans, [taxels] [share of full scale]
  const std::vector<std::uint8_t>* unmasked_ = nullptr;  // taxels of the present recording
  std::size_t run_ = 0;                                  // consecutive hold-out scans of one cycle so far
  std::map<Place, Mean> fitted_;
  std::map<std::pair<std::size_t, Place>, Mean> held_;  // by cycle
};

void DrivenGap::addErrors(std::uint32_t sample, bool after) {
  Sums& sum = sums_[hold_out_.cycleOf(sample)];
  const double slope = slope_[static_cast<Eigen::Index>(sample)];
  double squares = 0, number = 0;
  for (std::size_t t = 0; t < error_.size(); ++t) {
    if (!(*unmasked_)[t]) continue;
    squares += error_[t] * error_[t];
    ++number;
  }
  (after ? sum.after : sum.before) += squares;
  if (!after) sum.number += number;
  if (slope < kFlattestSlope * steepest_ || slope <= 0) return;
  (after ? sum.after_pressure : sum.before_pressure) += squares / (slope * slope);
  if (!after) sum.in_pressure += number;
}

// Second differences of neighbouring scans: what changes evenly, as a ramp does, is not in them.
void DrivenGap::addDifferences(std::size_t recording, std::size_t scan, std::uint32_t sample) {
  const std::uint32_t before = scan > 0 ? hold_out_.sampleOf(recording, scan - 1) : HoldOutView::kNotInView;
  const bool goes_on =
      before != HoldOutView::kNotInView && hold_out_.cycleOf(before) == hold_out_.cycleOf(sample);
  run_ = goes_on ? run_ + 1 : 1;
  if (run_ >= 3) {
    Sums& sum = sums_[hold_out_.cycleOf(sample)];
    for (std::size_t t = 0; t < error_.size(); ++t) {
      if (!(*unmasked_)[t]) continue;
      sum.differences += std::pow(error_[t] - 2 * last_[t] + last_but_one_[t], 2) / kOfDifferences;
      ++sum.triples;
    }
  }
  std::swap(last_but_one_, last_);
  last_ = error_;
}

Place DrivenGap::placeOf(std::uint32_t sample, double pressure) const {
  const std::size_t surface = fit_.classOf(sample);
  const Interval& range = fit_.covered(surface);
  const double width = std::max(1.0, range.high - range.low) / kBins;
  return {surface, fit_.directionOf(sample), std::lround(std::floor((pressure - range.low) / width))};
}

void DrivenGap::drive(const simulation::SimulationSettings& simulation, bool after) {
  error_.resize(hold_out_.taxels());
  std::vector<dataset::ScanCounts> counts;
  for (const dataset::Recording* recording : hold_out_.recordings()) counts.emplace_back(*recording);
  driveRecordings(hold_out_.recordings(), simulation,
                  [&](std::size_t r, std::size_t i, const simulation::SensorChain& chain) {
                    const std::uint32_t held = hold_out_.sampleOf(r, i), fitted = fit_.sampleOf(r, i);
                    const bool is_held = held != HoldOutView::kNotInView;
                    if (!is_held && (after || fitted == FitView::kNotInView)) return;
                    const dataset::Recording& recording = *hold_out_.recordings()[r];
                    unmasked_ = &hold_out_.unmasked(r);
                    subtract(counts[r][i], chain.counts());
                    if (is_held) addErrors(held, after);
                    if (after) return;
                    const Place place = placeOf(is_held ? held : fitted, recording.pressure[i]);
                    addToMean(is_held ? held_[{hold_out_.cycleOf(held), place}] : fitted_[place]);
                    if (is_held) addDifferences(r, i, held);
                  });
  if (!after) addRepeats();
}

void DrivenGap::subtract(const std::uint16_t* measured, const std::vector<std::uint16_t>& simulated) {
  const double full_scale = hold_out_.fullScale();
  for (std::size_t t = 0; t < error_.size(); ++t)
    error_[t] = (static_cast<double>(measured[t]) - simulated[t]) / full_scale;
}

void DrivenGap::addToMean(Mean& mean) const {
  mean.sum.resize(error_.size());
  mean.number.resize(error_.size());
  for (std::size_t t = 0; t < error_.size(); ++t) {
    if (!(*unmasked_)[t]) continue;
    mean.sum[t] += error_[t];
    mean.squares += error_[t] * error_[t];
    ++mean.number[t];
  }
}

// Errors of the hold-out scans about the mean error of the fitted scans at the same place.
void DrivenGap::addRepeats() {
  for (const auto& [key, held] : held_) {
    const auto found = fitted_.find(key.second);
    if (found == fitted_.end()) continue;
    const Mean& fitted = found->second;
    Sums& sum = sums_[key.first];
    sum.repeated += held.squares;
    for (std::size_t t = 0; t < held.sum.size(); ++t) {
      if (fitted.number[t] == 0) continue;
      const double mean = fitted.sum[t] / fitted.number[t];
      sum.repeated += mean * (held.number[t] * mean - 2 * held.sum[t]);
      sum.compared += held.number[t];
    }
  }
}

void DrivenGap::copyBefore() {
  for (Sums& sum : sums_) {
    sum.after = sum.before;
    sum.after_pressure = sum.before_pressure;
  }
}

std::vector<Sums> DrivenGap::cycles() const {
  std::vector<Sums> held;
  for (const Sums& sum : sums_) {
    if (sum.number > 0) held.push_back(sum);
  }
  return held;
}

std::vector<SurfaceGap> DrivenGap::surfaces() const {
  std::vector<std::string> names;  // in order of time
  std::map<std::string, Sums> sums;
  for (std::size_t c = 0; c < sums_.size(); ++c) {
    if (sums_[c].number == 0) continue;
    const std::string& name = hold_out_.surfaceOfCycle(c);
    if (sums.count(name) == 0) names.push_back(name);
    sums[name] += sums_[c];
  }
  std::vector<SurfaceGap> surfaces;
  for (const std::string& name : names) {
    const Sums& sum = sums.at(name);
    surfaces.push_back({name, rootOfMean(sum.before, sum.number), rootOfMean(sum.after, sum.number)});
  }
  return surfaces;
}

}  // namespace

// The short-lag end is the one that calls no effect noise. The mean of a parametric bootstrap can take its
// place.
double noiseFloor(const Interval& bracket) {
  return bracket.low;
}

void measureDrivenGap(const FitView& fit, const HoldOutView& hold_out,
                      const simulation::SimulationSettings& before,
                      const simulation::SimulationSettings& after, const Trace& slope, bool explained,
                      std::uint64_t seed, Gap& gap) {
  gap.left_out = hold_out.leftOut();
  for (std::size_t c = 0; c < fit.classes(); ++c) {
    if (fit.covered(c).low <= fit.covered(c).high) gap.covered.push_back({fit.surfaceOf(c), fit.covered(c)});
  }
  if (hold_out.scans() == 0) return;
  DrivenGap driven(fit, hold_out, slope);
  driven.drive(before, false);
  if (before.taxel_curves == after.taxel_curves) {
    driven.copyBefore();
  } else {
    driven.drive(after, true);
  }
  const std::vector<Sums> cycles = driven.cycles();
  Sums total;
  for (const Sums& cycle : cycles) total += cycle;
  const Gap numbers = numbersOf(total, explained);
  gap.surfaces = driven.surfaces();
  gap.before = numbers.before;
  gap.after = numbers.after;
  gap.floor = numbers.floor;
  gap.floor_bracket = numbers.floor_bracket;
  gap.closed = numbers.closed;
  gap.before_pressure = numbers.before_pressure;
  gap.after_pressure = numbers.after_pressure;
  gap.floor_pressure = gap.before > 0 ? gap.before_pressure * gap.floor / gap.before : NAN;
  if (cycles.size() < 2) return;
  setIntervals(
      cycles.size(), seed,
      [&](const std::vector<std::size_t>& chosen) {
        Sums drawn;
        for (const std::size_t c : chosen) drawn += cycles[c];
        return numbersOf(drawn, explained);
      },
      gap);
}

}  // namespace fsr::discrepancy
