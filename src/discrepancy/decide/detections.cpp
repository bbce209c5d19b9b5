#include "discrepancy/decide/detections.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "discrepancy/decide/refine.h"
#include "simulation/effects/effect_library.h"
#include "statistics/random_stream.h"
#include "statistics/samples.h"

namespace fsr::discrepancy {

namespace {

constexpr double kLeastTurns = 0.4;        // least turns of the phase over the whole scan
constexpr std::size_t kLongestPart = 256;  // samples of a part whose spectrum is taken
constexpr std::size_t kFewestTaxels = 8;
constexpr double kMainsFrequency = 50;  // assumed [Hz]

// Readings of the used taxels, minus their static curves and minus the mean residual of these taxels.
class SheetResiduals {
 public:
  SheetResiduals(const Measured& measured, const TaxelFit& taxels) : measured_(measured), taxels_(taxels) {
    for (std::size_t t = 0; t < measured.taxels(); ++t) {
      if (measured.used[t]) place_.push_back(t);
    }
  }
  std::size_t size() const { return place_.size(); }
  double place(std::size_t k) const { return static_cast<double>(place_[k]); }
  void at(std::size_t sample, Eigen::VectorXd& result) {
    taxels_.residuals(sample, all_);
    for (std::size_t k = 0; k < place_.size(); ++k) result[static_cast<Eigen::Index>(k)] = all_[place_[k]];
    result.array() -= result.mean();
  }

 private:
  const Measured& measured_;
  const TaxelFit& taxels_;
  std::vector<std::size_t> place_;
  std::vector<double> all_;
};

Eigen::MatrixXd covarianceOf(const Measured& measured, SheetResiduals& residuals) {
  const auto n = static_cast<Eigen::Index>(residuals.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd now(n);
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    residuals.at(i, now);
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(now);
  }
  covariance /= static_cast<double>(measured.samples());
  return covariance.selfadjointView<Eigen::Lower>();
}

Eigen::VectorXcd patternOf(const SheetResiduals& residuals, double turn) {
  Eigen::VectorXcd pattern(static_cast<Eigen::Index>(residuals.size()));
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    pattern[static_cast<Eigen::Index>(k)] =
        std::polar(1 / std::sqrt(static_cast<double>(residuals.size())), turn * residuals.place(k));
  }
  return pattern;
}

// SheetResiduals of the used taxels at all samples [samples x taxels], and where the parts of the spectrum
// lie.
struct Courses {
  Eigen::MatrixXf residual;
  struct Part {
    Eigen::Index first, samples;
  };
  std::vector<Part> parts;
};

Courses coursesOf(const Measured& measured, SheetResiduals& residuals) {
  Courses courses;
  const auto n = static_cast<Eigen::Index>(residuals.size());
  courses.residual.resize(static_cast<Eigen::Index>(measured.samples()), n);
  Eigen::VectorXd now(n);
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    residuals.at(i, now);
    courses.residual.row(static_cast<Eigen::Index>(i)) = now.cast<float>();
  }
  for (const Visit& visit : measured.visits) {
    const std::size_t length = visit.last - visit.first;
    const std::size_t parts = (length + kLongestPart - 1) / kLongestPart;
    for (std::size_t p = 0; p < parts; ++p) {
      const std::size_t from = visit.first + p * length / parts, to = visit.first + (p + 1) * length / parts;
      courses.parts.push_back({static_cast<Eigen::Index>(from), static_cast<Eigen::Index>(to - from)});
    }
  }
  return courses;
}

// The strongest pattern, and the line of its course.
struct Line {
  double turn = 0, excess = 0;
  double height = 0;  // one-sided power of the strongest line / mean power of all frequencies
  // Powers of the frequencies, turning one way and the other.
  Eigen::VectorXf forth, back;
};

// exp(2 pi j f i) of the frequencies 0 .. kLongestPart / 2, [samples x frequencies].
const Eigen::MatrixXcf& waves() {
  static const Eigen::MatrixXcf all = [] {
    const auto size = static_cast<Eigen::Index>(kLongestPart);
    Eigen::MatrixXcf result(size, size / 2 + 1);
    for (Eigen::Index f = 0; f < result.cols(); ++f) {
      for (Eigen::Index i = 0; i < size; ++i)
        result(i, f) = std::polar(1.0F, static_cast<float>(2 * M_PI * static_cast<double>(f * i % size) /
                                                           static_cast<double>(size)));
    }
    return result;
  }();
  return all;
}

// Probability that the ratio of two sums of `parts` powers of equal mean is beyond a ratio: Fisher's
// distribution with 2 parts and 2 parts degrees of freedom.
double beyondRatio(double ratio, std::size_t parts) {
  const double x = 1 / (1 + ratio), tests = 2 * static_cast<double>(parts) - 1;
  double p = 0;
  for (double k = static_cast<double>(parts); k <= tests; ++k)
    p += std::exp(std::lgamma(tests + 1) - std::lgamma(k + 1) - std::lgamma(tests - k + 1) + k * std::log(x) +
                  (tests - k) * std::log1p(-x));
  return std::min(1.0, p);
}

Line strongest(const Courses& courses, const Eigen::MatrixXd& covariance,
               const std::vector<Eigen::VectorXcd>& patterns, const std::vector<double>& turns,
               const std::vector<Eigen::Index>& order) {
  Line line;
  std::vector<double> powers;
  Eigen::VectorXcd placed(static_cast<Eigen::Index>(order.size()));
  const auto place = [&](const Eigen::VectorXcd& pattern) {
    for (Eigen::Index k = 0; k < placed.size(); ++k) placed[order[static_cast<std::size_t>(k)]] = pattern[k];
  };
  for (const Eigen::VectorXcd& pattern : patterns) {
    place(pattern);
    powers.push_back((placed.adjoint() * covariance * placed).value().real());
  }
  const auto peak = static_cast<std::size_t>(std::max_element(powers.begin(), powers.end()) - powers.begin());
  line.excess = powers[peak] - statistics::upperMedian(powers);
  line.turn = turns[peak];
  place(patterns[peak]);
  const Eigen::VectorXcf course = courses.residual * placed.conjugate().cast<std::complex<float>>();
  line.forth = line.back = Eigen::VectorXf::Zero(waves().cols());
  for (const Courses::Part& part : courses.parts) {
    const Eigen::VectorXcf now = course.segment(part.first, part.samples);
    const auto wave = waves().topRows(part.samples);
    line.forth += (wave.adjoint() * now).cwiseAbs2();
    line.back += (wave.transpose() * now).cwiseAbs2();
  }
  const float mean = (line.forth.mean() + line.back.mean()) / 2;
  if (mean > 0) line.height = static_cast<double>((line.forth - line.back).cwiseAbs().maxCoeff() / mean);
  return line;
}

// Probability that a pattern that does not move has such a line. The frequency where both sides differ most
// is chosen among all. The ratio of two powers of equal mean does not depend on their sum, so that of the
// largest sum is not.
double chanceOfStanding(const Line& line, std::size_t parts) {
  const auto p_at = [&](Eigen::Index f) {
    const float more = std::max(line.forth[f], line.back[f]);
    const float less = std::max(1e-30F, std::min(line.forth[f], line.back[f]));
    return 2 * beyondRatio(static_cast<double>(more / less), parts);
  };
  Eigen::Index most_different = 0, largest = 0;
  (line.forth - line.back).cwiseAbs().maxCoeff(&most_different);
  (line.forth + line.back).maxCoeff(&largest);
  const double chosen = static_cast<double>(line.forth.size()) * p_at(most_different);
  return std::min(1.0, 2 * std::min(chosen, p_at(largest)));
}

// Probability that the taxels in any other order have a line like `own`.
double chanceOfOrders(const Courses& courses, const Eigen::MatrixXd& covariance,
                      const std::vector<Eigen::VectorXcd>& patterns, const std::vector<double>& turns,
                      std::vector<Eigen::Index> order, const DiscrepancyOptions& options, const Line& own) {
  std::size_t beyond = 0, draws = 0;
  while (draws < options.null_draws) {
    const statistics::RandomStream stream = statistics::randomStream(options.seed, "hum", draws);
    for (std::size_t k = order.size(); k-- > 1;)
      std::swap(order[k], order[static_cast<std::size_t>(stream.uniform(k) * static_cast<double>(k + 1))]);
    const Line line = strongest(courses, covariance, patterns, turns, order);
    beyond += line.height * line.excess >= own.height * own.excess;
    ++draws;
    // No further draw can bring it below the level.
    if (static_cast<double>(1 + beyond) > options.level * static_cast<double>(options.null_draws + 1)) break;
  }
  return static_cast<double>(1 + beyond) / static_cast<double>(draws + 1);
}

}  // namespace

Mains findMains(const Measured& measured, const StaticFit& fit, const TaxelFit& taxels,
                const DiscrepancyOptions& options) {
  Mains mains;
  SheetResiduals residuals(measured, taxels);
  if (residuals.size() < kFewestTaxels) return mains;
  const Eigen::MatrixXd covariance = covarianceOf(measured, residuals);
  const auto n = static_cast<double>(measured.taxels());
  std::vector<double> turns;
  std::vector<Eigen::VectorXcd> patterns;
  for (double turn = kLeastTurns * 2 * M_PI / n; turn < M_PI; turn += M_PI / (2 * n)) {
    turns.push_back(turn);
    patterns.push_back(patternOf(residuals, turn));
  }
  const Courses courses = coursesOf(measured, residuals);
  std::vector<Eigen::Index> in_place(residuals.size());
  std::iota(in_place.begin(), in_place.end(), 0);
  const Line line = strongest(courses, covariance, patterns, turns, in_place);
  mains.turn = line.turn;
  const double total = covariance.trace() / static_cast<double>(residuals.size()) + taxels.within();
  mains.share = total > 0 ? 2 * line.excess / static_cast<double>(residuals.size()) / total : 0;
  mains.amplitude = 2 * std::sqrt(std::max(0.0, line.excess) / static_cast<double>(residuals.size()));
  const auto [low, high] = std::minmax_element(measured.pressure.begin(), measured.pressure.end());
  const double slope = fit.netCurve().maxCoeff() / std::max(1.0, *high - *low);
  mains.at_map = slope > 0 ? mains.amplitude / std::sqrt(2) / slope : 0;
  if (mains.at_map < leastGap(measured, options)) return mains;
  mains.p = chanceOfStanding(line, courses.parts.size());
  if (mains.p > options.level) return mains;
  mains.p = std::max(mains.p, chanceOfOrders(courses, covariance, patterns, turns, in_place, options, line));
  mains.found = mains.p <= options.level;
  if (!mains.found) return mains;
  const Eigen::VectorXcd pattern = patternOf(residuals, mains.turn);
  const auto samples = static_cast<Eigen::Index>(measured.samples());
  mains.cosine.resize(samples);
  mains.sine.resize(samples);
  std::complex<double> turned = 0, before = 0;
  double seconds = 0, steps = 0;
  for (Eigen::Index i = 0; i < samples; ++i) {
    const auto sample = static_cast<std::size_t>(i);
    const std::complex<double> z =
        pattern.dot(courses.residual.row(i).transpose().cast<std::complex<double>>());
    mains.cosine[i] = z.real();
    mains.sine[i] = z.imag();
    if (i > 0 && measured.visit[sample] == measured.visit[sample - 1]) {
      turned += std::conj(before) * z;
      seconds += measured.time[sample] - measured.time[sample - 1];
      ++steps;
    }
    before = z;
  }
  mains.rate = seconds > 0 ? steps / seconds : 0;
  mains.beat = std::arg(turned) / (2 * M_PI) * mains.rate;
  return mains;
}

void takeOut(const Mains& mains, const StaticFit& fit, CommonTraces& common) {
  Eigen::MatrixXd course(mains.cosine.size(), 2);
  course << mains.cosine, mains.sine;
  const Eigen::MatrixXd normal = course.transpose() * course;
  const Eigen::Vector2d weights = normal.ldlt().solve(course.transpose() * fit.residual(common.all));
  common.all -= course * weights;
}

simulation::EnabledEffect asEffect(const Mains& mains, double full_scale) {
  simulation::EnabledEffect effect{simulation::foundBy(simulation::Detector::kMains).id, {}};
  for (const simulation::EffectParameter& parameter : simulation::findEffect(effect.id)->info.parameters) {
    effect.values[parameter.name] = parameter.usual;
  }
  effect.values["amplitude"] = mains.amplitude * full_scale;
  // All frequencies that differ by the sample rate look the same; the hum is the one nearest to the mains.
  const double turns = mains.rate > 0 ? std::round((kMainsFrequency - mains.beat) / mains.rate) : 0;
  effect.values["frequency"] = mains.rate > 0 ? mains.beat + turns * mains.rate : kMainsFrequency;
  effect.values["taxel_time"] = std::abs(mains.turn) / (2 * M_PI * kMainsFrequency);
  return effect;
}

namespace {

constexpr double kFaultZ = 99;  // the result of this detector counts as certain
constexpr double kMisfitBeside =
    0.08;  // of the readings' squared error, where time courses were found, which bend the curves
constexpr double kByLimit = 0.9;       // share of a misfit that one limit of all surfaces explains
constexpr double kHighReadings = 0.6;  // of the highest reading: saturation is visible above it

Detection plain(const simulation::EffectInfo& info, double z) {
  Detection detection;
  detection.effect.id = info.id;
  detection.effect.summary = info.summary;
  detection.effect.z = z;
  detection.effect.share_of_explainable = 1;
  for (const simulation::Covariate c : info.depends_on) detection.depends_on.push_back(simulation::name(c));
  return detection;
}

Detection plain(simulation::Detector detector, double z) {
  return plain(simulation::foundBy(detector), z);
}

// Standard normal score that is exceeded with probability p.
double zOf(double p) {
  constexpr double kLeastP = 1e-300;
  return -statistics::normalQuantile(std::clamp(p, kLeastP, 1 - 1e-16));
}

void tellParameters(Detection& detection, const std::vector<std::string>& names) {
  const simulation::EnabledEffect& effect = detection.enable.front();
  for (const std::string& one : names) {
    const double value = effect.values.at(one);
    const std::string unit =
        simulation::parameter(simulation::findEffect(effect.id)->info, one).permitted.unit;
    detection.effect.parameters.push_back({one, value, unit, {NAN, NAN}});
  }
}

simulation::EnabledEffect usualValues(const std::string& id) {
  simulation::EnabledEffect effect{id, {}};
  for (const simulation::EffectParameter& parameter : simulation::findEffect(id)->info.parameters) {
    effect.values[parameter.name] = parameter.usual;
  }
  return effect;
}

// The effect and the parameter values with which a simulation shows the fault.
simulation::EnabledEffect asEffect(const health::Fault& fault) {
  simulation::EnabledEffect effect = usualValues(effectOf(fault).id);
  const auto set = [&](const char* name, double value) {
    const auto found = effect.values.find(name);
    if (found == effect.values.end()) return;
    const settings::Range& range =
        simulation::parameter(simulation::findEffect(effect.id)->info, name).permitted;
    found->second = std::clamp(value, range.low, range.high);
  };
  set("taxels", static_cast<double>(fault.taxels.size()));
  set("first", static_cast<double>(fault.taxels.front()));
  set("start", fault.times.front().first);
  set("line", static_cast<double>(fault.line));
  set("share", fault.share);
  set("depth", fault.depth);
  set("fades_over", fault.fades_over);
  double seconds = 0;
  for (const auto& [from, to] : fault.times) seconds += to - from;
  set("burst", seconds / static_cast<double>(fault.times.size()));
  for (const health::TaxelSpell& spell : fault.spells)
    effect.spells.push_back(
        {spell.taxel, spell.from, std::min(spell.to, simulation::kForever), spell.reading});
  for (std::size_t k = 0; k < fault.times.size() && fault.isLine(); ++k)
    effect.spells.push_back(
        {fault.line, fault.times[k].first, fault.times[k].second, std::clamp(fault.depths[k], 0.0, 1.0)});
  return effect;
}

}  // namespace

Detection detectionOf(const health::Fault& fault, const FaultyReadings& readings) {
  Detection detection = plain(effectOf(fault), zOf(fault.p));
  detection.enable = {asEffect(fault)};
  detection.where.taxels = fault.taxels;
  detection.where.conditions = readings.conditions;
  detection.where.pressure = readings.pressure;
  detection.where.times = fault.times;
  detection.before_more = readings.held_out_readings > 0 ? readings.held_out / readings.held_out_readings : 0;
  return detection;
}

Detection detectionOf(const Mains& mains, double square, const Measured& measured) {
  Detection detection = plain(simulation::Detector::kMains, zOf(mains.p));
  detection.enable = {asEffect(mains, measured.full_scale)};
  tellParameters(detection, {"amplitude", "frequency", "taxel_time"});
  detection.where.pressure = {0, *std::max_element(measured.pressure.begin(), measured.pressure.end())};
  detection.after_less = mains.share * square;
  return detection;
}

Detection detectionOf(const Repositioning& repositioning, double square) {
  Detection detection = plain(simulation::Detector::kMounts, repositioning.z);
  detection.enable = {usualValues(detection.effect.id)};
  detection.enable.front().values["offset"] = repositioning.offset;
  detection.enable.front().values["gain"] = std::min(0.5, repositioning.gain);
  tellParameters(detection, {"offset", "gain"});
  detection.where = repositioning.where;
  detection.before_more = repositioning.share * square;
  return detection;
}

Detection detectionOf(const RandomFinding& finding, const simulation::EffectInfo& info,
                      const WhereItShows& where, double amplitude) {
  Detection detection = plain(info, finding.z);
  detection.enable = {finding.effect};
  detection.effect.parameters = finding.parameters;
  FittedParameter& step = detection.effect.parameters.front();
  for (double* size : {&step.value, &step.interval.low, &step.interval.high}) *size *= amplitude;
  step.value = std::min(step.value, simulation::parameter(info, step.name).permitted.high);
  detection.enable.front().values[step.name] = step.value;
  detection.enable.front().only_taxels = where.taxels;
  detection.where = where;
  return detection;
}

Detection saturationOf(const StaticMisfit& misfit, const Measured& measured, const StaticFit& fit) {
  Detection detection = plain(simulation::Detector::kSaturation, kFaultZ);
  detection.enable = {usualValues(detection.effect.id)};
  detection.enable.front().values["level"] = misfit.level;
  detection.enable.front().values["sharpness"] = misfit.sharpness;
  tellParameters(detection, {"level", "sharpness"});
  const double high = kHighReadings * fit.curve().maxCoeff();
  detection.where.pressure = {INFINITY, 0};
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (fit.curve()[static_cast<Eigen::Index>(i)] < high) continue;
    detection.where.pressure.low = std::min(detection.where.pressure.low, measured.pressure[i]);
    detection.where.pressure.high = std::max(detection.where.pressure.high, measured.pressure[i]);
  }
  detection.before_more = misfit.rms * misfit.rms;
  return detection;
}

bool isMisfit(const StaticMisfit& misfit, bool something_else_found) {
  return misfit.share >= (something_else_found ? kMisfitBeside : thresholds::kLeastShareOfError);
}

bool isSaturation(const StaticMisfit& misfit) {
  return misfit.by_limit >= kByLimit;
}

}  // namespace fsr::discrepancy
