#include <cmath>

#include "simulation/effects/effect_library.h"
#include "simulation/effects/taxel_scatter.h"
#include "statistics/random_stream.h"

namespace fsr::simulation {

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

namespace {

constexpr double kHour = 3600;  // [s]

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
  return {info, makeEffect<Drift>};
}

// Each taxel has another zero in each session.
//
//     y = y + o N_is   [counts]
//
// N_is: a standard normal number, drawn for each taxel i and session s. A session begins with the first scan,
// and with the first scan after an interruption of at least `pause`, when the board was switched off and on
// again. In `simulate` each bag is a session of its own if its station rests for as long as that before it;
// the parts of a split bag belong to one session. The sheet need not be mounted again; the effect of a new
// mount is `repositioning`.
// Causes: amplifiers and references that settle at another level, a tare at the start of the session.
// Size: estimate, 0.2 % of the full scale of 12 bits.

namespace {

class SessionOffset : public Effect {
 public:
  SessionOffset(const EffectValues& values, const EffectContext& context)
      : seed_(context.seed),
        deviation_(values.at("offset")),
        pause_(values.at("pause")),
        offset_(context.layout.size.taxels(), 0.0) {
    state_.assign(1, 0.0);  // number of the session, from 1; 0 = no scan yet
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    if (sample.first || (sample.elapsed > 0 && sample.elapsed >= pause_)) ++state_[0];
    if (state_[0] != drawn_) draw();
    for (std::size_t i = 0; i < offset_.size(); ++i) signals.reading[i] += offset_[i];
  }

 private:
  void draw() {
    drawn_ = state_[0];
    const auto stream = statistics::randomStream(seed_, "session_offset", static_cast<std::uint64_t>(drawn_));
    for (std::size_t i = 0; i < offset_.size(); ++i) offset_[i] = deviation_ * stream.normal(i);
  }

  std::uint64_t seed_;
  double deviation_;            // [counts]
  double pause_;                // [s]
  std::vector<double> offset_;  // [taxels], in the session `drawn_` [counts]
  double drawn_ = 0;            // number of the session that offset_ belongs to
};

}  // namespace

EffectEntry sessionOffset() {
  EffectInfo info;
  info.id = "session_offset";
  info.summary = "each taxel has another zero in each session";
  info.equation = "y += o N_is, drawn for each taxel i and session s";
  info.source = "estimate, 0.2 % of the full scale of 12 bits";
  info.stage = ChainStage::kReading;
  info.level = EffectLevel::kSession;
  info.kind = EffectKind::kDetector;
  info.parameters = {
      scatter("offset", "o, deviation of the zero between taxels and sessions", {0, 10000, "counts"}, 8)
          .within(0.5, 400),
      shape("pause", "interruption of the scans after which a new session begins", {0, 1e7, "s"}, 10),
  };
  info.depends_on = {Covariate::kSession, Covariate::kTaxel};
  info.needs = {Evidence::kTwoSessions};
  info.collinear = {"repositioning", "drift"};
  info.experiment = Experiment::kNewSession;
  info.looked_for = false;
  return {info, makeEffect<SessionOffset>};
}

}  // namespace fsr::simulation
