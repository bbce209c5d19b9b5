// The readings of the first cycles after mounting differ until the sheet has settled.
//
//     g = g (1 + a exp(-N / N_0)),   N = W / (2 P_span),   W = sum |dP| since it was mounted
//
// W is the path length of the pressure [Pa]. N is the number of cycles computed from it, so that a partial
// cycle counts in part. Makers ask for conditioning for this reason: the manual of FlexiForce (rev. G) wants
// 110 % of the load four or five times before use.
// Size: a few per cent, which fade within 3 to 10 cycles (estimate). The sign is free.

#include <cmath>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

EffectInfo breakInInfo() {
  EffectInfo info;
  info.id = "break_in";
  info.summary = "the first cycles after mounting differ";
  info.equation = "g *= 1 + a exp(-N / N_0), N cycles since mounting";
  info.source = "FlexiForce manual: condition four or five times; size estimated";
  info.stage = ChainStage::kGain;
  info.level = EffectLevel::kMount;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("change", "a, at the start", {-0.5, 0.5, ""}, -0.04).within(-0.12, 0.12),
      shape("cycles", "N_0, that leave 37 % of it", {0.1, 1000, "cycles"}, 2).trying({1, 2, 4}),
      shape("span", "P_span, peak of a whole cycle", {1e3, 10e6, "Pa"}, 620e3),
  };
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kCycle, Covariate::kMount};
  info.needs = {Evidence::kMountLabels, Evidence::kRemounts};
  info.collinear = {"drift", "wear", "temperature"};
  info.experiment = Experiment::kRemount;
  info.slow = true;
  return info;
}

class BreakIn : public Effect {
 public:
  BreakIn(const EffectValues& values, const EffectContext&)
      : change_(values.at("change")), path_length_(values.at("cycles") * 2 * values.at("span")) {
    state_.assign(kState, 0.0);
  }

  void mount(const Mounting&) override { state_[kPathLength] = 0; }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    if (!sample.first) state_[kPathLength] += std::abs(sample.pressure - state_[kBefore]);
    state_[kBefore] = sample.pressure;
    const double factor = 1 + change_ * std::exp(-state_[kPathLength] / path_length_);
    for (double& gain : signals.gain) gain *= factor;
  }

 private:
  enum { kBefore, kPathLength, kState };  // chamber at the scan before, W [Pa]
  double change_;
  double path_length_;  // W that leaves 37 % [Pa]
};

}  // namespace

EffectEntry breakIn() {
  return {breakInInfo(), makeEffect<BreakIn>};
}

}  // namespace fsr::simulation
