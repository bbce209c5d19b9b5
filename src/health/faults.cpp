#include "health/faults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "health/reading_rule.h"
#include "health/taxel_courses.h"
#include "statistics/samples.h"

namespace fsr::health {

namespace {

constexpr std::size_t kFewestOfALine = 3;                          // taxels; fewer are no line
constexpr std::size_t kFewestForQuartiles = 8;                     // taxels; fewer have no quartiles
constexpr std::size_t kFewestLines = 3;                            // fewer have no neighbours
const std::vector<std::size_t> kSpansOfSteps = {2, 4, 8, 16, 32};  // scans on each side of a step
// Quantiles of Gumbel's standard distribution: median, and difference of the quartiles.
constexpr double kGumbelMedian = 0.36651, kGumbelQuartiles = 1.57253;
// Least scale of the logarithm of the taxels' largest deviations: they differ by some per cent by chance
// alone, and by steps of the converter.
constexpr double kLeastScale = 0.1;
// Share of a taxel's range above which the others certainly load it, or move it.
constexpr double kShows = 0.3;
// Limits of the rule: deviations of the noise, and the least share of a taxel's range.
constexpr double kBeyondNoise = 5, kLeastLimit = 0.02;
constexpr double kOpen = 0.001;  // share of full scale; see TaxelWatchOptions::floor_share
// Share of the readings in the second half of a spell that may lie beyond the limits. In the first half a
// fault may still be on its way.
constexpr double kOutside = 0.05;
// Share of a taxel's squared error that its kind must account for.
constexpr double kOfOneKind = 0.7;

// Share of the squared deviations of a line that the direction explains at the same reading. A line that does
// the same in every cycle has a loop or a lag; a contact fails at any time.
constexpr double kLoop = 0.3;
constexpr double kReadingBin = 0.1;  // of the taxel's range
constexpr double kOwnStep = 0.5;     // of a line, per step of it less the lines beside it
constexpr double kTogether = 0.5;    // share of the scans in which the taxels of a line fail together

// Whether a taxel or a line fails, [stays][scans].
using Spells = std::vector<std::vector<bool>>;

// Taxels that fail, each with its spells.
using Members = std::map<std::size_t, Spells>;

std::size_t lineOf(const matrix::Layout& layout, FaultKind kind, std::size_t taxel) {
  return kind == FaultKind::kRow ? layout.row({taxel}) : layout.column({taxel});
}

// Deviations of a taxel, or of a line from those beside it, [stays][scans].
using Course = std::vector<Eigen::VectorXd>;

// Calls use(stay, place, mean) for the mean of a course over each `span` scans. With `steps`: over the scans
// from a place on, less that over the scans before it.
template <typename Use>
void eachMean(const Course& course, std::size_t span, bool steps, Use use) {
  const Eigen::Index reach = span, before = steps ? reach : 0;
  for (std::size_t v = 0; v < course.size(); ++v) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(course[v].size() + 1);
    for (Eigen::Index i = 0; i < course[v].size(); ++i) sum[i + 1] = sum[i] + course[v][i];
    for (Eigen::Index at = before; at + reach < sum.size(); ++at)
      use(v, at, (sum[at + reach] - sum[at] - (sum[at] - sum[at - before])) / double(span));
  }
}

// Logarithm of the largest of these means, for each span.
std::vector<double> largest(const Course& course, const std::vector<std::size_t>& spans, bool steps) {
  std::vector<double> largest;
  for (const std::size_t span : spans) {
    double most = 1e-6;
    eachMean(course, span, steps,
             [&](std::size_t, Eigen::Index, double mean) { most = std::max(most, std::abs(mean)); });
    largest.push_back(std::log(most));
  }
  return largest;
}

// Distribution of a logarithm over the taxels.
struct Gumbel {
  double location = 0, scale = kLeastScale;

  explicit Gumbel(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
      return values[static_cast<std::size_t>(share * double(values.size() - 1))];
    };
    scale = std::max(kLeastScale, (at(0.75) - at(0.25)) / kGumbelQuartiles);
    location = at(0.5) - kGumbelMedian * scale;
  }
  double p(double value) const { return -std::expm1(-std::exp(-(value - location) / scale)); }
  // Value that only a share p of all exceed.
  double exceededBy(double p) const { return location - scale * std::log(-std::log1p(-p)); }
};

// Where the largest means of one course are outliers.
struct Outlier {
  double p = 1;          // for any span
  std::size_t span = 0;  // the shortest with an outlier: a longer one also grows beside a spell
  double limit = 0;      // of the mean over it
};

// Calls use(from, to) for each spell.
template <typename Use>
void eachSpell(const std::vector<bool>& fails, Use use) {
  for (std::size_t from = 0; from < fails.size();) {
    std::size_t to = from;
    while (to < fails.size() && fails[to] == fails[from]) ++to;
    if (fails[from]) use(from, to);
    from = to;
  }
}

// A taxel that fails.
struct FailingTaxel {
  std::size_t taxel = 0;
  std::optional<FaultKind> kind;  // none: it is neither dead nor stuck
  double p = 1;
  Spells spells;
};

class FaultSearch {
 public:
  FaultSearch(const Sheet& sheet, const FaultOptions& options)
      : sheet_(sheet), options_(options), courses_(taxelCourses(sheet)) {
    for (const StayCourses& stay : courses_) faults_.squares.emplace_back(stay.scans(), 0);
    for (std::size_t t = 0; t < sheet.used.size(); ++t) {
      if (sheet.used[t]) taxels_.push_back(t);
    }
  }
  Faults run(const FaultProgress& progress);

 private:
  Course medianOf(const std::vector<std::size_t>& taxels) const;
  Outlier judge(const std::vector<double>& own, const std::vector<std::vector<double>>& others,
                const std::vector<std::size_t>& spans, double tests) const;
  Spells spellsOf(const Course& course, std::size_t span, double limit) const;
  void join(std::size_t taxel, Spells& spells) const;
  std::optional<FaultKind> kindOf(std::size_t taxel, const Spells& spells) const;
  std::vector<FailingTaxel> failingTaxels() const;
  std::vector<std::vector<std::size_t>> linesOf(FaultKind kind) const;
  Course contrastOf(const std::vector<std::vector<std::size_t>>& lines, const std::vector<Course>& medians,
                    std::size_t line, double& noise) const;
  bool findLine(const std::vector<FaultKind>& kinds);
  void joinLines(FaultKind kind, const std::vector<FailingTaxel>& failing);
  bool isLoop(const Course& course, std::size_t taxel) const;
  bool keep(FaultKind kind, double p, const Members& members);
  bool isSound(std::size_t taxel) const { return std::count(taxels_.begin(), taxels_.end(), taxel) > 0; }

  const Sheet& sheet_;
  const FaultOptions& options_;
  std::vector<StayCourses> courses_;
  std::vector<std::size_t> taxels_;  // the sound ones
  Faults faults_;
};

// Median deviation of some taxels: what less than half of them do does not count.
Course FaultSearch::medianOf(const std::vector<std::size_t>& taxels) const {
  Course course;
  std::vector<double> values(taxels.size());
  const auto middle = values.begin() + (taxels.size() / 2);
  for (const StayCourses& stay : courses_) {
    course.emplace_back(stay.scans());
    for (std::size_t i = 0; i < stay.scans(); ++i) {
      for (std::size_t k = 0; k < taxels.size(); ++k) values[k] = stay.deviates(taxels[k], i);
      std::nth_element(values.begin(), middle, values.end());
      course.back()[i] = *middle;
    }
  }
  return course;
}

// `own`, `others`: logarithms of the largest means, [spans], [others][spans].
Outlier FaultSearch::judge(const std::vector<double>& own, const std::vector<std::vector<double>>& others,
                           const std::vector<std::size_t>& spans, double tests) const {
  Outlier outlier;
  if (others.size() < kFewestForQuartiles) return outlier;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    std::vector<double> values;
    for (const std::vector<double>& other : others) values.push_back(other[s]);
    const Gumbel usual(values);
    outlier.p = std::min(outlier.p, tests * usual.p(own[s]));
    const double limit = usual.exceededBy(options_.level / tests);
    if (outlier.span != 0 || own[s] < limit) continue;
    outlier.span = spans[s];
    outlier.limit = std::exp(limit);
  }
  return outlier;
}

// Scans in windows of `span` scans whose mean is beyond `limit`.
Spells FaultSearch::spellsOf(const Course& course, std::size_t span, double limit) const {
  Spells spells;
  for (const Eigen::VectorXd& stay : course) spells.emplace_back(stay.size(), false);
  eachMean(course, span, false, [&](std::size_t v, Eigen::Index at, double mean) {
    for (Eigen::Index i = at; std::abs(mean) >= limit && i < at + Eigen::Index(span); ++i)
      if (std::abs(course[v][i]) > limit / 2) spells[v][static_cast<std::size_t>(i)] = true;
  });
  return spells;
}

// Joins spells of one fault: between them it would not have shown, or it shows in most scans.
void FaultSearch::join(std::size_t taxel, Spells& spells) const {
  for (std::size_t v = 0; v < spells.size(); ++v) {
    std::vector<bool> joined = spells[v];
    std::size_t last = joined.size(), run = 0;  // end and length of the spell before
    eachSpell(spells[v], [&](std::size_t from, std::size_t to) {
      bool hidden = from > last;
      for (std::size_t i = last; i < from && hidden; ++i)
        hidden = courses_[v].expected(taxel, i) < kShows || std::abs(courses_[v].deviates(taxel, i)) > kShows;
      if (from > last && (hidden || from - last <= std::min(run, to - from) / 2))
        std::fill(joined.begin() + last, joined.begin() + from, true);
      last = to;
      run = to - from;
    });
    spells[v] = joined;
  }
}

// Holds the readings at the end of each spell against what is expected. Spells that show nothing do not
// count; others count by their squared errors, so spells of two kinds are neither.
std::optional<FaultKind> FaultSearch::kindOf(std::size_t taxel, const Spells& spells) const {
  std::vector<double> sound;
  const double code = 0.5 / sheet_.full_scale;
  double kept = 1, steps = 2;  // readings that are those of the scan before, and all
  double unloaded = INFINITY;  // lowest reading of the sheet [share of full scale]
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    for (const std::size_t t : taxels_) unloaded = std::min(unloaded, courses_[v].lowest[t]);
    for (std::size_t i = 0; i < courses_[v].scans(); ++i) {
      if (spells[v][i]) continue;
      sound.push_back(std::abs(courses_[v].deviates(taxel, i)));
      if (i == 0 || spells[v][i - 1]) continue;
      kept += std::abs(courses_[v].reading(taxel, i) - courses_[v].reading(taxel, i - 1)) < code;
      steps += 1;
    }
  }
  const double noise = statistics::kDeviationPerMedian * statistics::upperMedian(sound, 0);
  const double limit = std::max(kLeastLimit, kBeyondNoise * noise);  // [range of the taxel]
  double all = 0, dead = 0, stuck = 0;
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    const StayCourses& stay = courses_[v];
    eachSpell(spells[v], [&](std::size_t from, std::size_t to) {
      std::vector<double> reading, expected;
      double square = 0;
      for (std::size_t i = from; i < to; ++i) {
        square += std::pow(stay.deviates(taxel, i), 2);
        if (i - from < (to - from) / 2) continue;
        reading.push_back(stay.reading(taxel, i));
        expected.push_back(stay.expected(taxel, i));
      }
      std::sort(reading.begin(), reading.end());
      const auto outside = static_cast<std::size_t>(kOutside * double(reading.size()));
      const auto [low, high] = std::minmax_element(expected.begin(), expected.end());
      // One code for so long that the noise of a sound taxel would have changed it: no open circuit either.
      const bool frozen = reading.back() - reading.front() < code &&
                          std::pow(kept / steps, double(reading.size() - 1)) < options_.level;
      const double most = limit * stay.unit[taxel];
      const double floor = std::max(kOpen, unloaded + (frozen ? -most : most));
      const auto verdict =
          verdictOf({reading[outside], reading[reading.size() - 1 - outside], floor, most, INFINITY},
                    {*high >= kShows, frozen || *high - *low >= std::max(kShows, 2 * limit), false});
      all += verdict ? square : 0;
      if (verdict == map::taxel_flag::kDead) dead += square;
      if (verdict == map::taxel_flag::kStuck) stuck += square;
    });
  }
  if (all == 0 || std::max(dead, stuck) < kOfOneKind * all) return {};
  return dead > stuck ? FaultKind::kDeadTaxels : FaultKind::kStuckTaxels;
}

std::vector<FailingTaxel> FaultSearch::failingTaxels() const {
  std::size_t longest = 0;
  for (const StayCourses& stay : courses_) longest = std::max(longest, stay.scans());
  std::vector<std::size_t> spans;
  for (std::size_t span = 2; span <= longest; span *= 2) spans.push_back(span);
  std::vector<std::vector<double>> all;
  for (const std::size_t taxel : taxels_) all.push_back(largest(medianOf({taxel}), spans, false));
  std::vector<FailingTaxel> failing;
  for (std::size_t k = 0; k < taxels_.size(); ++k) {
    const Outlier outlier = judge(all[k], all, spans, double(taxels_.size() * spans.size()));
    if (outlier.span == 0) continue;
    Spells spells = spellsOf(medianOf({taxels_[k]}), outlier.span, outlier.limit);
    join(taxels_[k], spells);
    failing.push_back({taxels_[k], kindOf(taxels_[k], spells), outlier.p, spells});
  }
  return failing;
}

// Sound taxels of each row or column that has enough of them.
std::vector<std::vector<std::size_t>> FaultSearch::linesOf(FaultKind kind) const {
  std::map<std::size_t, std::vector<std::size_t>> all;
  for (const std::size_t t : taxels_) all[lineOf(sheet_.layout, kind, t)].push_back(t);
  std::vector<std::vector<std::size_t>> lines;
  for (const auto& [line, taxels] : all)
    if (taxels.size() >= kFewestOfALine) lines.push_back(taxels);
  return lines;
}

// The median of a line less those of the lines beside it. `noise`: of it, per noise of a taxel.
Course FaultSearch::contrastOf(const std::vector<std::vector<std::size_t>>& lines,
                               const std::vector<Course>& medians, std::size_t line, double& noise) const {
  Course contrast = medians[line];
  const double parts = line == 0 || line + 1 == lines.size() ? 1 : 2;  // lines beside it
  double variance = 1 / double(lines[line].size());
  for (const std::size_t beside : {line - 1, line + 1}) {
    if (beside >= lines.size()) continue;
    variance += 1 / (double(lines[beside].size()) * parts * parts);
    for (std::size_t v = 0; v < contrast.size(); ++v) contrast[v] -= medians[beside][v] / parts;
  }
  noise = std::sqrt(variance * M_PI / 2);  // the variance of a median is that of a mean times pi / 2
  return contrast;
}

// Keeps the line that stands out most among the taxels of the other lines.
bool FaultSearch::findLine(const std::vector<FaultKind>& kinds) {
  std::vector<std::vector<double>> of_taxels;
  for (const std::size_t taxel : taxels_)
    of_taxels.push_back(largest(medianOf({taxel}), kSpansOfSteps, true));
  const matrix::MatrixSize size = sheet_.layout.size;
  const double tests = double(size.rows + size.columns) * double(kSpansOfSteps.size());
  Members best;
  FaultKind best_kind = FaultKind::kRow;
  double p = 1;
  for (const FaultKind kind : kinds) {
    const std::vector<std::vector<std::size_t>> lines = linesOf(kind);
    std::vector<Course> medians;
    for (const std::vector<std::size_t>& line : lines) medians.push_back(medianOf(line));
    for (std::size_t l = 0; l < lines.size() && lines.size() >= kFewestLines; ++l) {
      std::vector<std::vector<double>> others;
      for (std::size_t k = 0; k < taxels_.size(); ++k)
        if (!std::count(lines[l].begin(), lines[l].end(), taxels_[k])) others.push_back(of_taxels[k]);
      double noise = 1;
      const Course contrast = contrastOf(lines, medians, l, noise);
      std::vector<double> steps = largest(contrast, kSpansOfSteps, true);
      for (double& step : steps) step -= std::log(noise);
      const Outlier outlier = judge(steps, others, kSpansOfSteps, tests);
      if (outlier.span == 0 || outlier.p >= p || isLoop(contrast, lines[l].front())) continue;
      // It steps itself, and not only the lines beside it.
      if (largest(medians[l], {outlier.span}, true)[0] <
          std::log(kOwnStep) + largest(contrast, {outlier.span}, true)[0])
        continue;
      p = outlier.p;
      best_kind = kind;
      best.clear();
      const Spells spells = spellsOf(contrast, outlier.span, outlier.limit * noise / 2);
      for (const std::size_t taxel : lines[l]) best[taxel] = spells;
    }
  }
  return !best.empty() && keep(best_kind, p, best);
}

// Share of the scans in which one of two taxels fails that both fail in.
double together(const Spells& a, const Spells& b) {
  double both = 0, any = 0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    for (std::size_t i = 0; i < a[v].size(); ++i) {
      both += a[v][i] && b[v][i];
      any += a[v][i] || b[v][i];
    }
  }
  return any > 0 ? both / any : 0;
}

// Taxels that fail together and make up a line have one cause.
void FaultSearch::joinLines(FaultKind kind, const std::vector<FailingTaxel>& failing) {
  for (const std::vector<std::size_t>& line : linesOf(kind)) {
    Members members;
    double p = 1;
    for (const FailingTaxel& one : failing) {
      if (!std::count(line.begin(), line.end(), one.taxel)) continue;
      if (!members.empty() && together(members.begin()->second, one.spells) < kTogether) continue;
      members[one.taxel] = one.spells;
      p = std::min(p, one.p);
    }
    if (members.size() == line.size() && !isLoop(medianOf(line), line.front())) keep(kind, p, members);
  }
}

// Whether the course of a line does the same in every cycle: it differs by direction at the same reading,
// which is that of one of its taxels.
bool FaultSearch::isLoop(const Course& course, std::size_t taxel) const {
  double squares = 0, between = 0;
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    std::map<long, std::array<statistics::RunningMoments, 2>> bins;  // falling, rising
    for (std::size_t i = 0; i < courses_[v].scans(); ++i) {
      const long reading = std::lround(courses_[v].expected(taxel, i) / kReadingBin);
      bins[reading][sheet_.stays[v].rising[i]].add(course[v][i]);
    }
    for (const auto& [at, bin] : bins) {
      const double a = bin[0].count, b = bin[1].count, loop = std::pow(bin[0].mean - bin[1].mean, 2);
      if (a > 0 && b > 0) between += a * b / (a + b) * loop;
    }
    squares += course[v].squaredNorm();
  }
  return between > kLoop * squares;
}

// Computes times, share, depth and size of a fault from the spells of its taxels, and keeps it where its size
// matters.
bool FaultSearch::keep(FaultKind kind, double p, const Members& members) {
  Fault fault;
  fault.kind = kind;
  fault.p = p;
  if (fault.isLine()) fault.line = lineOf(sheet_.layout, kind, members.begin()->first);
  double hit = 0, all = 0, lost = 0, lost_of = 0, square = 0;
  std::vector<std::vector<double>> squares = faults_.squares;
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    bool before = false;
    for (std::size_t i = 0; i < courses_[v].scans(); ++i) {
      bool now = false;
      for (const auto& [taxel, spells] : members) {
        if (!spells[v][i]) continue;
        now = true;
        const double deviation = courses_[v].deviates(taxel, i);
        square += deviation * deviation;
        squares[v][i] += std::pow(deviation * courses_[v].unit[taxel], 2);
        lost -= deviation;
        lost_of += courses_[v].expected(taxel, i);
      }
      all += 1;
      hit += now;
      const double time = sheet_.stays[v].time(i);
      if (now && !before) fault.times.emplace_back(time, time);
      if (now) fault.times.back().second = time;
      before = now;
    }
  }
  for (const auto& [from, to] : fault.times) fault.longest = std::max(fault.longest, to - from);
  fault.share = hit / std::max(1.0, all);
  fault.depth = lost_of > 0 ? lost / lost_of : 0;
  const double error = std::sqrt(square / (std::max(1.0, all) * double(members.size())));
  for (const auto& [taxel, spells] : members) fault.taxels.push_back(taxel);
  if (hit == 0 || error < options_.least_error) return false;
  for (const std::size_t taxel : fault.taxels)
    taxels_.erase(std::find(taxels_.begin(), taxels_.end(), taxel));
  faults_.faults.push_back(std::move(fault));
  faults_.squares = std::move(squares);
  return true;
}

Faults FaultSearch::run(const FaultProgress& progress) {
  const auto tell = [&](double share) {  // as measured on sound bags
    if (progress) progress(share);
  };
  tell(0.3);
  std::vector<FaultKind> kinds = {FaultKind::kRow, FaultKind::kColumn};  // at most one of each
  while (findLine(kinds)) kinds.erase(std::find(kinds.begin(), kinds.end(), faults_.faults.back().kind));
  tell(0.8);
  const std::vector<FailingTaxel> failing = failingTaxels();
  for (const FaultKind kind : {FaultKind::kRow, FaultKind::kColumn}) joinLines(kind, failing);
  for (const FaultKind kind : {FaultKind::kStuckTaxels, FaultKind::kDeadTaxels}) {
    Members members;
    double p = 1;
    for (const FailingTaxel& one : failing) {
      if (one.kind != kind || !isSound(one.taxel)) continue;
      members[one.taxel] = one.spells;
      p = std::min(p, one.p);
    }
    if (!members.empty()) keep(kind, p, members);
  }
  tell(1);
  return std::move(faults_);
}

}  // namespace

Faults findFaults(const Sheet& sheet, const FaultOptions& options, const FaultProgress& progress) {
  return FaultSearch(sheet, options).run(progress);
}

}  // namespace fsr::health
