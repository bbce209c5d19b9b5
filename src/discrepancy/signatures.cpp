#include "fsr_pressure_map/discrepancy/signatures.h"

#include <algorithm>
#include <cmath>

#include "fsr_pressure_map/matrix/for_each_taxel.h"
#include "fsr_pressure_map/simulation/effects/effect_library.h"
#include "fsr_pressure_map/simulation/sensitivity.h"

namespace fsr {

namespace {

// A break between two visits that is worth telling the chain of: the chamber was vented [s].
constexpr double kBreak = 2;

// Recorded pressure at any time, straight between the scans.
class RecordedCourse {
 public:
  explicit RecordedCourse(const Measured& measured) : measured_(measured) {}

  double operator()(double time) {
    const std::vector<double>& times = measured_.time;
    while (at_ > 0 && times[at_] > time) --at_;
    while (at_ + 2 < times.size() && times[at_ + 1] <= time) ++at_;
    const std::size_t next = std::min(at_ + 1, times.size() - 1);
    if (next == at_) return measured_.pressure[at_];
    double share = (time - times[at_]) / (times[next] - times[at_]);
    // Between two visits nothing was recorded: each one's end is held.
    if (measured_.visit[at_] != measured_.visit[next]) share = std::round(share);
    return measured_.pressure[at_] +
           std::clamp(share, 0.0, 1.0) * (measured_.pressure[next] - measured_.pressure[at_]);
  }

 private:
  const Measured& measured_;
  std::size_t at_ = 0;
};

// Leads a chain, or a difference of two, through everything that was recorded.
template <typename Chain, typename Make, typename Use>
void drive(const Measured& measured, bool carried, Make make, Use use) {
  RecordedCourse recorded(measured);
  const PressureCourse course = [&](double time) { return recorded(time); };
  Chain chain = make();
  RigMoment moment;
  moment.course = &course;
  const auto rest = [&](double time) {
    moment.time = time;
    moment.pressure = 0;
    chain.read(moment);
  };
  for (const Visit& visit : measured.visits) {
    const double start = measured.time[visit.first];
    const double before = visit.first > 0 ? measured.time[visit.first - 1] : start;
    if (!carried && visit.first > 0) chain = make();
    if (carried && start - before > kBreak) rest(before + kBreak / 4);
    chain.mount(visit.surface);
    if (carried && start - before > kBreak) rest(start - kBreak / 4);
    for (std::size_t i = visit.first; i < visit.last; ++i) {
      moment.time = measured.time[i];
      moment.pressure = measured.pressure[i];
      moment.scan = i;
      moment.temperature = measured.temperature.empty() ? kRoomTemperature : measured.temperature[i];
      use(i, chain.read(moment), chain);
    }
  }
}

DrivenSignals emptySignals(const Measured& measured) {
  const auto scans = static_cast<Eigen::Index>(measured.moments());
  return {Trace::Zero(scans), Trace::Zero(scans), Trace::Zero(scans)};
}

Surface oneTaxel(const Surface& surface) {
  Surface one = surface;
  one.deviation.clear();
  Curvature mean;
  for (const Curvature& c : surface.curvature) {
    const auto taxels = static_cast<double>(surface.curvature.size());
    mean.x += c.x / taxels;
    mean.y += c.y / taxels;
    mean.xy += c.xy / taxels;
  }
  one.curvature = {mean};
  return one;
}

// Of the derivative of one strength.
struct Derivative {
  Sensitivity sensitivity;
  const TaxelSignals& read(const RigMoment& moment) { return sensitivity.read(moment); }
  void mount(const Surface& surface) { sensitivity.mount(oneTaxel(surface)); }
};

struct Chain {
  SensorChain chain;
  const TaxelSignals& read(const RigMoment& moment) {
    chain.read(moment);
    return chain.signals();
  }
  void mount(const Surface& surface) { chain.mount(oneTaxel(surface)); }
};

template <typename Driver>
auto keep(DrivenSignals& signals, double full_scale) {
  return [&signals, full_scale](std::size_t scan, const TaxelSignals& now, Driver&) {
    const auto at = static_cast<Eigen::Index>(scan);
    signals.load[at] = now.load[0];
    signals.gain[at] = now.gain[0];
    signals.reading[at] = now.reading[0] / full_scale;
  };
}

// All combinations of the tried values of an effect's shapes; its other strengths and scatters off.
std::vector<EffectValues> shapeGrid(const EffectInfo& info) {
  std::vector<EffectValues> grid(1);
  for (const EffectParameter& parameter : info.parameters) {
    std::vector<double> tried = {parameter.usual};
    if (parameter.role != ParameterRole::kShape) tried = {parameter.neutral};
    if (parameter.role == ParameterRole::kShape && !parameter.tried.empty()) tried = parameter.tried;
    std::vector<EffectValues> next;
    for (const EffectValues& values : grid) {
      for (const double value : tried) {
        next.push_back(values);
        next.back()[parameter.name] = value;
      }
    }
    grid = std::move(next);
  }
  return grid;
}

bool sought(const EffectEntry& entry, const SimulationSettings& settings,
            const std::vector<std::string>& leave_out) {
  const EffectKind kind = entry.info.kind;
  const bool by_derivative = kind == EffectKind::kAdditive || kind == EffectKind::kGrid;
  const bool left_out = std::count(leave_out.begin(), leave_out.end(), entry.info.id) > 0;
  return by_derivative && !left_out && !settings.effect(entry.info.id) && entry.info.id != "mains_pickup";
}

bool remembers(const EffectEntry& entry) {
  return entry.info.stage == ChainStage::kMemory || entry.info.stage == ChainStage::kCavity;
}

std::vector<Signature> planned(const SimulationSettings& settings,
                               const std::vector<std::string>& leave_out) {
  std::vector<Signature> plan;
  for (const EffectEntry& entry : effectLibrary()) {
    if (!sought(entry, settings, leave_out)) continue;
    for (const EffectValues& values : shapeGrid(entry.info)) {
      for (const EffectParameter& strength : strengths(entry.info)) {
        Signature signature;
        signature.id = entry.info.id;
        signature.strength = strength.name;
        signature.values = values;
        signature.values.erase(strength.name);
        signature.free_sign = entry.info.sign == SignRule::kEither;
        signature.scale = entry.info.sign == SignRule::kNegative ? -1 : 1;
        plan.push_back(signature);
        if (!remembers(entry)) continue;
        signature.carried = false;
        plan.push_back(signature);
      }
    }
  }
  return plan;
}

bool possible(const EffectValues& values) {
  const auto fastest = values.find("fastest"), slowest = values.find("slowest");
  return fastest == values.end() || slowest == values.end() || fastest->second < slowest->second;
}

}  // namespace

SimulationSettings representative(const SimulationSettings& settings) {
  SimulationSettings one = settings;
  one.layout.size = {1, 1};
  one.taxel_curves = nullptr;
  auto& effects = one.effects;
  const auto unwanted = [](const EnabledEffect& effect) {
    const EffectEntry* entry = findEffect(effect.id);
    const bool detected = entry->info.kind == EffectKind::kDetector && effect.id != "saturation";
    return effect.id == "white_noise" || detected;
  };
  effects.erase(std::remove_if(effects.begin(), effects.end(), unwanted), effects.end());
  for (EnabledEffect& effect : effects) {
    effect.only_taxels.clear();  // the one taxel is one on which it acts
    for (const EffectParameter& parameter : findEffect(effect.id)->info.parameters) {
      if (parameter.role == ParameterRole::kScatter) effect.values[parameter.name] = parameter.neutral;
    }
  }
  return one;
}

DrivenSignals drivenDerivative(const Measured& measured, const SimulationSettings& settings,
                               const std::string& id, const std::string& strength, const EffectValues& values,
                               bool carried) {
  DrivenSignals signals = emptySignals(measured);
  const SimulationSettings one = representative(settings);
  const auto make = [&] { return Derivative{Sensitivity(one, id, strength, values)}; };
  drive<Derivative>(measured, carried, make, keep<Derivative>(signals, one.fullScale()));
  return signals;
}

DrivenSignals driven(const Measured& measured, const SimulationSettings& settings, bool carried) {
  DrivenSignals signals = emptySignals(measured);
  const SimulationSettings one = representative(settings);
  drive<Chain>(
      measured, carried, [&] { return Chain{SensorChain(one)}; }, keep<Chain>(signals, one.fullScale()));
  return signals;
}

Trace throughCurve(const StaticFit& fit, const DrivenSignals& derivative, ChainStage stage) {
  if (stage >= ChainStage::kConductance) return derivative.reading;
  return derivative.load.cwiseProduct(fit.slope()) + derivative.gain.cwiseProduct(fit.rise());
}

std::vector<Signature> signatures(const Measured& measured, const StaticFit& fit,
                                  const SimulationSettings& settings,
                                  const std::vector<std::string>& leave_out, unsigned threads) {
  std::vector<Signature> all = planned(settings, leave_out);
  forEachTaxel(all.size(), threads, [&](std::size_t s) {
    Signature& signature = all[s];
    if (!possible(signature.values)) return;
    const DrivenSignals derivative = drivenDerivative(measured, settings, signature.id, signature.strength,
                                                      signature.values, signature.carried);
    Trace trace = throughCurve(fit, derivative, findEffect(signature.id)->info.stage);
    const double rms = std::sqrt(trace.squaredNorm() / static_cast<double>(trace.size()));
    if (!(rms > 0) || !std::isfinite(rms)) return;
    trace *= signature.scale / rms;
    signature.scale /= rms;
    signature.trace = fit.project(trace);
    signature.left = std::sqrt(signature.trace.squaredNorm() / static_cast<double>(trace.size()));
  });
  const auto nothing = [](const Signature& s) { return s.trace.size() == 0; };
  all.erase(std::remove_if(all.begin(), all.end(), nothing), all.end());
  return all;
}

}  // namespace fsr
