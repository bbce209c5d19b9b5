#include "check/check.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <set>

#include "calibration/sources.h"
#include "calibration/stages/memory/history_stream.h"
#include "calibration/stages/session/session_rests.h"
#include "calibration/stages/session/tare.h"
#include "calibration/stages/temperature/temperature_course.h"
#include "dataset/count_readers.h"
#include "dataset/protocols.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "statistics/error_bins.h"

namespace fsr::check {

namespace {

using calibration::Calibration;
using calibration::HistoryScore;
using dataset::Recording;

constexpr std::uint64_t kLeastReadings = 100;  // of a taxel, before it can be suspicious
// Places of the readings before it was settled: all, loading, unloading.
constexpr std::array<const char*, 3> kUnsettledNames = {"not settled", "not settled, loading",
                                                        "not settled, unloading"};
constexpr std::size_t kUnsettled = calibration::kHistoryParts;
constexpr std::size_t kFirstProtocol = kUnsettled + kUnsettledNames.size();

// Of the readings of one part of the model of the sheet's memory.
struct PartSums {
  CheckedReadings fixed, live;
};

// The live map of a recording: as a node shows it, or without the model of memory or the tare.
struct LiveMap {
  LiveMap(const Calibration& calibration, bool with_tare) : calibrator(calibration), tared(with_tare) {}

  calibration::Calibrator calibrator;
  bool tared;
  map::PressureMap map;

  // A reading without conductance is an upper limit and a saturated one a lower limit; neither has an error.
  // A reading below those of training has one: at a known pressure it shows that the sheet reads less than
  // it did.
  bool hasValue(std::size_t taxel, std::uint16_t count) const {
    const bool limit = count == 0 || (map.flags[taxel] & map::taxel_flag::kSaturated) != 0;
    return !std::isnan(map.pressure[taxel]) && !limit;
  }
};

class Checker {
 public:
  Checker(const Calibration& calibration, const std::vector<Recording>& recordings)
      : calibration_(calibration), static_(calibration), taxels_(calibration.layout.size.taxels()) {
    static_.history = {};
    errors_.range = calibration.trained.pressure;
    for (const Recording& recording : recordings) errors_.bags.emplace_back().name = recording.name;
    if (!calibration.history.present()) return;
    for (const Recording& recording : recordings)
      sections_.push_back(dataset::divideIntoSections(recording, calibration.folds));
    protocols_ = dataset::protocolsOf(recordings, sections_);
    parts_.resize(kFirstProtocol + protocols_.names.size());
  }

  /// `lies_on`: the live maps of the recording before go on, see dataset::sheetLayOn().
  void take(const Recording& recording, std::size_t number, bool lies_on) {
    number_ = number;
    if (!lies_on) {
      first_ns_ = recording.start_ns;
      maps_.clear();
      maps_.emplace_back(calibration_, true);
      if (calibration_.history.present()) maps_.emplace_back(static_, true);
      if (calibration_.session_zero.expected()) maps_.emplace_back(calibration_, false);
    }
    const double start = double(recording.start_ns - first_ns_) * 1e-9;
    for (LiveMap& one : maps_) one.calibrator.setMask(recording.mask);
    std::size_t surface = recording.conditions.size(), checked = 0;  // its place in the result
    double turned = 0;  // when the chamber last changed its direction
    dataset::ScanCounts counts(recording);
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      const bool moved = recording.condition[i] != surface;
      surface = recording.condition[i];
      if (moved) checked = placeOf(recording.conditions[surface].name);
      if (moved && (i > 0 || !lies_on)) setSurface(recording, i, start + recording.time[i]);
      const matrix::ScanView scan{recording.layout.size, recording.full_scale, counts[i], taxels_.size()};
      for (LiveMap& one : maps_) {
        calibration::setTemperatureOf(recording, i, calibration_, one.calibrator);
        one.calibrator.calibrate(scan, start + recording.time[i], one.map);
      }
      add(scan.counts, recording.pressure[i], maps_.front(), errors_.surfaces[checked]);
      if (calibration_.session_zero.expected()) addUntared(scan.counts, recording.pressure[i], maps_.back());
      if (!calibration_.history.present()) continue;
      const dataset::Sections& sections = sections_[number];
      if (i == 0 || moved || sections.direction[i] != sections.direction[i - 1]) turned = recording.time[i];
      addParts(scan.counts, recording.pressure[i], maps_[0], maps_[1],
               calibration::historyPartsOf(sections.direction[i], recording.time[i] - turned),
               protocols_.of_scan[number][i]);
    }
    noteFailed(maps_.front().calibrator.watch().flags());
  }

  MapErrors result(const MapLimits& limits) const {
    MapErrors errors = errors_;
    for (std::size_t level = 0; level < errors.within.size(); ++level)
      errors.within[level] = sizes_.quantile(calibration::kIntervalLevels[level]);
    for (std::size_t i = 0; i < taxels_.size(); ++i) {
      const CheckedReadings& taxel = taxels_[i];
      if (taxel.readings >= kLeastReadings && taxel.rmse() > limits.taxel_ratio * taxel.expectedRmse())
        errors.suspicious.push_back(i);
    }
    errors.dead.assign(dead_.begin(), dead_.end());
    errors.stuck.assign(stuck_.begin(), stuck_.end());
    for (std::size_t part = 0; part < parts_.size(); ++part) addPart(part, errors.history);
    noteTare(errors);
    return errors;
  }

 private:
  std::size_t placeOf(const std::string& surface) {
    const auto found = std::find_if(errors_.surfaces.begin(), errors_.surfaces.end(),
                                    [&](const CheckedReadings& one) { return one.name == surface; });
    if (found != errors_.surfaces.end()) return static_cast<std::size_t>(found - errors_.surfaces.begin());
    errors_.surfaces.emplace_back().name = surface;
    return errors_.surfaces.size() - 1;
  }

  // `time`: in the time of the live maps [s].
  void setSurface(const Recording& recording, std::size_t scan, double time) {
    const std::size_t condition = recording.condition[scan];
    const matrix::Surface& surface = recording.conditions[condition];
    std::vector<float> offset;
    if (calibration_.session_zero.expected()) {
      offset = calibration::tareAtStart(calibration_, recording, condition);
      if (offset.empty())
        not_tared_.insert(recording.name + ", " + surface.name + ": not tared, because " +
                          calibration::whyNoRest(recording, condition));
    }
    for (LiveMap& one : maps_) {
      one.calibrator.setSurface(surface, time);
      if (!one.tared) continue;
      one.calibrator.setTare(offset);
      if (!offset.empty()) one.calibrator.markRest();
    }
  }

  void add(const std::uint16_t* counts, double pressure, const LiveMap& live, CheckedReadings& surface) {
    for (std::size_t i = 0; i < taxels_.size(); ++i) {
      if (!live.hasValue(i, counts[i])) continue;
      const double error = live.map.pressure[i] - pressure;
      for (CheckedReadings* one : {&errors_.whole, &surface, &errors_.bags[number_], &taxels_[i]})
        one->add(error, live.map.deviation[i], live.map.flags[i]);
      sizes_.add(static_cast<float>(error));
    }
  }

  void addUntared(const std::uint16_t* counts, double pressure, const LiveMap& live) {
    for (std::size_t i = 0; i < taxels_.size(); ++i) {
      if (live.hasValue(i, counts[i])) untared_.add(live.map.pressure[i] - pressure, 0);
    }
  }

  void addParts(const std::uint16_t* counts, double pressure, const LiveMap& live, const LiveMap& fixed,
                const std::array<std::size_t, 3>& parts, std::uint32_t protocol) {
    for (std::size_t i = 0; i < taxels_.size(); ++i) {
      if (!live.hasValue(i, counts[i])) continue;
      const double before = fixed.map.pressure[i] - pressure, error = live.map.pressure[i] - pressure;
      const auto add_to = [&](std::size_t part) {
        parts_[part].fixed.add(before, 0);
        parts_[part].live.add(error, live.map.deviation[i]);
      };
      add_to(0);
      if ((live.map.flags[i] & map::taxel_flag::kHistoryShort) != 0) {
        add_to(kUnsettled);
        if (parts[1] < kUnsettledNames.size()) add_to(kUnsettled + parts[1]);  // its direction is known
        continue;
      }
      for (std::size_t k = 1; k < parts.size(); ++k) {
        if (parts[k] != parts[k - 1]) add_to(parts[k]);
      }
      if (protocol != dataset::Protocols::kOther) add_to(kFirstProtocol + protocol);
    }
  }

  void addPart(std::size_t part, std::vector<HistoryScore::Part>& history) const {
    const CheckedReadings& live = parts_[part].live;
    if (live.readings == 0) return;
    const std::string name = part >= kFirstProtocol ? protocols_.names[part - kFirstProtocol]
                             : part >= kUnsettled   ? kUnsettledNames[part - kUnsettled]
                                                    : calibration::historyPartName(part);
    history.push_back({name, live.readings, parts_[part].fixed.rmse(), live.rmse(), live.share(live.within)});
  }

  void noteFailed(const std::vector<std::uint16_t>& flags) {
    for (std::size_t i = 0; i < flags.size(); ++i) {
      if ((flags[i] & map::taxel_flag::kDead) != 0) dead_.insert(i);
      if ((flags[i] & map::taxel_flag::kStuck) != 0) stuck_.insert(i);
    }
  }

  void noteTare(MapErrors& errors) const {
    if (!calibration_.session_zero.expected()) return;
    errors.rmse_without_tare = untared_.rmse();
    errors.remarks.push_back(
        "each session is checked with a tare at its start, as the calibration expects; without it the RMSE "
        "is " +
        settings::fixedPressure(errors.rmse_without_tare, 1));
    errors.not_tared.assign(not_tared_.begin(), not_tared_.end());
    errors.remarks.insert(errors.remarks.end(), not_tared_.begin(), not_tared_.end());
  }

  const Calibration& calibration_;
  Calibration static_;                       // the same without a model of memory
  std::deque<LiveMap> maps_;                 // of this recording; a calibrator does not move
  std::size_t number_ = 0;                   // of this recording
  std::int64_t first_ns_ = 0;                // of the first recording that the maps saw
  std::vector<dataset::Sections> sections_;  // [recordings], for that model
  dataset::Protocols protocols_;             // likewise
  MapErrors errors_;
  CheckedReadings untared_;
  statistics::ErrorSizes sizes_;  // of the errors [Pa]
  std::vector<CheckedReadings> taxels_;
  std::vector<PartSums> parts_;
  std::set<std::size_t> dead_, stuck_;
  std::set<std::string> not_tared_;  // a sentence for each session
};

std::string allowed(const std::string& limit) {
  return " (allowed: " + limit + ")";
}

void judge(const CheckedReadings& checked, double range, const MapLimits& limits,
           std::vector<std::string>& faults) {
  const std::string where = checked.name.empty() ? "" : "on " + checked.name + " ";
  if (checked.readings == 0) return;
  const double beyond = checked.share(checked.beyond), bias = checked.bias();
  if (beyond > limits.beyond_share) {
    faults.push_back(where + settings::percentText(beyond) +
                     " of the readings are outside the range of training" +
                     allowed(settings::percentText(limits.beyond_share)));
  }
  if (checked.rmse() > limits.rmse_ratio * checked.expectedRmse()) {
    faults.push_back(where + "errors are " + settings::fixedText(checked.rmse() / checked.expectedRmse(), 2) +
                     " times the expected ones (RMSE " + settings::fixedPressure(checked.rmse(), 1) +
                     ", expected " + settings::fixedPressure(checked.expectedRmse(), 1) +
                     "; allowed: " + settings::fixedText(limits.rmse_ratio, 2) + " times)");
  }
  if (std::abs(bias) > limits.bias_share * range) {
    faults.push_back(where + "maps are " + settings::fixedPressure(std::abs(bias), 1) +
                     (bias > 0 ? " above" : " below") + " the chamber pressure on average, " +
                     settings::percentText(std::abs(bias) / range) + " of the range" +
                     allowed(settings::percentText(limits.bias_share)));
  }
}

void judgeTaxels(const Calibration& calibration, const MapLimits& limits, MapErrors& errors) {
  const matrix::Layout& layout = calibration.layout;
  const std::string larger = "errors more than " + settings::fixedText(limits.taxel_ratio, 1) +
                             " times the expected ones: " + placesText(errors.suspicious, layout);
  if (double(errors.suspicious.size()) > limits.taxel_share * double(layout.size.taxels())) {
    errors.faults.push_back(std::to_string(errors.suspicious.size()) + " taxels (row, column) have " +
                            larger);
  } else if (!errors.suspicious.empty()) {
    errors.remarks.push_back("taxels (row, column) with " + larger);
  }
  if (!errors.dead.empty()) errors.faults.push_back("taxels are dead: " + placesText(errors.dead, layout));
  if (!errors.stuck.empty()) errors.faults.push_back("taxels are stuck: " + placesText(errors.stuck, layout));
}

std::string memoryNotShown(const Calibration& calibration, double not_settled) {
  std::string text =
      "the sheet's memory: " + settings::percentText(not_settled) + " of the readings were not settled";
  const std::vector<HistoryScore::Part>& parts = calibration.scores.history.parts;
  if (!parts.empty()) {
    text += ", so that the RMSE that training found with it on left-out protocols (" +
            settings::fixedPressure(parts.front().rmse, 1) + " instead of " +
            settings::fixedPressure(parts.front().static_rmse, 1) + ") was not seen";
  }
  return text + "; give a bag that begins at rest, or one with wide changes of load";
}

void noteWhatIsNotShown(const Calibration& calibration, const std::vector<Recording>& recordings,
                        MapErrors& errors) {
  constexpr double kMost = 0.5;    // of the readings: their RMSE is then that of the others
  constexpr double kLoaded = 0.9;  // of the trained pressures, as in the coverage of a training
  const double unsettled = errors.whole.share(errors.whole.unsettled);
  if (calibration.history.present() && unsettled > kMost)
    errors.not_shown.push_back(memoryNotShown(calibration, unsettled));
  double highest = 0;
  for (const Recording& recording : recordings) {
    for (const double pressure : recording.pressure) highest = std::max(highest, pressure);
  }
  if (highest >= kLoaded * errors.range.high) return;
  errors.not_shown.push_back("pressures of " + settings::fixedText(highest / 1000, 0) + " to " +
                             settings::fixedText(errors.range.high / 1000, 0) +
                             " kPa: the bags do not reach them");
}

}  // namespace

std::string placesText(const std::vector<std::size_t>& taxels, const matrix::Layout& layout) {
  constexpr std::size_t kListed = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(taxels.size(), kListed); ++i) {
    list += (i == 0 ? "(" : ", (") + std::to_string(layout.row({taxels[i]})) + ", " +
            std::to_string(layout.column({taxels[i]})) + ")";
  }
  return taxels.size() > kListed ? list + ", ..." : list;
}

void CheckedReadings::add(double difference, double deviation, std::uint16_t flags) {
  constexpr std::uint16_t kBeyond =
      map::taxel_flag::kReadingExtrapolated | map::taxel_flag::kCurvatureExtrapolated;
  ++readings;
  within += std::abs(difference) <= deviation;
  beyond += (flags & kBeyond) != 0;
  unsettled += (flags & map::taxel_flag::kHistoryShort) != 0;
  error += difference;
  square += difference * difference;
  expected += deviation * deviation;
}

void CheckedReadings::add(const CheckedReadings& more) {
  readings += more.readings;
  within += more.within;
  beyond += more.beyond;
  unsettled += more.unsettled;
  error += more.error;
  square += more.square;
  expected += more.expected;
}

MapErrors errorsOfMap(const Calibration& calibration, const std::vector<Recording>& recordings,
                      const MapLimits& limits) {
  if (recordings.empty())
    throw settings::InputError("there is no bag to check the calibration on; give one at least");
  for (const Recording& recording : recordings) calibration::requireFit(calibration, recording);
  Checker checker(calibration, recordings);
  const std::vector<std::size_t> order = dataset::inOrderOfTime(recordings);
  for (std::size_t k = 0; k < order.size(); ++k)
    checker.take(recordings[order[k]], order[k],
                 k > 0 && dataset::sheetLayOn(recordings[order[k - 1]], recordings[order[k]]));
  MapErrors errors = checker.result(limits);
  if (errors.whole.readings == 0)
    throw settings::InputError("no reading of the bags gives a pressure; is every taxel masked?");
  const double range = errors.range.high - errors.range.low;
  judge(errors.whole, range, limits, errors.faults);
  for (const CheckedReadings& checked : errors.surfaces) judge(checked, range, limits, errors.faults);
  judgeTaxels(calibration, limits, errors);
  for (const Recording& recording : recordings) {
    const std::string &serial = recording.sensor.serial, &trained = calibration.sensor.serial;
    if (!serial.empty() && !trained.empty() && serial != trained) {
      errors.faults.push_back(recording.name + " is of sensor " + serial +
                              ", but the calibration was made with " + trained);
    }
  }
  noteWhatIsNotShown(calibration, recordings, errors);
  return errors;
}

}  // namespace fsr::check
