#include "discrepancy/fit/signatures.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "dataset/count_readers.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "matrix/for_each_taxel.h"
#include "simulation/sensitivity.h"

namespace fsr::discrepancy {

namespace {

constexpr std::size_t kReadingsInMemory = 16u << 20;  // of one recording [bytes]

// A simulation that goes from recording to recording.
class Driver {
 public:
  Driver(const dataset::Recording& first, const simulation::SimulationSettings& simulation)
      : expected_(simulation::withoutChance(simulation::fitted(simulation, first))),
        origin_ns_(first.start_ns),
        rig_(expected_) {}

  template <typename Use>
  void run(const dataset::Recording& recording, Use use) {
    const double start = 1e-9 * static_cast<double>(recording.start_ns - origin_ns_);
    if (start + recording.time.front() < end_) rig_ = simulation::DrivenRig(expected_);
    end_ = start + recording.time.back();
    rig_.run(recording, use);
  }

 private:
  simulation::SimulationSettings expected_;
  std::int64_t origin_ns_;
  simulation::DrivenRig rig_;
  double end_ = -INFINITY;  // of the last recording [s]
};

}  // namespace

void driveRecordings(const std::vector<const dataset::Recording*>& recordings,
                     const simulation::SimulationSettings& simulation,
                     const std::function<void(std::size_t recording, std::size_t scan,
                                              const simulation::SensorChain& chain)>& use) {
  if (recordings.empty()) return;
  Driver driver(*recordings.front(), simulation);
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    driver.run(*recordings[r],
               [&](std::size_t scan, const simulation::SensorChain& chain) { use(r, scan, chain); });
  }
}

void driveRecordingsTwice(
    const std::vector<const dataset::Recording*>& recordings, const simulation::SimulationSettings& first,
    const simulation::SimulationSettings& second,
    const std::function<void(std::size_t recording, std::size_t scan, const double* first,
                             const simulation::SensorChain& second)>& use) {
  if (recordings.empty()) return;
  Driver one(*recordings.front(), first), other(*recordings.front(), second);
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    dataset::RowSpool<double> spool(kReadingsInMemory);
    spool.begin(recordings[r]->layout.size.taxels(), recordings[r]->scans());
    one.run(*recordings[r],
            [&](std::size_t, const simulation::SensorChain& chain) { spool.add(chain.reading().data()); });
    dataset::RowSpool<double>::Reader readings(spool);
    other.run(*recordings[r], [&](std::size_t scan, const simulation::SensorChain& chain) {
      use(r, scan, readings[scan], chain);
    });
  }
}

namespace {

// If the break between two visits is longer, the chain is told that the chamber was vented [s].
constexpr double kBreak = 2;

// Recorded pressure at any time, interpolated linearly between the scans.
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
    // Nothing was recorded between two visits: the nearer end is held.
    if (measured_.visit[at_] != measured_.visit[next]) share = std::round(share);
    return measured_.pressure[at_] +
           std::clamp(share, 0.0, 1.0) * (measured_.pressure[next] - measured_.pressure[at_]);
  }

 private:
  const Measured& measured_;
  std::size_t at_ = 0;
};

// Whether the sheet was mounted again between two visits. Visits that do not number their mountings are taken
// for a mounting each.
bool mountedAgain(const Visit& before, const Visit& now) {
  return now.surface.mount == 0 || !matrix::sameCondition(before.surface, now.surface);
}

// Drives a chain, or the difference of two chains, through everything that was recorded.
template <typename Chain, typename Make, typename Use>
void drive(const Measured& measured, bool state_kept, Make make, Use use) {
  RecordedCourse recorded(measured);
  const simulation::PressureCourse course = [&](double time) { return recorded(time); };
  Chain chain = make();
  simulation::RigSample sample;
  sample.course = &course;
  const auto rest = [&](double time) {
    sample.time = time;
    sample.pressure = 0;
    chain.read(sample);
  };
  const Visit* last = nullptr;
  for (const Visit& visit : measured.visits) {
    const double start = measured.time[visit.first];
    const double before = visit.first > 0 ? measured.time[visit.first - 1] : start;
    const bool mounted = !last || mountedAgain(*last, visit);
    const bool afresh = last && mounted && !state_kept;
    last = &visit;
    if (afresh) chain = make();
    if (!afresh && start - before > kBreak) rest(before + kBreak / 4);
    if (mounted) chain.mount(visit.surface);
    if (!afresh && start - before > kBreak) rest(start - kBreak / 4);
    for (std::size_t i = visit.first; i < visit.last; ++i) {
      sample.time = measured.time[i];
      sample.pressure = measured.pressure[i];
      sample.scan = i;
      sample.temperature =
          measured.temperature.empty() ? simulation::kRoomTemperature : measured.temperature[i];
      use(i, chain.read(sample), chain);
    }
  }
}

DrivenSignals emptySignals(const Measured& measured) {
  const auto scans = static_cast<Eigen::Index>(measured.samples());
  return {Trace::Zero(scans), Trace::Zero(scans), Trace::Zero(scans)};
}

// The derivative with respect to one strength, in the form that drive() expects.
struct Derivative {
  simulation::Sensitivity sensitivity;
  const simulation::TaxelSignals& read(const simulation::RigSample& sample) {
    return sensitivity.read(sample);
  }
  void mount(const matrix::Surface& surface) { sensitivity.mount(oneTaxel(surface)); }
};

struct Chain {
  simulation::SensorChain chain;
  const simulation::TaxelSignals& read(const simulation::RigSample& sample) {
    chain.read(sample);
    return chain.signals();
  }
  void mount(const matrix::Surface& surface) { chain.mount(oneTaxel(surface)); }
};

template <typename Driver>
auto keep(DrivenSignals& signals, double full_scale) {
  return [&signals, full_scale](std::size_t scan, const simulation::TaxelSignals& now, Driver&) {
    const auto at = static_cast<Eigen::Index>(scan);
    signals.load[at] = now.load[0];
    signals.gain[at] = now.gain[0];
    signals.reading[at] = now.reading[0] / full_scale;
  };
}

// All combinations of the tried values of an effect's shapes. Its strengths and scatters are neutral.
std::vector<simulation::EffectValues> shapeGrid(const simulation::EffectInfo& info) {
  std::vector<simulation::EffectValues> grid(1);
  for (const simulation::EffectParameter& parameter : info.parameters) {
    std::vector<double> tried = {parameter.usual};
    if (parameter.role != simulation::ParameterRole::kShape) tried = {parameter.neutral};
    if (parameter.role == simulation::ParameterRole::kShape && !parameter.tried.empty())
      tried = parameter.tried;
    std::vector<simulation::EffectValues> next;
    for (const simulation::EffectValues& values : grid) {
      for (const double value : tried) {
        next.push_back(values);
        next.back()[parameter.name] = value;
      }
    }
    grid = std::move(next);
  }
  return grid;
}

bool sought(const simulation::EffectEntry& entry, const simulation::SimulationSettings& settings,
            const std::vector<std::string>& leave_out) {
  const simulation::EffectKind kind = entry.info.kind;
  const bool by_derivative =
      kind == simulation::EffectKind::kAdditive || kind == simulation::EffectKind::kGrid;
  return by_derivative && entry.info.looked_for && mayBeFound(entry.info.id, settings, leave_out) &&
         entry.info.detector == simulation::Detector::kNone;
}

bool remembers(const simulation::EffectEntry& entry) {
  return entry.info.stage == simulation::ChainStage::kMemory ||
         entry.info.stage == simulation::ChainStage::kCavity;
}

// Strengths at which the signature of an effect on the load is taken.
std::vector<double> amplitudes(const simulation::EffectInfo& info,
                               const simulation::EffectParameter& strength) {
  if (info.stage >= simulation::ChainStage::kGain || strength.usual == 0) return {0};
  std::vector<double> strengths;
  for (const double share : {0.1, 1.0, 3.0}) {
    const double amplitude = share * std::abs(strength.usual);
    if (info.sign != simulation::SignRule::kNegative) strengths.push_back(amplitude);
    if (info.sign != simulation::SignRule::kPositive) strengths.push_back(-amplitude);
  }
  return strengths;
}

// One signature for each derivative, without its amplitude.
std::vector<Signature> planned(const simulation::SimulationSettings& settings,
                               const std::vector<std::string>& leave_out) {
  std::vector<Signature> plan;
  for (const simulation::EffectEntry& entry : simulation::libraryOf(settings).entries()) {
    if (!sought(entry, settings, leave_out)) continue;
    for (const simulation::EffectValues& values : shapeGrid(entry.info)) {
      for (const simulation::EffectParameter& strength : simulation::strengths(entry.info)) {
        Signature signature;
        signature.id = entry.info.id;
        signature.strength = strength.name;
        signature.values = values;
        signature.values.erase(strength.name);
        signature.free_sign = entry.info.sign == simulation::SignRule::kEither;
        signature.scale = entry.info.sign == simulation::SignRule::kNegative ? -1 : 1;
        plan.push_back(signature);
        if (!remembers(entry)) continue;
        signature.state_kept = false;
        plan.push_back(signature);
      }
    }
  }
  return plan;
}

}  // namespace

matrix::Surface oneTaxel(const matrix::Surface& surface) {
  matrix::Surface one = surface;
  one.deviation.clear();
  matrix::Curvature mean;
  for (const matrix::Curvature& c : surface.curvature) {
    const auto taxels = static_cast<double>(surface.curvature.size());
    mean.x += c.x / taxels;
    mean.y += c.y / taxels;
    mean.xy += c.xy / taxels;
  }
  one.curvature = {mean};
  return one;
}

simulation::SimulationSettings representative(const simulation::SimulationSettings& settings) {
  simulation::SimulationSettings one = settings;
  one.layout.size = {1, 1};
  one.taxel_curves = nullptr;
  auto& effects = one.effects;
  const simulation::EffectLibrary& library = simulation::libraryOf(settings);
  const auto unwanted = [&](const simulation::EnabledEffect& effect) {
    const simulation::EffectInfo& info = library.info(effect.id);
    const bool single =
        info.kind == simulation::EffectKind::kDetector && info.level != simulation::EffectLevel::kRig;
    return info.stochastic || single;
  };
  effects.erase(std::remove_if(effects.begin(), effects.end(), unwanted), effects.end());
  for (simulation::EnabledEffect& effect : effects) {
    effect.only_taxels.clear();  // the effect acts on the only taxel
    for (const simulation::EffectParameter& parameter : library.info(effect.id).parameters) {
      if (parameter.role == simulation::ParameterRole::kScatter)
        effect.values[parameter.name] = parameter.neutral;
    }
  }
  return one;
}

DrivenSignals drivenDerivative(const Measured& measured, const simulation::SimulationSettings& settings,
                               const std::string& id, const std::string& strength,
                               const simulation::EffectValues& values, bool state_kept) {
  DrivenSignals signals = emptySignals(measured);
  const simulation::SimulationSettings one = representative(settings);
  const auto make = [&] { return Derivative{simulation::Sensitivity(one, id, strength, values)}; };
  drive<Derivative>(measured, state_kept, make, keep<Derivative>(signals, one.fullScale()));
  return signals;
}

DrivenSignals driven(const Measured& measured, const simulation::SimulationSettings& settings) {
  DrivenSignals signals = emptySignals(measured);
  const simulation::SimulationSettings one = representative(settings);
  drive<Chain>(
      measured, true, [&] { return Chain{simulation::SensorChain(one)}; },
      keep<Chain>(signals, one.fullScale()));
  return signals;
}

Trace throughCurve(const Measured& measured, const StaticFit& fit, const DrivenSignals& derivative,
                   simulation::ChainStage stage, double amplitude) {
  if (stage >= simulation::ChainStage::kConductance) return derivative.reading;
  const Trace gained = derivative.gain.cwiseProduct(fit.netCurve());
  if (amplitude == 0) return derivative.load.cwiseProduct(fit.slope()) + gained;
  Trace changed(gained.size());
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double load = measured.loads()[i];
    changed[at] = (fit.curveAt(i, load + amplitude * derivative.load[at]) - fit.curveAt(i, load)) / amplitude;
  }
  return changed + gained;
}

bool mayBeFound(const std::string& id, const simulation::SimulationSettings& settings,
                const std::vector<std::string>& leave_out) {
  return !settings.effect(id) && !std::count(leave_out.begin(), leave_out.end(), id);
}

std::vector<Signature> signatures(const Measured& measured, const StaticFit& fit,
                                  const simulation::SimulationSettings& settings,
                                  const std::vector<std::string>& leave_out, unsigned threads) {
  const std::vector<Signature> plan = planned(settings, leave_out);
  std::vector<std::vector<Signature>> of_derivative(plan.size());
  matrix::forEachTaxel(plan.size(), threads, [&](std::size_t k) {
    const Signature& one = plan[k];
    DrivenSignals derivative;
    try {
      derivative = drivenDerivative(measured, settings, one.id, one.strength, one.values, one.state_kept);
    } catch (const settings::InputError&) {
      return;  // the effect refuses this combination of shapes
    }
    const simulation::EffectInfo& info = measured.info(one.id);
    for (const double amplitude : amplitudes(info, simulation::parameter(info, one.strength))) {
      Trace trace = throughCurve(measured, fit, derivative, info.stage, amplitude);
      const double rms = std::sqrt(trace.squaredNorm() / static_cast<double>(trace.size()));
      if (!(rms > 0) || !std::isfinite(rms)) continue;
      Signature signature = one;
      signature.amplitude = amplitude;
      signature.scale /= rms;
      signature.trace = trace * (one.scale / rms);
      of_derivative[k].push_back(std::move(signature));
    }
  });
  std::vector<Signature> all;
  for (std::vector<Signature>& some : of_derivative)
    std::move(some.begin(), some.end(), std::back_inserter(all));
  return all;
}

}  // namespace fsr::discrepancy
