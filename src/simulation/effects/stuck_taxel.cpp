// A taxel always has the same reading.
//
//     y_i = const from a start time on   [counts]
//
// Causes: a short circuit, a crease, a converter that returns an old value. With `value` -1 the taxel keeps
// the reading that it had when the fault began.

#include "simulation/effects/effect_library.h"
#include "simulation/effects/faults.h"

namespace fsr::simulation {

namespace {

EffectInfo stuckTaxelInfo() {
  EffectInfo info;
  info.id = "stuck_taxel";
  info.summary = "a taxel that always reads the same";
  info.equation = "y_i = const";
  info.source = "fault";
  info.stage = ChainStage::kReading;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kDetector;
  info.parameters = faultyTaxelParameters();
  info.parameters.push_back(
      shape("value", "where it is stuck; -1 = where the fault found it", {-1, 65535, "counts"}, 1000));
  info.depends_on = {Covariate::kTaxel};
  info.collinear = {"dead_taxel"};
  info.detector = Detector::kStuckTaxels;
  return info;
}

class StuckTaxel : public Effect {
 public:
  StuckTaxel(const EffectValues& values, const EffectContext& context)
      : start_(values.at("start")),
        value_(values.at("value")),
        stuck_(faultyTaxels("stuck_taxel", values, context)) {
    state_.assign(1 + stuck_.size(), 0.0);  // whether the fault has begun, then the readings [counts]
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    if (sample.time < start_) return;
    for (std::size_t k = 0; k < stuck_.size(); ++k) {
      double& reading = signals.reading[stuck_[k]];
      if (state_[0] == 0) state_[k + 1] = value_ < 0 ? reading : value_;
      reading = state_[k + 1];
    }
    state_[0] = 1;
  }

 private:
  double start_;  // [s]
  double value_;  // [counts]
  std::vector<std::size_t> stuck_;
};

}  // namespace

EffectEntry stuckTaxel() {
  return {stuckTaxelInfo(), makeEffect<StuckTaxel>};
}

}  // namespace fsr::simulation
