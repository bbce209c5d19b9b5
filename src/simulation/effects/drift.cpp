// The reading changes slowly with clock time, with and without load.
//
//     y = y + (r y + z) h(t) + u(t) y + w(t)
//     h = tau (1 - exp(-t / tau))   [hours]
//     du = -u dt / tau + a dB_u,   dw = -w dt / tau + b dB_w,   u(0) = w(0) = 0
//
// r: share of the reading an hour; z: counts an hour. B: Brownian motions, by the seed. a, b: standard
// deviations of the step of a random walk in one hour. With an infinite tau the drift never ends, and the
// walk goes as far as it gets; else it is pulled back within tau (G. Uhlenbeck, L. Ornstein, Phys. Rev. 36
// (1930) 823). The drift is common to all taxels or scatters from taxel to taxel.
// Size: 1 to 5 % an hour, an estimate from amplifiers and ageing contacts. What data sheets call drift under
// load is `creep`.

#include <cmath>

#include "simulation/effects/effect_library.h"
#include "simulation/effects/taxel_scatter.h"
#include "statistics/random_stream.h"

namespace fsr::simulation {

namespace {

constexpr double kHour = 3600;  // [s]

EffectInfo driftInfo() {
  EffectInfo info;
  info.id = "drift";
  info.summary = "slow change with clock time, whatever the load";
  info.equation = "y += (r y + z) h(t) + u(t) y + w(t), h = tau (1 - exp(-t / tau)); u, w: random walks";
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
      scatter("rate_walk", "a, step of a random walk in one hour, share of the reading", {0, 1, "1/sqrt(h)"},
              0)
          .within(0, 0.15)
          .walking(Walk::kGain, "time_constant"),
      scatter("zero_walk", "b, the same of the zero", {0, 10000, "counts/sqrt(h)"}, 0)
          .within(0, 600)
          .walking(Walk::kZero, "time_constant"),
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
        rate_walk_(values.at("rate_walk")),
        zero_walk_(values.at("zero_walk")),
        rate_(scatteredValues(values.at("rate_per_hour"), values.at("scatter"), "drift", context)),
        share_(scatteredValues(1, values.at("scatter"), "drift", context)),
        stream_(statistics::randomStream(context.seed, "drift.walk")) {
    state_.assign(walks() ? kStates : 1, 0.0);
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    state_[kTime] += sample.elapsed;
    const double hours = effectiveTime(state_[kTime]) / kHour;
    if (walks()) walk(sample.elapsed, signals);
    for (std::size_t i = 0; i < rate_.size(); ++i) {
      signals.reading[i] += (rate_[i] * signals.reading[i] + zero_) * hours;
    }
  }

 private:
  enum { kTime, kScans, kRate, kZero, kStates };  // [s], number, share of the reading, [counts]

  double effectiveTime(double time) const {
    return std::isinf(time_constant_) ? time : -time_constant_ * std::expm1(-time / time_constant_);
  }

  bool walks() const { return rate_walk_ > 0 || zero_walk_ > 0; }

  // The exact step of the walks over some seconds.
  void walk(double seconds, TaxelSignals& signals) {
    const bool endless = std::isinf(time_constant_);
    const double keep = endless ? 1 : std::exp(-seconds / time_constant_);
    const double variance =
        endless ? seconds : -time_constant_ / 2 * std::expm1(-2 * seconds / time_constant_);
    const double spread = std::sqrt(variance / kHour);
    const auto scan = static_cast<std::uint64_t>(state_[kScans]++);
    state_[kRate] = keep * state_[kRate] + rate_walk_ * spread * stream_.normal(2 * scan);
    state_[kZero] = keep * state_[kZero] + zero_walk_ * spread * stream_.normal(2 * scan + 1);
    for (std::size_t i = 0; i < share_.size(); ++i)
      signals.reading[i] += share_[i] * (state_[kRate] * signals.reading[i] + state_[kZero]);
  }

  double time_constant_;       // [s]
  double zero_;                // [counts/h]
  double rate_walk_;           // [1/sqrt(h)]
  double zero_walk_;           // [counts/sqrt(h)]
  std::vector<double> rate_;   // [taxels], 1/h
  std::vector<double> share_;  // [taxels], of the walks
  statistics::RandomStream stream_;
};

}  // namespace

EffectEntry drift() {
  return {driftInfo(), makeEffect<Drift>};
}

}  // namespace fsr::simulation
