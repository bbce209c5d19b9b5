#include "calibration/stages/deviation/budget_sums.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fsr::calibration {

BudgetCycles budgetCycles(const std::vector<dataset::Recording>& recordings,
                          const dataset::ConditionClasses& classes,
                          const std::vector<dataset::Sections>& sections) {
  BudgetCycles cycles;
  cycles.of_class.resize(classes.classes.size());
  std::vector<std::uint32_t> sessions(classes.classes.size(), 0);
  std::vector<std::map<std::uint32_t, std::uint32_t>> mounts(classes.classes.size());
  const std::vector<std::vector<std::size_t>> first = firstCycles(classes, sections);
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (std::size_t c = 0; c < recordings[r].conditions.size(); ++c) {
      const std::size_t k = classes.class_of[r][c];
      const auto number = static_cast<std::uint32_t>(mounts[k].size());
      const std::uint32_t mount = mounts[k].emplace(recordings[r].conditions[c].mount, number).first->second;
      const std::size_t last = cycleNumber(first[r][c] + std::max<std::size_t>(1, sections[r].cycles[c]) - 1);
      if (cycles.of_class[k].size() <= last) cycles.of_class[k].resize(last + 1, {sessions[k], mount, 0});
      ++sessions[k];
    }
  }
  std::size_t all = 0, number = 0;
  for (const auto& of_class : cycles.of_class) all += of_class.size();
  cycles.units = std::min(all, BudgetCycles::kMostUnits);
  for (auto& of_class : cycles.of_class) {
    for (BudgetCycle& cycle : of_class)
      cycle.unit = static_cast<std::uint32_t>(number++ * cycles.units / all);
  }
  return cycles;
}

namespace {

constexpr std::size_t kBudgetPoints = kBudgetShares.size();

}  // namespace

BudgetScale::BudgetScale(const TrainedInterval& trained)
    : range(trained.high - trained.low), highest(trained.high), pressure{} {
  for (std::size_t p = 0; p < kBudgetPoints; ++p) pressure[p] = trained.low + kBudgetShares[p] * range;
}

std::size_t BudgetScale::pointOf(double at) const {
  std::size_t point = 0;
  while (point < kBudgetPoints && !(std::abs(at - pressure[point]) <= kHalfWindow * range)) ++point;
  return point;
}

void BudgetPoint::add(const BudgetPoint& more) {
  held_out += more.held_out, cells += more.cells;
  noise += more.noise, steps += more.steps;
  repeat += more.repeat, repeat_freedom += more.repeat_freedom, repeat_noise += more.repeat_noise;
  loop += more.loop, loops += more.loops;
  dwell += more.dwell, dwell_freedom += more.dwell_freedom;
  dwell_noise += more.dwell_noise, dwell_steps += more.dwell_steps;
  dwells += more.dwells, dwells_inside += more.dwells_inside;
  mount += more.mount, mount_freedom += more.mount_freedom;
  first += more.first, first_change += more.first_change, firsts += more.firsts;
  surfaces += more.surfaces, mount_shares += more.mount_shares;
}

void addSums(const BudgetSums& more, BudgetSums& sums) {
  for (std::size_t p = 0; p < kBudgetPoints; ++p) sums[p].add(more[p]);
}

CodeSpan::CodeSpan(const regression::CodeTable& table, const BudgetScale& scale, std::size_t point) {
  const double half = BudgetScale::kHalfWindow * scale.range;
  const auto first = [&](double at) {
    std::size_t code = table.lowest;
    while (code <= table.highest && !(double(table.pressure[code]) >= at)) ++code;
    return code;
  };
  const std::size_t low = first(scale.pressure[point] - half), high = first(scale.pressure[point] + half);
  if (high > table.highest || low >= high) return;
  step = (double(table.pressure[high]) - double(table.pressure[low])) / double(high - low);
  middle = (low + high) / 2;
}

BudgetTally::BudgetTally(const BudgetScale& scale, const std::vector<BudgetCycle>& cycles,
                         const regression::CodeTable& table)
    : scale_(scale),
      cycles_(cycles),
      table_(table),
      step_{},
      cells_(kBudgetPoints * cycles.size() * kDirections) {
  for (std::size_t p = 0; p < kBudgetPoints; ++p) step_[p] = CodeSpan(table, scale, p).step;
  for (const BudgetCycle& cycle : cycles) {
    if (mount_of_session_.size() <= cycle.session) mount_of_session_.resize(cycle.session + 1);
    mount_of_session_[cycle.session] = cycle.mount;
  }
}

void BudgetTally::add(const TrainingScan& scan, double error) {
  addDwell(scan);
  const std::size_t point = scale_.pointOf(regression::fromFixed(scan.pressure));
  if (point == kBudgetPoints || scan.direction == statistics::LoadDirection::kNone) {
    last_cell_ = nullptr;
    return;
  }
  Cell& own = cell(point, scan.cycle, scan.direction == statistics::LoadDirection::kUnloading);
  if (last_cell_ == &own) {
    const double step = error - last_error_;
    sums_[point].noise += step * step / 2;
    sums_[point].steps += 1;
  }
  own.count += 1;
  own.sum += error;
  own.squares += error * error;
  own.answers += double(table_.pressure[scan.code]) - regression::fromFixed(scan.pressure);
  last_cell_ = &own;
  last_error_ = error;
}

// A table answers the highest pressure for every count that creep reaches there, so that errors would not
// show it: counts do.
void BudgetTally::addDwell(const TrainingScan& scan) {
  if (dwell_.count > 0 && (!scan.dwell || scan.cycle != dwell_cycle_)) endDwell();
  if (!scan.dwell) return;
  const double step = dwell_.count > 0 ? double(scan.code) - double(dwell_code_) : 0;
  dwell_noise_ += step * step / 2;
  dwell_code_ = scan.code;
  dwell_.add(scan.code);
  dwell_pressure_ += regression::fromFixed(scan.pressure);
  dwell_cycle_ = scan.cycle;
}

// A dwell counts for the nearest of the pressures.
void BudgetTally::endDwell() {
  const double pressure = dwell_pressure_ / dwell_.count;
  std::size_t nearest = 0;
  const auto distance = [&](std::size_t p) { return std::abs(pressure - scale_.pressure[p]); };
  for (std::size_t p = 1; p < kBudgetPoints; ++p) {
    if (distance(p) < distance(nearest)) nearest = p;
  }
  if (distance(nearest) <= BudgetScale::kDwellReach * scale_.range && !std::isnan(step_[nearest])) {
    BudgetPoint& sums = sums_[nearest];
    const double unit = step_[nearest] * step_[nearest];
    sums.dwell += dwell_.squares * unit;
    sums.dwell_noise += dwell_noise_ * unit;
    sums.dwell_steps += dwell_.count - 1;
    sums.dwell_freedom += dwell_.count - 1;
    sums.dwells += 1;
    sums.dwells_inside += distance(nearest) <= BudgetScale::kHalfWindow * scale_.range;
  }
  dwell_ = {};
  dwell_noise_ = 0;
  dwell_pressure_ = 0;
}

double BudgetTally::Side::varianceOfMean() const {
  return cycles.count > 1 ? cycles.squares / (cycles.count - 1) / cycles.count : 0;
}

std::vector<std::array<BudgetTally::Side, BudgetTally::kDirections>> BudgetTally::sidesOf(std::size_t point) {
  std::vector<std::array<Side, kDirections>> sides(mount_of_session_.size());
  for (std::size_t c = 0; c < cycles_.size(); ++c) {
    for (std::size_t d = 0; d < kDirections; ++d) {
      const Cell& own = cell(point, c, d);
      if (own.count == 0) continue;
      Side& side = sides[cycles_[c].session][d];
      side.cycles.add(own.sum / own.count);
      side.inverse_counts += 1 / own.count;
      sums_[point].held_out += own.squares / own.count;
      sums_[point].cells += 1;
    }
  }
  return sides;
}

// The variance of the means over cycles is subtracted from what is found between directions and mounts.
void BudgetTally::addSessions(const std::vector<std::array<Side, kDirections>>& sides,
                              BudgetPoint& sums) const {
  struct Mount {
    double sessions = 0, mean = 0, variance = 0;
  };
  std::vector<Mount> mounts(mount_of_session_.size());
  for (std::size_t s = 0; s < sides.size(); ++s) {
    for (const Side& side : sides[s]) {
      if (side.cycles.count < 2) continue;
      sums.repeat += side.cycles.squares;
      sums.repeat_freedom += side.cycles.count - 1;
      sums.repeat_noise += side.inverse_counts * (1 - 1 / side.cycles.count);
    }
    const Side &up = sides[s][0], &down = sides[s][1];
    if (up.cycles.count == 0 || down.cycles.count == 0) continue;
    const double variance = (up.varianceOfMean() + down.varianceOfMean()) / 4;
    const double half = (down.cycles.mean - up.cycles.mean) / 2;
    sums.loop += half * half - variance;
    sums.loops += 1;
    Mount& mount = mounts[mount_of_session_[s]];
    mount.sessions += 1;
    mount.mean += (down.cycles.mean + up.cycles.mean) / 2;
    mount.variance += variance;
  }
  statistics::RunningMoments means;
  double variance = 0;
  for (const Mount& mount : mounts) {
    if (mount.sessions == 0) continue;
    means.add(mount.mean / mount.sessions);
    variance += mount.variance / (mount.sessions * mount.sessions);
  }
  if (means.count == 0) return;
  sums.surfaces += 1;
  sums.mount_shares += 1 / means.count;
  if (means.count < 2) return;
  sums.mount += means.squares - variance * (1 - 1 / means.count);
  sums.mount_freedom += means.count - 1;
}

// One table answers to all cycles, so that its error cancels. What the later cycles scatter by, and the first
// one with them, is subtracted.
void BudgetTally::addFirstCycles(std::size_t point) {
  struct Course {
    bool begun = false;
    std::array<Cell, kDirections> first;
    std::array<statistics::RunningMoments, kDirections> later;
  };
  std::vector<Course> courses(mount_of_session_.size());
  for (std::size_t c = 0; c < cycles_.size(); ++c) {
    Course& course = courses[cycles_[c].session];
    for (std::size_t d = 0; d < kDirections; ++d) {
      const Cell& own = cell(point, c, d);
      if (!course.begun) {
        course.first[d] = own;
      } else if (own.count > 0) {
        course.later[d].add(own.answers / own.count);
      }
    }
    course.begun = true;
  }
  std::vector<bool> seen(courses.size(), false);  // mounts
  for (std::size_t s = 0; s < courses.size(); ++s) {
    if (seen[mount_of_session_[s]]) continue;
    seen[mount_of_session_[s]] = true;
    double changes = 0, variance = 0, directions = 0;
    for (std::size_t d = 0; d < kDirections; ++d) {
      const Cell& first = courses[s].first[d];
      const statistics::RunningMoments& later = courses[s].later[d];
      if (first.count == 0 || later.count < 2) continue;
      changes += later.mean - first.answers / first.count;
      variance += later.squares / (later.count - 1) * (1 + 1 / later.count);
      directions += 1;
    }
    if (directions == 0) continue;
    const double change = changes / directions;
    sums_[point].first += change * change - variance / (directions * directions);
    sums_[point].first_change += change;
    sums_[point].firsts += 1;
  }
}

BudgetSums BudgetTally::sums() {
  if (dwell_.count > 0) endDwell();
  for (std::size_t point = 0; point < kBudgetPoints; ++point) {
    addSessions(sidesOf(point), sums_[point]);
    addFirstCycles(point);
  }
  return sums_;
}

}  // namespace fsr::calibration
