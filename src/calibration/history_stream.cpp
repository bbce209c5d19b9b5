#include "calibration/history_stream.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compensation/history_state.h"

namespace fsr::calibration {

namespace {

// Readings are compared in means over this time. White noise, which no memory can remove, then counts less
// [s].
constexpr double kRow = 0.5;

}  // namespace

HistoryStream::HistoryStream(const dataset::Recording& recording, const std::vector<std::size_t>& classes,
                             const dataset::Sections& sections, const std::vector<std::uint32_t>& protocol,
                             const compensation::HistoryGrid& grid, std::vector<Session> sessions)
    : recording_(&recording),
      sections_(&sections),
      operators_(compensation::operatorsOf(grid)),
      sessions_(std::move(sessions)) {
  std::uint32_t row = 0;
  double row_begins = 0, turned = 0, duration = 0;
  for (std::size_t i = 0; i < recording.scans(); ++i) {
    if (sections.section[i] == dataset::kNoSection) continue;
    Scan scan;
    scan.number = i;
    scan.curvature_class = static_cast<std::uint32_t>(classes[recording.condition[i]]);
    scan.protocol = protocol[i];
    const double time = recording.time[i];
    if (scans_.empty()) {
      scan.starts = true;
    } else {
      const std::size_t before = scans_.back().number;
      duration = time - recording.time[before];
      scan.starts = recording.condition[i] != recording.condition[before] || duration < 0 ||
                    duration > compensation::HistoryState::kLongestGap;
    }
    const bool turns = scan.starts || sections.direction[i] != sections.direction[scans_.back().number];
    if (turns) turned = time;
    scan.since_reversal = time - turned;
    if (scan.starts || protocol[i] != scans_.back().protocol || time >= row_begins + kRow) {
      ++row;
      row_begins = time;
    }
    scan.row = row;
    scans_.push_back(scan);
    steps_.resize(steps_.size() + operators_.memories());
    if (!scan.starts) operators_.stepsOver(duration, steps_.data() + steps_.size() - operators_.memories());
  }
  markSettled(compensation::settlingTime(grid.time_constants));
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

// The scans after the settling time of a stay on a surface count, but at least two thirds of the stay.
void HistoryStream::markSettled(double settling_time) {
  for (std::size_t first = 0; first < scans_.size();) {
    std::size_t last = first + 1;
    while (last < scans_.size() && !scans_[last].starts) ++last;
    const double begin = recording_->time[scans_[first].number];
    const double length = recording_->time[scans_[last - 1].number] - begin;
    const double counts = begin + std::min(settling_time, length / 3);
    for (std::size_t k = first; k < last; ++k)
      scans_[k].settled = recording_->time[scans_[k].number] >= counts;
    first = last;
  }
}

void addHistoryRows(const HistoryStream& stream, const compensation::HistoryGrid& grid, std::size_t taxel,
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
    compensation::historyFeatures(grid, x, state, features.data());
    for (std::size_t k = 0; k < n; ++k) mean[k] += features[k];
    const bool is_judged = judged != nullptr && scan.protocol == left_out;
    target += (is_judged ? *judged : stream.recording().pressure)[scan.number] - x;
    count += 1;
  });
  close();
}

}  // namespace fsr::calibration
