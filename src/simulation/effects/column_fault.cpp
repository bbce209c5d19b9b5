// The wire of a column has a bad contact. All its taxels lose conductance together, in bursts.
//
//     G_i = G_i (1 - depth) in a burst, for all taxels i of the column
//
// Causes: a crimped connector, a cracked tail. The form of a burst is an assumption.

#include "simulation/effects/effect_library.h"
#include "simulation/effects/faults.h"

namespace fsr::simulation {

namespace {

EffectInfo columnFaultInfo() {
  EffectInfo info;
  info.id = "column_fault";
  info.summary = "a column loses contact in bursts";
  info.equation = "G_i *= 1 - depth in a burst, i in the column";
  info.source = "fault";
  info.stage = ChainStage::kReadOut;
  info.level = EffectLevel::kColumn;
  info.kind = EffectKind::kDetector;
  info.parameters = looseLineParameters("column");
  info.depends_on = {Covariate::kColumn, Covariate::kClockTime};
  info.collinear = {"row_fault"};
  info.by_chance = true;
  info.detector = Detector::kColumnFaults;
  return info;
}

class ColumnFault : public Effect {
 public:
  ColumnFault(const EffectValues& values, const EffectContext& context)
      : size_(context.layout.size), line_("column_fault", size_.columns, values, context) {}

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    const double contact = line_.contact(sample.time);
    for (std::size_t row = 0; row < size_.rows; ++row) {
      signals.conductance[row * size_.columns + line_.line()] *= contact;
    }
  }

 private:
  matrix::MatrixSize size_;
  LooseLine line_;
};

}  // namespace

EffectEntry columnFault() {
  return {columnFaultInfo(), makeEffect<ColumnFault>};
}

}  // namespace fsr::simulation
