#include "health/faults.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
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
const std::vector<std::size_t> kSpansOfSteps = {2, 4, 8, 16, 32};  // scans beside a step
// Quantiles of Gumbel's standard distribution: median, and difference of the quartiles.
constexpr double kGumbelMedian = 0.36651, kGumbelQuartiles = 1.57253;
// Least scale of the logarithm of the taxels' largest deviations: they differ by some per cent by chance
// alone, and by steps of the converter.
constexpr double kLeastScale = 0.1;
constexpr double kLeastMean = 1e-6;  // has a logarithm
// Share of a taxel's range above which the others certainly load it, or move it.
constexpr double kShows = 0.3;
// Limits of the rule: deviations of the noise, and the least share of a taxel's range.
constexpr double kBeyondNoise = 5, kLeastLimit = 0.02;
constexpr double kOpen = 0.001;   // share of full scale; see TaxelWatchOptions::floor_share
constexpr double kOpenCodes = 3;  // of an open circuit; a converter's noise
// Share of the readings in the later part of a spell that may lie beyond the limits.
constexpr double kOutside = 0.05;
// Share of a taxel's squared error that its kind must account for.
constexpr double kOfOneKind = 0.7;

// A taxel that fades: parts of a stay whose gains are compared, least loss over a stay, and tried durations.
constexpr std::size_t kParts = 4;
constexpr double kFades = 0.03;
constexpr double kTells = 0.1;  // of the largest sum of squared expected readings of a part
constexpr int kTriedDurations = 60;
// A taxel that loses its contact in each spell: tried durations and starts, largest share of the gain that
// may be left at the end, and of the squared error of a reading, or a gain, that is kept through the spell.
constexpr int kDurations = 24;
constexpr std::size_t kStarts = 12, kFewestScans = 4;
constexpr double kMostLeft = 0.5, kUnlikeKept = 0.5;

// Share of the squared deviations of a line that the direction explains at the same reading. A line that does
// the same in every cycle has a loop or a lag; a contact fails at any time.
constexpr double kLoop = 0.3;
constexpr double kReadingBin = 0.1;  // of the range of the median reading
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
using Course = std::vector<std::vector<float>>;

// Logarithms of the largest means of some courses, [courses x spans].
using Largest = Eigen::ArrayXXd;

// From the largest sums over each number of scans, [courses x spans].
Largest logarithmsOf(Largest sums, const std::vector<std::size_t>& spans) {
  for (std::size_t s = 0; s < spans.size(); ++s) sums.col(s) /= double(spans[s]);
  return sums.max(kLeastMean).log();
}

// Of one course over each number of scans, [1 x spans].
Largest largestMeans(const Course& course, const std::vector<std::size_t>& spans) {
  Largest largest = Largest::Zero(1, Eigen::Index(spans.size()));
  for (const std::vector<float>& stay : course) {
    std::vector<double> sum(stay.size() + 1, 0);
    for (std::size_t i = 0; i < stay.size(); ++i) sum[i + 1] = sum[i] + double(stay[i]);
    for (std::size_t s = 0; s < spans.size(); ++s) {
      double most = largest(0, s);
      for (std::size_t at = 0; at + spans[s] < sum.size(); ++at)
        most = std::max(most, std::abs(sum[at + spans[s]] - sum[at]));
      largest(0, s) = most;
    }
  }
  return logarithmsOf(largest, spans);
}

// What some courses do, without their scans.
class CourseSums {
 public:
  explicit CourseSums(Eigen::Index courses)
      : last_(courses, Eigen::Index(2 * kSpansOfSteps.back() + 1)),
        most_(Eigen::ArrayXXd::Zero(courses, Eigen::Index(kSpansOfSteps.size()))),
        squares_(Eigen::ArrayXd::Zero(courses)),
        between_(squares_) {}

  // `scan` counts from 0 in each stay. `reading`: 0 .. 1 from the lowest to the highest.
  void add(std::size_t scan, double reading, bool rising, const Eigen::ArrayXd& values) {
    const auto before = [&](std::size_t back) { return last_.col((scan + 1 - back) % last_.cols()); };
    if (scan == 0) {
      finishStay();
      before(1).setZero();
    }
    before(0) = before(1) + values;
    for (std::size_t s = 0; s < kSpansOfSteps.size() && 2 * kSpansOfSteps[s] <= scan + 1; ++s) {
      const std::size_t span = kSpansOfSteps[s];
      most_.col(s) = most_.col(s).max((before(0) - 2 * before(span) + before(2 * span)).abs());
    }
    Bin& bin = bins_[std::lround(reading / kReadingBin)][rising];
    if (bin.number == 0) bin.sum.setZero(values.size());
    bin.sum += values;
    bin.number += 1;
    squares_ += values.square();
  }
  void finishStay() {
    for (const auto& [reading, bin] : bins_) {
      const double a = bin[0].number, b = bin[1].number;
      if (a > 0 && b > 0) between_ += a * b / (a + b) * (bin[0].sum / a - bin[1].sum / b).square();
    }
    bins_.clear();
  }
  // Of the mean over each of kSpansOfSteps scans less that over those before.
  Largest largestSteps() const { return logarithmsOf(most_, kSpansOfSteps); }
  // Whether the course does the same in every cycle: it differs by direction at the same reading.
  bool isLoop(Eigen::Index course) const { return between_[course] > kLoop * squares_[course]; }

 private:
  struct Bin {
    double number = 0;
    Eigen::ArrayXd sum;
  };

  Eigen::ArrayXXd last_;                     // sums of the values up to each of the last scans
  Eigen::ArrayXXd most_;                     // largest differences of two sums, [courses x spans]
  std::map<long, std::array<Bin, 2>> bins_;  // by reading; falling, rising
  Eigen::ArrayXd squares_, between_;
};

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
  double p = 1;                     // for any span
  std::optional<std::size_t> span;  // the shortest with an outlier: a longer one also grows beside a spell
  double limit = 0;                 // of the mean over it
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

// The time between a scan of a stay and the one before it [s].
double boundary(const Stay& stay, std::size_t scan) {
  return scan == 0 ? std::max(0.0, stay.time(0) - 1e-3) : (stay.time(scan - 1) + stay.time(scan)) / 2;
}

// How a taxel fades: since when, and until nothing would be left [s].
struct Fade {
  double start = 0, lasts = 0;
};

// Gain of a taxel in a part of a stay, against what is expected of it in that stay.
struct PartGain {
  std::size_t stay = 0;
  double time = 0;  // [s]
  double gain = 1;
  double weight = 0;   // sum of the squared expected readings
  double squares = 0;  // of the deviations
  double left = 0;     // of the deviations from the gain
};

// A taxel that fails.
struct FailingTaxel {
  std::size_t taxel = 0;
  std::optional<FaultKind> kind;  // none: it is not known how it fails
  double p = 1;
  Spells spells;
  std::vector<TaxelSpell> fades;  // of a taxel that fades
  double lasts = 0;               // from the start of a fade until nothing would be left [s]
};

// A row or column.
struct Line {
  FaultKind kind;
  std::vector<std::size_t> taxels;  // the sound ones
  std::vector<std::size_t> beside;  // indices of the lines beside it
  double noise = INFINITY;          // of its contrast, per noise of a taxel
};

// Weighted squared error of a fade, each stay with the factor that fits best.
double errorOf(const std::vector<PartGain>& gains, const Fade& fade) {
  std::map<std::size_t, std::array<double, 3>> sums;  // of each stay: gain squared, product, model squared
  for (const PartGain& part : gains) {
    const double model = std::clamp(1 - (part.time - fade.start) / fade.lasts, 0.0, 1.0);
    std::array<double, 3>& sum = sums[part.stay];
    sum[0] += part.weight * part.gain * part.gain;
    sum[1] += part.weight * part.gain * model;
    sum[2] += part.weight * model * model;
  }
  double error = 0;
  for (const auto& [stay, sum] : sums) error += sum[0] - (sum[2] > 0 ? sum[1] * sum[1] / sum[2] : 0);
  return error;
}

class FaultSearch {
 public:
  FaultSearch(const Sheet& sheet, const FaultOptions& options)
      : sheet_(sheet), options_(options), courses_(taxelCourses(sheet)) {
    for (std::size_t t = 0; t < sheet.used.size(); ++t) {
      if (sheet.used[t]) taxels_.push_back(t);
    }
  }
  Faults run(const FaultProgress& progress);

 private:
  std::vector<Line> linesOf(const std::vector<FaultKind>& kinds) const;
  template <typename Use>
  void eachScan(const std::vector<Line>& lines, Use use) const;
  CourseSums sumsOf(const std::vector<Line>& lines) const;
  Outlier judge(const Eigen::ArrayXd& own, const Largest& all, const std::vector<std::size_t>& others,
                double tests) const;
  Course courseOf(std::size_t taxel) const;
  void join(std::size_t taxel, Spells& spells) const;
  double longestRun(std::size_t taxel, const Spells& spells) const;
  Spells heldParts(std::size_t taxel, const Spells& spells) const;
  double squaresIn(std::size_t taxel, const Spells& spells) const;
  Spells openParts(std::size_t taxel, const Spells& spells) const;
  bool failsInParts(FailingTaxel& failing) const;
  std::optional<FaultKind> kindOf(std::size_t taxel, const Spells& spells, double& other) const;
  std::vector<PartGain> gainsOf(std::size_t taxel) const;
  std::optional<Fade> fadeOf(std::size_t taxel) const;
  void fadeInSpells(FailingTaxel& failing) const;
  std::vector<FailingTaxel> failingTaxels() const;
  bool findLine(const std::vector<FaultKind>& kinds);
  void joinLines(FaultKind kind, const std::vector<FailingTaxel>& failing);
  double firstOther(std::size_t v, std::size_t scan, std::size_t taxel, double low, double high) const;
  std::vector<TaxelSpell> taxelSpells(const Members& members) const;
  bool keep(FaultKind kind, double p, const Members& members);
  bool isSound(std::size_t taxel) const { return std::count(taxels_.begin(), taxels_.end(), taxel) > 0; }

  const Sheet& sheet_;
  const FaultOptions& options_;
  std::vector<StayCourses> courses_;
  std::vector<std::size_t> taxels_;  // the sound ones
  Faults faults_;
};

// Rows or columns with enough sound taxels.
std::vector<Line> FaultSearch::linesOf(const std::vector<FaultKind>& kinds) const {
  std::vector<Line> lines;
  for (const FaultKind kind : kinds) {
    const std::size_t first = lines.size();
    std::map<std::size_t, std::vector<std::size_t>> all;
    for (const std::size_t t : taxels_) all[lineOf(sheet_.layout, kind, t)].push_back(t);
    for (const auto& [line, taxels] : all)
      if (taxels.size() >= kFewestOfALine) lines.push_back({kind, taxels, {}});
    if (lines.size() < first + kFewestLines) continue;
    for (std::size_t l = first; l < lines.size(); ++l) {
      if (l > first) lines[l].beside.push_back(l - 1);
      if (l + 1 < lines.size()) lines[l].beside.push_back(l + 1);
      double variance = 1 / double(lines[l].taxels.size());
      for (const std::size_t b : lines[l].beside)
        variance += 1 / (double(lines[b].taxels.size()) * std::pow(lines[l].beside.size(), 2));
      lines[l].noise = std::sqrt(variance * M_PI / 2);  // a median has pi / 2 times the variance of a mean
    }
  }
  return lines;
}

// Calls use(stay, scan, values) for each scan. Values: the deviations of all taxels; the median of those of
// each line, in which what less than half of its taxels do does not count; the contrast of each line, which
// is its median less those of the lines beside it; and the contrast of medians that are, of the two in the
// middle, nearer to 0, in which what half of the taxels do does not count either.
template <typename Use>
void FaultSearch::eachScan(const std::vector<Line>& lines, Use use) const {
  const auto taxels = static_cast<Eigen::Index>(sheet_.used.size());
  Eigen::ArrayXd values(taxels + 3 * Eigen::Index(lines.size()));
  std::vector<double> of_line, nearer(lines.size());
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    dataset::ScanCounts counts(*sheet_.stays[v].recording);
    for (std::size_t i = 0; i < courses_[v].scans(); ++i) {
      courses_[v].deviations(i, counts[sheet_.stays[v].first + i], values.head(taxels));
      double* const median = values.data() + taxels;
      for (std::size_t l = 0; l < lines.size(); ++l) {
        of_line.clear();
        for (const std::size_t t : lines[l].taxels) of_line.push_back(values[t]);
        const auto middle = of_line.begin() + of_line.size() / 2;
        std::nth_element(of_line.begin(), middle, of_line.end());
        const double below = of_line.size() % 2 ? *middle : *std::max_element(of_line.begin(), middle);
        median[l] = *middle;
        nearer[l] = std::abs(below) < std::abs(*middle) ? below : *middle;
      }
      for (std::size_t l = 0; l < lines.size(); ++l) {
        double& contrast = median[lines.size() + l] = median[l];
        double& nearer_contrast = median[2 * lines.size() + l] = nearer[l];
        for (const std::size_t b : lines[l].beside) {
          contrast -= median[b] / double(lines[l].beside.size());
          nearer_contrast -= nearer[b] / double(lines[l].beside.size());
        }
      }
      use(v, i, values);
    }
  }
}

CourseSums FaultSearch::sumsOf(const std::vector<Line>& lines) const {
  CourseSums sums(Eigen::Index(sheet_.used.size() + 3 * lines.size()));
  eachScan(lines, [&](std::size_t v, std::size_t i, const Eigen::ArrayXd& values) {
    const double reading = double(courses_[v].place[i]) / double(courses_[v].curve.cols() - 1);
    sums.add(i, reading, sheet_.stays[v].rising[i], values);
  });
  sums.finishStay();
  return sums;
}

// `own`: logarithms of the largest means, [spans]. `others`: rows of `all`.
Outlier FaultSearch::judge(const Eigen::ArrayXd& own, const Largest& all,
                           const std::vector<std::size_t>& others, double tests) const {
  Outlier outlier;
  if (others.size() < kFewestForQuartiles) return outlier;
  for (Eigen::Index s = 0; s < own.size(); ++s) {
    std::vector<double> values;
    for (const std::size_t other : others) values.push_back(all(other, s));
    const Gumbel usual(values);
    outlier.p = std::min(outlier.p, tests * usual.p(own[s]));
    const double limit = usual.exceededBy(options_.level / tests);
    if (outlier.span || own[s] < limit) continue;
    outlier.span = s;
    outlier.limit = std::exp(limit);
  }
  return outlier;
}

// Spells in which a course is about `limit` or more away from 0 for `span` scans, or farther for fewer: they
// begin and end where the sum of what lies beyond half the limit is smallest and largest. Source: E. Page,
// Continuous inspection schemes, Biometrika 41 (1954) 100.
Spells spellsOf(const Course& course, std::size_t span, double limit) {
  const double enough = double(span) * limit / 2;
  Spells spells;
  for (const std::vector<float>& stay : course) {
    spells.emplace_back(stay.size(), false);
    for (const double sign : {-1, 1}) {
      double sum = 0, most = 0;
      for (std::size_t i = 0, from = 0, to = 0; i < stay.size(); ++i) {
        sum += sign * double(stay[i]) - limit / 2;
        if (sum > most) {
          most = sum;
          to = i + 1;
        }
        if (sum > 0 && most - sum < enough && i + 1 < stay.size()) continue;
        if (most >= enough) {
          std::fill(spells.back().begin() + from, spells.back().begin() + to, true);
          i = to - 1;
        }
        sum = most = 0;
        from = i + 1;
      }
    }
  }
  return spells;
}

Course FaultSearch::courseOf(std::size_t taxel) const {
  Course course;
  for (const StayCourses& stay : courses_) {
    course.emplace_back(stay.scans());
    TaxelCourse of_taxel(stay, taxel);
    for (std::size_t i = 0; i < stay.scans(); ++i)
      course.back()[i] = static_cast<float>(of_taxel.deviates(i));
  }
  return course;
}

// Joins spells of one fault: between them it would not have shown, or it shows in most scans.
void FaultSearch::join(std::size_t taxel, Spells& spells) const {
  for (std::size_t v = 0; v < spells.size(); ++v) {
    std::vector<bool> joined = spells[v];
    TaxelCourse course(courses_[v], taxel);
    std::size_t last = joined.size(), run = 0;  // end and length of the spell before
    eachSpell(spells[v], [&](std::size_t from, std::size_t to) {
      bool hidden = from > last;
      for (std::size_t i = last; i < from && hidden; ++i)
        hidden = courses_[v].expected(taxel, i) < kShows || std::abs(course.deviates(i)) > kShows;
      if (from > last && (hidden || from - last <= std::min(run, to - from) / 2))
        std::fill(joined.begin() + last, joined.begin() + from, true);
      last = to;
      run = to - from;
    });
    spells[v] = joined;
  }
}

// By how much a load came and went.
double swing(const std::vector<double>& load) {
  std::vector<double> before = load;  // lowest up to each scan
  for (std::size_t i = 1; i < load.size(); ++i) before[i] = std::min(before[i - 1], load[i]);
  double most = 0, after = INFINITY;
  for (std::size_t i = load.size(); i-- > 0;) {
    after = std::min(after, load[i]);
    most = std::max(most, load[i] - std::max(before[i], after));
  }
  return most;
}

// The middle of a spell, or of its loaded scans where that is earlier: a spell may end after the load. Before
// it a fault may still be on its way.
std::size_t judgedFrom(const StayCourses& stay, std::size_t taxel, std::size_t from, std::size_t to) {
  std::vector<std::size_t> loaded;
  for (std::size_t i = from; i < to; ++i) {
    if (stay.expected(taxel, i) >= kShows) loaded.push_back(i);
  }
  const std::size_t middle = from + (to - from) / 2;
  return loaded.empty() ? middle : std::min(middle, loaded[loaded.size() / 2]);
}

// How many scans in a row have one code before a sound taxel is unlikely to show it: by the share of its
// other scans, outside of the spells, that repeat the code before.
double FaultSearch::longestRun(std::size_t taxel, const Spells& spells) const {
  double kept = 1, steps = 2;
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    TaxelCourse course(courses_[v], taxel);
    for (std::size_t i = 1; i < courses_[v].scans(); ++i) {
      if (spells[v][i] || spells[v][i - 1]) continue;
      kept += course.repeats(i);
      steps += 1;
    }
  }
  return 1 + std::log(options_.level) / std::log(kept / steps);
}

// The parts of the spells in which the taxel keeps one code for longer. It may keep another one in each.
Spells FaultSearch::heldParts(std::size_t taxel, const Spells& spells) const {
  const double longest = longestRun(taxel, spells);
  Spells held;
  for (std::size_t v = 0; v < spells.size(); ++v) {
    held.emplace_back(spells[v].size(), false);
    TaxelCourse course(courses_[v], taxel);
    eachSpell(spells[v], [&](std::size_t from, std::size_t to) {
      for (std::size_t first = from, i = from + 1; i <= to; ++i) {
        if (i < to && course.repeats(i)) continue;
        // The first scan is sound: its reading is the one that is kept.
        if (longest < double(i - first))
          std::fill(held.back().begin() + first + 1, held.back().begin() + i, true);
        first = i;
      }
    });
  }
  return held;
}

double FaultSearch::squaresIn(std::size_t taxel, const Spells& spells) const {
  double squares = 0;
  for (std::size_t v = 0; v < spells.size(); ++v) {
    TaxelCourse course(courses_[v], taxel);
    for (std::size_t i = 0; i < spells[v].size(); ++i)
      if (spells[v][i]) squares += std::pow(course.deviates(i), 2);
  }
  return squares;
}

// The parts of the spells in which the taxel reads no more than an open circuit.
Spells FaultSearch::openParts(std::size_t taxel, const Spells& spells) const {
  const double most = std::max(kOpen, kOpenCodes / sheet_.full_scale);
  Spells open = spells;
  for (std::size_t v = 0; v < spells.size(); ++v) {
    TaxelCourse course(courses_[v], taxel);
    for (std::size_t i = 0; i < spells[v].size(); ++i) open[v][i] = spells[v][i] && course.reading(i) <= most;
  }
  return open;
}

// Spells may hold sound scans between two failures. Where parts of them are all of one kind and account for
// most of their squared error, the parts become the spells.
bool FaultSearch::failsInParts(FailingTaxel& failing) const {
  const double all = squaresIn(failing.taxel, failing.spells);
  const auto become = [&](Spells parts, FaultKind kind) {
    double other = 0;
    if (kindOf(failing.taxel, parts, other) != kind) return false;
    if (squaresIn(failing.taxel, parts) < kOfOneKind * all) return false;
    failing.kind = kind;
    failing.spells = std::move(parts);
    return true;
  };
  return become(openParts(failing.taxel, failing.spells), FaultKind::kDeadTaxels) ||
         become(heldParts(failing.taxel, failing.spells), FaultKind::kStuckTaxels);
}

// Holds the readings at the end of each spell against what is expected. Spells that show nothing do not
// count; others count by their squared errors, so spells of two kinds are neither. `other`: the squared
// errors of spells of another kind.
std::optional<FaultKind> FaultSearch::kindOf(std::size_t taxel, const Spells& spells, double& other) const {
  std::vector<double> sound;
  double unloaded = INFINITY;  // lowest reading of the sheet [share of full scale]
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    for (const std::size_t t : taxels_) unloaded = std::min(unloaded, courses_[v].lowest[t]);
    TaxelCourse course(courses_[v], taxel);
    for (std::size_t i = 0; i < courses_[v].scans(); ++i) {
      if (!spells[v][i]) sound.push_back(std::abs(course.deviates(i)));
    }
  }
  const double noise = statistics::kDeviationPerMedian * statistics::upperMedian(sound, 0);
  const double limit = std::max(kLeastLimit, kBeyondNoise * noise);  // [range of the taxel]
  const double longest = longestRun(taxel, spells), code = 0.5 / sheet_.full_scale;
  double all = 0, dead = 0, stuck = 0;
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    const StayCourses& stay = courses_[v];
    TaxelCourse course(stay, taxel);
    eachSpell(spells[v], [&](std::size_t from, std::size_t to) {
      std::vector<double> reading, expected;
      double square = 0;
      for (std::size_t i = from; i < to; ++i) square += std::pow(course.deviates(i), 2);
      for (std::size_t i = judgedFrom(stay, taxel, from, to); i < to; ++i) {
        reading.push_back(course.reading(i));
        expected.push_back(stay.expected(taxel, i));
      }
      std::sort(reading.begin(), reading.end());
      const auto outside = static_cast<std::size_t>(kOutside * double(reading.size()));
      const auto [low, high] = std::minmax_element(expected.begin(), expected.end());
      // A lag keeps a reading still while a load comes, but not while it comes and goes.
      const double lost = kResponds * swing(expected) * stay.unit[taxel];
      // One code for so long that the noise of a sound taxel would have changed it: no open circuit either.
      const bool one_code = reading.back() - reading.front() < code;
      const bool frozen = one_code && longest < double(reading.size());
      const double most = limit * stay.unit[taxel];
      const double floor = std::max(kOpen, unloaded + (frozen ? -most : most));
      const auto verdict = verdictOf(
          {reading[outside], reading[reading.size() - 1 - outside], floor, std::max(most, lost), INFINITY},
          {*high >= kShows, frozen || *high - *low >= std::max(kShows, 2 * limit), false});
      all += verdict ? square : 0;
      if (verdict == map::taxel_flag::kDead) dead += square;
      if (verdict == map::taxel_flag::kStuck) stuck += square;
    });
  }
  other = all - std::max(dead, stuck);
  if (all == 0 || other > (1 - kOfOneKind) * all) return {};
  return dead > stuck ? FaultKind::kDeadTaxels : FaultKind::kStuckTaxels;
}

std::vector<PartGain> FaultSearch::gainsOf(std::size_t taxel) const {
  std::vector<PartGain> gains;
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    const StayCourses& stay = courses_[v];
    if (stay.foreign[taxel]) continue;  // the gain of another bend is none of this one's
    TaxelCourse course(stay, taxel);
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t from = part * stay.scans() / kParts, to = (part + 1) * stay.scans() / kParts;
      if (from == to) continue;
      PartGain now{v, stay.stay->time((from + to) / 2)};
      double product = 0;
      for (std::size_t i = from; i < to; ++i) {
        const double expected = stay.expected(taxel, i), deviates = course.deviates(i);
        now.weight += expected * expected;
        product += expected * deviates;
        now.squares += deviates * deviates;
      }
      if (!(now.weight > 0)) continue;
      now.gain = 1 + product / now.weight;
      now.left = now.squares - product * product / now.weight;
      gains.push_back(now);
    }
  }
  // Where nearly nothing is left, it has no gain that could be lost.
  const auto by_weight = [](const PartGain& a, const PartGain& b) { return a.weight < b.weight; };
  const auto most = std::max_element(gains.begin(), gains.end(), by_weight);
  const double least = most == gains.end() ? 0 : kTells * most->weight;
  gains.erase(std::remove_if(gains.begin(), gains.end(), [&](const PartGain& g) { return g.weight < least; }),
              gains.end());
  return gains;
}

// Whether a taxel loses gain from part to part of each stay, or of those after it began to, and how fast: the
// gain 1 - (t - start) / lasts fits best, with a factor for each stay, because a change of mount is no fault.
std::optional<Fade> FaultSearch::fadeOf(std::size_t taxel) const {
  const std::vector<PartGain> gains = gainsOf(taxel);
  double squares = 0, left = 0;
  bool lost = false;
  for (std::size_t k = 0; k < gains.size(); ++k) {
    squares += gains[k].squares;
    left += gains[k].left;
    if (k == 0 || gains[k].stay != gains[k - 1].stay) continue;
    lost = lost || gains[k].gain < gains[k - 1].gain - kFades;
    if (gains[k].gain > gains[k - 1].gain + kFades / kParts) return {};
  }
  if (!lost || left > (1 - kOfOneKind) * squares) return {};
  const double first = sheet_.stays.front().time(0);
  const double whole = gains.back().time - first;
  Fade best;
  double least = INFINITY;
  for (std::size_t b = 0; b < gains.size(); ++b) {
    const double start = b == 0 ? first : gains[b - 1].time;
    for (int d = 0; d < kTriedDurations; ++d) {
      const double lasts = 0.1 * whole * std::pow(10, 2.0 * d / kTriedDurations);
      const double error = errorOf(gains, {start, lasts});
      if (error >= least) continue;
      least = error;
      best = {start, lasts};
    }
  }
  return best;
}

// The scans of a stay that begin as long before a spell as it lasts: contact is lost before much is.
struct Window {
  std::size_t stay = 0, first = 0, from = 0, to = 0;  // scans; the spell begins at `from`
  std::vector<double> time, expected, deviation;      // [s], [unit of the courses]; since `first`
};

struct WindowError {
  double error = INFINITY;
  double start = 0;  // of the fade [s]
  double left = 1;   // of the gain at the end
};

// The start at which a fade that takes `lasts` [s] explains a window best.
WindowError bestStart(const Window& window, double lasts) {
  WindowError best;
  const std::size_t before = window.from - window.first;
  for (std::size_t k = 0; k <= kStarts; ++k) {
    const double start = window.time[k * before / kStarts];
    const auto left = [&](std::size_t i) {
      return std::clamp(1 - (window.time[i] - start) / lasts, 0.0, 1.0);
    };
    double error = 0;
    for (std::size_t i = 0; i < window.time.size(); ++i)
      error += std::pow(window.deviation[i] + window.expected[i] * (1 - left(i)), 2);
    if (error < best.error) best = {error, start, left(window.time.size() - 1)};
  }
  return best;
}

// Squared error of what else a spell can be: a reading that is kept, or a gain that is, whichever fits
// better.
double errorOfKept(const Window& window) {
  const auto from = static_cast<Eigen::Index>(window.from - window.first);
  const auto in_spell = static_cast<Eigen::Index>(window.time.size()) - from;
  using Values = Eigen::Map<const Eigen::ArrayXd>;
  const Values expected(window.expected.data() + from, in_spell);
  const Eigen::ArrayXd reading = expected + Values(window.deviation.data() + from, in_spell);
  const double gain = (reading * expected).sum() / std::max(1e-12, expected.square().sum());
  return Values(window.deviation.data(), from).square().sum() +
         std::min((reading - reading.mean()).square().sum(), (reading - gain * expected).square().sum());
}

// Whether a taxel loses its contact in the course of each spell and has it again afterwards. One duration
// holds for all spells of a taxel.
void FaultSearch::fadeInSpells(FailingTaxel& failing) const {
  std::vector<Window> windows;
  double squares = 0, kept = 0, longest = 0;
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    const StayCourses& stay = courses_[v];
    TaxelCourse course(stay, failing.taxel);
    eachSpell(failing.spells[v], [&](std::size_t from, std::size_t to) {
      Window window{v, from - std::min(from, to - from), from, to, {}, {}, {}};
      for (std::size_t i = window.first; i < to; ++i) {
        window.time.push_back(stay.stay->time(i));
        window.expected.push_back(stay.expectedReading(failing.taxel, i) / stay.unit[failing.taxel]);
        window.deviation.push_back(course.deviates(i));
        squares += std::pow(window.deviation.back(), 2);
      }
      kept += errorOfKept(window);
      longest = std::max(longest, window.time.back() - window.time.front());
      if (to - from >= kFewestScans) windows.push_back(std::move(window));
    });
  }
  if (windows.empty()) return;
  double least = INFINITY;
  for (int d = 0; d < kDurations; ++d) {
    const double lasts = 0.1 * longest * std::pow(10, 1.5 * d / kDurations);
    double error = 0, left = 0;
    std::vector<TaxelSpell> fades;
    for (const Window& window : windows) {
      const WindowError best = bestStart(window, lasts);
      error += best.error;
      left = std::max(left, best.left);
      const Stay& stay = *courses_[window.stay].stay;
      const double end = window.to < stay.last - stay.first ? boundary(stay, window.to) : INFINITY;
      fades.push_back({failing.taxel, best.start, end, 0});
    }
    if (error >= least || left > kMostLeft) continue;
    least = error;
    failing.fades = fades;
    failing.lasts = lasts;
  }
  if (least > std::min((1 - kOfOneKind) * squares, kUnlikeKept * kept)) return;
  failing.kind = FaultKind::kFadingTaxels;
}

std::vector<FailingTaxel> FaultSearch::failingTaxels() const {
  std::size_t longest = 0;
  for (const StayCourses& stay : courses_) longest = std::max(longest, stay.scans());
  std::vector<std::size_t> spans;
  for (std::size_t span = 2; span <= longest; span *= 2) spans.push_back(span);
  Largest all(sheet_.used.size(), spans.size());
  for (const std::size_t taxel : taxels_) all.row(taxel) = largestMeans(courseOf(taxel), spans);
  std::vector<FailingTaxel> failing;
  for (const std::size_t taxel : taxels_) {
    const Outlier outlier = judge(all.row(taxel), all, taxels_, double(taxels_.size() * spans.size()));
    if (!outlier.span) continue;
    Spells spells = spellsOf(courseOf(taxel), spans[*outlier.span], outlier.limit);
    join(taxel, spells);
    double other = 0;
    failing.push_back({taxel, kindOf(taxel, spells, other), outlier.p, spells, {}});
    if (!failing.back().kind && failsInParts(failing.back())) continue;
    // What is dead at last may have faded before.
    const std::optional<Fade> fade = failing.back().kind && other == 0 ? std::nullopt : fadeOf(taxel);
    if (!fade && !failing.back().kind) fadeInSpells(failing.back());
    if (!fade) continue;
    failing.back().kind = FaultKind::kFadingTaxels;
    failing.back().fades = {{taxel, fade->start, INFINITY, 0}};
    failing.back().lasts = fade->lasts;
    for (std::vector<bool>& stay : failing.back().spells) stay.assign(stay.size(), true);
  }
  return failing;
}

// Keeps the line that stands out most among the taxels of the other lines.
bool FaultSearch::findLine(const std::vector<FaultKind>& kinds) {
  const std::vector<Line> lines = linesOf(kinds);
  const CourseSums sums = sumsOf(lines);
  const Largest largest = sums.largestSteps();
  const matrix::MatrixSize size = sheet_.layout.size;
  const double tests = double(size.rows + size.columns) * double(kSpansOfSteps.size());
  Outlier best;
  std::size_t line = 0;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    std::vector<std::size_t> others;
    std::set_difference(taxels_.begin(), taxels_.end(), lines[l].taxels.begin(), lines[l].taxels.end(),
                        std::back_inserter(others));
    const std::size_t own = sheet_.used.size() + l, contrast = own + lines.size();
    const Outlier outlier = judge(largest.row(contrast) - std::log(lines[l].noise), largest, others, tests);
    if (!outlier.span || outlier.p >= best.p || sums.isLoop(Eigen::Index(contrast))) continue;
    const Eigen::Index nearer = Eigen::Index(contrast + lines.size());
    if (!judge(largest.row(nearer) - std::log(lines[l].noise), largest, others, tests).span) continue;
    // It steps itself, and not only the lines beside it.
    if (largest(own, *outlier.span) < std::log(kOwnStep) + largest(contrast, *outlier.span)) continue;
    best = outlier;
    line = l;
  }
  if (!best.span) return false;
  Course contrast(courses_.size());
  eachScan(lines, [&](std::size_t v, std::size_t, const Eigen::ArrayXd& values) {
    contrast[v].push_back(static_cast<float>(values[sheet_.used.size() + lines.size() + line]));
  });
  // A step has the noise of two means.
  const double limit = best.limit * lines[line].noise / std::sqrt(2);
  const Spells spells = spellsOf(contrast, kSpansOfSteps[*best.span], limit);
  Members members;
  for (const std::size_t taxel : lines[line].taxels) members[taxel] = spells;
  return keep(lines[line].kind, best.p, members);
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
  for (const Line& line : linesOf({kind})) {
    Members members;
    double p = 1;
    for (const FailingTaxel& one : failing) {
      if (!std::count(line.taxels.begin(), line.taxels.end(), one.taxel)) continue;
      if (!members.empty() && together(members.begin()->second, one.spells) < kTogether) continue;
      members[one.taxel] = one.spells;
      p = std::min(p, one.p);
    }
    if (members.size() < line.taxels.size()) continue;
    if (!sumsOf({{kind, line.taxels, {}}}).isLoop(Eigen::Index(sheet_.used.size()))) keep(kind, p, members);
  }
}

// When a taxel first has another reading than `low` to `high`, after scan `scan` of stay `v`: until then a
// spell goes on, since nothing shows that it has ended. INFINITY = never.
double FaultSearch::firstOther(std::size_t v, std::size_t scan, std::size_t taxel, double low,
                               double high) const {
  for (; v < courses_.size(); ++v, scan = 0) {
    TaxelCourse course(courses_[v], taxel);
    for (; scan < courses_[v].scans(); ++scan) {
      const double reading = course.reading(scan);
      if (reading < low - kOpen || reading > high + kOpen) return boundary(sheet_.stays[v], scan);
    }
  }
  return INFINITY;
}

// The spells of taxels.
std::vector<TaxelSpell> FaultSearch::taxelSpells(const Members& members) const {
  std::vector<TaxelSpell> all;
  for (const auto& [taxel, spells] : members) {
    for (std::size_t v = 0; v < courses_.size(); ++v) {
      TaxelCourse course(courses_[v], taxel);
      eachSpell(spells[v], [&, t = taxel](std::size_t from, std::size_t to) {
        std::vector<double> readings;
        for (std::size_t i = (from + to) / 2; i < to; ++i) readings.push_back(course.reading(i));
        const auto [low, high] = std::minmax_element(readings.begin(), readings.end());
        const double begin = boundary(sheet_.stays[v], from);
        if (!all.empty() && all.back().taxel == t && all.back().to > begin) all.back().to = begin;
        all.push_back({t, begin, firstOther(v, to, t, *low, *high),
                       sheet_.full_scale * statistics::upperMedian(readings, 0)});
      });
    }
  }
  return all;
}

// Computes times, share, depth and size of a fault from the spells of its taxels, and keeps it where its size
// matters.
bool FaultSearch::keep(FaultKind kind, double p, const Members& members) {
  Fault fault;
  fault.kind = kind;
  fault.p = p;
  if (fault.isLine()) fault.line = lineOf(sheet_.layout, kind, members.begin()->first);
  double hit = 0, all = 0, lost = 0, lost_of = 0, square = 0;
  std::vector<std::pair<double, double>> losses;  // of each spell: what is lost, and of how much
  std::vector<std::vector<float>> squares = faults_.squares;
  squares.resize(courses_.size());
  for (std::size_t v = 0; v < courses_.size(); ++v) {
    squares[v].resize(courses_[v].scans());
    std::vector<TaxelCourse> courses;
    for (const auto& [taxel, spells] : members) courses.emplace_back(courses_[v], taxel);
    bool before = false;
    for (std::size_t i = 0; i < courses_[v].scans(); ++i) {
      bool now = false;
      double loss = 0, loss_of = 0;
      auto course = courses.begin();
      for (const auto& [taxel, spells] : members) {
        TaxelCourse& own = *course++;
        if (!spells[v][i]) continue;
        now = true;
        const double deviation = own.deviates(i);
        square += deviation * deviation;
        squares[v][i] += static_cast<float>(std::pow(deviation * courses_[v].unit[taxel], 2));
        loss -= deviation;
        loss_of += courses_[v].expected(taxel, i);
      }
      lost += loss;
      lost_of += loss_of;
      all += 1;
      hit += now;
      const double time = sheet_.stays[v].time(i);
      if (now && !before) {
        fault.times.emplace_back(time, time);
        losses.emplace_back(0, 0);
      }
      if (now) {
        fault.times.back().second = time;
        losses.back().first += loss;
        losses.back().second += loss_of;
      }
      before = now;
    }
  }
  if (!fault.isLine()) fault.spells = taxelSpells(members);
  for (const auto& [from, to] : fault.times) fault.longest = std::max(fault.longest, to - from);
  fault.share = hit / std::max(1.0, all);
  fault.depth = lost_of > 0 ? lost / lost_of : 0;
  for (const auto& [loss, of] : losses) fault.depths.push_back(of > 0 ? loss / of : 0);
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
  for (const FaultKind kind : {FaultKind::kStuckTaxels, FaultKind::kDeadTaxels, FaultKind::kFadingTaxels}) {
    Members members;
    std::vector<TaxelSpell> fading;
    std::vector<double> lasts;
    double p = 1;
    for (const FailingTaxel& one : failing) {
      if (one.kind != kind || !isSound(one.taxel)) continue;
      members[one.taxel] = one.spells;
      fading.insert(fading.end(), one.fades.begin(), one.fades.end());
      lasts.push_back(one.lasts);
      p = std::min(p, one.p);
    }
    if (members.empty() || !keep(kind, p, members) || kind != FaultKind::kFadingTaxels) continue;
    faults_.faults.back().spells = fading;
    faults_.faults.back().fades_over = statistics::upperMedian(lasts);
  }
  tell(1);
  return std::move(faults_);
}

}  // namespace

Faults findFaults(const Sheet& sheet, const FaultOptions& options, const FaultProgress& progress) {
  return FaultSearch(sheet, options).run(progress);
}

}  // namespace fsr::health
