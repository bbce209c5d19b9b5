// A taxel has no contact.
//
//     G_i = 0 from a start time on
//
// Causes: a cracked trace, a detached layer.

#include "simulation/effects/effect_library.h"
#include "simulation/effects/faults.h"

namespace fsr::simulation {

namespace {

EffectInfo deadTaxelInfo() {
  EffectInfo info;
  info.id = "dead_taxel";
  info.summary = "a taxel that conducts nothing";
  info.equation = "G_i = 0";
  info.source = "fault";
  info.stage = ChainStage::kConductance;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kDetector;
  info.parameters = faultyTaxelParameters();
  info.depends_on = {Covariate::kTaxel};
  info.collinear = {"stuck_taxel"};
  info.detector = Detector::kDeadTaxels;
  return info;
}

class DeadTaxel : public Effect {
 public:
  DeadTaxel(const EffectValues& values, const EffectContext& context)
      : start_(values.at("start")), dead_(faultyTaxels("dead_taxel", values, context)) {}

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    if (sample.time < start_) return;
    for (const std::size_t taxel : dead_) signals.conductance[taxel] = 0;
  }

 private:
  double start_;  // [s]
  std::vector<std::size_t> dead_;
};

}  // namespace

EffectEntry deadTaxel() {
  return {deadTaxelInfo(), makeEffect<DeadTaxel>};
}

}  // namespace fsr::simulation
