#include <algorithm>
#include <cmath>
#include <map>

#include "calibration/sources.h"
#include "calibration/stages/session/session_rests.h"
#include "calibration/stages/session/tare.h"
#include "calibration/stages/temperature/temperature_course.h"
#include "check/check.h"
#include "check/correction.h"
#include "dataset/count_readers.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "settings/text.h"

namespace fsr::check {

namespace {

using calibration::Calibration;

constexpr double kLeastSpan = 0.75;         // of a cycle, share of the trained range
constexpr double kBottom = 0.25;            // share of a cycle's span in which it begins and ends
constexpr std::size_t kSlopeWindows = 256;  // windows of a slope in the full scale

// Pressures of one cycle [Pa].
struct CycleSpan {
  double first = NAN, last = NAN, low = INFINITY, high = -INFINITY;

  void include(double pressure) {
    if (std::isnan(first)) first = pressure;
    last = pressure;
    low = std::min(low, pressure);
    high = std::max(high, pressure);
  }
  // Whether the cycle counts: its pressures span `least` [Pa], and it begins and ends in the lowest quarter
  // of them. A loading without its unloading would take the sheet's loop for a change.
  bool counts(double least) const {
    const double bottom = low + kBottom * (high - low);
    return high - low >= least && first <= bottom && last <= bottom;
  }
};

void requireSameBoard(const Calibration& parent, const dataset::Recording& recording) {
  const std::string &serial = recording.sensor.serial, &wanted = parent.sensor.serial;
  if (serial.empty() || wanted.empty() || serial == wanted) return;
  throw settings::InputError(recording.name + ": is of the sensor with the serial number \"" + serial +
                             "\", but calibration " + parent.id + " was trained with \"" + wanted +
                             "\"; recheck the same sensor, or train anew");
}

void requireTrainedSurface(const Calibration& parent, const dataset::Recording& recording,
                           const dataset::CurvatureClass& surface) {
  const std::vector<dataset::ConditionCoverage>& trained = parent.coverage.conditions;
  const auto same = [&](const dataset::ConditionCoverage& one) {
    if (parent.tables.scheme == compensation::Scheme::kPerSurface)
      return one.condition.surface == surface.surface;
    for (std::size_t i = 0; i < parent.layout.size.taxels(); ++i) {
      if (!(std::abs(one.condition.at(i) - surface.at(i)) <= dataset::kSameClassCurvature)) return false;
    }
    return true;
  };
  if (std::any_of(trained.begin(), trained.end(), same)) return;
  const auto name = [](const dataset::ConditionCoverage& one) { return one.condition.surface; };
  throw settings::InputError(recording.name + ": the surface \"" + surface.surface +
                             "\" is not one that calibration " + parent.id +
                             " was trained on; recheck on one of " + settings::joinedTexts(trained, name));
}

std::vector<AnswerTable> answersOn(const Calibration& parent, const matrix::Surface& surface) {
  calibration::Calibrator calibrator(parent.tables, parent.layout);
  calibrator.setSurface(surface, 0);
  const std::size_t taxels = parent.layout.size.taxels(), codes = parent.tables.full_scale + 1u;
  std::vector<AnswerTable> answers(taxels);
  std::vector<std::uint16_t> scan(taxels);
  map::PressureMap map;
  for (std::size_t code = 0; code < codes; ++code) {
    std::fill(scan.begin(), scan.end(), static_cast<std::uint16_t>(code));
    calibrator.calibrate({parent.layout.size, parent.tables.full_scale, scan.data(), taxels}, 0, map);
    for (std::size_t i = 0; i < taxels; ++i) {
      answers[i].pressure.push_back(map.pressure[i]);
      answers[i].deviation.push_back(map.deviation[i]);
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
  const std::vector<double> sheet = calibration::sheetTemperature(recording, parent.temperature.lag);
  for (std::size_t i = 0; i < targets.size(); ++i)
    targets[i] /= calibration::temperatureFactor(parent.temperature, sheet[i]);
  return targets;
}

class Gathering {
 public:
  explicit Gathering(const Calibration& parent)
      : parent_(parent), taxels_(parent.layout.size.taxels()), least_(leastCycleSpan(parent)) {}

  void take(const dataset::Recording& recording) {
    calibration::requireFit(parent_, recording);
    requireSameBoard(parent_, recording);
    const auto surfaces = dataset::conditionsOf(recording);
    for (const auto& surface : surfaces) requireTrainedSurface(parent_, recording, surface.condition);
    const std::vector<double> targets = targetsOf(parent_, recording);
    const dataset::Sections sections = dataset::divideIntoSections(recording, 2);
    for (std::size_t condition = 0; condition < surfaces.size(); ++condition)
      takeStay(recording, condition, targets, sections);
  }

  CycleReadings result() {
    if (result_.cycles() < kLeastCycles) {
      throw settings::InputError("a recheck needs at least " + std::to_string(kLeastCycles) +
                                 " cycles that span " + settings::fixedPressure(least_, 0) +
                                 ", three quarters of the trained range, but the bags have " +
                                 std::to_string(result_.cycles()) + "; record more cycles on one surface");
    }
    return std::move(result_);
  }

 private:
  void takeStay(const dataset::Recording& recording, std::size_t condition,
                const std::vector<double>& targets, const dataset::Sections& sections) {
    std::map<std::uint32_t, CycleSpan> spans;
    const auto isOf = [&](std::size_t i) {
      return recording.condition[i] == condition && sections.section[i] != dataset::kNoSection;
    };
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (isOf(i)) spans[sections.cycle[i]].include(recording.pressure[i]);
    }
    std::map<std::uint32_t, std::size_t> number;  // of the cycles that count, among all
    for (const auto& [cycle, span] : spans) {
      if (span.counts(least_)) number.emplace(cycle, result_.cycles() + number.size());
    }
    if (number.size() < spans.size()) {
      result_.remarks.push_back(recording.name + ", " + recording.conditions[condition].name + ": " +
                                std::to_string(spans.size() - number.size()) +
                                " cycles are left out, because they are not whole or span less than three "
                                "quarters of the trained range");
    }
    if (number.empty()) return;
    result_.stay_of_cycle.resize(result_.cycles() + number.size(), result_.stays.size());
    result_.cycle.resize(result_.stay_of_cycle.size(), TaxelReadings(taxels_));
    addStay(recording.conditions[condition]);
    takeRest(recording, condition, targets);
    dataset::ScanCounts scans(recording);
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      const auto found = isOf(i) ? number.find(sections.cycle[i]) : number.end();
      if (found != number.end()) takeScan(recording, scans[i], targets[i], result_.cycle[found->second]);
    }
  }

  void addStay(const matrix::Surface& surface) {
    const auto known = std::find(result_.surfaces.begin(), result_.surfaces.end(), surface.name);
    const auto number = static_cast<std::size_t>(known - result_.surfaces.begin());
    if (known == result_.surfaces.end()) result_.surfaces.push_back(surface.name);
    result_.stays.push_back({number, surface.mount, answersOn(parent_, surface), {}});
  }

  bool hasModel(std::size_t taxel) const { return !result_.stays.back().answers[taxel].pressure.empty(); }

  void takeScan(const dataset::Recording& recording, const std::uint16_t* scan, double target,
                TaxelReadings& readings) const {
    for (std::size_t taxel = 0; taxel < taxels_; ++taxel) {
      const bool masked = !recording.mask.empty() && recording.mask[taxel] != 0;
      if (masked || scan[taxel] == 0 || scan[taxel] >= parent_.tables.full_scale || !hasModel(taxel))
        continue;
      readings[taxel].push_back({scan[taxel], static_cast<float>(target)});
    }
  }

  void takeRest(const dataset::Recording& recording, std::size_t condition,
                const std::vector<double>& targets) {
    if (!parent_.session_zero.expected()) return;
    const std::vector<std::size_t> scans = calibration::restAtStart(recording, condition);
    if (scans.empty()) {
      result_.remarks.push_back(recording.name + ", " + recording.conditions[condition].name +
                                ": not tared, because " + calibration::whyNoRest(recording, condition));
      return;
    }
    TaxelReadings& rest = result_.stays.back().rest;
    rest.resize(taxels_);
    calibration::Calibrator calibrator(parent_.tables, parent_.layout);
    calibrator.setSurface(recording.conditions[condition], 0);
    const std::vector<float> training = calibration::restOfTraining(parent_.session_zero, calibrator);
    dataset::ScanCounts counts(recording);
    for (const std::size_t i : scans) {
      const std::uint16_t* const codes = counts[i];
      for (std::size_t taxel = 0; taxel < taxels_; ++taxel) {
        if (codes[taxel] < parent_.tables.full_scale && hasModel(taxel))
          rest[taxel].push_back({codes[taxel], static_cast<float>(targets[i]) + training[taxel]});
      }
    }
  }

  const Calibration& parent_;
  std::size_t taxels_;
  double least_;  // span of a cycle [Pa]
  CycleReadings result_;
};

}  // namespace

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
  return (at(pressure, high) - at(pressure, low)) / (high - low);
}

CycleReadings gatherCycles(const Calibration& parent, const std::vector<dataset::Recording>& recordings) {
  Gathering gathering(parent);
  for (const dataset::Recording& recording : recordings) gathering.take(recording);
  return gathering.result();
}

}  // namespace fsr::check
