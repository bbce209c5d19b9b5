// The reading changes slowly with clock time, with and without load.
//
//     y = y + (r y + z) h(t),   h = tau (1 - exp(-t / tau))   [hours]
//
// r: share of the reading an hour; z: counts an hour. With an infinite tau the drift never ends. It is
// common to all taxels or scatters from taxel to taxel.
// Size: 1 to 5 % an hour, an estimate from amplifiers and ageing contacts. What data sheets call drift under
// load is `creep`.

#include <cmath>

#include "simulation/effects/effect_library.h"
#include "simulation/effects/taxel_scatter.h"

namespace fsr::simulation {

namespace {

constexpr double kHour = 3600;  // [s]

EffectInfo info() {
  EffectInfo info;
  info.id = "drift";
  info.summary = "slow change with clock time, whatever the load";
  info.equation = "y += (r y + z) h(t), h = tau (1 - exp(-t / tau))";
  info.source = "estimate, 1 to 5 % an hour";
  info.stage = ChainStage::kReading;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("rate_per_hour", "r, share of the reading", {-1, 1, "1/h"}, 0.02).within(-0.15, 0.15),
      strength("zero_per_hour", "z", {-10000, 10000, "counts/h"}, 0).within(-600, 600),
      shape("time_constant", "tau, .inf = it never ends", {1, INFINITY, "s"}, INFINITY)
          .trying({600, 3600, INFINITY}),
      scatter("scatter", "deviation from taxel to taxel, relative", {0, 2, ""}, 0),
  };
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kClockTime};
  info.needs = {Evidence::kThermometer, Evidence::kUnevenPace};
  info.collinear = {"temperature", "wear",         "break_in",   "creep",
                    "seal_leak",   "mains_pickup", "relaxation", "session_offset"};
  info.experiment = Experiment::kRest;
  info.slow = true;
  info.any_course = true;
  return info;
}

class Drift : public Effect {
 public:
  Drift(const EffectValues& values, const EffectContext& context)
      : time_constant_(values.at("time_constant")),
        zero_(values.at("zero_per_hour")),
        rate_(scatteredValues(values.at("rate_per_hour"), values.at("scatter"), "drift", context)) {
    state_.assign(1, 0.0);  // t [s]
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    state_[0] += sample.elapsed;
    const double hours = effectiveTime(state_[0]) / kHour;
    for (std::size_t i = 0; i < rate_.size(); ++i) {
      signals.reading[i] += (rate_[i] * signals.reading[i] + zero_) * hours;
    }
  }

 private:
  double effectiveTime(double time) const {
    return std::isinf(time_constant_) ? time : -time_constant_ * std::expm1(-time / time_constant_);
  }

  double time_constant_;      // [s]
  double zero_;               // [counts/h]
  std::vector<double> rate_;  // [taxels], 1/h
};

}  // namespace

EffectEntry drift() {
  return {info(), makeEffect<Drift>};
}

}  // namespace fsr::simulation
