#include "study/study_data.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "calibration/sources.h"
#include "dataset/count_readers.h"
#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "statistics/random_stream.h"

namespace fsr::study {

void ScanList::add(const ScanRun& run) {
  const bool goes_on =
      !runs_.empty() && runs_.back().recording == run.recording && runs_.back().end == run.begin;
  if (goes_on)
    runs_.back().end = run.end;
  else
    runs_.push_back(run);
  scans_ += run.scans();
}

ScanList ScanList::picked(const std::vector<std::uint32_t>& places) const {
  ScanList picked;
  auto run = runs_.begin();
  std::size_t before = 0;  // scans of the list before the run
  for (const std::uint32_t place : places) {
    while (place >= before + run->scans()) before += (run++)->scans();
    picked.add(ScanPlace{run->recording, static_cast<std::uint32_t>(run->begin + (place - before))});
  }
  return picked;
}

bool operator==(const ScanList& a, const ScanList& b) {
  return std::equal(a.runs().begin(), a.runs().end(), b.runs().begin(), b.runs().end(),
                    [](const ScanRun& one, const ScanRun& other) {
                      return one.recording == other.recording && one.begin == other.begin &&
                             one.end == other.end;
                    });
}

namespace {

constexpr std::size_t kFewestTaxels = 3;  // required by Shapiro and Wilk's test

// The requirements on the recordings are those of a calibration.
void requireUsable(const std::vector<dataset::Recording>& recordings, std::size_t sections) {
  calibration::CalibrationOptions options;
  options.scheme = compensation::Scheme::kBaseline;
  options.folds = sections;
  calibration::validate(recordings, options);
}

// Numbers the mounts in order of appearance. A mount is identified by its surface and mount number in all
// recordings. Mount number 0 is unknown: then each condition of each recording counts as a mount.
class MountNumbers {
 public:
  std::uint32_t of(std::size_t recording, std::size_t condition, const matrix::Surface& surface) {
    const bool known = surface.mount != 0;
    const auto key =
        std::make_tuple(surface.name, surface.mount, known ? 0 : recording, known ? 0 : condition);
    return numbers_.emplace(key, static_cast<std::uint32_t>(numbers_.size())).first->second;
  }
  std::size_t count() const { return numbers_.size(); }

 private:
  std::map<std::tuple<std::string, std::uint32_t, std::size_t, std::size_t>, std::uint32_t> numbers_;
};

// Whether the taxel reads more than one count on each class.
bool varies(const StudyData& data, std::size_t taxel) {
  std::vector<dataset::TaxelCounts> counts = dataset::taxelCounts(*data.recordings, taxel);
  return std::all_of(data.scans.begin(), data.scans.end(), [&](const ScanList& scans) {
    if (scans.empty()) return false;
    const ScanRun& start = scans.runs().front();
    const std::uint16_t first = counts[start.recording][start.begin];
    return std::any_of(scans.runs().begin(), scans.runs().end(), [&](const ScanRun& run) {
      dataset::TaxelCounts& own = counts[run.recording];
      for (std::uint32_t i = run.begin; i < run.end; ++i)
        if (own[i] != first) return true;
      return false;
    });
  });
}

void chooseTaxels(const std::vector<dataset::Recording>& recordings, StudyData& data) {
  const std::vector<std::uint8_t> masked = calibration::unionOfMasks(recordings, data.matrix_taxels);
  std::string constant;
  for (std::size_t taxel = 0; taxel < data.matrix_taxels; ++taxel) {
    if (masked[taxel] != 0) continue;
    if (varies(data, taxel)) {
      data.taxels.push_back(taxel);
    } else {
      constant += (constant.empty() ? "" : ", ") + std::to_string(taxel);
    }
  }
  if (data.taxels.empty()) {
    for (std::size_t c = 0; data.scans.size() > 1 && c < data.scans.size(); ++c) {
      if (data.scans[c].size() > 1) continue;
      throw settings::InputError(
          "\"" + data.classes[c].surface + "\" has " + std::to_string(data.scans[c].size()) +
          " scan, but the study needs several in each section; record it again or leave it out");
    }
    throw settings::InputError(
        recordings.front().name +
        ": every taxel is masked or reads the same count during a whole condition; is the matrix connected?");
  }
  if (data.taxels.size() < kFewestTaxels) {
    throw settings::InputError(recordings.front().name + ": the matrix has " +
                               std::to_string(data.taxels.size()) +
                               (data.taxels.size() == 1 ? " taxel that changes" : " taxels that change") +
                               ", but the statistical tests need at least 3 taxels");
  }
  if (!constant.empty()) {
    data.warnings.push_back("taxels that read the same count during a whole condition are left out: " +
                            constant);
  }
}

void findRange(StudyData& data) {
  data.lowest = INFINITY;
  data.highest = -INFINITY;
  for (const ScanList& scans : data.scans) {
    scans.forEach([&](const ScanPlace& scan) {
      const double pressure = data.pressure(scan);
      data.lowest = std::min(data.lowest, pressure);
      data.highest = std::max(data.highest, pressure);
    });
  }
}

void addRecording(const dataset::Recording& recording, std::uint32_t number, MountNumbers& mounts,
                  StudyData& data) {
  constexpr std::uint32_t kNone = 0xffffffff;
  const dataset::Sections& sections = data.divided[number];
  std::vector<std::uint32_t>& first_cycle = data.first_cycle.emplace_back(recording.conditions.size());
  for (std::size_t i = 0; i < first_cycle.size(); ++i) {
    first_cycle[i] = static_cast<std::uint32_t>(data.cycles);
    data.cycles += sections.cycles[i];
  }
  std::vector<std::uint32_t>& mount_of = data.mount_of.emplace_back(recording.conditions.size(), kNone);
  for (std::uint32_t i = 0; i < recording.scans(); ++i) {
    if (sections.section[i] == dataset::kNoSection) continue;
    const std::size_t condition = recording.condition[i];
    if (mount_of[condition] == kNone)
      mount_of[condition] = mounts.of(number, condition, recording.conditions[condition]);
    data.scans[data.class_of[number][condition]].add(ScanPlace{number, i});
  }
}

template <typename GroupOf>
Grouping grouped(const StudyData& data, std::size_t groups, GroupOf group_of) {
  Grouping grouping{groups, {}};
  for (const ScanList& scans : data.scans) {
    std::vector<ScanList> lists(groups);
    scans.forEach([&](const ScanPlace& scan) {
      const std::size_t group = group_of(scan);
      if (group < groups) lists[group].add(scan);
    });
    grouping.scans.push_back(std::move(lists));
  }
  return grouping;
}

}  // namespace

std::size_t StudyData::scanCount() const {
  std::size_t count = 0;
  for (const ScanList& of_class : scans) count += of_class.size();
  return count;
}

std::size_t StudyData::flatClass() const {
  const auto flat = std::find_if(classes.begin(), classes.end(), dataset::isFlat);
  if (flat == classes.end()) {
    throw settings::InputError(
        "the study compares with the flat surface, but there is no recording of a flat surface; add one");
  }
  return static_cast<std::size_t>(flat - classes.begin());
}

StudyData gatherStudyData(const std::vector<dataset::Recording>& recordings, std::size_t sections) {
  requireUsable(recordings, sections);
  const dataset::ConditionClasses pooled = dataset::poolConditions(recordings);
  StudyData data;
  data.classes = pooled.classes;
  data.scans.resize(data.classes.size());
  data.sections = sections;
  data.full_scale = recordings.front().full_scale;
  data.matrix_taxels = recordings.front().layout.size.taxels();
  data.recordings = &recordings;
  data.class_of = pooled.class_of;
  for (const dataset::Recording& recording : recordings)
    data.divided.push_back(dataset::divideIntoSections(recording, sections));
  data.protocols = dataset::protocolsOf(recordings, data.divided);
  MountNumbers mounts;
  for (std::size_t r = 0; r < recordings.size(); ++r)
    addRecording(recordings[r], static_cast<std::uint32_t>(r), mounts, data);
  data.mounts = mounts.count();
  data.warnings = calibration::warningsOf(recordings, data.divided);
  findRange(data);
  chooseTaxels(recordings, data);
  return data;
}

Grouping bySection(const StudyData& data) {
  return grouped(data, data.sections, [&](const ScanPlace& scan) { return data.section(scan); });
}

Grouping byMount(const StudyData& data) {
  return grouped(data, data.mounts, [&](const ScanPlace& scan) { return data.mount(scan); });
}

Grouping byHalfProtocol(const StudyData& data) {
  return grouped(data, 2 * data.protocols.names.size(), [&](const ScanPlace& scan) -> std::size_t {
    return 2 * std::size_t{data.protocol(scan)} + data.cycle(scan) % 2;
  });
}

namespace {

// Draws `kept` of the indices 0 to scans - 1 without replacement (Fisher and Yates); ascending.
std::vector<std::uint32_t> drawn(std::size_t scans, std::size_t kept,
                                 const statistics::RandomStream& stream) {
  std::vector<std::uint32_t> places(scans);
  std::iota(places.begin(), places.end(), 0u);
  for (std::size_t i = 0; i < kept; ++i) {
    const auto left = static_cast<double>(scans - i);
    std::swap(places[i], places[i + static_cast<std::size_t>(stream.uniform(i) * left)]);
  }
  places.resize(kept);
  std::sort(places.begin(), places.end());
  return places;
}

std::vector<std::uint32_t> placesKept(std::size_t scans, std::size_t one_of, DownSampling rule,
                                      const statistics::RandomStream& stream) {
  const std::size_t kept = (scans + one_of - 1) / one_of;
  if (rule == DownSampling::kRandom) return drawn(scans, kept, stream);
  std::vector<std::uint32_t> places(kept);
  const auto begin = static_cast<std::size_t>(stream.uniform(0) * static_cast<double>(scans - kept + 1));
  for (std::size_t i = 0; i < kept; ++i) {
    places[i] = static_cast<std::uint32_t>(rule == DownSampling::kEveryNth ? i * one_of : begin + i);
  }
  return places;
}

}  // namespace

Grouping downSampled(const Grouping& whole, const std::vector<std::size_t>& one_of, DownSampling rule,
                     std::uint64_t seed) {
  Grouping kept{whole.groups, {}};
  for (std::size_t c = 0; c < whole.scans.size(); ++c) {
    std::vector<ScanList> groups(whole.groups);
    for (std::size_t g = 0; g < whole.groups && one_of[c] > 0; ++g) {
      const ScanList& all = whole.scans[c][g];
      const statistics::RandomStream stream =
          statistics::randomStream(seed, "down_sampling_" + std::to_string(one_of[c]), c * whole.groups + g);
      if (all.empty()) continue;
      groups[g] = one_of[c] == 1 ? all : all.picked(placesKept(all.size(), one_of[c], rule, stream));
    }
    kept.scans.push_back(std::move(groups));
  }
  return kept;
}

}  // namespace fsr::study
