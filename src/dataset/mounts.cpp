#include "dataset/mounts.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "dataset/count_readers.h"
#include "dataset/protocols.h"
#include "dataset/sections.h"
#include "fsr_pressure_map/statistics/metrics.h"
#include "matrix/for_each_taxel.h"
#include "settings/number_text.h"
#include "statistics/samples.h"

namespace fsr::dataset {

namespace {

constexpr double kNight = 8;  // [h]

double hoursBetween(const Recording& first, const Recording& second) {
  const double end = first.time.empty() ? 0 : first.time.back();
  return (1e-9 * (static_cast<double>(second.start_ns) - static_cast<double>(first.start_ns)) - end) / 3600;
}

}  // namespace

std::vector<MountRemark> remarksOnMounts(const std::vector<Recording>& recordings) {
  using Mount = std::pair<std::string, std::uint32_t>;
  std::map<Mount, std::size_t> last;  // the recording before, on each mount
  std::set<Mount> told;
  std::vector<MountRemark> remarks;
  for (const std::size_t r : inOrderOfTime(recordings)) {
    for (const matrix::Surface& surface : recordings[r].conditions) {
      const Mount mount{surface.name, surface.mount};
      if (surface.mount == 0 || surface.name.empty()) continue;
      const auto before = last.find(mount);
      const double hours = before == last.end() ? 0 : hoursBetween(recordings[before->second], recordings[r]);
      if (hours >= kNight && told.insert(mount).second) {
        remarks.push_back(
            {r, surface.name + ", mount " + std::to_string(surface.mount) + ": " + recordings[r].name +
                    " begins " + settings::fixedText(hours, 0) + " h after the end of " +
                    recordings[before->second].name +
                    "; if the matrix was taken off in between, these are two mounts under one "
                    "number, and the stated error of another mount leaves their difference out"});
      }
      last[mount] = r;
    }
  }
  return remarks;
}

namespace {

constexpr double kMayBeChance = 0.5;  // what is less likely than not without a mistake is told
constexpr double kNoLevel = std::numeric_limits<double>::quiet_NaN();
// The lowest bin is left out: near rest the reading hardly depends on the pressure.
constexpr std::size_t kBins = statistics::kPressureBins - 1;
constexpr std::size_t kCells = 2 * kBins;  // loading, then unloading
constexpr std::uint32_t kNoCell = 0xffffffff;
constexpr std::size_t kCodeBins = 64;    // of the curve that all mounts share
constexpr std::uint64_t kFewScans = 10;  // a second at the usual rate; fewer do not tell a cell's mean

struct ComparedMount {
  std::string surface;
  std::uint32_t number = 0;
  std::size_t recording = 0;          // the first with it
  std::array<double, kBins> level{};  // pressure at equal readings beyond the surface's first mount [Pa]
  bool in_doubt = false;              // stands out, or is the other of two that differ
};

// The mounts of the recordings, and of each scan the number of its cell: mount, direction and pressure bin.
struct MountCells {
  std::vector<ComparedMount> mounts;
  std::vector<std::vector<std::uint32_t>> cell;  // [recordings][scans]
};

struct CellMean {
  double sum = 0;
  std::uint64_t scans = 0;

  double value() const { return scans < kFewScans ? kNoLevel : sum / static_cast<double>(scans); }
};

// Of one taxel: what the pressure is beyond the shared curve.
struct BeyondCurve {
  std::vector<double> level;    // [mounts x kBins] [Pa]; NaN = not recorded in both directions
  double half_loop = kNoLevel;  // root mean square of half of unloading minus loading [Pa]
};

bool comparable(const std::vector<Recording>& recordings) {
  const auto fits = [&](const Recording& recording) {
    const Recording& first = recordings.front();
    const auto finite = [](double pressure) { return std::isfinite(pressure); };
    return recording.scans() > 0 && recording.pressure.size() == recording.scans() &&
           recording.layout.size.taxels() == first.layout.size.taxels() &&
           recording.full_scale == first.full_scale && countsAreWhole(recording) &&
           std::all_of(recording.pressure.begin(), recording.pressure.end(), finite);
  };
  return std::all_of(recordings.begin(), recordings.end(), fits);
}

// [scans]; `mount_of`: [conditions].
std::vector<std::uint32_t> cellsOf(const Recording& recording, const std::vector<std::uint32_t>& mount_of) {
  const std::vector<double> rate = pressureRates(recording);
  double fastest = 0;
  for (const double one : rate) fastest = std::max(fastest, std::abs(one));
  std::vector<std::uint32_t> cells(recording.scans(), kNoCell);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t bin = statistics::pressureBin(recording.pressure[i]);
    const std::uint32_t mount = mount_of[recording.condition[i]];
    if (bin == 0 || mount == kNoCell || std::abs(rate[i]) <= kStill * fastest) continue;
    cells[i] = static_cast<std::uint32_t>(mount * kCells + (rate[i] < 0 ? kBins : 0) + bin - 1);
  }
  return cells;
}

MountCells mountCells(const std::vector<Recording>& recordings) {
  MountCells cells;
  std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> index;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    std::vector<std::uint32_t> mount_of;
    for (const matrix::Surface& surface : recordings[r].conditions) {
      if (surface.name.empty() || surface.mount == 0) {
        mount_of.push_back(kNoCell);
        continue;
      }
      const auto next = static_cast<std::uint32_t>(index.size());
      const auto [own, fresh] = index.emplace(std::pair{surface.name, surface.mount}, next);
      if (fresh) cells.mounts.push_back({surface.name, surface.mount, r, {}, false});
      mount_of.push_back(own->second);
    }
    cells.cell.push_back(cellsOf(recordings[r], mount_of));
  }
  return cells;
}

// The curve from reading to pressure of one taxel that all mounts share, so that only what differs is left.
class SharedCurve {
 public:
  explicit SharedCurve(std::uint16_t full_scale) : width_((full_scale + kCodeBins) / kCodeBins) {}

  void add(std::uint16_t code, double pressure) {
    Point& point = points_[code / width_];
    ++point.scans, point.code += code, point.pressure += pressure;
  }
  // After all scans are added.
  void close() {
    for (const Point& point : points_) {
      if (point.scans == 0) continue;
      codes_.push_back(point.code / point.scans), pressures_.push_back(point.pressure / point.scans);
    }
  }
  // Straight between the means of the bins.
  double at(double code) const {
    if (codes_.size() < 2) return 0;
    const auto above = std::upper_bound(codes_.begin() + 1, codes_.end() - 1, code);
    const auto i = static_cast<std::size_t>(above - codes_.begin());
    const double part = (code - codes_[i - 1]) / (codes_[i] - codes_[i - 1]);
    return pressures_[i - 1] + part * (pressures_[i] - pressures_[i - 1]);
  }

 private:
  struct Point {
    double scans = 0, code = 0, pressure = 0;
  };
  std::size_t width_;
  std::array<Point, kCodeBins> points_{};
  std::vector<double> codes_, pressures_;
};

BeyondCurve beyondCurve(const std::vector<Recording>& recordings, const MountCells& cells,
                        std::size_t taxel) {
  std::vector<TaxelCounts> counts = taxelCounts(recordings, taxel);
  const std::uint16_t full_scale = recordings.front().full_scale;
  const auto forEachScan = [&](const auto& work) {
    for (std::size_t r = 0; r < recordings.size(); ++r) {
      for (std::size_t i = 0; i < recordings[r].scans(); ++i) {
        const std::uint32_t cell = cells.cell[r][i];
        if (cell == kNoCell) continue;
        const std::uint16_t code = counts[r][i];
        if (code > 0 && code < full_scale) work(cell, code, recordings[r].pressure[i]);
      }
    }
  };
  SharedCurve curve(full_scale);
  forEachScan([&](std::uint32_t, std::uint16_t code, double pressure) { curve.add(code, pressure); });
  curve.close();
  std::vector<CellMean> means(cells.mounts.size() * kCells);
  forEachScan([&](std::uint32_t cell, std::uint16_t code, double pressure) {
    means[cell].sum += pressure - curve.at(code), ++means[cell].scans;
  });
  BeyondCurve result;
  double squares = 0, filled = 0;
  for (std::size_t i = 0; i < cells.mounts.size() * kBins; ++i) {
    const double loading = means[i / kBins * kCells + i % kBins].value();
    const double unloading = means[i / kBins * kCells + kBins + i % kBins].value();
    result.level.push_back((loading + unloading) / 2);
    if (!std::isfinite(result.level.back())) continue;
    squares += (unloading - loading) * (unloading - loading) / 4;
    ++filled;
  }
  if (filled > 0) result.half_loop = std::sqrt(squares / filled);
  return result;
}

// Fills ComparedMount::level; NaN where a bin cannot be compared. Returns half of the loop of the
// median taxel [Pa].
double compareMounts(const std::vector<Recording>& recordings, MountCells& cells) {
  std::vector<BeyondCurve> taxels(recordings.front().layout.size.taxels());
  matrix::forEachTaxel(taxels.size(), 0, [&](std::size_t taxel) {
    const auto masks = [&](const Recording& recording) {
      return taxel < recording.mask.size() && recording.mask[taxel] != 0;
    };
    if (std::none_of(recordings.begin(), recordings.end(), masks))
      taxels[taxel] = beyondCurve(recordings, cells, taxel);
  });
  const auto unusable = [](const BeyondCurve& taxel) { return !std::isfinite(taxel.half_loop); };
  taxels.erase(std::remove_if(taxels.begin(), taxels.end(), unusable), taxels.end());
  std::map<std::string, std::size_t> first;
  for (std::size_t m = 0; m < cells.mounts.size(); ++m) {
    const std::size_t reference = first.emplace(cells.mounts[m].surface, m).first->second;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      std::vector<double> differences;
      for (const BeyondCurve& taxel : taxels) {
        const double difference = taxel.level[m * kBins + bin] - taxel.level[reference * kBins + bin];
        if (std::isfinite(difference)) differences.push_back(difference);
      }
      cells.mounts[m].level[bin] = statistics::upperMedian(std::move(differences));
    }
  }
  std::vector<double> loops;
  for (const BeyondCurve& taxel : taxels) loops.push_back(taxel.half_loop);
  return statistics::upperMedian(std::move(loops));
}

// The mounts of one surface that are not in doubt, around their mean.
struct MountGroup {
  std::vector<ComparedMount*> mounts;

  double size() const { return static_cast<double>(mounts.size()); }
  // CellMean square over the bins that all of them have, from the mean of all [Pa^2]; NaN = there is none.
  double square(const ComparedMount& mount) const {
    double sum = 0;
    std::size_t bins = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      double mean = 0;
      for (const ComparedMount* const other : mounts) mean += other->level[bin] / size();
      if (!std::isfinite(mean)) continue;
      sum += (mount.level[bin] - mean) * (mount.level[bin] - mean);
      ++bins;
    }
    return bins == 0 ? kNoLevel : sum / static_cast<double>(bins);
  }
};

std::vector<MountGroup> groupsOf(std::vector<ComparedMount>& mounts) {
  std::map<std::string, MountGroup> by_name;
  for (ComparedMount& mount : mounts) {
    if (!mount.in_doubt) by_name[mount.surface].mounts.push_back(&mount);
  }
  std::vector<MountGroup> groups;
  for (auto& [name, group] : by_name) {
    if (group.mounts.size() > 1 && std::isfinite(group.square(*group.mounts.front())))
      groups.push_back(std::move(group));
  }
  return groups;
}

struct StandsOut {
  const MountGroup* group = nullptr;
  ComparedMount* mount = nullptr;
  double distance = 0;   // from the mean of the other mounts of its surface [Pa]
  double usual = 0;      // root mean square of this distance, by the scatter of all other mounts [Pa]
  double by_chance = 1;  // share of recordings without any mistake
};

// The mount that differs most; `mount` is null where chance explains it, or where it is less than `least`
// [Pa].
StandsOut mostDifferent(const std::vector<MountGroup>& groups, double least) {
  double all = 0, freedom = -1, compared = 0;  // the mount itself takes one degree of freedom
  for (const MountGroup& group : groups) {
    for (const ComparedMount* const mount : group.mounts) all += group.square(*mount);
    freedom += group.size() - 1;
    compared += group.size() == 2 ? 1 : group.size();  // two mounts have one difference
  }
  StandsOut most;
  if (freedom < 1) return most;
  double highest = 0;
  for (const MountGroup& group : groups) {
    const double others = group.size() / (group.size() - 1);
    for (ComparedMount* const mount : group.mounts) {
      const double own = group.square(*mount) * others;
      const double scatter = std::max(0.0, all - own) / freedom;
      if (own <= highest * scatter || std::sqrt(own * others) < least) continue;
      highest = own / scatter;
      most = {&group, mount, std::sqrt(own * others), std::sqrt(scatter * others)};
    }
  }
  const double p = 2 * boost::math::cdf(boost::math::students_t(freedom), -std::sqrt(highest));
  most.by_chance = p * compared;
  if (!(most.by_chance < kMayBeChance)) most.mount = nullptr;
  return most;
}

std::string distanceText(double pressure) {
  return settings::fixedText(pressure / 1e3, 1) + " kPa";
}

MountRemark remarkOn(const StandsOut& found, const std::vector<Recording>& recordings) {
  const auto nameOf = [&](const ComparedMount& mount) {
    return "mount " + std::to_string(mount.number) + " (" + recordings[mount.recording].name + ")";
  };
  const std::vector<ComparedMount*>& all = found.group->mounts;
  std::string usual = ", mounts of one surface usually by " + distanceText(found.usual);
  if (found.by_chance >= kCertain)
    usual += " (by chance in " + settings::fixedText(100 * found.by_chance, 0) + " % of such sessions)";
  if (all.size() == 2)
    return {all[1]->recording,
            all[0]->surface + ": " + nameOf(*all[0]) + " and " + nameOf(*all[1]) + " differ by " +
                distanceText(found.distance) + usual +
                "; two mounts, either may be wrong: see whether both lay on the surface that was declared",
            found.by_chance};
  return {found.mount->recording,
          found.mount->surface + ": " + nameOf(*found.mount) + " differs by " + distanceText(found.distance) +
              " from the other " + std::to_string(all.size() - 1) + " mounts of this surface" + usual +
              ": see whether it lay on the surface that was declared",
          found.by_chance};
}

}  // namespace

std::vector<MountRemark> remarksOnDifferingMounts(const std::vector<Recording>& recordings) {
  std::vector<MountRemark> remarks;
  if (recordings.empty() || !comparable(recordings)) return remarks;
  MountCells cells = mountCells(recordings);
  std::set<std::string> surfaces;
  for (const ComparedMount& mount : cells.mounts) surfaces.insert(mount.surface);
  if (cells.mounts.size() < surfaces.size() + 2) return remarks;  // no scatter is known
  const double half_loop = compareMounts(recordings, cells);
  while (true) {
    const std::vector<MountGroup> groups = groupsOf(cells.mounts);
    const StandsOut found = mostDifferent(groups, half_loop);
    if (found.mount == nullptr) return remarks;
    remarks.push_back(remarkOn(found, recordings));
    if (!remarks.back().certain()) return remarks;
    for (ComparedMount* const mount : found.group->mounts) {
      if (mount == found.mount || found.group->mounts.size() == 2) mount->in_doubt = true;
    }
  }
}

}  // namespace fsr::dataset
