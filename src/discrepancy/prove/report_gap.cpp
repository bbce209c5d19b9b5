#include "discrepancy/prove/report_gap.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/decide/changes.h"
#include "discrepancy/decide/refine.h"
#include "discrepancy/prove/gap.h"
#include "discrepancy/prove/wording.h"
#include "discrepancy/samples/held_out.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"
#include "simulation/sensor_chain.h"

namespace fsr::discrepancy {

namespace {

// Share of what is closed on all hold-out cycles. A part with less is reported as a limitation.
constexpr double kHoldsElsewhere = 0.5;
constexpr int kHalvings = 12;  // of the largest size that an effect's formula permits

double squareOf(const Trace& trace) {
  return trace.squaredNorm() / static_cast<double>(trace.size());
}

class GapReporter {
 public:
  GapReporter(const Found& found, DiscrepancyReport& report) : found_(found), report_(report) {}

  Gap run();

 private:
  void confine(double amplitude);
  simulation::SimulationSettings confined(double amplitude) const;
  double explainedShare() const;
  std::vector<Part> surfacesWhereItShows() const;
  Trace leftWithout(const Part& part) const;
  void holdOut(const std::string& by, const std::vector<Part>& parts, const GapGround& ground,
               const std::string& missing);

  const Found& found_;
  DiscrepancyReport& report_;
  Gap of_traces_;
};

// The simulation with the effects found, confined to the taxels and surfaces where they show. If these are
// not all taxels, the strengths are multiplied by `amplitude`, because the common trace is a mean over all
// taxels.
simulation::SimulationSettings GapReporter::confined(double amplitude) const {
  simulation::SimulationSettings settings = report_.added;
  for (const simulation::EnabledEffect& found : found_.decision.refined.effects) {
    simulation::EnabledEffect effect = *settings.effect(found.id);
    effect.only_taxels = report_.where.taxels;
    effect.only_surfaces = report_.where.conditions;
    for (const simulation::EffectParameter& strength :
         simulation::strengths(found_.measured.info(found.id))) {
      double& value = effect.values.at(strength.name);
      if (!effect.only_taxels.empty())
        value = std::clamp(amplitude * value, strength.permitted.low, strength.permitted.high);
    }
    settings = withEffect(settings, effect);
  }
  return settings;
}

// Whether the effects take their parameters together.
bool isPermitted(const simulation::SimulationSettings& settings) {
  try {
    simulation::SensorChain chain(settings);
    return true;
  } catch (const settings::InputError&) {
    return false;
  }
}

// On a few taxels an effect may have to be larger than its other parameters permit. It then gets the largest
// size that they do.
void GapReporter::confine(double amplitude) {
  double least = 1, most = std::max(1.0, amplitude);
  simulation::SimulationSettings added = confined(most);
  if (!isPermitted(added)) {
    for (int halved = 0; halved < kHalvings; ++halved) {
      const double between = (least + most) / 2;
      (isPermitted(confined(between)) ? least : most) = between;
    }
    added = confined(least);
    report_.limitations.push_back(
        "On the taxels where the effect shows it would have to be larger than its formula permits.");
  }
  report_.added = added;
}

// Share of the common trace's squared error that the findings explain.
double GapReporter::explainedShare() const {
  const double before = squareOf(found_.fit.residual(found_.common.all));
  return before > 0 ? 1 - squareOf(found_.fit.residual(found_.common.all) - found_.left) / before : 0;
}

std::vector<Part> GapReporter::surfacesWhereItShows() const {
  std::vector<Part> surfaces = partsByCondition(found_.measured);
  const std::vector<std::string>& where = report_.where.conditions;
  const auto elsewhere = [&](const Part& part) {
    return !where.empty() && !std::count(where.begin(), where.end(), part.name);
  };
  surfaces.erase(std::remove_if(surfaces.begin(), surfaces.end(), elsewhere), surfaces.end());
  return surfaces.size() < 2 ? std::vector<Part>() : surfaces;
}

// What the explanation removes from the common trace if its size is fitted without one part.
Trace GapReporter::leftWithout(const Part& part) const {
  std::vector<simulation::EnabledEffect> effects = found_.decision.refined.effects;
  effects.insert(effects.end(), found_.beside.begin(), found_.beside.end());
  return refine(withoutPart(found_.measured, part), found_.common, found_.fit, report_.base, effects,
                found_.decision.refined.state_kept, found_.decision.bent_only)
      .trace;
}

// Measures the gap again. Each part is predicted from a fit to the other parts.
void GapReporter::holdOut(const std::string& by, const std::vector<Part>& parts, const GapGround& ground,
                          const std::string& missing) {
  if (found_.decision.verdict == Verdict::kNone || found_.by_terms) return;
  if (parts.empty()) {
    report_.gap.missing.push_back(missing);
    return;
  }
  const Trace foretold = predictedByTheRest(found_.measured, parts, found_.threads,
                                            [this](const Part& part) { return leftWithout(part); });
  HeldOutGap held{by, 0, {}, {}};
  std::vector<std::size_t> cycles;
  for (const Part& part : parts) {
    cycles.insert(cycles.end(), part.cycles.begin(), part.cycles.end());
    held.parts.emplace_back(part.name, measureGap(ground, foretold, part.cycles).closed);
  }
  const Gap all = measureGap(ground, foretold, cycles);
  held.closed = all.closed;
  held.closed_interval = all.closed_interval;
  for (const auto& [part, closed] : held.parts) {
    if (closed >= kHoldsElsewhere * of_traces_.closed) continue;
    report_.limitations.push_back(weakPartText(part, closed));
  }
  report_.gap.held_out_by.push_back(by);
  report_.gap.foretold.push_back(held);
}

Gap GapReporter::run() {
  const Spread spread = spreadOf(found_.measured, found_.taxels, found_.left);
  const double to_error =
      spread.square > 0 ? squareOf(found_.fit.project(found_.common.all)) * spread.local / spread.square : 0;
  const bool in_common = found_.decision.verdict != Verdict::kNone;
  if (in_common) report_.where = placeOf(found_.measured, found_.left, spread);
  const Eigen::MatrixXd mask = maskOf(found_.measured, report_.where, spread);
  GapExtras extras;
  for (const Detection& detection : found_.detections) {
    extras.before_more += detection.before_more;
    extras.after_less += detection.after_less;
  }
  extras.before_more += found_.static_square;
  const double explainable = in_common ? std::min(1.0, explainedShare() * to_error) : 0;
  if (!found_.by_terms && in_common) confine(mask.maxCoeff());
  const GapGround ground{found_.measured, found_.fit, found_.taxels, mask, explainable, extras, found_.seed};
  of_traces_ = measureGap(ground, found_.left, allCycles(found_.measured));
  report_.gap.held_out_by = of_traces_.held_out_by;
  holdOut("condition", surfacesWhereItShows(), ground,
          "The discrepancy is visible on one surface only, so no surface was held out.");
  holdOut("protocol", partsByProtocol(found_.measured), ground,
          "All cycles have the same protocol, so no protocol was held out.");
  if (report_.gap.held_out_by.size() < 2)
    report_.gap.missing.push_back(
        "Held-out cycles alone are weak evidence for other surfaces and protocols.");
  const Trace before = found_.fit.residual(found_.common.all);
  report_.curves = residualCurves(found_.measured, before, before - found_.left);
  return of_traces_;
}

}  // namespace

Gap reportGap(const Found& found, DiscrepancyReport& report) {
  return GapReporter(found, report).run();
}

}  // namespace fsr::discrepancy
