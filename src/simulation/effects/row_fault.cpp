// The wire of a row has a bad contact. All its taxels lose conductance together, in bursts.
//
//     G_i = G_i (1 - depth) in a burst, for all taxels i of the row
//
// Causes: a crimped connector, a cracked tail. The form of a burst is an assumption.

#include "simulation/effects/effect_library.h"
#include "simulation/effects/faults.h"

namespace fsr::simulation {

namespace {

EffectInfo rowFaultInfo() {
  EffectInfo info;
  info.id = "row_fault";
  info.summary = "a row loses contact in bursts";
  info.equation = "G_i *= 1 - depth in a burst, i in the row";
  info.source = "fault";
  info.stage = ChainStage::kReadOut;
  info.level = EffectLevel::kRow;
  info.kind = EffectKind::kDetector;
  info.parameters = looseLineParameters("row");
  info.depends_on = {Covariate::kRow, Covariate::kClockTime};
  info.collinear = {"column_fault"};
  info.by_chance = true;
  info.detector = Detector::kRowFaults;
  return info;
}

class RowFault : public Effect {
 public:
  RowFault(const EffectValues& values, const EffectContext& context)
      : size_(context.layout.size), line_("row_fault", size_.rows, values, context) {}

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    const double contact = line_.contact(sample.time);
    const std::size_t columns = size_.columns;
    for (std::size_t column = 0; column < columns; ++column) {
      signals.conductance[line_.line() * columns + column] *= contact;
    }
  }

 private:
  matrix::MatrixSize size_;
  LooseLine line_;
};

}  // namespace

EffectEntry rowFault() {
  return {rowFaultInfo(), makeEffect<RowFault>};
}

}  // namespace fsr::simulation
