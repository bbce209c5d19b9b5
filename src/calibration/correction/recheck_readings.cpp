#include "calibration/correction/recheck_readings.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "calibration/calibration_check.h"
#include "calibration/session/session_rests.h"
#include "calibration/temperature/temperature_course.h"
#include "compensation/temperature_state.h"
#include "dataset/count_readers.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

constexpr double kLeastSpan = 0.75;         // of a cycle, share of the trained range
constexpr double kBottom = 0.25;            // share of a cycle's span in which it begins and ends
constexpr std::size_t kSlopeWindows = 256;  // windows of a slope in the full scale

void requireSameBoard(const Calibration& parent, const dataset::Recording& recording) {
  const std::string &serial = recording.sensor.serial, &wanted = parent.sensor.serial;
  if (serial.empty() || wanted.empty() || serial == wanted) return;
  throw settings::InputError(recording.name + ": is of the sensor with the serial number \"" + serial +
                             "\", but calibration " + parent.id + " was trained with \"" + wanted +
                             "\"; recheck the same sensor, or train anew");
}

std::string namesOf(const std::vector<dataset::ConditionCoverage>& conditions) {
  std::string names;
  for (const auto& one : conditions) names += (names.empty() ? "" : ", ") + one.condition.surface;
  return names;
}

bool isTrained(const Calibration& parent, const dataset::CurvatureClass& surface) {
  const auto same = [&](const dataset::ConditionCoverage& trained) {
    if (parent.tables.scheme == compensation::Scheme::kPerSurface)
      return trained.condition.surface == surface.surface;
    for (std::size_t i = 0; i < parent.layout.size.taxels(); ++i) {
      if (!(std::abs(trained.condition.at(i) - surface.at(i)) <= dataset::kSameClassCurvature)) return false;
    }
    return true;
  };
  return std::any_of(parent.coverage.conditions.begin(), parent.coverage.conditions.end(), same);
}

void requireTrainedSurface(const Calibration& parent, const dataset::Recording& recording,
                           const dataset::CurvatureClass& surface) {
  if (isTrained(parent, surface)) return;
  throw settings::InputError(recording.name + ": the surface \"" + surface.surface +
                             "\" is not one that calibration " + parent.id +
                             " was trained on; recheck on one of " + namesOf(parent.coverage.conditions));
}

std::vector<AnswerTable> answersOn(const Calibration& parent, const matrix::Surface& surface) {
  Calibrator calibrator(parent.tables, parent.layout);
  calibrator.setSurface(surface, 0);
  const std::size_t taxels = parent.layout.size.taxels(), codes = parent.tables.full_scale + 1u;
  std::vector<AnswerTable> answers(taxels);
  std::vector<std::uint16_t> scan(taxels);
  map::PressureMap map;
  for (AnswerTable& answer : answers) answer.pressure.resize(codes), answer.deviation.resize(codes);
  for (std::size_t code = 0; code < codes; ++code) {
    std::fill(scan.begin(), scan.end(), static_cast<std::uint16_t>(code));
    calibrator.calibrate({parent.layout.size, parent.tables.full_scale, scan.data(), taxels}, 0, map);
    for (std::size_t i = 0; i < taxels; ++i) {
      answers[i].pressure[code] = map.pressure[i];
      answers[i].deviation[code] = map.deviation[i];
    }
  }
  for (AnswerTable& answer : answers) {
    if (std::isnan(answer.pressure.front())) answer = {};
  }
  return answers;
}

// What the tables should answer to each scan [Pa]: the chamber pressure, at T_0 of a model of the
// temperature.
std::vector<double> targetsOf(const Calibration& parent, const dataset::Recording& recording) {
  std::vector<double> targets = recording.pressure;
  const auto& measured = recording.temperature;
  const bool known =
      measured.size() == targets.size() &&
      std::all_of(measured.begin(), measured.end(), [](double one) { return std::isfinite(one); });
  if (!parent.temperature.present() || !known) return targets;
  const std::vector<double> sheet = sheetTemperature(recording, parent.temperature.lag);
  for (std::size_t i = 0; i < targets.size(); ++i)
    targets[i] /= compensation::temperatureFactor(parent.temperature, sheet[i]);
  return targets;
}

class Gathering {
 public:
  explicit Gathering(const Calibration& parent) : parent_(parent), least_(leastCycleSpan(parent)) {
    result_.readings.resize(parent.layout.size.taxels());
    result_.first.assign(parent.layout.size.taxels(), {0});
  }

  void take(const dataset::Recording& recording) {
    requireFit(parent_, recording);
    requireSameBoard(parent_, recording);
    const auto surfaces = dataset::conditionsOf(recording);
    for (const auto& surface : surfaces) requireTrainedSurface(parent_, recording, surface.condition);
    const std::vector<double> targets = targetsOf(parent_, recording);
    const dataset::Sections sections = dataset::divideIntoSections(recording, 2);
    for (std::size_t condition = 0; condition < surfaces.size(); ++condition) {
      takeStay(recording, condition, targets, sections);
    }
  }

  RecheckReadings result() {
    if (result_.cycles() < kLeastCycles) {
      throw settings::InputError("a recheck needs at least " + std::to_string(kLeastCycles) +
                                 " cycles that span " + settings::fixedKilopascals(least_, 0) +
                                 ", a quarter of the trained range, but the bags have " +
                                 std::to_string(result_.cycles()) + "; record more cycles on one surface");
    }
    return std::move(result_);
  }

 private:
  void takeStay(const dataset::Recording& recording, std::size_t condition,
                const std::vector<double>& targets, const dataset::Sections& sections) {
    std::map<std::uint32_t, CycleSpan> spans;
    const auto counts = [&](std::size_t i) {
      return recording.condition[i] == condition && sections.section[i] != dataset::kNoSection;
    };
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (counts(i)) spans[sections.cycle[i]].include(recording.pressure[i]);
    }
    std::map<std::uint32_t, std::uint32_t> number;
    for (const auto& [cycle, span] : spans) {
      if (!span.counts(least_)) continue;
      number[cycle] = static_cast<std::uint32_t>(result_.cycles());
      result_.stay_of_cycle.push_back(result_.stays.size());
    }
    if (number.size() < spans.size()) {
      result_.remarks.push_back(recording.name + ", " + recording.conditions[condition].name + ": " +
                                std::to_string(spans.size() - number.size()) +
                                " cycles are left out, because they are not whole or span less than three "
                                "quarters of the trained range");
    }
    if (number.empty()) return;
    const std::string& name = recording.conditions[condition].name;
    const auto known = std::find(result_.surfaces.begin(), result_.surfaces.end(), name);
    const auto surface = static_cast<std::size_t>(known - result_.surfaces.begin());
    if (known == result_.surfaces.end()) result_.surfaces.push_back(name);
    result_.stays.push_back({surface,
                             recording.conditions[condition].mount,
                             answersOn(parent_, recording.conditions[condition]),
                             {}});
    takeRest(recording, condition, targets);
    dataset::ScanCounts scans(recording);
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (!counts(i)) continue;
      const auto found = number.find(sections.cycle[i]);
      if (found == number.end()) continue;
      takeScan(recording, scans[i], found->second, targets[i]);
    }
    for (std::vector<std::size_t>& first : result_.first) {
      const std::size_t taxel = static_cast<std::size_t>(&first - result_.first.data());
      const auto& readings = result_.readings[taxel];
      while (first.size() <= result_.cycles()) {
        const auto next = static_cast<std::uint32_t>(first.size());
        const auto end = std::find_if(readings.begin() + static_cast<std::ptrdiff_t>(first.back()),
                                      readings.end(), [&](const auto& one) { return one.cycle >= next; });
        first.push_back(static_cast<std::size_t>(end - readings.begin()));
      }
    }
  }

  bool usable(const dataset::Recording& recording, std::size_t taxel, std::uint16_t code) const {
    const bool masked = !recording.mask.empty() && recording.mask[taxel] != 0;
    return !masked && code > 0 && code < parent_.tables.full_scale &&
           !result_.stays.back().answers[taxel].pressure.empty();
  }

  void takeScan(const dataset::Recording& recording, const std::uint16_t* scan, std::uint32_t cycle,
                double target) {
    for (std::size_t taxel = 0; taxel < result_.readings.size(); ++taxel) {
      if (!usable(recording, taxel, scan[taxel])) continue;
      result_.readings[taxel].push_back({scan[taxel], cycle, static_cast<float>(target)});
    }
  }

  void takeRest(const dataset::Recording& recording, std::size_t condition,
                const std::vector<double>& targets) {
    if (!parent_.session_zero.expected()) return;
    const std::vector<std::size_t> scans = restAtStart(recording, condition);
    if (scans.empty()) {
      result_.remarks.push_back(recording.name + ", " + recording.conditions[condition].name +
                                ": does not start with 2 s at rest at the lowest pressure, so that it is "
                                "rechecked without the tare that the calibration expects");
      return;
    }
    auto& rest = result_.stays.back().rest;
    rest.resize(result_.readings.size());
    dataset::ScanCounts counts(recording);
    for (const std::size_t i : scans) {
      const std::uint16_t* const codes = counts[i];
      for (std::size_t taxel = 0; taxel < rest.size(); ++taxel) {
        const std::uint16_t code = codes[taxel];
        if (code < parent_.tables.full_scale && !result_.stays.back().answers[taxel].pressure.empty())
          rest[taxel].push_back({code, 0, static_cast<float>(targets[i])});
      }
    }
  }

  const Calibration& parent_;
  double least_;  // span of a cycle [Pa]
  RecheckReadings result_;
};

}  // namespace

void CycleSpan::include(double pressure) {
  if (empty) first = low = high = pressure;
  empty = false;
  last = pressure;
  low = std::min(low, pressure);
  high = std::max(high, pressure);
}

bool CycleSpan::counts(double least) const {
  const double bottom = low + kBottom * width();
  return !empty && width() >= least && first <= bottom && last <= bottom;
}

double leastCycleSpan(const Calibration& parent) {
  return kLeastSpan * (parent.trained.pressure.high - parent.trained.pressure.low);
}

std::size_t countCycles(const std::vector<double>& pressure, double least, bool& running) {
  const dataset::Cycles cycles = dataset::findCycles(pressure);
  std::size_t number = 0;
  running = false;
  for (std::size_t cycle = 0; cycle < cycles.count(); ++cycle) {
    const std::size_t end = cycle + 1 < cycles.count() ? cycles.first[cycle + 1] : pressure.size();
    CycleSpan span;
    for (std::size_t i = cycles.first[cycle]; i < end; ++i) span.include(pressure[i]);
    running = span.counts(least);
    number += running ? 1 : 0;
  }
  return number;
}

double AnswerTable::at(const std::vector<float>& values, double code) {
  const double limited = std::min(std::max(code, 0.0), double(values.size() - 1));
  const auto below = std::min(static_cast<std::size_t>(limited), values.size() - 2);
  const double share = limited - double(below);
  return values[below] + share * (double(values[below + 1]) - values[below]);
}

double AnswerTable::slopeAt(double code) const {
  const double half = std::max(1.0, double(pressure.size()) / kSlopeWindows);
  const double last = double(pressure.size() - 1);
  const double low = std::min(std::max(code - half, 0.0), last - 1);
  const double high = std::max(std::min(code + half, last), low + 1);
  return (pressureAt(high) - pressureAt(low)) / (high - low);
}

RecheckReadings gatherRecheck(const Calibration& parent, const std::vector<dataset::Recording>& recordings) {
  if (recordings.empty()) throw settings::InputError("there is no bag to recheck with; give one at least");
  Gathering gathering(parent);
  for (const dataset::Recording& recording : recordings) gathering.take(recording);
  return gathering.result();
}

}  // namespace fsr::calibration
