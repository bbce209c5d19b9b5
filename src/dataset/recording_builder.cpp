#include "dataset/recording_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <tuple>

#include "dataset/count_readers.h"
#include "dataset/reference_errors.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "statistics/samples.h"

namespace fsr::dataset {

namespace {

// A bag begins and ends between two chamber readings, so a few such scans are normal.
constexpr std::uint64_t kScansAtTheEnds = 10;

std::string scans(std::uint64_t number) {
  return std::to_string(number) + (number == 1 ? " scan" : " scans");
}

}  // namespace

std::vector<std::string> describeLosses(const RecordingLosses& losses) {
  std::vector<std::string> sentences;
  if (losses.counter_back > 0) {
    sentences.push_back("the board's counter ran backwards " + std::to_string(losses.counter_back) +
                        (losses.counter_back == 1 ? " time" : " times") +
                        ": the board started again, or stamps ran backwards and were sorted");
  }
  if (losses.sequence_gaps > 0) {
    sentences.push_back(std::to_string(losses.sequence_gaps) +
                        (losses.sequence_gaps == 1 ? " gap" : " gaps") + " between scans, " +
                        scans(losses.lost_scans) + " lost by the board's counter");
  }
  if (losses.duplicates > 0) {
    sentences.push_back("dropped " + scans(losses.duplicates) + " with the stamp of another one");
  }
  if (losses.near_change > 0) {
    sentences.push_back("dropped " + scans(losses.near_change) + " within 1 s of a change of surface");
  }
  if (losses.no_reference > kScansAtTheEnds) {
    sentences.push_back("dropped " + scans(losses.no_reference) + " in gaps of chamber_pressure");
  }
  if (losses.bad_reference > 0) {
    sentences.push_back("left out " + std::to_string(losses.bad_reference) +
                        " chamber pressures that are not finite");
  }
  if (losses.reference_spikes > 0) {
    sentences.push_back("left out " + std::to_string(losses.reference_spikes) +
                        " chamber pressures that jump away and back while the sheet feels nothing");
  }
  if (losses.unknown_surface > 0) {
    sentences.push_back("dropped " + scans(losses.unknown_surface) + " on a surface of unknown curvature");
  }
  return sentences;
}

namespace {

bool sameSurface(const matrix::Surface& a, const matrix::Surface& b, double tolerance) {
  if (a.name != b.name || a.mount != b.mount || a.known() != b.known()) return false;
  const std::size_t values = std::max(a.curvature.size(), b.curvature.size());
  for (std::size_t i = 0; i < values; ++i) {
    const matrix::Curvature& left = a.at(matrix::TaxelIndex{i});
    const matrix::Curvature& right = b.at(matrix::TaxelIndex{i});
    const double difference =
        std::max({std::abs(left.x - right.x), std::abs(left.y - right.y), std::abs(left.xy - right.xy)});
    if (!(difference < tolerance)) return false;
  }
  return true;
}

// A total order, so that the order of the calls does not matter for two surfaces with the same stamp.
bool beganBefore(const SurfaceTimeline::Event& a, const SurfaceTimeline::Event& b) {
  const auto key = [](const SurfaceTimeline::Event& event) {
    return std::tie(event.first, event.second.name, event.second.mount);
  };
  if (key(a) != key(b)) return key(a) < key(b);
  return std::lexicographical_compare(
      a.second.curvature.begin(), a.second.curvature.end(), b.second.curvature.begin(),
      b.second.curvature.end(), [](const matrix::Curvature& left, const matrix::Curvature& right) {
        return std::tie(left.x, left.y, left.xy) < std::tie(right.x, right.y, right.xy);
      });
}

}  // namespace

SurfaceTimeline::SurfaceTimeline(std::vector<Event> events, double tolerance) {
  const auto known = [](const Event& event) { return event.second.known(); };
  if (std::none_of(events.begin(), events.end(), known)) {
    events.assign(1, Event{std::numeric_limits<std::int64_t>::min(), matrix::Surface{}});
  }
  std::sort(events.begin(), events.end(), beganBefore);
  for (const auto& [stamp, surface] : events) {
    const std::size_t condition = conditionOf(surface, tolerance);
    if (from_.empty() || from_.back().second != condition) from_.emplace_back(stamp, condition);
  }
}

std::size_t SurfaceTimeline::conditionOf(const matrix::Surface& surface, double tolerance) {
  const auto same = [&](const matrix::Surface& other) { return sameSurface(other, surface, tolerance); };
  const auto found = std::find_if(conditions_.begin(), conditions_.end(), same);
  if (found != conditions_.end()) return static_cast<std::size_t>(found - conditions_.begin());
  conditions_.push_back(surface);
  return conditions_.size() - 1;
}

std::vector<SurfaceTimeline::Entry>::const_iterator SurfaceTimeline::after(std::int64_t stamp_ns) const {
  return std::upper_bound(from_.begin(), from_.end(), stamp_ns,
                          [](std::int64_t stamp, const Entry& entry) { return stamp < entry.first; });
}

std::size_t SurfaceTimeline::at(std::int64_t stamp_ns) const {
  const auto next = after(stamp_ns);
  return next == from_.begin() ? next->second : (next - 1)->second;
}

bool SurfaceTimeline::nearChange(std::int64_t stamp_ns, std::int64_t margin_ns) const {
  const auto first_change = from_.begin() + 1;  // the begin of the first surface is no change
  const auto next = std::max(after(stamp_ns), first_change);
  const bool soon = next != from_.end() && next->first - stamp_ns <= margin_ns;
  const bool just = next != first_change && stamp_ns - (next - 1)->first <= margin_ns;
  return soon || just;
}

namespace {

using CountReader = RowSpool<std::uint16_t>::Reader;

std::int64_t nanoseconds(double seconds) {
  return std::llround(seconds * 1e9);
}

// A chamber is vented between cycles. Gauge readings that never come this close to zero [Pa] therefore
// indicate a wrong ambient pressure.
constexpr double kSuspectOffset = 50e3;

// Rms error of monotone cubic interpolation, by its rms difference from linear interpolation: of a triangle
// read 10 to 40 times a cycle. That of dwells is 1.4, of exponential fillings 1.2 to 1.6, of a sine 0.5.
constexpr double kErrorOfCubic = 1.7;

// Without a scan for so long, scans are missing, whatever the board's counter says: tables and some boards
// have none. A busy computer that stamps scans at their arrival is late by less.
constexpr double kTimesUsualStep = 10, kLeastSilence = 0.1;  // [s]

// Whether the board's counter jumped.
bool countJump(std::uint32_t before, std::uint32_t now, RecordingLosses& losses) {
  const std::uint32_t step = now - before;
  if (step <= 1) return false;  // 0: the board does not count
  if (step < 0x80000000u) {
    losses.lost_scans += step - 1;
  } else {
    ++losses.counter_back;
  }
  return true;
}

std::string silenceText(double from, double to, std::size_t silences) {
  return "no scan came for " + settings::fixedText(to - from, 1) + " s (" + settings::fixedText(from, 1) +
         " to " + settings::fixedText(to, 1) + " s)" +
         (silences > 1 ? ", the longest of " + std::to_string(silences) + " such gaps" : "");
}

// Whether the scan is on a known surface and not close to a change; counts the others.
bool onOneSurface(const SurfaceTimeline& timeline, std::int64_t stamp_ns, const RecordingOptions& options,
                  RecordingLosses& losses) {
  if (timeline.nearChange(stamp_ns, nanoseconds(options.change_margin))) {
    ++losses.near_change;
    return false;
  }
  const bool known = timeline.conditions()[timeline.at(stamp_ns)].known();
  if (known || !timeline.anyKnown()) return true;
  ++losses.unknown_surface;
  return false;
}

void warnOfOffset(Recording& recording) {
  const auto lowest = std::min_element(recording.pressure.begin(), recording.pressure.end());
  if (lowest == recording.pressure.end() || std::abs(*lowest) < kSuspectOffset) return;
  std::ostringstream warning;
  warning << "the lowest chamber pressure is " << *lowest * 1e-3
          << " kPa gauge; chamber_pressure is absolute by definition: check --ambient";
  recording.warnings.push_back(warning.str());
}

// Removes conditions without scans.
void dropUnusedConditions(const std::vector<matrix::Surface>& conditions, Recording& recording) {
  std::vector<std::size_t> place(conditions.size(), conditions.size());
  for (std::uint32_t& condition : recording.condition) {
    if (place[condition] == conditions.size()) {
      place[condition] = recording.conditions.size();
      recording.conditions.push_back(conditions[condition]);
    }
    condition = static_cast<std::uint32_t>(place[condition]);
  }
}

}  // namespace

void RecordingBuilder::addScan(std::int64_t stamp_ns, std::uint32_t sequence, const matrix::ScanView& scan) {
  matrix::requireSound(scan);
  if (scans_.empty()) {
    size_ = scan.size;
    full_scale_ = scan.full_scale;
    const std::uint64_t expected =
        std::min(expected_scans_, most_bytes_ / (sizeof(std::uint16_t) * scan.count));
    counts_.begin(scan.count, expected);
    scans_.reserve(expected);
  } else if (scan.size != size_ || scan.full_scale != full_scale_) {
    throw settings::InputError("raw holds scans of " + matrix::sizeText(size_) + " taxels with full_scale " +
                               std::to_string(full_scale_) + " and of " + matrix::sizeText(scan.size) +
                               " with " + std::to_string(scan.full_scale) +
                               ", but a recording is of one matrix; choose it by its namespace");
  }
  const double sum = std::accumulate(scan.counts, scan.counts + scan.count, 0.0);
  const auto reading = static_cast<float>(sum / static_cast<double>(scan.count));
  scans_.push_back({stamp_ns, sequence, reading, scans_.size()});
  counts_.add(scan.counts);
  ++events_.scans;
}

void RecordingBuilder::addChamberPressure(std::int64_t stamp_ns, double absolute_pressure) {
  chamber_pressure_.add(stamp_ns, absolute_pressure);
  ++events_.chamber_pressures;
}

void RecordingBuilder::addSurface(std::int64_t stamp_ns, const matrix::Surface& surface) {
  surfaces_.emplace_back(stamp_ns, surface);
  ++events_.surfaces;
}

void RecordingBuilder::addTemperature(std::int64_t stamp_ns, double temperature) {
  temperature_.add(stamp_ns, temperature);
  ++events_.temperatures;
}

void RecordingBuilder::addDescription(std::int64_t stamp_ns, const MatrixDescription& description) {
  descriptions_.emplace_back(stamp_ns, description);
  ++events_.descriptions;
}

std::vector<RecordingBuilder::ScanEvent> RecordingBuilder::sortedScans(RecordingLosses& losses) const {
  std::vector<ScanEvent> sorted = scans_;
  const std::size_t taxels = size_.taxels();
  CountReader left(counts_), right(counts_);
  const auto before = [&](const ScanEvent& a, const ScanEvent& b) {
    if (a.stamp_ns != b.stamp_ns) return a.stamp_ns < b.stamp_ns;
    if (a.sequence != b.sequence) return a.sequence < b.sequence;
    const auto* const first = left[a.number];
    const auto* const second = right[b.number];
    return std::lexicographical_compare(first, first + taxels, second, second + taxels);
  };
  std::sort(sorted.begin(), sorted.end(), before);
  const auto same_stamp = [](const ScanEvent& a, const ScanEvent& b) { return a.stamp_ns == b.stamp_ns; };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), same_stamp), sorted.end());
  losses.duplicates = scans_.size() - sorted.size();
  return sorted;
}

void RecordingBuilder::findGaps(const std::vector<ScanEvent>& scans, Recording& recording) {
  std::vector<double> steps;  // [s]
  for (std::size_t i = 1; i < scans.size(); ++i) {
    steps.push_back(1e-9 * static_cast<double>(scans[i].stamp_ns - scans[i - 1].stamp_ns));
  }
  if (steps.empty()) return;
  const auto longest = static_cast<std::size_t>(std::max_element(steps.begin(), steps.end()) - steps.begin());
  const double silence = std::max(kLeastSilence, kTimesUsualStep * statistics::upperMedian(steps));
  std::size_t silences = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool jumped = countJump(scans[i].sequence, scans[i + 1].sequence, recording.losses);
    const bool silent = steps[i] > silence;
    recording.losses.sequence_gaps += jumped || silent;
    silences += silent;
  }
  if (silences == 0) return;
  const auto seconds = [&](std::size_t i) {
    return 1e-9 * static_cast<double>(scans[i].stamp_ns - scans[0].stamp_ns);
  };
  recording.warnings.push_back(silenceText(seconds(longest), seconds(longest + 1), silences));
}

// Places of the spikes in the reference. The sheet's reading at a chamber pressure is that of the scan before
// or at it, if there is one within a second.
std::vector<std::size_t> RecordingBuilder::spikesOf(const TimeSeries& reference,
                                                    const std::vector<ScanEvent>& scans) const {
  constexpr std::int64_t kNear = 1'000'000'000;  // [ns]
  std::vector<double> time, pressure, reading;
  auto scan = scans.begin();
  for (const auto& [stamp, value] : reference.entries()) {
    while (scan != scans.end() && scan + 1 != scans.end() && (scan + 1)->stamp_ns <= stamp) ++scan;
    const bool near = scan != scans.end() && std::abs(scan->stamp_ns - stamp) <= kNear;
    time.push_back(1e-9 * static_cast<double>(stamp - reference.entries().front().first));
    pressure.push_back(value);
    reading.push_back(near ? static_cast<double>(scan->reading) : NAN);
  }
  return referenceSpikes(time, pressure, reading);
}

const MatrixDescription* RecordingBuilder::description() const {
  const auto before = [](const DescriptionEvent& a, const DescriptionEvent& b) { return a.first < b.first; };
  const auto first = std::min_element(descriptions_.begin(), descriptions_.end(), before);
  if (first == descriptions_.end()) return nullptr;
  for (const auto& [stamp, described] : descriptions_) {
    if (described.layout.size != size_ || described.full_scale != full_scale_) {
      throw settings::InputError("matrix_info describes " + matrix::sizeText(described.layout.size) +
                                 " taxels with full_scale " + std::to_string(described.full_scale) +
                                 ", but the scans in raw have " + matrix::sizeText(size_) + " with " +
                                 std::to_string(full_scale_));
    }
    if (described.sensor.serial != first->second.sensor.serial) {
      throw settings::InputError("matrix_info has the serial numbers \"" + first->second.sensor.serial +
                                 "\" and \"" + described.sensor.serial +
                                 "\", but a recording is of one matrix");
    }
  }
  return &first->second;
}

double RecordingBuilder::ambient(const RecordingOptions& options, std::vector<std::string>& warnings) const {
  if (options.ambient_pressure) return *options.ambient_pressure;
  const MatrixDescription* const described = description();
  if (described != nullptr && described->ambient_pressure > 0) return described->ambient_pressure;
  if (!chamber_pressure_.empty()) warnings.push_back("no ambient pressure is recorded; 101325 Pa is assumed");
  return kStandardAmbient;
}

Recording RecordingBuilder::emptyRecording(const RecordingOptions& options) const {
  Recording recording;
  recording.name = options.name;
  recording.sha256 = options.sha256;
  recording.full_scale = full_scale_;
  recording.layout.size = size_;
  if (const MatrixDescription* const described = description()) {
    recording.sensor = described->sensor;
    recording.layout = described->layout;
    recording.mask = described->mask;
  } else {
    recording.warnings.push_back("no matrix_info is recorded; a pitch of 0.010 m is assumed");
  }
  return recording;
}

bool RecordingBuilder::inOrderOfTime() const {
  const auto not_later = [](const ScanEvent& a, const ScanEvent& b) { return a.stamp_ns >= b.stamp_ns; };
  return std::adjacent_find(scans_.begin(), scans_.end(), not_later) == scans_.end();
}

void RecordingBuilder::append(const RecordingBuilder& other) {
  CountReader all(other.counts_);
  for (const ScanEvent& scan : other.scans_) {
    addScan(scan.stamp_ns, scan.sequence,
            {other.size_, other.full_scale_, all[scan.number], other.size_.taxels()});
  }
  for (const auto& [stamp, value] : other.chamber_pressure_.entries()) addChamberPressure(stamp, value);
  for (const auto& [stamp, value] : other.temperature_.entries()) addTemperature(stamp, value);
  for (const auto& [stamp, surface] : other.surfaces_) addSurface(stamp, surface);
  for (const auto& [stamp, described] : other.descriptions_) addDescription(stamp, described);
}

Recording RecordingBuilder::build(const RecordingOptions& options) const {
  if (counts_.inFile()) return buildFile(options);
  std::vector<std::uint16_t> kept;
  CountReader all(counts_);
  Recording recording = assemble(options, [&](std::size_t number) {
    const auto* const counts = all[number];
    kept.insert(kept.end(), counts, counts + size_.taxels());
  });
  recording.counts = std::move(kept);
  return recording;
}

Recording RecordingBuilder::take(const RecordingOptions& options) {
  if (counts_.inFile() || !inOrderOfTime()) {
    Recording recording = build(options);
    clear();
    return recording;
  }
  const std::size_t taxels = size_.taxels();
  std::vector<std::uint16_t>& counts = counts_.memory();
  std::size_t kept = 0;
  Recording recording = assemble(options, [&](std::size_t number) {  // kept <= number
    if (kept != number) std::copy_n(counts.data() + number * taxels, taxels, counts.data() + kept * taxels);
    ++kept;
  });
  counts.resize(kept * taxels);
  recording.counts = std::move(counts);
  clear();
  return recording;
}

Recording RecordingBuilder::buildFile(const RecordingOptions& options) const {
  const auto file = std::make_shared<CountFile>(size_.taxels());
  CountReader all(counts_);
  Recording recording = assemble(options, [&](std::size_t number) { file->add(all[number]); });
  file->finish();
  recording.count_file = file;
  return recording;
}

void RecordingBuilder::dropUnsound(const std::vector<ScanEvent>& scans, std::vector<std::size_t>& kept,
                                   Recording& recording) const {
  if (recording.pressure.empty()) return;
  ScanCourse course{{}, recording.pressure, {}, recording.condition};
  for (const std::size_t scan : kept) {
    course.stamp_ns.push_back(scans[scan].stamp_ns);
    course.reading.push_back(static_cast<double>(scans[scan].reading));
  }
  std::vector<AttemptEnd> ends = attempt_ends_;
  std::sort(ends.begin(), ends.end(), [](const AttemptEnd& a, const AttemptEnd& b) {
    return std::tie(a.stamp_ns, a.reason) < std::tie(b.stamp_ns, b.reason);
  });
  const std::vector<UnsoundSpan> spans = unsoundSpans(course, ends);
  if (spans.empty()) return;
  std::vector<bool> sound(kept.size(), true);
  for (const UnsoundSpan& span : spans) {
    std::fill(sound.begin() + static_cast<std::ptrdiff_t>(span.first),
              sound.begin() + static_cast<std::ptrdiff_t>(span.end), false);
  }
  const auto compact = [&](auto& values) {
    std::size_t to = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (sound[i]) values[to++] = values[i];
    }
    values.resize(to);
  };
  for (std::vector<double>* const values : {&recording.pressure, &recording.temperature}) {
    if (!values->empty()) compact(*values);
  }
  compact(recording.condition);
  compact(kept);
  recording.warnings.push_back(unsoundText(course, spans));
}

Recording RecordingBuilder::assemble(const RecordingOptions& options,
                                     const std::function<void(std::size_t)>& keep) const {
  if (scans_.empty()) throw settings::InputError("raw has no scan");
  for (const SurfaceTimeline::Event& event : surfaces_) matrix::requireFit(event.second, size_);
  Recording recording = emptyRecording(options);
  const SurfaceTimeline timeline(surfaces_, options.same_curvature);
  const double ambient_pressure = ambient(options, recording.warnings);
  TimeSeries reference = chamber_pressure_;
  TimeSeries temperature = temperature_;
  reference.sort();
  temperature.sort();

  const std::int64_t gap = nanoseconds(options.longest_reference_gap);
  const std::vector<ScanEvent> scans = sortedScans(recording.losses);
  findGaps(scans, recording);
  const std::vector<std::size_t> spikes = spikesOf(reference, scans);
  reference.drop(spikes);
  recording.losses.reference_spikes = spikes.size();
  recording.reference_interval = reference.interval();
  double square = 0;
  std::vector<std::size_t> kept;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const ScanEvent& scan = scans[s];
    const auto pressure = reference.between(scan.stamp_ns, gap);
    if (!onOneSurface(timeline, scan.stamp_ns, options, recording.losses)) continue;
    if (!reference.empty() && !pressure) {
      ++recording.losses.no_reference;
      continue;
    }
    kept.push_back(s);
    recording.condition.push_back(static_cast<std::uint32_t>(timeline.at(scan.stamp_ns)));
    if (pressure) {
      recording.pressure.push_back(*pressure - ambient_pressure);
      square += std::pow(*pressure - *reference.straight(scan.stamp_ns, gap), 2);
    }
    if (!temperature.empty()) recording.temperature.push_back(temperature.nearby(scan.stamp_ns));
  }
  if (!kept.empty())
    recording.reference_error = kErrorOfCubic * std::sqrt(square / static_cast<double>(kept.size()));
  dropUnsound(scans, kept, recording);
  if (!kept.empty()) recording.start_ns = scans[kept.front()].stamp_ns;
  recording.time.reserve(kept.size());
  for (const std::size_t s : kept) {
    recording.time.push_back(static_cast<double>(scans[s].stamp_ns - recording.start_ns) * 1e-9);
    keep(scans[s].number);
  }
  recording.losses.bad_reference = reference.notFinite();
  dropUnusedConditions(timeline.conditions(), recording);
  const std::vector<std::string> lost = describeLosses(recording.losses);
  recording.warnings.insert(recording.warnings.end(), lost.begin(), lost.end());
  warnOfOffset(recording);
  return recording;
}

}  // namespace fsr::dataset
