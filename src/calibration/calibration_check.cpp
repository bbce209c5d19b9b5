#include "calibration/calibration_check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "calibration/history_check.h"
#include "calibration/session/session_check.h"
#include "calibration/temperature/temperature_course.h"
#include "dataset/count_readers.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "statistics/error_bins.h"

namespace fsr::calibration {

namespace {

constexpr std::uint64_t kLeastReadings = 100;  // of a taxel, before it can be suspicious

// Sums over the readings of one surface, of one taxel, or of all.
struct Sums {
  std::uint64_t readings = 0;
  std::uint64_t within = 0;
  std::uint64_t beyond = 0;
  std::uint64_t not_settled = 0;
  double error = 0;     // [Pa]
  double square = 0;    // [Pa^2]
  double expected = 0;  // of the stated deviations [Pa^2]

  void add(double e, double deviation, std::uint16_t flags) {
    constexpr std::uint16_t kBeyond =
        map::taxel_flag::kReadingExtrapolated | map::taxel_flag::kCurvatureExtrapolated;
    ++readings;
    within += std::abs(e) <= deviation;
    beyond += (flags & kBeyond) != 0;
    not_settled += (flags & map::taxel_flag::kHistoryShort) != 0;
    error += e;
    square += e * e;
    expected += deviation * deviation;
  }
  double rmse() const { return std::sqrt(square / double(readings)); }
  double expectedRmse() const { return std::sqrt(expected / double(readings)); }

  CheckedClass summary(const std::string& name) const {
    CheckedClass result;
    result.name = name;
    result.readings = readings;
    if (readings == 0) return result;
    const auto n = double(readings);
    result.expected_rmse = expectedRmse();
    result.rmse = rmse();
    result.bias = error / n;
    result.within_one_deviation = double(within) / n;
    result.beyond_training = double(beyond) / n;
    result.not_settled = double(not_settled) / n;
    return result;
  }
};

std::string places(const std::vector<std::size_t>& taxels, const matrix::Layout& layout) {
  constexpr std::size_t kListed = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(taxels.size(), kListed); ++i) {
    list += (i == 0 ? "(" : ", (") + std::to_string(layout.row({taxels[i]})) + ", " +
            std::to_string(layout.column({taxels[i]})) + ")";
  }
  return taxels.size() > kListed ? list + ", ..." : list;
}

class Checker {
 public:
  /// `tared`: with a tare at the start of each session, if the calibration expects one.
  Checker(const Calibration& calibration, bool tared)
      : calibration_(calibration), tared_(tared), taxels_(calibration.layout.size.taxels()) {}

  void take(const dataset::Recording& recording) {
    Calibrator calibrator(calibration_);
    calibrator.setMask(recording.mask);
    bags_.push_back({recording.name, {}});
    std::size_t surface = recording.conditions.size();
    dataset::ScanCounts counts(recording);
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      if (recording.condition[i] != surface) {
        surface = recording.condition[i];
        calibrator.setSurface(recording.conditions[surface], recording.time[i]);
        if (tared_) tare(recording, surface, calibrator);
      }
      setTemperatureOf(recording, i, calibration_, calibrator);
      calibrator.calibrate({recording.layout.size, recording.full_scale, counts[i], taxels_.size()},
                           recording.time[i], map_);
      add(counts[i], recording.pressure[i], sumsOf(recording.conditions[surface]));
    }
    noteFaults(calibrator.watch().flags());
  }

  CalibrationCheck result(const CalibrationCheckOptions& options) const {
    CalibrationCheck check;
    check.whole = whole_.summary("");
    for (const std::string& name : order_) check.classes.push_back(surfaces_.at(name).summary(name));
    for (const auto& [name, sums] : bags_) check.bags.push_back(sums.summary(name));
    for (std::size_t level = 0; level < check.within.size(); ++level)
      check.within[level] = sizes_.quantile(kIntervalLevels[level]);
    for (std::size_t i = 0; i < taxels_.size(); ++i) {
      const Sums& sums = taxels_[i];
      if (sums.readings >= kLeastReadings && sums.rmse() > options.taxel_ratio * sums.expectedRmse()) {
        check.suspicious.push_back(i);
      }
    }
    check.dead = dead_;
    check.stuck = stuck_;
    for (const std::string& session : without_rest_) {
      check.remarks.push_back(session +
                              ": does not start with 2 s at rest at the lowest pressure, so that the session "
                              "is checked without the tare that the calibration expects");
    }
    return check;
  }

 private:
  Sums& sumsOf(const matrix::Surface& surface) {
    const auto [place, fresh] = surfaces_.try_emplace(surface.name);
    if (fresh) order_.push_back(surface.name);
    return place->second;
  }

  void tare(const dataset::Recording& recording, std::size_t surface, Calibrator& calibrator) {
    const std::vector<float> offset = tareAtStart(calibration_, recording, surface);
    calibrator.setTare(offset);
    if (!offset.empty()) calibrator.markRest();
    if (offset.empty() && calibration_.session_zero.expected())
      without_rest_.insert(recording.name + ", " + recording.conditions[surface].name);
  }

  // A reading without conductance is an upper limit and a saturated one a lower limit; neither has an error.
  // A reading below those of training has one: at a known pressure it shows that the sheet reads less than it
  // did.
  void add(const std::uint16_t* counts, double pressure, Sums& surface) {
    for (std::size_t i = 0; i < taxels_.size(); ++i) {
      const bool no_value = counts[i] == 0 || (map_.flags[i] & map::taxel_flag::kSaturated) != 0;
      if (std::isnan(map_.pressure[i]) || no_value) continue;
      const double error = map_.pressure[i] - pressure;
      for (Sums* sums : {&whole_, &surface, &bags_.back().second, &taxels_[i]})
        sums->add(error, map_.deviation[i], map_.flags[i]);
      sizes_.add(static_cast<float>(error));
    }
  }

  void noteFaults(const std::vector<std::uint16_t>& flags) {
    for (std::size_t i = 0; i < flags.size(); ++i) {
      if ((flags[i] & map::taxel_flag::kDead) != 0) dead_.push_back(i);
      if ((flags[i] & map::taxel_flag::kStuck) != 0) stuck_.push_back(i);
    }
  }

  const Calibration& calibration_;
  bool tared_;
  map::PressureMap map_;
  Sums whole_;
  statistics::ErrorSizes sizes_;                    // of the errors [Pa]
  std::vector<std::pair<std::string, Sums>> bags_;  // by name
  std::map<std::string, Sums> surfaces_;
  std::vector<std::string> order_;
  std::vector<Sums> taxels_;
  std::vector<std::size_t> dead_, stuck_;
  std::set<std::string> without_rest_;  // sessions
};

void noteTare(const Calibration& calibration, const std::vector<dataset::Recording>& recordings,
              CalibrationCheck& check) {
  if (!calibration.session_zero.expected()) return;
  Checker without(calibration, false);
  for (const dataset::Recording& recording : recordings) without.take(recording);
  check.rmse_without_tare = without.result({}).whole.rmse;
  check.remarks.insert(
      check.remarks.begin(),
      "each session is checked with a tare at its start, as the calibration expects; without "
      "it the RMSE is " +
          settings::fixedKilopascals(check.rmse_without_tare, 1));
}

void judgeClass(const CheckedClass& checked, double range, const CalibrationCheckOptions& options,
                std::vector<std::string>& reasons) {
  const std::string where = checked.name.empty() ? "" : "on " + checked.name + " ";
  if (checked.readings == 0) return;
  if (checked.beyond_training > options.beyond_share) {
    reasons.push_back(where + settings::percentText(checked.beyond_training) +
                      " of the readings are outside the range of training (allowed: " +
                      settings::percentText(options.beyond_share) + ")");
  }
  if (checked.rmse > options.rmse_ratio * checked.expected_rmse) {
    reasons.push_back(where + "errors are " + settings::fixedText(checked.rmse / checked.expected_rmse, 2) +
                      " times the expected ones (RMSE " + settings::fixedKilopascals(checked.rmse, 1) +
                      ", expected " + settings::fixedKilopascals(checked.expected_rmse, 1) +
                      "; allowed: " + settings::fixedText(options.rmse_ratio, 2) + " times)");
  }
  if (std::abs(checked.bias) > options.bias_share * range) {
    reasons.push_back(where + "maps are " + settings::fixedKilopascals(std::abs(checked.bias), 1) +
                      (checked.bias > 0 ? " above" : " below") + " the chamber pressure on average, " +
                      settings::percentText(std::abs(checked.bias) / range) +
                      " of the range (allowed: " + settings::percentText(options.bias_share) + ")");
  }
}

// Readings that are not settled are judged as static answers.
std::string memoryNotShown(const Calibration& calibration, double not_settled) {
  std::string text = "the sheet's memory: " + settings::percentText(not_settled) +
                     " of the readings were not settled and are static answers";
  const std::vector<HistoryScore::Part>& parts = calibration.scores.history.parts;
  if (!parts.empty()) {
    text += ", so that the RMSE that training found with it on left-out protocols (" +
            settings::fixedKilopascals(parts.front().rmse, 1) + " instead of " +
            settings::fixedKilopascals(parts.front().static_rmse, 1) + ") was not seen";
  }
  return text + "; give a bag that begins at rest, or one with wide changes of load after " +
         settings::fixedText(std::ceil(calibration.history.settlingTime()), 0) + " s";
}

// What the calibration promises and the bags cannot show.
std::vector<std::string> notShown(const Calibration& calibration,
                                  const std::vector<dataset::Recording>& recordings,
                                  const CheckedClass& whole) {
  constexpr double kMost = 0.5;    // of the readings: their RMSE is then that of the others
  constexpr double kLoaded = 0.9;  // of the trained pressures, as in the coverage of a training
  std::vector<std::string> sentences;
  if (calibration.history.present() && whole.not_settled > kMost)
    sentences.push_back(memoryNotShown(calibration, whole.not_settled));
  double highest = 0;
  for (const dataset::Recording& recording : recordings) {
    for (const double pressure : recording.pressure) highest = std::max(highest, pressure);
  }
  if (highest < kLoaded * calibration.trained.pressure.high) {
    sentences.push_back("pressures of " + settings::fixedText(highest / 1000, 0) + " to " +
                        settings::fixedText(calibration.trained.pressure.high / 1000, 0) +
                        " kPa: the bags do not reach them");
  }
  return sentences;
}

}  // namespace

void requireMatrix(const Calibration& calibration, const dataset::Recording& recording) {
  if (recording.layout.size == calibration.layout.size &&
      recording.full_scale == calibration.tables.full_scale)
    return;
  throw settings::InputError(
      recording.name + ": has " + matrix::sizeText(recording.layout.size) + " taxels up to " +
      std::to_string(recording.full_scale) + " counts, but the calibration is for " +
      matrix::sizeText(calibration.layout.size) + " up to " + std::to_string(calibration.tables.full_scale));
}

void requireFit(const Calibration& calibration, const dataset::Recording& recording) {
  if (recording.pressure.empty()) {
    throw settings::InputError(recording.name +
                               ": has no chamber_pressure, so there is no reference for the maps; "
                               "without a chamber use check_bag --use socket");
  }
  requireMatrix(calibration, recording);
}

CalibrationCheck checkCalibration(const Calibration& calibration,
                                  const std::vector<dataset::Recording>& recordings,
                                  const CalibrationCheckOptions& options) {
  if (recordings.empty())
    throw settings::InputError("there is no bag to check the calibration on; give one at least");
  Checker checker(calibration, true);
  for (const dataset::Recording& recording : recordings) {
    requireFit(calibration, recording);
    checker.take(recording);
  }
  CalibrationCheck check = checker.result(options);
  if (check.whole.readings == 0)
    throw settings::InputError("no reading of the bags gives a pressure; is every taxel masked?");
  noteTare(calibration, recordings, check);
  if (calibration.history.present()) check.history = checkHistory(calibration, recordings);
  const double range = calibration.trained.pressure.high - calibration.trained.pressure.low;
  const matrix::Layout& layout = calibration.layout;
  judgeClass(check.whole, range, options, check.reasons);
  for (const CheckedClass& checked : check.classes) judgeClass(checked, range, options, check.reasons);
  if (double(check.suspicious.size()) > options.taxel_share * double(layout.size.taxels())) {
    check.reasons.push_back(std::to_string(check.suspicious.size()) +
                            " taxels (row, column) have errors more than " +
                            settings::fixedText(options.taxel_ratio, 1) +
                            " times the expected ones: " + places(check.suspicious, layout));
  } else if (!check.suspicious.empty()) {
    check.remarks.push_back("taxels (row, column) with errors more than " +
                            settings::fixedText(options.taxel_ratio, 1) +
                            " times the expected ones: " + places(check.suspicious, layout));
  }
  if (!check.dead.empty()) check.reasons.push_back("taxels are dead: " + places(check.dead, layout));
  if (!check.stuck.empty()) check.reasons.push_back("taxels are stuck: " + places(check.stuck, layout));
  for (const dataset::Recording& recording : recordings) {
    const std::string& serial = recording.sensor.serial;
    if (!serial.empty() && !calibration.sensor.serial.empty() && serial != calibration.sensor.serial) {
      check.reasons.push_back(recording.name + " is of sensor " + serial +
                              ", but the calibration was made with " + calibration.sensor.serial);
    }
  }
  check.range = calibration.trained.pressure;
  check.not_shown = notShown(calibration, recordings, check.whole);
  check.still_good = check.reasons.empty();
  return check;
}

}  // namespace fsr::calibration
