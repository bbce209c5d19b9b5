#include "discrepancy/decide/detections.h"

#include <algorithm>
#include <cmath>

#include "discrepancy/decide/changes.h"
#include "discrepancy/fit/base_fit.h"
#include "discrepancy/thresholds.h"
#include "simulation/effects/effect_library.h"
#include "statistics/random_stream.h"

namespace fsr::discrepancy {

namespace {

constexpr double kFaultZ = 99;  // the result of this detector counts as certain
constexpr double kMisfitBeside =
    0.08;  // of the readings' squared error, where time courses were found, which bend the curves
constexpr double kByCode = 0.4;        // share of a misfit that one function of the reading explains
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

}  // namespace

Detection detectionOf(const Fault& fault, const FaultyReadings& readings, double square) {
  Detection detection = plain(fault.detector, zOf(fault.p));
  detection.enable = {asEffect(fault)};
  detection.where.taxels = fault.taxels;
  detection.where.conditions = readings.conditions;
  detection.where.pressure = readings.pressure;
  detection.where.times = fault.times;
  detection.before_more = readings.held_out_readings > 0 ? readings.held_out / readings.held_out_readings : 0;
  static_cast<void>(square);
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

Detection saturationOf(const StaticMisfit& misfit, const Measured& measured, const StaticFit& fit,
                       const simulation::SimulationSettings& base) {
  Detection detection = plain(simulation::Detector::kSaturation, kFaultZ);
  simulation::EnabledEffect effect = usualValues(detection.effect.id);
  const double highest = fit.curve().maxCoeff();
  effect.values["level"] = 1.1 * highest * measured.full_scale;
  effect.values["sharpness"] = 4;
  const simulation::SimulationSettings fitted = fitBase(measured, fit, withEffect(base, effect));
  detection.enable = {*fitted.effect(effect.id)};
  tellParameters(detection, {"level", "sharpness"});
  detection.where.pressure = {INFINITY, 0};
  for (std::size_t i = 0; i < measured.samples(); ++i) {
    if (fit.curve()[static_cast<Eigen::Index>(i)] < kHighReadings * highest) continue;
    detection.where.pressure.low = std::min(detection.where.pressure.low, measured.pressure[i]);
    detection.where.pressure.high = std::max(detection.where.pressure.high, measured.pressure[i]);
  }
  detection.before_more = misfit.rms * misfit.rms;
  return detection;
}

bool isMisfit(const StaticMisfit& misfit, bool something_else_found) {
  return misfit.share >= (something_else_found ? kMisfitBeside : thresholds::kLeastShareOfError);
}

bool isSaturation(const StaticMisfit& misfit, const Measured& measured) {
  return misfit.by_code >= kByCode && misfit.conditions.size() + 1 >= measured.classes.size();
}

}  // namespace fsr::discrepancy
