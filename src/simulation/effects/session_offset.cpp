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

#include "simulation/effects/effect_library.h"
#include "statistics/random_stream.h"

namespace fsr::simulation {

namespace {

EffectInfo sessionOffsetInfo() {
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
  return info;
}

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
  return {sessionOffsetInfo(), makeEffect<SessionOffset>};
}

}  // namespace fsr::simulation
