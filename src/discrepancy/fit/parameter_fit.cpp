#include "discrepancy/fit/parameter_fit.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/fit/signatures.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"
#include "simulation/sensor_chain.h"

namespace fsr::discrepancy {

namespace {

constexpr int kTries = 4;

// Takes a damped step that lowers the error. Returns none if no damping that is tried lowers it.
std::optional<std::pair<std::vector<double>, Eigen::VectorXd>> betterPoint(const Residuals& residuals,
                                                                           const std::vector<double>& at,
                                                                           const Eigen::VectorXd& now,
                                                                           const Eigen::MatrixXd& jacobian,
                                                                           double& damping) {
  const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
  const Eigen::VectorXd right = -jacobian.transpose() * now;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    Eigen::MatrixXd damped = normal;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff() + 1e-300;
    const Eigen::VectorXd move = damped.ldlt().solve(right).cwiseMax(-1).cwiseMin(1);
    std::vector<double> next = at;
    for (std::size_t k = 0; k < next.size(); ++k) next[k] += move[static_cast<Eigen::Index>(k)];
    const auto there = residuals(next);
    const bool better = there && there->squaredNorm() < now.squaredNorm();
    damping *= better ? 0.3 : 8;
    if (better) return std::make_pair(next, *there);
  }
  return std::nullopt;
}

}  // namespace

Eigen::MatrixXd derivatives(const Residuals& residuals, const std::vector<double>& at,
                            const Eigen::VectorXd& there, double difference) {
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(there.size(), static_cast<Eigen::Index>(at.size()));
  for (std::size_t k = 0; k < at.size(); ++k) {
    for (const double step : {difference, -difference}) {
      std::vector<double> beside = at;
      beside[k] += step;
      const auto value = residuals(beside);
      if (!value) continue;
      slopes.col(static_cast<Eigen::Index>(k)) = (*value - there) / step;
      break;
    }
  }
  return slopes;
}

std::vector<double> levenberg(const Residuals& residuals, std::vector<double> at,
                              const LevenbergOptions& options) {
  auto now = residuals(at);
  double damping = 1e-2;
  for (int step = 0; now && step < options.steps; ++step) {
    const Eigen::MatrixXd jacobian = derivatives(residuals, at, *now, options.difference);
    auto better = betterPoint(residuals, at, *now, jacobian, damping);
    if (!better) break;
    const double gained = 1 - better->second.squaredNorm() / now->squaredNorm();
    at = better->first;
    now = better->second;
    if (gained < options.enough) break;
  }
  return at;
}

namespace {

constexpr std::size_t kPressures = 24;  // in each visit, at which curves are compared
constexpr double kLargestStep = 4;      // of a logarithm: about a factor of 50 up or down

// A fitted parameter. The fit works on the logarithm of its value.
struct Fitted {
  int place;  // in the order of the fit
  std::string effect, name;
  double start;
  settings::Range range;
};

bool isFitted(const simulation::EffectParameter& parameter) {
  return parameter.place_in_base_fit > 0;
}

bool isFitted(const simulation::EffectInfo& info) {
  return std::any_of(info.parameters.begin(), info.parameters.end(),
                     [](const simulation::EffectParameter& parameter) { return isFitted(parameter); });
}

simulation::EnabledEffect& enabled(simulation::SimulationSettings& settings, const std::string& id) {
  return *std::find_if(settings.effects.begin(), settings.effects.end(),
                       [&](const simulation::EnabledEffect& e) { return e.id == id; });
}

// Returns the parameters of these settings that are fitted. An offset of 0 starts from a hundredth of the
// conductance; other parameters that are 0 are not fitted.
std::vector<Fitted> fittedOf(const simulation::SimulationSettings& settings, bool bent) {
  std::vector<Fitted> fitted;
  for (const simulation::EnabledEffect& effect : settings.effects) {
    const simulation::EffectInfo& info = simulation::libraryOf(settings).info(effect.id);
    if (!bent && info.with_bending) continue;
    for (const simulation::EffectParameter& parameter : info.parameters) {
      if (!isFitted(parameter)) continue;
      double start = effect.values.at(parameter.name);
      if (parameter.name == "offset" && start == 0) start = 0.01 * effect.values.at("conductance");
      if (start == 0 || !std::isfinite(start)) continue;
      fitted.push_back({parameter.place_in_base_fit, effect.id, parameter.name, start, parameter.permitted});
    }
  }
  std::sort(fitted.begin(), fitted.end(), [](const Fitted& a, const Fitted& b) { return a.place < b.place; });
  return fitted;
}

simulation::SimulationSettings settingsAt(simulation::SimulationSettings settings,
                                          const std::vector<Fitted>& fitted, const std::vector<double>& at) {
  for (std::size_t k = 0; k < fitted.size(); ++k) {
    const double value = fitted[k].start * std::exp(std::clamp(at[k], -kLargestStep, kLargestStep));
    enabled(settings, fitted[k].effect).values[fitted[k].name] =
        std::clamp(value, fitted[k].range.low, fitted[k].range.high);
  }
  return settings;
}

// A few samples of every visit, evenly spaced over its range of pressure.
std::vector<std::size_t> chosenSamples(const Measured& measured) {
  std::vector<std::size_t> chosen;
  for (const Visit& visit : measured.visits) {
    std::vector<std::size_t> order;
    for (std::size_t i = visit.first; i < visit.last; ++i) order.push_back(i);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return measured.pressure[a] < measured.pressure[b]; });
    const double low = measured.pressure[order.front()], high = measured.pressure[order.back()];
    auto next = order.begin();
    for (std::size_t k = 0; k < kPressures; ++k) {
      const double wanted = low + (high - low) * static_cast<double>(k) / (kPressures - 1);
      while (next + 1 != order.end() && measured.pressure[*next] < wanted) ++next;
      chosen.push_back(*next);
    }
  }
  return chosen;
}

// Static readings of the representative taxel at the chosen samples [share of full scale].
Eigen::VectorXd staticReadings(const Measured& measured, const simulation::SimulationSettings& settings,
                               const std::vector<std::size_t>& samples) {
  simulation::SensorChain chain(representative(settings));
  Eigen::VectorXd readings(static_cast<Eigen::Index>(samples.size()));
  std::size_t mounted = measured.visits.size();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (measured.visit[samples[k]] != mounted) {
      mounted = measured.visit[samples[k]];
      matrix::Surface surface = measured.visits[mounted].surface;
      matrix::Curvature mean;
      for (const matrix::Curvature& c : surface.curvature)
        mean.x += matrix::principalCurvature(c) / static_cast<double>(surface.curvature.size());
      surface.curvature = {mean};
      chain.mount(surface);
    }
    simulation::RigSample sample;
    sample.pressure = measured.pressure[samples[k]];
    chain.read(sample);
    readings[static_cast<Eigen::Index>(k)] = chain.reading()[0] / settings.fullScale();
  }
  return readings;
}

// Keeps only the fitted and the required effects. They are static, and so are the curves.
simulation::SimulationSettings withoutMemory(simulation::SimulationSettings settings) {
  auto& effects = settings.effects;
  effects.erase(std::remove_if(effects.begin(), effects.end(),
                               [&](const simulation::EnabledEffect& e) {
                                 const simulation::EffectInfo& info =
                                     simulation::libraryOf(settings).info(e.id);
                                 return !isFitted(info) && !info.required;
                               }),
                effects.end());
  return settings;
}

// Relative standard deviation of the taxels' readings at the highest pressure.
double taxelScatter(const Measured& measured) {
  const auto peak = std::max_element(measured.pressure.begin(), measured.pressure.end());
  std::vector<double> readings;
  measured.readings(static_cast<std::size_t>(peak - measured.pressure.begin()), readings);
  double sum = 0, squares = 0, number = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (!measured.used[i] || readings[i] <= 0) continue;
    sum += std::log(readings[i]);
    squares += std::pow(std::log(readings[i]), 2);
    ++number;
  }
  return number > 1 ? std::sqrt(std::max(0.0, (squares - sum * sum / number) / (number - 1))) : 0;
}

}  // namespace

simulation::SimulationSettings fitBase(const Measured& measured, const StaticFit& fit,
                                       const simulation::SimulationSettings& settings) {
  bool bent = false;
  for (const dataset::CurvatureClass& c : measured.classes) bent = bent || !dataset::isFlat(c);
  const std::vector<Fitted> fitted = fittedOf(settings, bent);
  const std::vector<std::size_t> samples = chosenSamples(measured);
  Eigen::VectorXd wanted(static_cast<Eigen::Index>(samples.size()));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    wanted[static_cast<Eigen::Index>(k)] = fit.curve()[static_cast<Eigen::Index>(samples[k])];
  }
  const simulation::SimulationSettings still = withoutMemory(settings);
  const Residuals residuals = [&](const std::vector<double>& at) -> std::optional<Eigen::VectorXd> {
    try {
      return staticReadings(measured, settingsAt(still, fitted, at), samples) - wanted;
    } catch (const settings::InputError&) {
      return std::nullopt;
    }
  };
  LevenbergOptions options;
  options.steps = 40;
  const auto at = levenberg(residuals, std::vector<double>(fitted.size(), 0.0), options);
  simulation::SimulationSettings base = settingsAt(settings, fitted, at);
  for (simulation::EnabledEffect& effect : base.effects) {
    for (const simulation::EffectParameter& parameter : measured.info(effect.id).parameters) {
      if (!parameter.from_taxel_deviation) continue;
      effect.values[parameter.name] = std::min(taxelScatter(measured), parameter.permitted.high);
    }
  }
  return base;
}

}  // namespace fsr::discrepancy
