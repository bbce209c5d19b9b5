#include "calibration/stages/memory/history_stream.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "calibration/stages/memory/history_state.h"

namespace fsr::calibration {

namespace {

// Readings are compared in means over this time. White noise, which no memory can remove, then counts less
// [s].
constexpr double kRow = 0.5;

constexpr std::size_t kMostInMemory = 8u << 20;  // of the scans of a recording, and of their steps [bytes]

}  // namespace

HistoryStream::HistoryStream(const dataset::Recording& recording, const std::vector<std::size_t>& classes,
                             const dataset::Sections& sections, const std::vector<std::uint32_t>& protocol,
                             const HistoryGrid& grid, std::vector<Session> sessions)
    : recording_(&recording),
      sections_(&sections),
      operators_(operatorsOf(grid)),
      sessions_(std::move(sessions)),
      scans_(kMostInMemory),
      steps_(kMostInMemory) {
  const std::vector<double> counts_from = countsFrom(settlingTime(grid.time_constants));
  const std::size_t memories = operators_.memories();
  if (memories > 0) steps_.begin(memories, recording.scans());
  std::vector<Step> steps(memories);
  std::optional<Scan> last;
  std::size_t stay = 0;
  double row_begins = 0, turned = 0;
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (sections.section[i] == dataset::kNoSection) continue;
    const double time = recording.time[i];
    Scan scan;
    scan.number = static_cast<std::uint32_t>(i);
    scan.curvature_class = static_cast<std::uint16_t>(classes[recording.condition[i]]);
    scan.protocol = protocol[i];
    scan.starts = !last || starts(i, last->number);
    if (last && scan.starts) ++stay;
    scan.settled = time >= counts_from[stay];
    if (scan.starts || sections.direction[i] != sections.direction[last->number]) turned = time;
    scan.since_reversal = time - turned;
    scan.row = last ? last->row : 0;
    if (scan.starts || protocol[i] != last->protocol || time >= row_begins + kRow) {
      ++scan.row;
      row_begins = time;
    }
    if (memories > 0) {
      std::fill(steps.begin(), steps.end(), Step());
      if (!scan.starts) operators_.stepsOver(time - recording.time[last->number], steps.data());
      steps_.add(steps.data());
    }
    scans_.add(&scan);
    last = scan;
  }
}

// Whether nothing is known before a scan that follows another one.
bool HistoryStream::starts(std::size_t scan, std::size_t before) const {
  const double duration = recording_->time[scan] - recording_->time[before];
  return recording_->condition[scan] != recording_->condition[before] || duration < 0 ||
         duration > HistoryState::kLongestGap;
}

// The time from which on the scans of each stay on a surface count: after the settling time, but at least two
// thirds of the stay [s].
std::vector<double> HistoryStream::countsFrom(double settling_time) const {
  struct Stay {
    double begin, end;
  };
  std::vector<Stay> stays;
  std::size_t last = 0;
  for (std::size_t i = 0; i < recording_->scans(); ++i) {
    if (sections_->section[i] == dataset::kNoSection) continue;
    const double time = recording_->time[i];
    if (stays.empty() || starts(i, last)) stays.push_back({time, time});
    stays.back().end = time;
    last = i;
  }
  std::vector<double> counts;
  for (const Stay& stay : stays)
    counts.push_back(stay.begin + std::min(settling_time, (stay.end - stay.begin) / 3));
  return counts;
}

// [conditions]
std::vector<double> HistoryStream::zerosOf(std::size_t taxel,
                                           const std::vector<StaticAnswer>& answers) const {
  std::vector<double> zeros(recording_->conditions.size(), 0.0);
  for (const Session& session : sessions_) {
    const std::vector<double>& table = answers[session.curvature_class].pressure;
    zeros[session.condition] = zeroAtRest(*recording_, session.rest, taxel, table).value_or(0);
  }
  return zeros;
}

void addHistoryRows(const HistoryStream& stream, const HistoryGrid& grid, std::size_t taxel,
                    const std::vector<StaticAnswer>& answers, std::size_t left_out, LeftOutSums& sums,
                    const std::vector<double>* judged) {
  const std::size_t n = grid.features();
  std::vector<double> features(n), mean(n);
  double target = 0, count = 0;
  HistoryStream::Scan row;
  const auto close = [&] {
    if (count == 0) return;
    for (double& value : mean) value /= count;
    (row.protocol == left_out ? sums.left_out : sums.trained).add(mean.data(), target / count);
    std::fill(mean.begin(), mean.end(), 0.0);
    target = count = 0;
  };
  stream.run(taxel, answers, [&](const HistoryStream::Scan& scan, double x, const double* state) {
    if (scan.row != row.row) close();
    row = scan;
    historyFeatures(grid, x, state, features.data());
    for (std::size_t k = 0; k < n; ++k) mean[k] += features[k];
    const bool is_judged = judged != nullptr && scan.protocol == left_out;
    target += (is_judged ? *judged : stream.recording().pressure)[scan.number] - x;
    count += 1;
  });
  close();
}

}  // namespace fsr::calibration
