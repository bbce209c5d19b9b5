#include "blind/identifiability.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

namespace blind {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const std::set<std::string> kFaults = {"stuck_taxel", "dead_taxel", "row_fault", "column_fault"};
// Effects whose sign is known: a rival of these cannot be negative.
const std::set<std::string> kSigned = {"hysteresis", "creep", "seal_leak", "wear"};
// Effects of a second or a minute, which one pace of the ramps cannot separate.
const std::set<std::string> kFast = {"hysteresis", "creep", "time_skew", "seal_leak"};
// Effects that all taxels share; the only ones that rival each other.
const std::vector<std::string> kRivals = {"hysteresis", "creep",       "time_skew",
                                          "seal_leak",  "temperature", "wear",
                                          "break_in",   "drift",       "repositioning"};
constexpr std::uint64_t kDraws = 2;      // of the parameters of each form
constexpr double kMostReadings = 120e3;  // for one signature
constexpr double kLargestScale = 10;     // of a representative, relative to its usual size
constexpr double kShows = 2e-4;  // rms that an effect of its usual size must leave [share of full scale]
constexpr Index kChannels = 3;

Index cast(std::size_t number) {
  return static_cast<Index>(number);
}

// Signature of one effect on some taxels.
struct Seen {
  std::vector<std::size_t> taxels;
  MatrixXd blocks;   // [taxels x blocks], share of full scale
  double rms = 0;    // at the full rate
  double fast = 0;   // sum of the squares within the blocks
  double share = 1;  // taxels of the sheet for which one taxel here stands
};

// A time course that a rival may add, in its own unit, and how much of it: at most three times the usual
// size.
struct Course {
  VectorXd blocks;
  double low, high;
};

struct Channel {
  VectorXd pattern;  // over the taxels, unit length
  VectorXd gain;     // one standard deviation of the gain of each cycle, seen through the pattern
  double variance = 0;
};

class Study {
 public:
  explicit Study(const IdentifiabilityProblem& problem)
      : p_(problem), campaign_(problem.campaign), scans_(problem.campaign.scans()) {
    chooseTaxels();
    chooseBlocks();
    measureNoise();
    for (const std::string& id : kRivals) drawRival(id);
  }

  Identifiability run() {
    Identifiability result;
    std::set<std::string> done;
    std::vector<Seen> seen;
    for (const Active& active : p_.hidden) seen.push_back(see(active));
    for (std::size_t i = 0; i < seen.size(); ++i) {
      std::vector<Seen> partners = seen;
      partners.erase(partners.begin() + static_cast<std::ptrdiff_t>(i));
      const HiddenForm& form = *p_.hidden[i].placed->form;
      result.effects.push_back(judge(form, seen[i], partners, p_.strengths[i]));
      result.effects.back().hidden = true;
      done.insert(form.id);
    }
    for (const std::string& id : hiddenIds()) {
      const bool library = !formsOf(id).front()->foreign;
      if (library && done.count(id) == 0) result.effects.push_back(representative(id));
    }
    return result;
  }

 private:
  // --- grid of taxels and blocks ---

  void chooseTaxels() {
    const auto most =
        static_cast<std::size_t>(std::clamp(kMostReadings / static_cast<double>(scans_), 3.0, 12.0));
    const std::size_t number = campaign_.taxels(), stride = std::max<std::size_t>(1, number / most);
    for (std::size_t i = stride / 2; i < number && taxels_.size() < most; i += stride) taxels_.push_back(i);
    share_ = static_cast<double>(number) / static_cast<double>(taxels_.size());
  }

  void chooseBlocks() {
    const double cycles = campaign_.cycle.back() + 1.0;
    const double number = std::clamp(24 * cycles, 400.0, 3000.0);
    const auto length = static_cast<std::size_t>(std::ceil(static_cast<double>(scans_) / number));
    for (const Visit& visit : campaign_.visits) {
      for (std::size_t first = visit.first; first < visit.last; first += length) {
        first_.push_back(first);
        last_.push_back(std::min(first + length, visit.last));
      }
    }
    blocks_ = cast(first_.size());
  }

  VectorXd blockMeans(const Trace& trace) const {
    VectorXd means = VectorXd::Zero(blocks_);
    for (std::size_t b = 0; b < first_.size(); ++b) {
      for (std::size_t scan = first_[b]; scan < last_[b]; ++scan) means(cast(b)) += trace[scan];
      means(cast(b)) /= static_cast<double>(last_[b] - first_[b]);
    }
    return means;
  }

  double withinBlocks(const Trace& trace, const VectorXd& means) const {
    double squares = 0;
    for (std::size_t b = 0; b < first_.size(); ++b) {
      for (std::size_t scan = first_[b]; scan < last_[b]; ++scan)
        squares += std::pow(trace[scan] - means(cast(b)), 2);
    }
    return squares;
  }

  // --- noise ---

  // Long-run variance: that of a mean over many blocks, times their number.
  static double longRun(const VectorXd& values) {
    const VectorXd centred = values.array() - values.mean();
    const double variance = centred.squaredNorm() / static_cast<double>(centred.size());
    double factor = 1;
    for (Index lag = 1; lag <= 8 && lag < centred.size(); ++lag) {
      const Index number = centred.size() - lag;
      const double correlation = centred.head(number).dot(centred.tail(number)) /
                                 (static_cast<double>(number) * std::max(variance, 1e-30));
      if (correlation < 0.02) break;
      factor += 2 * correlation;
    }
    return variance * factor;
  }

  void measureNoise() {
    VectorXd common = VectorXd::Zero(blocks_);
    double fast = 0;
    std::vector<VectorXd> own;
    const std::size_t stride = 1 + campaign_.taxels() / 40;
    for (std::size_t taxel = 0; taxel < campaign_.taxels(); taxel += stride) {
      Trace noise = p_.noise[taxel];
      const Trace slope = p_.rig.slope(taxel);
      for (std::size_t scan = 0; scan < scans_; ++scan) noise[scan] += slope[scan] * p_.reference_error[scan];
      own.push_back(blockMeans(noise));
      fast += withinBlocks(noise, own.back());
      common += own.back();
    }
    const auto number = static_cast<double>(own.size());
    common /= number;
    double single = 0;
    for (const VectorXd& taxel : own) single += longRun(taxel - common) / std::max(1.0, number - 1);
    single_variance_ = single;
    common_variance_ = std::max(0.0, longRun(common) - single / number);
    const double inside = static_cast<double>(scans_) - static_cast<double>(blocks_);
    scan_variance_ = inside > 0 ? fast / (number * inside) : single;
  }

  // --- signatures ---

  Seen see(const Active& active) const {
    Seen seen;
    seen.taxels = active.hidden->taxels();
    if (seen.taxels.empty()) {
      seen.taxels = taxels_;
      // An effect that is confined to some taxels is seen on those.
      std::vector<std::size_t> placed;
      for (std::size_t i = 0; i < campaign_.taxels(); ++i) {
        if (active.placed->taxels[i]) placed.push_back(i);
      }
      seen.share = share_;
      if (placed.size() < campaign_.taxels()) {
        const std::size_t stride = 1 + (placed.size() - 1) / taxels_.size();
        seen.taxels.clear();
        for (std::size_t i = 0; i < placed.size(); i += stride) seen.taxels.push_back(placed[i]);
        seen.share = static_cast<double>(placed.size()) / static_cast<double>(seen.taxels.size());
      }
    }
    seen.blocks.resize(cast(seen.taxels.size()), blocks_);
    double squares = 0;
    for (std::size_t i = 0; i < seen.taxels.size(); ++i) {
      const Trace left = p_.rig.residual(active, seen.taxels[i]);
      const VectorXd means = blockMeans(left);
      seen.blocks.row(cast(i)) = means.transpose();
      seen.fast += withinBlocks(left, means);
      for (const double value : left) squares += value * value;
    }
    seen.rms = std::sqrt(squares / (static_cast<double>(seen.taxels.size()) * static_cast<double>(scans_)));
    return seen;
  }

  Placed everywhere(const HiddenForm& form, std::uint64_t draw) const {
    Placed placed;
    placed.form = &form;
    placed.seed = p_.seed + 7919 * (draw + 1);
    placed.taxels.assign(campaign_.taxels(), true);
    placed.surfaces.assign(campaign_.surfaces.size(), true);
    return placed;
  }

  void drawRival(const std::string& id) {
    if (id != "repositioning") {
      for (const HiddenForm* form : openFormsOf(id)) {
        for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
          drawn_[id].push_back({form, see(p_.rig.activate(everywhere(*form, draw), 1))});
        }
      }
    }
    if (id == "creep") addLags();
    if (id == "drift") addSlow(id, false);
    if (id == "temperature" && !p_.plan.thermometer) addSlow(id, true);
    if (id == "repositioning") addMounts();
  }

  // One time course that all taxels have, as the curves of a middle taxel leave it.
  void addShape(const std::string& id, Trace change, double low, double high) {
    double squares = 0;
    for (const double value : change) squares += value * value;
    if (squares <= 0) return;
    const double scale = 1e-3 / std::sqrt(squares / static_cast<double>(scans_));
    for (double& value : change) value *= scale;
    const VectorXd means = blockMeans(p_.rig.leftOf(middle(), change));
    // What the curves leave only numerically is nothing.
    if (means.norm() < 1e-3 * 1e-3 * std::sqrt(static_cast<double>(blocks_))) return;
    shapes_[id].push_back({means / scale, low, high});
  }
  std::size_t middle() const { return taxels_[taxels_.size() / 2]; }

  // A short or long memory: a share of the load follows with any time constant.
  void addLags() {
    constexpr double kMostCreep = 0.15;  // share of the load, for each time constant
    const Trace slope = p_.rig.slope(middle());
    for (const double time_constant : {0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0}) {
      const double keep = std::exp(-campaign_.scan_period / time_constant);
      Trace change(scans_);
      double lagged = 0;
      for (std::size_t scan = 0; scan < scans_; ++scan) {
        const bool fresh = scan == 0 || campaign_.visit[scan] != campaign_.visit[scan - 1];
        if (fresh) lagged = campaign_.pressure[scan];
        lagged += (1 - keep) * (campaign_.pressure[scan] - lagged);
        change[scan] = slope[scan] * (lagged - campaign_.pressure[scan]);
      }
      addShape("creep", change, 0, kMostCreep);
    }
  }

  // Karhunen-Loeve modes of a random walk over the campaign: any slow course, as a zero or also as a gain.
  void addSlow(const std::string& id, bool gain_too) {
    const Trace base = p_.rig.reading(middle(), {});
    const double start = campaign_.time.front(), length = campaign_.time.back() - start;
    for (int k = 1; k <= 8; ++k) {
      Trace zero(scans_), gain(scans_);
      for (std::size_t scan = 0; scan < scans_; ++scan) {
        zero[scan] = std::sin((k - 0.5) * M_PI * (campaign_.time[scan] - start) / length);
        gain[scan] = zero[scan] * base[scan];
      }
      addShape(id, zero, -0.1, 0.1);
      if (gain_too) addShape(id, gain, -0.1, 0.1);
    }
  }

  // Each mount has a zero, a gain and a preload of its own.
  void addMounts() {
    const Trace base = p_.rig.reading(middle(), {}), slope = p_.rig.slope(middle());
    for (const Visit& visit : campaign_.visits) {
      if (stays(visit.surface) < 2) continue;
      Trace gain(scans_), preload(scans_);
      for (std::size_t scan = visit.first; scan < visit.last; ++scan) {
        gain[scan] = base[scan] - p_.sheet.zero(middle());
        preload[scan] = slope[scan];
      }
      addShape("repositioning", gain, -0.15, 0.15);
      addShape("repositioning", preload, -40e3, 40e3);
    }
  }
  std::size_t stays(std::size_t surface) const {
    const auto on = [&](const Visit& visit) { return visit.surface == surface; };
    return static_cast<std::size_t>(std::count_if(campaign_.visits.begin(), campaign_.visits.end(), on));
  }
  bool remounted() const { return campaign_.visits.size() > campaign_.surfaces.size(); }

  // --- judgement ---

  std::vector<Channel> channelsOf(const Seen& seen) const {
    const Eigen::JacobiSVD<MatrixXd> svd(seen.blocks * seen.blocks.transpose(), Eigen::ComputeThinU);
    std::vector<Channel> channels;
    const double first = svd.singularValues()(0);
    for (Index k = 0; k < std::min(kChannels, svd.singularValues().size()); ++k) {
      if (svd.singularValues()(k) <= 1e-3 * first) break;
      Channel channel;
      channel.pattern = svd.matrixU().col(k);
      if (channel.pattern.sum() < 0) channel.pattern = -channel.pattern;
      const double sum = channel.pattern.sum();
      channel.variance = single_variance_ / seen.share + common_variance_ * sum * sum;
      channel.gain = VectorXd::Zero(blocks_);
      for (std::size_t i = 0; i < seen.taxels.size(); ++i) {
        channel.gain +=
            p_.cycle_gain * channel.pattern(cast(i)) * blockMeans(p_.rig.reading(seen.taxels[i], {}));
      }
      channels.push_back(std::move(channel));
    }
    return channels;
  }

  // Unit variance and independent blocks. Within a cycle the covariance is that of the noise and of a gain.
  VectorXd whitened(const Channel& channel, VectorXd values) const {
    for (Index begin = 0; begin < blocks_;) {
      Index end = begin;
      const std::uint32_t cycle = campaign_.cycle[first_[static_cast<std::size_t>(begin)]];
      while (end < blocks_ && campaign_.cycle[first_[static_cast<std::size_t>(end)]] == cycle) ++end;
      const auto gain = channel.gain.segment(begin, end - begin);
      const double square = gain.squaredNorm();
      if (square > 0) {
        auto part = values.segment(begin, end - begin);
        const double shrink = 1 - std::sqrt(channel.variance / (channel.variance + square));
        part -= (shrink * gain.dot(part) / square) * gain;
      }
      begin = end;
    }
    return values / std::sqrt(channel.variance);
  }

  // A rival through the pattern of the effect; its amplitude there is its own.
  VectorXd through(const Channel& channel, const Seen& seen, const Seen& rival) const {
    VectorXd course = VectorXd::Zero(blocks_);
    const bool same = seen.taxels == rival.taxels;
    const double all = channel.pattern.lpNorm<1>() / static_cast<double>(rival.blocks.rows());
    for (Index i = 0; i < rival.blocks.rows(); ++i) {
      course += (same ? std::abs(channel.pattern(i)) : all) * rival.blocks.row(i).transpose();
    }
    return course;
  }

  // Everything that a rival may add in a channel, whitened. In the first channel, where all taxels agree, a
  // rival keeps its sign; in the others, which hold the differences of the taxels, either sign is possible.
  std::vector<Course> spanOf(const std::string& id, bool first, const Channel& channel, const Seen& seen,
                             const std::vector<Seen>& partners, double strength,
                             const HiddenForm* without = nullptr) const {
    std::vector<Course> span;
    const auto add = [&](const VectorXd& course, double low, double high) {
      if (!first) low = -(high = std::max(-low, high));
      span.push_back({whitened(channel, course), low, high});
    };
    const double size = 3 * std::max(1.0, strength);
    for (const Seen& partner : partners) add(through(channel, seen, partner), -2, 2);
    const auto drawn = drawn_.find(id);
    if (drawn != drawn_.end()) {
      for (const auto& [form, signature] : drawn->second) {
        if (form == without) continue;
        add(through(channel, seen, signature), kSigned.count(id) > 0 ? 0 : -size, size);
      }
    }
    const auto shapes = shapes_.find(id);
    if (shapes != shapes_.end()) {
      for (const Course& shape : shapes->second) {
        const double more = std::max(1.0, strength);
        add(channel.pattern.lpNorm<1>() * shape.blocks, more * shape.low, more * shape.high);
      }
    }
    return span;
  }

  // Squares that least squares within the bounds leave of `values`, by cyclic coordinate descent.
  static double beyond(const VectorXd& values, const std::vector<Course>& span) {
    const Index number = cast(span.size());
    if (number == 0) return values.squaredNorm();
    MatrixXd courses(values.size(), number);
    for (Index j = 0; j < number; ++j) courses.col(j) = span[static_cast<std::size_t>(j)].blocks;
    const MatrixXd gram = courses.transpose() * courses;
    const VectorXd wanted = courses.transpose() * values;
    VectorXd size = VectorXd::Zero(number);
    double before = 0;
    for (int round = 0; round < 3000; ++round) {
      for (Index j = 0; j < number; ++j) {
        if (!(gram(j, j) > 0)) continue;
        const Course& course = span[static_cast<std::size_t>(j)];
        const double step = (wanted(j) - gram.row(j).dot(size)) / gram(j, j);
        size(j) = std::clamp(size(j) + step, course.low, course.high);
      }
      if (round % 20 > 0) continue;
      const double gained = 2 * wanted.dot(size) - size.dot(gram * size);
      if (round > 0 && gained - before < 1e-4 * (1 + gained)) break;
      before = gained;
    }
    return (values - courses * size).squaredNorm();
  }

  double fastNats(const HiddenForm& form, const Seen& seen) const {
    const bool counts = kFaults.count(form.id) > 0 || form.id == "mains_pickup";
    return counts ? 0.5 * seen.share * seen.fast / scan_variance_ : 0;
  }

  Told judge(const HiddenForm& form, const Seen& seen, const std::vector<Seen>& partners, double strength) {
    Told told;
    told.id = form.id;
    const bool is_static = form.left_after == LeftAfter::kCurveShared;
    const double fast = fastNats(form, seen);
    std::vector<Channel> channels;
    std::vector<VectorXd> courses;
    // What a usual size does not show is the error of the static fit.
    const bool shows = seen.rms > kShows * std::max(strength, 1e-9);
    if (shows) channels = channelsOf(seen);
    told.nats = shows ? fast : 0;
    for (const Channel& channel : channels) {
      courses.push_back(whitened(channel, seen.blocks.transpose() * channel.pattern));
      const bool first = courses.size() == 1;
      told.nats += 0.5 * beyond(courses.back(), spanOf("", first, channel, seen, partners, strength));
    }
    for (const std::string& rival : kRivals) {
      if (rival == form.id || is_static || told.nats <= 0) continue;
      if (rival == "repositioning" && !remounted()) continue;
      double left = fast;
      for (std::size_t k = 0; k < channels.size(); ++k) {
        left += 0.5 * beyond(courses[k], spanOf(rival, k == 0, channels[k], seen, partners, strength));
      }
      told.beyond[rival] = {left, left / told.nats};
    }
    if (told.nats > 0 && !is_static && drawn_.count(form.id) > 0) {
      double left = fast;
      for (std::size_t k = 0; k < channels.size(); ++k) {
        left +=
            0.5 * beyond(courses[k], spanOf(form.id, k == 0, channels[k], seen, partners, strength, &form));
      }
      told.own_forms = left / told.nats;
    }
    conclude(form, told);
    return told;
  }

  void conclude(const HiddenForm& form, Told& told) const {
    for (const auto& [rival, left] : told.beyond) {
      if (left.first < kNats || left.second < kLeftShare) told.confused_with.push_back(rival);
    }
    std::sort(told.confused_with.begin(), told.confused_with.end(), [&](const auto& a, const auto& b) {
      return told.beyond.at(a).first < told.beyond.at(b).first;
    });
    const bool blind_to_warmth = form.id == "temperature" && !p_.plan.thermometer;
    told.could_be_told = told.nats >= kNats && told.confused_with.empty() && !blind_to_warmth &&
                         !(form.needs_remounts && !remounted());
    if (!told.could_be_told) told.reason = reasonOf(form, told);
    if (told.nats < kNats) told.confused_with.clear();
  }

  std::string reasonOf(const HiddenForm& form, const Told& told) const {
    if (form.needs_remounts && !remounted()) return "one_mount";
    const bool of_surfaces = form.left_after == LeftAfter::kCurveShared || form.foreign;
    if (told.nats < kNats) return of_surfaces && campaign_.surfaces.size() == 1 ? "one_surface" : "too_small";
    const auto confused = [&](const char* id) {
      return std::count(told.confused_with.begin(), told.confused_with.end(), id) > 0;
    };
    if (!p_.plan.thermometer && (form.id == "temperature" || confused("temperature")))
      return "no_thermometer";
    const std::string& nearest = told.confused_with.front();
    if (p_.plan.onePace() && kFast.count(form.id) > 0 && kFast.count(nearest) > 0) return "one_pace";
    if (form.id == "break_in" && !remounted()) return "one_mount";
    return "collinear_with:" + nearest;
  }

  // The forms of set A of an effect, each at the typical size; it could be told where each of them could.
  Told representative(const std::string& id) {
    Told all;
    all.id = id;
    all.could_be_told = true;
    bool first = true;
    for (const HiddenForm* form : openFormsOf(id)) {
      const Placed placed = everywhere(*form, 0);
      const Active active = p_.rig.activate(placed, 1);
      Seen seen = see(active);
      const double scale = seen.rms > 0 ? std::min(kLargestScale, p_.typical_left / seen.rms) : 0;
      seen.blocks *= scale;
      seen.rms *= scale;
      seen.fast *= scale * scale;
      const Told told = judge(*form, seen, {}, scale);
      if (first || (!told.could_be_told && all.could_be_told)) {
        all.reason = told.reason;
        all.nats = told.nats;
        all.beyond = told.beyond;
        all.own_forms = told.own_forms;
      }
      first = false;
      all.could_be_told = all.could_be_told && told.could_be_told;
      for (const std::string& rival : told.confused_with) {
        const auto& known = all.confused_with;
        if (std::find(known.begin(), known.end(), rival) == known.end()) all.confused_with.push_back(rival);
      }
    }
    return all;
  }

  const IdentifiabilityProblem& p_;
  const Campaign& campaign_;
  std::size_t scans_;
  std::vector<std::size_t> taxels_;
  double share_ = 1;
  std::vector<std::size_t> first_, last_;  // scans of each block
  Index blocks_ = 0;
  double single_variance_ = 0, common_variance_ = 0;  // of a block
  double scan_variance_ = 0;                          // of a scan about its block
  std::map<std::string, std::vector<std::pair<const HiddenForm*, Seen>>> drawn_;
  std::map<std::string, std::vector<Course>> shapes_;
};

}  // namespace

Identifiability identify(const IdentifiabilityProblem& problem) {
  return Study(problem).run();
}

}  // namespace blind
