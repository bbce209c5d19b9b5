#include "calibration/history_check.h"

#include <cmath>
#include <map>

#include "calibration/history_parts.h"
#include "calibration/session/session_check.h"
#include "calibration/temperature/temperature_course.h"
#include "dataset/count_readers.h"
#include "dataset/protocols.h"
#include "fsr_pressure_map/calibration/calibrator.h"

namespace fsr::calibration {

namespace {

constexpr std::size_t kUnsettled = kHistoryParts;  // place of the readings before the model was settled
constexpr std::size_t kFirstProtocol = kUnsettled + 1;

struct Sum {
  std::uint64_t readings = 0, within = 0;
  double static_square = 0, square = 0;  // [Pa^2]
};

class HistoryChecker {
 public:
  HistoryChecker(const Calibration& calibration, const dataset::Protocols& protocols)
      : calibration_(calibration), protocols_(protocols), sums_(kFirstProtocol + protocols.names.size()) {}

  void take(const dataset::Recording& recording, const dataset::Sections& sections,
            const std::vector<std::uint32_t>& protocol) {
    Calibration of_tables = calibration_;
    of_tables.history = {};
    Calibrator with(calibration_), without(of_tables);
    for (Calibrator* calibrator : {&with, &without}) calibrator->setMask(recording.mask);
    std::size_t surface = recording.conditions.size();
    double turned = 0;
    dataset::ScanCounts counts(recording);
    for (std::size_t i = 0; i < recording.scans(); ++i) {
      const double time = recording.time[i];
      if (i == 0 || sections.direction[i] != sections.direction[i - 1] || recording.condition[i] != surface)
        turned = time;
      const matrix::ScanView scan{recording.layout.size, recording.full_scale, counts[i],
                                  recording.layout.size.taxels()};
      if (recording.condition[i] != surface) {
        surface = recording.condition[i];
        const std::vector<float> tare = tareAtStart(calibration_, recording, surface);
        for (Calibrator* calibrator : {&with, &without}) {
          calibrator->setSurface(recording.conditions[surface], time);
          calibrator->setTare(tare);
          if (!tare.empty()) calibrator->markRest();
        }
      }
      for (Calibrator* calibrator : {&with, &without})
        setTemperatureOf(recording, i, calibration_, *calibrator);
      with.calibrate(scan, time, map_);
      without.calibrate(scan, time, static_map_);
      const auto parts = historyPartsOf(sections.direction[i], time - turned);
      add(scan.counts, recording.pressure[i], parts, protocol[i]);
    }
  }

  std::vector<HistoryScore::Part> result() const {
    std::vector<HistoryScore::Part> parts;
    for (std::size_t p = 0; p < sums_.size(); ++p) {
      const Sum& sum = sums_[p];
      if (sum.readings == 0) continue;
      const double n = static_cast<double>(sum.readings);
      parts.push_back({nameOf(p), sum.readings, std::sqrt(sum.static_square / n), std::sqrt(sum.square / n),
                       static_cast<double>(sum.within) / n});
    }
    return parts;
  }

 private:
  std::string nameOf(std::size_t part) const {
    if (part == kUnsettled) return "not settled: static answer";
    return part < kUnsettled ? historyPartName(part) : protocols_.names[part - kFirstProtocol];
  }

  // As in checkCalibration(): limits are no values.
  void add(const std::uint16_t* counts, double pressure, const std::array<std::size_t, 3>& parts,
           std::uint32_t protocol) {
    for (std::size_t i = 0; i < map_.pressure.size(); ++i) {
      const bool no_value = counts[i] == 0 || (map_.flags[i] & map::taxel_flag::kSaturated) != 0;
      if (std::isnan(map_.pressure[i]) || no_value) continue;
      const double before = static_map_.pressure[i] - pressure, error = map_.pressure[i] - pressure;
      const bool within = std::abs(error) <= map_.deviation[i];
      const auto add_to = [&](std::size_t part) {
        ++sums_[part].readings;
        sums_[part].within += within;
        sums_[part].static_square += before * before;
        sums_[part].square += error * error;
      };
      add_to(0);
      if ((map_.flags[i] & map::taxel_flag::kHistoryShort) != 0) {
        add_to(kUnsettled);
        continue;
      }
      for (std::size_t k = 1; k < parts.size(); ++k) {
        if (parts[k] != parts[k - 1]) add_to(parts[k]);
      }
      if (protocol != dataset::Protocols::kOther) add_to(kFirstProtocol + protocol);
    }
  }

  const Calibration& calibration_;
  const dataset::Protocols& protocols_;
  map::PressureMap map_, static_map_;
  std::vector<Sum> sums_;
};

}  // namespace

std::vector<HistoryScore::Part> checkHistory(const Calibration& calibration,
                                             const std::vector<dataset::Recording>& recordings) {
  std::vector<dataset::Sections> sections;
  for (const dataset::Recording& recording : recordings)
    sections.push_back(dataset::divideIntoSections(recording, calibration.folds));
  const dataset::Protocols protocols = dataset::protocolsOf(recordings, sections);
  HistoryChecker checker(calibration, protocols);
  for (std::size_t r = 0; r < recordings.size(); ++r)
    checker.take(recordings[r], sections[r], protocols.of_scan[r]);
  return checker.result();
}

}  // namespace fsr::calibration
