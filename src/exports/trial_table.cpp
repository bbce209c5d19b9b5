#include "exports/trial_table.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "exports/region_readings.h"
#include "exports/row_table.h"
#include "exports/scan_formats.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/samples.h"

namespace fsr::exports {

namespace {

constexpr double kRelease = 0.5;        // of a step's threshold above the lowest force
constexpr double kShortestStep = 0.1;   // [s]
constexpr double kLongestGap = 1.0;     // between scans, for integrals [s]; as in map::PressureIntegral
constexpr double kShareOfRange = 0.1;   // of the force, for a step's threshold
constexpr double kOutliers = 0.01;      // share of the forces on each side
constexpr char kSeveral[] = "several";  // surfaces or sessions in one recording

std::vector<TableColumn> trialColumns(const std::string& unit) {
  return {
      {"bag", "", "base name of the recording", true},
      {"session", "", "session id, or several", true},
      {"surface", "", "under the matrix, or several", true},
      {"mount", "", "number of the mount"},
      {"region", "", "whole_matrix, or its name in the region file", true},
      {"step", "", "0 = the whole recording; from 1 = steps of the force on the whole matrix"},
      {"begin", "s", "since the first scan", false, 12},
      {"end", "s", "since the first scan", false, 12},
      {"peak", unit, "highest reading of all taxels and scans"},
      {"peak_deviation", unit, "one standard deviation of that reading"},
      {"peak_row", "", "row of its taxel, from 0"},
      {"peak_column", "", "column of its taxel, from 0"},
      {"mean_peak", unit, "mean of the scans' peaks while the region is in contact"},
      {"mean_contact", unit, "mean of the scans' means over the contact area"},
      {"force", "N", "largest force"},
      {"impulse", "N s", "integral of the force over time"},
      {"peak_integral", unit + " s", "integral of the scans' peaks over time"},
      {"contact_time", "s", "time with a taxel in contact"},
      {"time_above", "s", "time with a peak at or above the column `above`"},
      {"contact_area", "cm2", "largest contact area"},
      {"at_least", "", "scans in which a taxel's pressure is at least its reading; above 0, the row is >="},
      {"step_force", "N", "force from which a step counts"},
      {"contact_threshold", unit, "pressure from which a taxel is in contact"},
      {"above", unit, "pressure of time_above"}};
}

// By trapezoids over scans first .. last; gaps and unknown values add nothing.
template <typename Value>
double integral(const std::vector<double>& time, Step step, Value value) {
  double sum = 0;
  for (std::size_t i = step.first; i < step.second; ++i) {
    const double part = 0.5 * (time[i + 1] - time[i]) * (value(i) + value(i + 1));
    if (time[i + 1] - time[i] <= kLongestGap && !std::isnan(part)) sum += part;
  }
  return sum;
}

std::vector<double> known(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }),
               values.end());
  std::sort(values.begin(), values.end());
  return values;
}

// Lowest and highest, without the outliers on each side.
std::pair<double, double> range(const std::vector<double>& sorted) {
  const auto outside = static_cast<std::size_t>(kOutliers * double(sorted.size() - 1));
  return {sorted[outside], sorted[sorted.size() - 1 - outside]};
}

}  // namespace

double stepThreshold(const std::vector<double>& force) {
  const std::vector<double> sorted = known(force);
  if (sorted.empty()) return ScanRecord::kUnknown;
  const auto [low, high] = range(sorted);
  return low + kShareOfRange * (high - low);
}

std::vector<Step> findSteps(const std::vector<double>& force, const std::vector<double>& time,
                            double threshold) {
  std::vector<Step> steps;
  const std::vector<double> sorted = known(force);
  if (sorted.empty() || !(threshold > range(sorted).first)) return steps;
  const double release = range(sorted).first + kRelease * (threshold - range(sorted).first);
  std::size_t first = 0;
  bool within = false;  // a step
  bool rested = false;  // the force has been below since the recording began
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (force[i] <= release) {
      if (within && time[i] - time[first] >= kShortestStep) steps.emplace_back(first, i - 1);
      within = false;
      rested = true;
    } else if (force[i] >= threshold && !within && rested) {
      first = i;
      within = true;
    }
  }
  return steps;
}

namespace {

// A table with one row for each region of a recording, step 0, and one for each step that is found in the
// force on the whole matrix. HDF5 holds units and meanings of the columns. Memory grows by 56 bytes for each
// region and scan.
class TrialTable : public ScanSink {
 public:
  TrialTable(const std::string& path, const StatisticsOptions& options)
      : options_(options),
        factor_(1 / view::pascals(options.unit)),
        reader_(options),
        table_(openRowTable(path, "trial", withSheet(trialColumns(view::name(options.unit)), options))) {}

  void begin(const ExportSubject& subject) override {
    writeRecording();
    reader_.begin(subject);
    bag_ = subject.name;
    sheet_ = subject.sheet;
  }

  void add(const ScanRecord& scan) override {
    const std::vector<RegionReading>& readings = reader_.read(scan);
    if (readings.empty()) return;
    const std::string surface = scan.surface ? scan.surface->name : "";
    const std::uint32_t mount = scan.surface ? scan.surface->mount : 0;
    if (time_.empty()) {
      session_ = scan.session;
      surface_ = surface;
      mount_ = mount;
      layout_ = scan.layout;
      regions_.clear();
      for (const RegionReading& reading : readings) regions_.push_back(regionName(reading.of));
      moments_.assign(readings.size(), {});
    }
    if (session_ != scan.session) session_ = kSeveral;
    if (surface_ != surface) surface_ = kSeveral;
    if (mount_ != mount) mount_.reset();
    time_.push_back(1e-9 * double(scan.since_ns));
    for (std::size_t r = 0; r < readings.size(); ++r) {
      const map::RegionStatistics& of = readings[r].of;
      moments_[r].push_back({of.peak, readings[r].peak_deviation, of.mean, of.force, of.contact_area,
                             of.peak_taxel, of.at_least > 0});
    }
  }

  void finish() override {
    writeRecording();
    table_->finish();
  }

 private:
  struct Moment {  // of a region in a scan
    double peak, peak_deviation, mean, force, area;
    matrix::TaxelIndex taxel;
    bool at_least;
  };

  void writeRecording() {
    if (time_.empty()) return;
    std::vector<double> force;
    for (const Moment& moment : moments_.front()) force.push_back(moment.force);
    if (std::none_of(moments_.front().begin(), moments_.front().end(),
                     [](const Moment& m) { return m.area > 0; }))
      throw settings::InputError(bag_ + ": is a trial without load: no taxel reaches " +
                                 view::pressureText(options_.contact_threshold, options_.unit) +
                                 "; leave it out, or give a lower --contact");
    const double threshold = std::isnan(options_.step_force) ? stepThreshold(force) : options_.step_force;
    std::vector<Step> steps = findSteps(force, time_, threshold);
    steps.insert(steps.begin(), {0, time_.size() - 1});
    for (std::size_t r = 0; r < regions_.size(); ++r)
      for (std::size_t s = 0; s < steps.size(); ++s)
        writeRow(regions_[r], moments_[r], s, steps[s], threshold);
    time_.clear();
  }

  void writeRow(const std::string& region, const std::vector<Moment>& moments, std::size_t number, Step step,
                double step_force) {
    constexpr double kNone = ScanRecord::kUnknown;
    const Moment* highest = nullptr;
    statistics::RunningMoments peaks, means;
    double force = kNone, area = 0, at_least = 0;
    for (std::size_t i = step.first; i <= step.second; ++i) {
      const Moment& moment = moments[i];
      if (!std::isnan(moment.peak) && (highest == nullptr || moment.peak > highest->peak)) highest = &moment;
      force = std::fmax(force, moment.force);
      area = std::max(area, moment.area);
      at_least += moment.at_least;
      if (!(moment.area > 0)) continue;
      peaks.add(moment.peak);
      means.add(moment.mean);
    }
    const auto over = [&](auto value) {
      return integral(time_, step, [&](std::size_t i) { return double(value(moments[i])); });
    };
    table_->add(withSheet(
        {bag_,
         session_,
         surface_,
         mount_.value_or(0) > 0 ? double(*mount_) : kNone,
         region,
         double(number),
         time_[step.first],
         time_[step.second],
         highest ? highest->peak * factor_ : kNone,
         highest ? highest->peak_deviation * factor_ : kNone,
         highest ? double(layout_.row(highest->taxel)) : kNone,
         highest ? double(layout_.column(highest->taxel)) : kNone,
         peaks.count > 0 ? peaks.mean * factor_ : kNone,
         means.count > 0 ? means.mean * factor_ : kNone,
         force,
         over([](const Moment& m) { return m.force; }),
         over([](const Moment& m) { return m.peak; }) * factor_,
         over([](const Moment& m) { return m.area > 0; }),
         std::isnan(options_.above) ? kNone : over([&](const Moment& m) { return m.peak >= options_.above; }),
         area * 1e4,
         at_least,
         step_force,
         options_.contact_threshold * factor_,
         options_.above * factor_},
        sheet_, options_));
  }

  StatisticsOptions options_;
  double factor_;  // of pressures in the table [unit / Pa]
  RegionReader reader_;
  std::unique_ptr<RowTable> table_;
  std::string bag_, sheet_, session_, surface_;
  std::optional<std::uint32_t> mount_;
  matrix::Layout layout_;
  std::vector<double> time_;                  // of each scan [s]
  std::vector<std::string> regions_;          // names
  std::vector<std::vector<Moment>> moments_;  // [regions][scans]
};

}  // namespace

std::unique_ptr<ScanSink> openTrial(const std::string& output, const StatisticsOptions& options) {
  return std::make_unique<TrialTable>(output, options);
}

}  // namespace fsr::exports
