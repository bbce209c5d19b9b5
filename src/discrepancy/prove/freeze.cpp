#include "discrepancy/prove/freeze.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/parameter_fit.h"
#include "discrepancy/samples/views.h"
#include "settings/sha256.h"
#include "settings/text.h"
#include "simulation/effects/effect_library.h"
#include "simulation/settings_text.h"
#include "simulation/taxel_curves.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy {

namespace {

constexpr double kSizeDifference = 0.02;        // of the size's logarithm
constexpr double kSmallest = -4, kLargest = 2;  // logarithm of the size of predicted effects

// Effects with fixed parameters in recordings that they were not fitted to. The first variable is the
// logarithm of the common factor of all strengths; the parameters of the spread follow.
class Predictor {
 public:
  Predictor(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
            const simulation::SimulationSettings& base, const std::vector<simulation::EnabledEffect>& effects,
            const ParameterSpread& spread)
      : measured_(measured),
        common_(common),
        fit_(fit),
        effects_(effects),
        spread_(spread),
        everywhere_(effects.size(), false),
        forward_(measured, common, fit, base) {}

  Predicted run() const;

 private:
  std::vector<simulation::EnabledEffect> effectsAt(const std::vector<double>& at) const;
  std::optional<Eigen::VectorXd> error(const std::vector<double>& at) const {
    return forward_.left(effectsAt(at), everywhere_);
  }
  static double sizeOf(double logarithm) { return std::exp(std::clamp(logarithm, kSmallest, kLargest)); }
  // Derivative of the error with respect to the size.
  Eigen::VectorXd slopeAt(double logarithm) const {
    const double inside = std::clamp(logarithm, kSmallest + kSizeDifference, kLargest - kSizeDifference);
    const Residuals residuals = [this](const std::vector<double>& at) { return error(at); };
    return derivatives(residuals, {inside}, *error({inside}), kSizeDifference).col(0) / sizeOf(inside);
  }
  void judgeCycles(const Eigen::VectorXd& slope, const Eigen::VectorXd& left, Predicted& told) const;
  double bySpread(const Eigen::VectorXd& slope, const Eigen::VectorXd& left) const;

  const Measured& measured_;
  const CommonTraces& common_;
  const StaticFit& fit_;
  const std::vector<simulation::EnabledEffect>& effects_;
  const ParameterSpread& spread_;
  std::vector<bool> everywhere_;  // no effect acts on bent surfaces only
  Forward forward_;
};

std::vector<simulation::EnabledEffect> Predictor::effectsAt(const std::vector<double>& at) const {
  std::vector<simulation::EnabledEffect> effects = effects_;
  for (std::size_t k = 1; k < at.size(); ++k) {
    const ParameterSpread::Parameter& one = spread_.parameters[k - 1];
    double& value = effects[one.effect].values[one.name];
    const settings::Range& permitted =
        simulation::parameter(measured_.info(effects[one.effect].id), one.name).permitted;
    value =
        std::clamp(one.logarithmic ? value * std::exp(at[k]) : value + at[k], permitted.low, permitted.high);
  }
  for (simulation::EnabledEffect& effect : effects) {
    for (const simulation::EffectParameter& parameter : simulation::strengths(measured_.info(effect.id)))
      effect.values[parameter.name] *= sizeOf(at[0]);
  }
  return effects;
}

// The size that each cycle gives, and the variance of the common one, clustered by cycle and corrected for
// one fitted number.
void Predictor::judgeCycles(const Eigen::VectorXd& slope, const Eigen::VectorXd& left,
                            Predicted& told) const {
  double squares = 0;
  for (const MeasuredCycle& cycle : measured_.cycles) {
    const auto first = static_cast<Eigen::Index>(cycle.first);
    const auto samples = static_cast<Eigen::Index>(cycle.last - cycle.first);
    const double pull = slope.segment(first, samples).dot(left.segment(first, samples));
    told.information.push_back(slope.segment(first, samples).squaredNorm());
    told.apart.push_back(-pull / std::max(1e-300, told.information.back()));
    squares += pull * pull;
  }
  const auto cycles = static_cast<double>(measured_.fitCycles());
  told.variance =
      squares / std::max(1e-300, std::pow(slope.squaredNorm(), 2)) * cycles / std::max(1.0, cycles - 1);
}

// A parameter that is wrong by d changes the size that fits best by d times (its derivative along that of the
// size). Each derivative is taken over a third of the parameter's standard deviation, at size 1.
double Predictor::bySpread(const Eigen::VectorXd& slope, const Eigen::VectorXd& left) const {
  const auto size = static_cast<Eigen::Index>(spread_.parameters.size());
  Eigen::VectorXd along = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd covariance(size, size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const auto row = static_cast<std::size_t>(k);
    for (Eigen::Index l = 0; l < size; ++l)
      covariance(k, l) = spread_.covariance[row][static_cast<std::size_t>(l)];
    const double step = std::sqrt(std::max(0.0, covariance(k, k))) / 3;
    if (!(step > 0)) continue;
    std::vector<double> moved(spread_.parameters.size() + 1, 0.0);
    double width = 0;
    Eigen::VectorXd change = Eigen::VectorXd::Zero(left.size());
    for (const double side : {-1.0, 1.0}) {
      moved[row + 1] = side * step;
      const auto there = error(moved);
      if (!there) continue;
      change += side * (*there - left);
      width += step;
    }
    if (width > 0) along[k] = slope.dot(change) / width / std::max(1e-300, slope.squaredNorm());
  }
  return std::max(0.0, along.dot(covariance * along));
}

Predicted Predictor::run() const {
  Predicted told;
  told.trace = Trace::Zero(common_.all.size());
  const Residuals residuals = [this](const std::vector<double>& at) { return error(at); };
  const double before = withoutHoldOut(measured_, fit_.project(common_.all)).squaredNorm();
  const auto as_told = error({0});
  if (!as_told || before <= 0) return told;
  told.share = 1 - as_told->squaredNorm() / before;
  const std::vector<double> at = levenberg(residuals, {0}, {12, 0.02, 1e-5});
  const auto best = error(at);
  told.size = sizeOf(at[0]);
  judgeCycles(slopeAt(at[0]), *best, told);
  told.of_spread = bySpread(slopeAt(0), *as_told);
  told.trace = forward_.explained(effectsAt(at), everywhere_);
  return told;
}

}  // namespace

Predicted predict(const Measured& measured, const CommonTraces& common, const StaticFit& fit,
                  const simulation::SimulationSettings& base,
                  const std::vector<simulation::EnabledEffect>& effects, const ParameterSpread& spread) {
  return Predictor(measured, common, fit, base, effects, spread).run();
}

namespace {

using Effects = std::vector<simulation::EnabledEffect>;

// Every field has a name and an end mark, so that different predictions have different texts.
void write(std::ostream& out, const Effects& effects) {
  for (const simulation::EnabledEffect& effect : effects) {
    out << effect.id << " {";
    for (const auto& [name, value] : effect.values)
      out << name << ": " << settings::numberText(value) << ", ";
    out << "only_taxels: [";
    for (const std::size_t taxel : effect.only_taxels) out << taxel << ", ";
    out << "], only_surfaces: [";
    for (const std::string& surface : effect.only_surfaces) out << settings::quotedText(surface) << ", ";
    out << (effect.carried_over ? "]} " : "], carried_over: false} ");  // older hashes stay
  }
  out << "\n";
}

// File names are left out, because base.yaml and its table may be moved and renamed.
std::string contentOf(simulation::SimulationSettings simulation) {
  const auto curves = std::exchange(simulation.taxel_curves, nullptr);
  simulation.taxel_curves_file.clear();
  return simulation::simulationText(simulation) + (curves ? simulation::taxelCurvesText(*curves) : "");
}

std::string hashOfText(const std::string& text) {
  return settings::sha256(text.data(), text.size());
}

void writeFirst(std::ostream& out, const Effects& effects) {
  for (const simulation::EnabledEffect& effect : effects) {
    out << effect.id << "{";
    for (const auto& [name, value] : effect.values) out << name << "=" << value << ";";
    for (const std::size_t taxel : effect.only_taxels) out << taxel << ",";
    for (const std::string& surface : effect.only_surfaces) out << surface << ",";
    out << "}";
  }
  out << "\n";
}

void write(std::ostream& out, const ParameterSpread& spread) {
  out << "spread: ";
  for (std::size_t k = 0; k < spread.parameters.size(); ++k) {
    const ParameterSpread::Parameter& one = spread.parameters[k];
    out << one.effect << " " << one.name << (one.logarithmic ? " logarithm" : "") << ": [";
    for (const double covariance : spread.covariance[k]) out << settings::numberText(covariance) << ", ";
    out << "] ";
  }
  out << "cycles: " << spread.cycles << " groups: " << spread.groups
      << " between: " << settings::numberText(spread.between) << "\n";
}

bool hasDistribution(const Prediction& prediction) {
  const ParameterSpread& spread = prediction.spread;
  return !prediction.weights.empty() || !spread.parameters.empty() || !spread.covariance.empty() ||
         spread.cycles != 0 || spread.groups != 0 || spread.between != 0;
}

}  // namespace

std::string hashOf(const Prediction& prediction, const simulation::SimulationSettings& simulation) {
  std::ostringstream text;
  const bool third = hasDistribution(prediction);
  text << (third ? "prediction, third form\neffects: " : "prediction, second form\neffects: ");
  write(text, prediction.effects);
  for (const Effects& rival : prediction.rivals) {
    text << "rival: ";
    write(text, rival);
  }
  text << "size: " << settings::numberText(prediction.size.low) << " to "
       << settings::numberText(prediction.size.high) << "\n";
  if (third) {
    text << "weights: ";
    for (const double weight : prediction.weights) text << settings::numberText(weight) << ", ";
    text << "\n";
    write(text, prediction.spread);
  }
  text << contentOf(simulation);
  return hashOfText(text.str());
}

std::string firstHashOf(const Prediction& prediction, const simulation::SimulationSettings& simulation) {
  std::ostringstream text;
  text.precision(9);
  writeFirst(text, prediction.effects);
  for (const Effects& rival : prediction.rivals) writeFirst(text, rival);
  text << prediction.size.low << " " << prediction.size.high << "\n";
  text << simulation.layout.size.rows << " x " << simulation.layout.size.columns << "\n";
  writeFirst(text, simulation.effects);
  return hashOfText(text.str());
}

bool hasItsHash(const Prediction& prediction, const simulation::SimulationSettings& simulation) {
  return prediction.hash == hashOf(prediction, simulation) ||
         (!hasDistribution(prediction) && prediction.hash == firstHashOf(prediction, simulation));
}

// A prediction is a distribution: what new recordings of the same protocol would give for the size of the
// effects. It is as wide as the scatter of the parameters, of the new cycles, and between mounts and
// protocols makes it.

namespace {

double varianceBetween(const std::vector<double>& weight, const std::vector<double>& size,
                       const std::vector<double>& within) {
  double all = 0, squares = 0, mean = 0;
  for (std::size_t g = 0; g < size.size(); ++g) {
    all += weight[g];
    squares += weight[g] * weight[g];
    mean += weight[g] * size[g];
  }
  mean /= all;
  double seen = 0, by_chance = 0;
  for (std::size_t g = 0; g < size.size(); ++g) {
    seen += weight[g] * std::pow(size[g] - mean, 2);
    by_chance += weight[g] * within[g] * (1 - weight[g] / all);
  }
  return std::max(0.0, (seen - by_chance) / (all - squares / all));
}

}  // namespace

std::vector<double> weightsOf(const std::vector<std::vector<double>>& densities, std::size_t draws,
                              std::uint64_t seed) {
  std::vector<double> weights(densities.size(), 0.0);
  const statistics::RandomStream stream = statistics::randomStream(seed, "discrepancy.weights");
  const std::size_t cycles = densities.front().size();
  std::vector<double> share(cycles), score(densities.size());
  for (std::size_t draw = 0; draw < draws; ++draw) {
    double sum = 0;
    for (std::size_t c = 0; c < cycles; ++c) {
      share[c] = -std::log(stream.uniform(draw * cycles + c));
      sum += share[c];
    }
    for (std::size_t e = 0; e < densities.size(); ++e) {
      score[e] = 0;
      for (std::size_t c = 0; c < cycles; ++c)
        score[e] += densities[e][c] * share[c] / sum * static_cast<double>(cycles);
    }
    const double most = *std::max_element(score.begin(), score.end());
    double all = 0;
    for (double& one : score) all += one = std::exp(one - most);
    for (std::size_t e = 0; e < score.size(); ++e) weights[e] += score[e] / all / static_cast<double>(draws);
  }
  return weights;
}

void judgeGroups(const Measured& measured, const Predicted& here, ParameterSpread& spread) {
  std::vector<std::size_t> protocol(measured.cycles.size(), 0);
  const std::vector<Part> parts = partsByProtocol(measured);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const std::size_t c : parts[p].cycles) protocol[c] = p + 1;
  }
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> groups;
  for (std::size_t c = 0; c < measured.cycles.size(); ++c) {
    if (measured.cycles[c].use == CycleUse::kFit)
      groups[{measured.cycles[c].visit, protocol[c]}].push_back(c);
  }
  std::vector<double> weight, size, within;
  for (const auto& [key, cycles] : groups) {
    double all = 0, mean = 0, squares = 0;
    for (const std::size_t c : cycles) {
      all += here.information[c];
      mean += here.information[c] * here.apart[c];
    }
    if (cycles.size() < 2 || !(all > 0)) continue;
    mean /= all;
    for (const std::size_t c : cycles)
      squares += std::pow(here.information[c] / all * (here.apart[c] - mean), 2);
    const auto number = static_cast<double>(cycles.size());
    weight.push_back(all);
    size.push_back(mean);
    within.push_back(squares * number / (number - 1));
  }
  spread.groups = size.size();
  if (size.size() >= 2) spread.between = varianceBetween(weight, size, within);
}

Interval predictiveInterval(const Predicted& here, const ParameterSpread& spread, std::size_t cycles) {
  const auto atLeastTwo = [](std::size_t n) { return static_cast<double>(std::max<std::size_t>(n, 2)); };
  const double known = atLeastTwo(spread.cycles);
  const double parts[] = {here.of_spread * known / (known - 1), here.variance, spread.between};
  const double degrees[] = {known - 1, atLeastTwo(cycles) - 1, atLeastTwo(spread.groups) - 1};
  double variance = 0, of_variance = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    variance += parts[k];
    of_variance += parts[k] * parts[k] / degrees[k];
  }
  if (!(variance > 0)) return {1, 1};
  const boost::math::students_t t(variance * variance / of_variance);
  const double reach = boost::math::quantile(t, 0.975) * std::sqrt(variance);
  return {std::max(0.0, 1 - reach), 1 + reach};
}

Interval sizeInterval(const Predicted& here, std::size_t cycles) {
  const auto degrees = static_cast<double>(std::max<std::size_t>(cycles, 2) - 1);
  const double reach =
      boost::math::quantile(boost::math::students_t(degrees), 0.975) * std::sqrt(here.variance);
  return {std::max(0.0, here.size - reach), here.size + reach};
}

Prediction freeze(const Decision& decision, const Measured& measured, const CommonTraces& common,
                  const StaticFit& fit, const simulation::SimulationSettings& base,
                  const DiscrepancyOptions& options) {
  Prediction prediction;
  prediction.effects = decision.refined.effects;
  for (const Refined& rival : decision.rivals) prediction.rivals.push_back(rival.effects);
  prediction.weights = weightsOf(decision.densities, options.resamples, options.seed);
  prediction.spread = decision.refined.spread;
  const Predicted again = predict(measured, common, fit, base, prediction.effects, prediction.spread);
  judgeGroups(measured, again, prediction.spread);
  prediction.size = predictiveInterval(again, prediction.spread, measured.fitCycles());
  return prediction;
}

}  // namespace fsr::discrepancy
