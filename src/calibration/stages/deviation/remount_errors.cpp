#include "calibration/stages/deviation/remount_errors.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "calibration/stages/session/session_rests.h"

namespace fsr::calibration {

namespace {

constexpr double kLoaded = 0.5;  // of the highest pressure on a surface: a mount at rest tells nothing

// The pressures of a model that was trained without a mount, in the form of the tables.
std::vector<compensation::TableEntry> entriesOf(const std::vector<double>& pressure) {
  std::vector<compensation::TableEntry> entries;
  for (const double value : pressure) entries.push_back({static_cast<float>(value), 0.0F});
  return entries;
}

std::vector<compensation::TableEntry> entriesOf(const regression::CodeTable& table) {
  std::vector<compensation::TableEntry> entries;
  for (std::size_t code = 0; code < table.pressure.size(); ++code) {
    entries.push_back({table.pressure[code], table.deviation[code]});
  }
  return entries;
}

// By mount number.
using Peaks = std::map<std::uint32_t, double>;

// The highest pressure of each mount of each class, in the scans that are used [Pa].
std::vector<Peaks> peaksOf(const std::vector<dataset::Recording>& recordings,
                           const dataset::ConditionClasses& classes,
                           const std::vector<dataset::Sections>& sections) {
  std::vector<Peaks> peaks(classes.classes.size());
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (std::size_t i = 0; i < recordings[r].scans(); ++i) {
      if (sections[r].section[i] == dataset::kNoSection) continue;
      const std::size_t condition = recordings[r].condition[i];
      double& peak = peaks[classes.class_of[r][condition]][recordings[r].conditions[condition].mount];
      peak = std::max(peak, recordings[r].pressure[i]);
    }
  }
  return peaks;
}

bool isLoaded(const Peaks& peaks, std::uint32_t mount) {
  double highest = 0;
  for (const auto& [other, peak] : peaks) highest = std::max(highest, peak);
  const auto own = peaks.find(mount);
  return own != peaks.end() && own->second >= kLoaded * highest;
}

}  // namespace

RemountErrors::RemountErrors(const std::vector<dataset::Recording>& recordings,
                             const dataset::ConditionClasses& classes,
                             const std::vector<dataset::Sections>& sections, const SessionZeros& zeros)
    : divided_(sections), mounts_(classes.classes.size()), names_(classes.classes.size()) {
  // [classes], from mount number to 0, 1, ...
  std::vector<std::map<std::uint32_t, std::uint32_t>> number(classes.classes.size());
  const std::vector<Peaks> peaks = peaksOf(recordings, classes, sections);
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (std::size_t c = 0; c < recordings[r].conditions.size(); ++c) {
      const std::size_t k = classes.class_of[r][c];
      const std::uint32_t mount = recordings[r].conditions[c].mount;
      if (!isLoaded(peaks[k], mount)) continue;
      const bool fresh = number[k].emplace(mount, static_cast<std::uint32_t>(number[k].size())).second;
      if (fresh) names_[k].push_back(Session{r, c, k, 0, {}}.name(recordings));
    }
  }
  for (std::size_t k = 0; k < number.size(); ++k) {
    mounts_[k] = number[k].size();
    most_mounts_ = std::max(most_mounts_, mounts_[k]);
  }
  if (!assessable()) return;
  std::vector<dataset::Sections> by_mount = sections;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (std::size_t i = 0; i < recordings[r].scans(); ++i) {
      std::uint32_t& section = by_mount[r].section[i];
      if (section == dataset::kNoSection) continue;
      const std::size_t condition = recordings[r].condition[i], k = classes.class_of[r][condition];
      const auto own = number[k].find(recordings[r].conditions[condition].mount);
      section =
          mounts_[k] > 1 && own != number[k].end() ? own->second : static_cast<std::uint32_t>(most_mounts_);
    }
  }
  scans_ = gatherScans(recordings, classes, by_mount, zeros);
  errors_.resize(recordings.front().layout.size.taxels());
  covered_.resize(errors_.size());
}

bool RemountErrors::leavesOut(const compensation::SchemePlan& plan, std::size_t curvature_class) const {
  return mounts_[curvature_class] > 1 && plan.trainsOn(curvature_class);
}

void RemountErrors::measure(const compensation::SchemePlan& plan, std::size_t taxel,
                            const regression::RegressorOptions& regressor, const Calibration& calibration) {
  if (!assessable()) return;
  const compensation::SectionedReadings readings =
      sectionedReadings(scans_, most_mounts_ + 1, calibration.tables.full_scale, taxel, regressor);
  const auto models =
      compensation::crossValidateScheme(plan, taxel, readings, regressor, regression::HeldOutDeviation::kNo);
  compensation::UnseenErrors& errors = errors_[taxel];
  for (std::size_t k = 0; k < mounts_.size(); ++k) {
    if (!leavesOut(plan, k)) continue;
    const std::size_t model = plan.model_of_class[k];
    const std::vector<compensation::TableEntry> own =
        entriesOf(calibration.tables.table(taxel, calibration.tables.classes.size() == 1 ? 0 : k));
    for (std::size_t mount = 0; mount < mounts_[k]; ++mount) {
      const std::vector<double>& answer = models[model].held_out[mount].pressure;
      if (!answer.empty()) addErrors(readings.sums[k][mount], entriesOf(answer), own, errors);
    }
  }
}

RemountScore RemountErrors::apply(Calibration& calibration) const {
  if (!assessable()) return {};
  const compensation::UnseenDeviation more = compensation::unseenDeviation(errors_);
  if (more.pressure.empty()) return {};
  for (regression::CodeTable& table : calibration.tables.tables) {
    for (std::size_t code = 0; code < table.deviation.size(); ++code) {
      const double pressure = double(table.pressure[code]);
      if (std::isnan(pressure)) continue;
      table.deviation[code] =
          static_cast<float>(std::hypot(double(table.deviation[code]), more.at(pressure)));
    }
  }
  const compensation::UnseenSummary summary = compensation::summaryOf(errors_);
  return {summary.readings, summary.rmse_percent, summary.rmse};
}

std::size_t RemountErrors::units() const {
  std::size_t units = 0;
  for (const std::size_t mounts : mounts_) units += mounts > 1 ? mounts : 0;
  return units;
}

void RemountErrors::cover(const compensation::SchemePlan& plan, std::size_t taxel,
                          const regression::RegressorOptions& regressor, const Calibration& calibration,
                          IntervalTally& intervals) {
  if (!assessable()) return;
  const compensation::SectionedReadings readings =
      sectionedReadings(scans_, most_mounts_ + 1, calibration.tables.full_scale, taxel, regressor);
  const auto models =
      compensation::crossValidateScheme(plan, taxel, readings, regressor, regression::HeldOutDeviation::kNo);
  IntervalTally::Taxel ratios(intervals);
  std::vector<Squares>& squares = covered_[taxel];
  squares.resize(units());
  statistics::ErrorSizes sizes;
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*scans_.recordings, taxel);
  std::size_t first = 0;  // unit of the first mount of the class
  for (std::size_t k = 0; k < mounts_.size(); ++k) {
    if (mounts_[k] < 2) continue;
    const bool left_out = leavesOut(plan, k);
    const regression::CodeTable& own =
        calibration.tables.table(taxel, calibration.tables.classes.size() == 1 ? 0 : k);
    for (const TrainingRun& run : scans_.of_class[k]) {
      if (!left_out || run.section >= mounts_[k]) continue;
      const std::vector<double>& held_out = models[plan.model_of_class[k]].held_out[run.section].pressure;
      if (held_out.empty()) continue;
      const double zero = regression::fromFixed(run.zeroOf(taxel));
      scans_.forEachScan(run, counts, divided_, [&](const TrainingScan& scan) {
        const double answer = held_out[scan.code] - zero;
        const double error = answer - regression::fromFixed(scan.pressure);
        ratios.add(first + run.section, answer, scan.direction,
                   std::abs(error) / double(own.deviation[scan.code]));
        if (!std::isfinite(error)) return;
        squares[first + run.section].sum += error * error;
        ++squares[first + run.section].readings;
        sizes.add(static_cast<float>(error));
      });
    }
    first += mounts_[k];
  }
  intervals.add(taxel, ratios);
  const std::lock_guard<std::mutex> lock(adding_);
  sizes_.merge(sizes);
}

// Sums over the taxels in their order: the result does not depend on the number of threads.
NewMountErrors RemountErrors::newMount() const {
  NewMountErrors errors;
  for (std::size_t level = 0; level < kIntervalLevels.size(); ++level)
    errors.within[level] = sizes_.quantile(kIntervalLevels[level]);
  std::size_t unit = 0;
  for (std::size_t k = 0; k < mounts_.size(); ++k) {
    if (mounts_[k] < 2) continue;
    for (std::size_t mount = 0; mount < mounts_[k]; ++mount, ++unit) {
      Squares all;
      for (const std::vector<Squares>& taxel : covered_) {
        if (taxel.empty()) continue;
        all.sum += taxel[unit].sum;
        all.readings += taxel[unit].readings;
      }
      if (all.readings > 0)
        errors.mounts.push_back({names_[k][mount], std::sqrt(all.sum / static_cast<double>(all.readings))});
    }
  }
  return errors;
}

}  // namespace fsr::calibration
