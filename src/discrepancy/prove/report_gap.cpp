#include "discrepancy/prove/report_gap.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/signatures.h"
#include "discrepancy/fit/static_fit.h"
#include "discrepancy/prove/gap.h"
#include "discrepancy/prove/wording.h"
#include "discrepancy/samples/views.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"
#include "simulation/sensor_chain.h"
#include "statistics/samples.h"

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
                found_.decision.bent_only)
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

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRamp = 17e3;     // speed of the ramps in the paper [Pa/s]
constexpr double kStance = 0.6;    // time with the foot on the ground, and time with it off the ground [s]
constexpr double kSteps = 10;      // by the last step the sheet has adapted to walking
constexpr double kStanding = 600;  // duration of standing [s]
constexpr double kOnto = 1;        // time from no load to standing [s]
constexpr double kLoaded = 0.1;    // share of the peak; errors below it do not count
constexpr double kBeyond = 1.3;    // curves are extrapolated linearly to this factor of the highest pressure
constexpr double kTellingSlope = 0.05;  // of the usual one: below it a reading tells nothing of the pressure
constexpr std::size_t kPoints = 500;    // points of a curve

// A course of pressure, and the part of it in which errors count.
struct Situation {
  const char* name;
  double peak;       // [Pa]
  double from, end;  // [s]
  double step;       // [s]
  simulation::PressureCourse pressure;
};

std::vector<Situation> situations(double highest) {
  const double up = highest / kRamp, half = highest / 2;
  const simulation::PressureCourse ramp = [=](double t) {
    const double phase = t < 0 ? 0 : std::fmod(t, 2 * up);
    return kRamp * std::min(phase, 2 * up - phase);
  };
  const simulation::PressureCourse steps = [=](double t) {
    const double phase = t < 0 ? 0 : std::fmod(t, 2 * kStance);
    return phase < kStance ? half * std::sin(kPi * phase / kStance) : 0;
  };
  const simulation::PressureCourse standing = [=](double t) {
    return half * std::clamp(t / kOnto, 0.0, 1.0);
  };
  return {{"ramp", highest, 2 * up, 4 * up, up / 100, ramp},
          {"stance", half, 2 * kStance * (kSteps - 1), 2 * kStance * (kSteps - 1) + kStance, 0.02, steps},
          {"standing", half, kOnto, kOnto + kStanding, 0.5, standing}};
}

matrix::Surface surfaceOf(const Measured& measured, std::size_t curvature_class) {
  matrix::Surface surface;
  for (const Visit& visit : measured.visits) {
    if (visit.curvature_class == curvature_class) surface = visit.surface;
  }
  surface.curvature.resize(1);
  surface.deviation.clear();
  return surface;
}

// The recordings as they were made, without the subtraction of effects.
Measured asRecorded(const Measured& measured) {
  Measured plain = measured;
  plain.load.clear();
  plain.gain.clear();
  plain.added.clear();
  return plain;
}

// Readings of a static curve at kPoints pressures from 0 to `highest`, never falling.
struct Curve {
  double highest = 0;  // [Pa]
  double usual = 0;    // slope from point to point
  std::vector<double> reading;

  double step() const { return highest / (kPoints - 1); }
  // Pressure at which the curve has this reading [Pa]. NaN beyond its ends: a map gives no pressure there.
  double pressureOf(double value) const {
    const auto above = std::upper_bound(reading.begin(), reading.end(), value);
    if (above == reading.begin() || above == reading.end()) return NAN;
    const double share = (value - *(above - 1)) / (*above - *(above - 1));
    return step() * (static_cast<double>(above - reading.begin() - 1) + share);
  }
  // Whether the curve is so flat at this pressure that its reading tells nothing.
  bool flatAt(double pressure) const {
    const auto at = std::min(kPoints - 2, static_cast<std::size_t>(std::max(0.0, pressure / step())));
    return reading[at + 1] - reading[at] < kTellingSlope * usual;
  }
};

// A sheet with the static curves that were fitted to it in the chamber.
class CalibratedSheet {
 public:
  CalibratedSheet(const Measured& measured, const simulation::SimulationSettings& settings)
      : measured_(asRecorded(measured)),
        settings_(representative(settings)),
        fit_(measured_, CurvePer::kClass, driven(measured_, settings).reading) {}

  // Error of the pressure that the sheet reads at each step of the situation [Pa]; NaN where it does not
  // count. `highest`: pressure that the class reached in the recordings [Pa].
  std::vector<double> errors(const Situation& situation, std::size_t curvature_class, double highest) const;

 private:
  Curve curveOf(std::size_t curvature_class, double highest) const;

  const Measured measured_;
  const simulation::SimulationSettings settings_;
  const StaticFit fit_;
};

Curve CalibratedSheet::curveOf(std::size_t curvature_class, double highest) const {
  std::size_t sample = 0;
  while (measured_.classOf(sample) != curvature_class) ++sample;
  Curve curve;
  curve.highest = kBeyond * highest;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const double reading = fit_.curveAt(sample, curve.step() * static_cast<double>(k));
    curve.reading.push_back(k == 0 ? reading : std::max(reading, curve.reading.back()));
  }
  std::vector<double> slopes;
  for (std::size_t k = 1; k < kPoints; ++k) slopes.push_back(curve.reading[k] - curve.reading[k - 1]);
  curve.usual = statistics::upperMedian(slopes);
  return curve;
}

std::vector<double> CalibratedSheet::errors(const Situation& situation, std::size_t curvature_class,
                                            double highest) const {
  simulation::SensorChain chain(settings_);
  chain.mount(surfaceOf(measured_, curvature_class));
  const double full_scale = settings_.fullScale();
  const Curve curve = curveOf(curvature_class, highest);
  std::vector<double> errors;
  simulation::RigSample now;
  now.course = &situation.pressure;
  for (now.time = 0; now.time <= situation.end; now.time += situation.step, ++now.scan) {
    now.pressure = situation.pressure(now.time);
    chain.read(now);
    const bool counts =
        now.time >= situation.from && now.pressure >= kLoaded * situation.peak && !curve.flatAt(now.pressure);
    errors.push_back(counts ? curve.pressureOf(chain.reading()[0] / full_scale) - now.pressure : NAN);
  }
  return errors;
}

// Largest difference where both count.
double largestApart(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double apart = std::abs(a[i] - b[i]);
    if (apart > largest) largest = apart;
  }
  return largest;
}

double highestOn(const Measured& measured, std::size_t curvature_class) {
  double highest = 0;
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (measured.classOf(i) == curvature_class) highest = std::max(highest, measured.pressure[i]);
  }
  return highest;
}

}  // namespace

std::vector<GapInUse> costsInUse(const Measured& measured, const simulation::SimulationSettings& without,
                                 const simulation::SimulationSettings& with, double closed) {
  const double left = std::sqrt(std::clamp(1 - closed, 0.0, 1.0));  // NaN if `closed` is not known
  const CalibratedSheet before(measured, with), neutral(measured, without);
  std::vector<GapInUse> costs;
  for (std::size_t c = 0; c < measured.classes.size(); ++c) {
    const double highest = highestOn(measured, c);
    const std::vector<Situation> all = situations(highest);
    costs.resize(all.size());
    for (std::size_t s = 0; s < all.size(); ++s) {
      const double apart =
          largestApart(before.errors(all[s], c, highest), neutral.errors(all[s], c, highest));
      costs[s].situation = all[s].name;
      costs[s].before = std::max(costs[s].before, apart);
    }
  }
  for (GapInUse& cost : costs) cost.after = left * cost.before;
  return costs;
}

}  // namespace fsr::discrepancy
