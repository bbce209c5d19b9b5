#include "calibration/stages/memory/history_stream.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>

#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

constexpr std::array<double, 6> kTimes = {0.3, 1, 3, 10, 30, 100};  // since the last reversal [s]
constexpr std::size_t kLoading = 1, kUnloading = 2, kFirstTime = 3;

std::string timeName(std::size_t place) {
  const std::string unit = " s since the reversal";
  if (place == 0) return "up to " + settings::roundedText(kTimes.front()) + unit;
  if (place == kTimes.size()) return "over " + settings::roundedText(kTimes.back()) + unit;
  return settings::roundedText(kTimes[place - 1]) + " to " + settings::roundedText(kTimes[place]) + unit;
}

}  // namespace

std::array<std::size_t, 3> historyPartsOf(statistics::LoadDirection direction, double since_reversal) {
  const auto time = std::upper_bound(kTimes.begin(), kTimes.end(), since_reversal) - kTimes.begin();
  const std::size_t by_time = kFirstTime + static_cast<std::size_t>(time);
  switch (direction) {
    case statistics::LoadDirection::kLoading:
      return {0, kLoading, by_time};
    case statistics::LoadDirection::kUnloading:
      return {0, kUnloading, by_time};
    case statistics::LoadDirection::kNone:
      break;
  }
  return {0, by_time, by_time};
}

std::string historyPartName(std::size_t part) {
  if (part == 0) return "all readings";
  if (part == kLoading) return "loading";
  if (part == kUnloading) return "unloading";
  return timeName(part - kFirstTime);
}

namespace {

constexpr double kRow = 0.5;      // of a mean [s]
constexpr double kSampled = 0.1;  // between readings; those between tell little more [s]

constexpr std::size_t kMostInMemory = 8u << 20;  // of the scans of a recording, and of their steps [bytes]

}  // namespace

HistoryStream::HistoryStream(const dataset::Recording& recording, std::size_t number,
                             const std::vector<std::size_t>& classes, const dataset::Sections& sections,
                             const dataset::Protocols& protocols, const HistoryGrid& grid, bool lies_on,
                             std::vector<Session> sessions)
    : recording_(&recording),
      number_(number),
      sections_(&sections),
      operators_(operatorsOf(grid)),
      lies_on_(lies_on),
      sessions_(std::move(sessions)),
      scans_(kMostInMemory),
      steps_(kMostInMemory) {
  const std::vector<std::uint32_t>& protocol = protocols.of_scan[number];
  const std::size_t memories = operators_.memories();
  if (memories > 0) steps_.begin(memories, recording.scans());
  std::vector<Step> steps(memories);
  std::optional<Scan> last;
  double row_begins = 0, turned = 0, sampled = 0;
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (sections.section[i] == dataset::kNoSection) continue;
    const double time = recording.time[i];
    Scan scan;
    scan.number = static_cast<std::uint32_t>(i);
    scan.curvature_class = static_cast<std::uint16_t>(classes[recording.condition[i]]);
    scan.protocol = protocol[i];
    if (!protocols.part_of_scan.empty()) scan.part = protocols.part_of_scan[number][i];
    scan.starts = last ? starts(i, last->number) : !lies_on;
    if (!last || scan.starts || sections.direction[i] != sections.direction[last->number]) turned = time;
    scan.since_reversal = time - turned;
    scan.row = last ? last->row : 0;
    if (!last || scan.starts || protocol[i] != last->protocol || scan.part != last->part ||
        time >= row_begins + kRow) {
      ++scan.row;
      row_begins = time;
      scan.sampled = true;
    }
    scan.sampled = scan.sampled || time >= sampled + kSampled;
    if (scan.sampled) sampled = time;
    if (memories > 0) {
      std::fill(steps.begin(), steps.end(), Step());
      if (last && !scan.starts) operators_.stepsOver(time - recording.time[last->number], steps.data());
      steps_.add(steps.data());
    }
    scans_.add(&scan);
    last = scan;
  }
}

// Whether nothing is known before a scan that follows another one.
bool HistoryStream::starts(std::size_t scan, std::size_t before) const {
  return recording_->condition[scan] != recording_->condition[before] ||
         recording_->time[scan] < recording_->time[before];
}

// Takes over the course of the stream before, in the time of this recording.
void HistoryStream::begin(HistoryCourse& course) const {
  const double later = double(recording_->start_ns - course.start_ns) * 1e-9;
  course.start_ns = recording_->start_ns;
  course.taxel.at -= later;
  course.taxel.limited_at -= later;
  course.before -= later;
  course.state.resize(operators_.size());
  course.open.resize(operators_.size());
}

// [conditions]. `last`: of the last surface of the stream before, then of this one. A sheet that lay on keeps
// its tare.
std::vector<double> HistoryStream::zerosOf(std::size_t taxel, const std::vector<StaticAnswer>& answers,
                                           double& last) const {
  std::vector<double> zeros(recording_->conditions.size(), 0.0);
  for (const Session& session : sessions_) {
    const std::vector<double>& table = answers[session.curvature_class].pressure;
    const bool goes_on = lies_on_ && session.condition == recording_->condition.front();
    zeros[session.condition] =
        zeroAtRest(*recording_, session.rest, taxel, table).value_or(goes_on ? last : 0);
  }
  if (recording_->scans() > 0) last = zeros[recording_->condition.back()];
  return zeros;
}

std::vector<HistoryStream> historyStreams(const std::vector<dataset::Recording>& recordings,
                                          const std::vector<std::vector<std::size_t>>& classes,
                                          const std::vector<dataset::Sections>& sections,
                                          const dataset::Protocols& protocols, const HistoryGrid& grid,
                                          const Sessions* sessions) {
  std::vector<HistoryStream> streams;
  const std::vector<std::size_t> order = dataset::inOrderOfTime(recordings);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t r = order[k];
    const bool lies_on = k > 0 && dataset::sheetLayOn(recordings[order[k - 1]], recordings[r]);
    std::vector<Session> tared;
    if (sessions != nullptr) {
      std::copy_if(sessions->all.begin(), sessions->all.end(), std::back_inserter(tared),
                   [&](const Session& session) { return session.recording == r; });
    }
    streams.emplace_back(recordings[r], r, classes[r], sections[r], protocols, grid, lies_on,
                         std::move(tared));
  }
  return streams;
}

void setTrainedPressures(const std::vector<HistoryStream>& streams, std::size_t left_out,
                         std::vector<StaticAnswer>& answers) {
  std::vector<std::pair<double, double>> range(answers.size(), {1, 0});
  for (const HistoryStream& stream : streams) {
    stream.forEachScan([&](const HistoryStream::Scan& scan) {
      if (scan.protocol == left_out) return;
      auto& [low, high] = range[scan.curvature_class];
      const double pressure = stream.recording().pressure[scan.number];
      const bool first = low > high;
      low = first ? pressure : std::min(low, pressure);
      high = first ? pressure : std::max(high, pressure);
    });
  }
  for (std::size_t k = 0; k < answers.size(); ++k)
    std::tie(answers[k].lowest_pressure, answers[k].highest_pressure) = range[k];
}

HistorySums& LeftOutSums::part(std::size_t number) {
  while (left_out.size() <= number)
    left_out.emplace_back(static_cast<std::size_t>(trained.gram().rows()) - 1);
  return left_out[number];
}

void LeftOutSums::finish() {
  trained.finish();
  for (HistorySums& sums : left_out) sums.finish();
}

void LeftOutSums::merge(const LeftOutSums& other) {
  trained.merge(other.trained);
  for (std::size_t k = 0; k < other.left_out.size(); ++k) part(k).merge(other.left_out[k]);
}

void addHistoryRows(const HistoryStream& stream, const HistoryGrid& grid, std::size_t taxel,
                    const std::vector<StaticAnswer>& answers, HistoryRows rows, HistoryCourse& course,
                    const SumsOfScan& sums_of) {
  const std::size_t n = grid.features();
  std::vector<double> features(n), mean(n);
  double target = 0, count = 0;
  HistoryStream::Scan row;
  const auto add = [&] {
    if (count == 0) return;
    for (double& value : mean) value /= count;
    sums_of(row).add(mean.data(), target / count);
    std::fill(mean.begin(), mean.end(), 0.0);
    target = count = 0;
  };
  stream.run(taxel, answers, course,
             [&](const HistoryStream::Scan& scan, double x, const double* state, const double* /*open*/) {
               if (rows == HistoryRows::kReadings && !scan.sampled) return;
               if (rows == HistoryRows::kReadings || scan.row != row.row) add();
               row = scan;
               historyFeatures(grid, x, state, features.data());
               for (std::size_t k = 0; k < n; ++k) mean[k] += features[k];
               target += stream.recording().pressure[scan.number] - x;
               count += 1;
             });
  add();
}

}  // namespace fsr::calibration
