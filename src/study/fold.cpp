#include "study/fold.h"

#include <algorithm>
#include <set>

#include "dataset/count_readers.h"

namespace fsr::study {

namespace {

// The cells that contain scans.
std::vector<Cell> occupied(const Grouping& grouping) {
  std::vector<Cell> cells;
  for (std::size_t c = 0; c < grouping.scans.size(); ++c) {
    for (std::size_t g = 0; g < grouping.groups; ++g) {
      if (!grouping.scans[c][g].empty()) cells.push_back({c, g});
    }
  }
  return cells;
}

template <typename HeldOut>
Fold foldOf(const std::string& name, const std::vector<Cell>& cells, HeldOut held_out) {
  Fold fold{name, {}, {}};
  for (const Cell& cell : cells) (held_out(cell) ? fold.test : fold.train).push_back(cell);
  return fold;
}

bool everyClassMountedTwice(const Grouping& mounts) {
  return std::all_of(mounts.scans.begin(), mounts.scans.end(), [](const auto& of_class) {
    return std::count_if(of_class.begin(), of_class.end(), [](const auto& list) { return !list.empty(); }) >
           1;
  });
}

}  // namespace

Split leaveSectionOut(const StudyData& data) {
  Split split{"five_sections",
              std::to_string(data.sections) +
                  " sections of each condition, contiguous in time and divided between cycles; each section "
                  "is predicted by the earlier and later ones",
              bySection(data),
              {}};
  const std::vector<Cell> cells = occupied(split.grouping);
  for (std::size_t k = 0; k < data.sections; ++k) {
    split.folds.push_back(
        foldOf("section " + std::to_string(k + 1), cells, [&](const Cell& cell) { return cell.group == k; }));
  }
  return split;
}

Split pastToFuture(const StudyData& data) {
  const std::size_t past = std::max<std::size_t>(1, data.sections * 3 / 5);
  Split split{"past_to_future",
              "the first " + std::to_string(past) + " of " + std::to_string(data.sections) +
                  " sections of each condition predict the later ones",
              bySection(data),
              {}};
  split.folds.push_back(foldOf("later sections", occupied(split.grouping),
                               [&](const Cell& cell) { return cell.group >= past; }));
  return split;
}

Split leaveProtocolOut(const StudyData& data) {
  Split split{kProtocolSplit,
              "each protocol (pace, dwell and peak of the cycles) is predicted by the other protocols",
              byHalfProtocol(data),
              {}};
  const std::vector<Cell> cells = occupied(split.grouping);
  for (std::size_t p = 0; p < data.protocols.names.size(); ++p) {
    Fold fold = foldOf(data.protocols.names[p], cells, [&](const Cell& cell) { return cell.group / 2 == p; });
    // A class that was recorded with this protocol only would be another curvature that is left out.
    const auto alone = [&](const Cell& cell) {
      return std::none_of(fold.train.begin(), fold.train.end(),
                          [&](const Cell& other) { return other.curvature_class == cell.curvature_class; });
    };
    fold.test.erase(std::remove_if(fold.test.begin(), fold.test.end(), alone), fold.test.end());
    if (!fold.test.empty()) split.folds.push_back(fold);
  }
  return split;
}

std::size_t protocolOf(const Fold& fold) {
  return fold.test.front().group / 2;
}

Split leaveCurvatureOut(const StudyData& data) {
  Split split{"leave_curvature_out",
              "each curvature is predicted by models trained on the other curvatures",
              bySection(data),
              {}};
  if (data.classes.size() < 3) return split;
  const std::vector<Cell> cells = occupied(split.grouping);
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    split.folds.push_back(
        foldOf(data.classes[c].surface, cells, [&](const Cell& cell) { return cell.curvature_class == c; }));
  }
  return split;
}

Split leaveMountOut(const StudyData& data) {
  Split split{
      "leave_mount_out", "each mount is predicted by the other mounts of the matrix", byMount(data), {}};
  if (!everyClassMountedTwice(split.grouping)) return split;
  const std::vector<Cell> cells = occupied(split.grouping);
  for (std::size_t mount = 0; mount < data.mounts; ++mount) {
    split.folds.push_back(foldOf("mount " + std::to_string(mount + 1), cells,
                                 [&](const Cell& cell) { return cell.group == mount; }));
  }
  return split;
}

TaxelReadings::TaxelReadings(const StudyData& data, const Grouping& grouping, std::size_t taxel)
    : data_(data), grouping_(grouping), taxel_(taxel) {
  regression::CodeAccumulator accumulator(data.full_scale);
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*data.recordings, taxel);
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    for (std::size_t g = 0; g < grouping.groups; ++g) {
      grouping.scans[c][g].forEach([&](const ScanPlace& scan) {
        accumulator.add(counts[scan.recording][scan.number], data.fixedPressure(scan));
      });
      cells_.push_back(accumulator.take());
    }
  }
}

regression::ClassReadings TaxelReadings::training(const std::vector<Cell>& cells, bool by_samples) const {
  regression::ClassReadings readings;
  readings.full_scale = data_.full_scale;
  if (!by_samples) {
    readings.sums.assign(data_.classes.size(), regression::CodeHistogram(data_.full_scale));
    for (const Cell& part : cells) readings.sums[part.curvature_class].add(cell(part));
    return readings;
  }
  readings.samples.resize(data_.classes.size());
  for (regression::CodeSamples& samples : readings.samples) samples.full_scale = data_.full_scale;
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*data_.recordings, taxel_);
  for (const Cell& part : cells) {
    regression::CodeSamples& samples = readings.samples[part.curvature_class];
    grouping_.scans[part.curvature_class][part.group].forEach([&](const ScanPlace& scan) {
      samples.add(counts[scan.recording][scan.number], data_.fixedPressure(scan));
    });
  }
  return readings;
}

}  // namespace fsr::study
