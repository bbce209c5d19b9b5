#include "discrepancy/decide/findings.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/decide/refine.h"
#include "discrepancy/fit/base_fit.h"
#include "discrepancy/thresholds.h"
#include "simulation/effects/effect_library.h"

namespace fsr::discrepancy {

namespace {

constexpr double kFaultZ = 99;  // a detector does not doubt
constexpr double kMisfitBeside =
    0.08;  // of the readings' squared error, where time courses were found that bend the curves
constexpr double kByCode = 0.4;        // share of a misfit that one function of the reading explains
constexpr double kHighReadings = 0.6;  // of the highest: where a saturation shows

Finding plain(simulation::Detector detector, double z) {
  Finding finding;
  const simulation::EffectInfo& info = simulation::foundBy(detector);
  finding.effect.id = info.id;
  finding.effect.summary = info.summary;
  finding.effect.z = z;
  finding.effect.share_of_ceiling = 1;
  for (const simulation::Covariate c : info.depends_on) finding.depends_on.push_back(simulation::name(c));
  return finding;
}

void tellParameters(Finding& finding, const std::vector<std::string>& names) {
  const simulation::EnabledEffect& effect = finding.enable.front();
  for (const std::string& one : names) {
    const double value = effect.values.at(one);
    const std::string unit =
        simulation::parameter(simulation::findEffect(effect.id)->info, one).permitted.unit;
    finding.effect.parameters.push_back({one, value, unit, {NAN, NAN}});
  }
}

simulation::EnabledEffect usualValues(const std::string& id) {
  simulation::EnabledEffect effect{id, {}};
  for (const simulation::EffectParameter& parameter : simulation::findEffect(id)->info.parameters) {
    effect.values[parameter.name] = parameter.usual;
  }
  return effect;
}

}  // namespace

Finding findingOf(const Fault& fault, const FaultyReadings& readings, double square) {
  Finding finding = plain(fault.detector, kFaultZ);
  finding.enable = {asEffect(fault)};
  finding.where.taxels = fault.taxels;
  finding.where.conditions = readings.conditions;
  finding.where.pressure = readings.pressure;
  finding.where.times = fault.times;
  finding.before_more = readings.readings_shown > 0 ? readings.shown / readings.readings_shown : 0;
  static_cast<void>(square);
  return finding;
}

Finding findingOf(const Mains& mains, double square, const Measured& measured) {
  Finding finding = plain(simulation::Detector::kMains, mains.z);
  finding.enable = {asEffect(mains, measured.full_scale)};
  tellParameters(finding, {"amplitude", "frequency", "taxel_time"});
  finding.where.pressure = {0, *std::max_element(measured.pressure.begin(), measured.pressure.end())};
  finding.after_less = mains.share * square;
  return finding;
}

Finding findingOf(const Repositioning& repositioning, double square) {
  Finding finding = plain(simulation::Detector::kMounts, repositioning.z);
  finding.enable = {usualValues(finding.effect.id)};
  finding.enable.front().values["offset"] = repositioning.offset;
  finding.enable.front().values["gain"] = std::min(0.5, repositioning.gain);
  tellParameters(finding, {"offset", "gain"});
  finding.where = repositioning.where;
  finding.before_more = repositioning.share * square;
  return finding;
}

Finding saturationOf(const StaticMisfit& misfit, const Measured& measured, const StaticFit& fit,
                     const simulation::SimulationSettings& base) {
  Finding finding = plain(simulation::Detector::kSaturation, kFaultZ);
  simulation::EnabledEffect effect = usualValues(finding.effect.id);
  const double highest = fit.curve().maxCoeff();
  effect.values["level"] = 1.1 * highest * measured.full_scale;
  effect.values["sharpness"] = 4;
  const simulation::SimulationSettings fitted = fitBase(measured, fit, withEffect(base, effect));
  finding.enable = {*fitted.effect(effect.id)};
  tellParameters(finding, {"level", "sharpness"});
  finding.where.pressure = {INFINITY, 0};
  for (std::size_t i = 0; i < measured.moments(); ++i) {
    if (fit.curve()[static_cast<Eigen::Index>(i)] < kHighReadings * highest) continue;
    finding.where.pressure.low = std::min(finding.where.pressure.low, measured.pressure[i]);
    finding.where.pressure.high = std::max(finding.where.pressure.high, measured.pressure[i]);
  }
  finding.before_more = misfit.rms * misfit.rms;
  return finding;
}

bool isMisfit(const StaticMisfit& misfit, bool something_else_found) {
  return misfit.share >= (something_else_found ? kMisfitBeside : thresholds::kLeastShareOfError);
}

bool isSaturation(const StaticMisfit& misfit, const Measured& measured) {
  return misfit.by_code >= kByCode && misfit.conditions.size() + 1 >= measured.classes.size();
}

}  // namespace fsr::discrepancy
