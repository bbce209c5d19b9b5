// The wires of a row and of a column carry the currents of all their taxels. The voltage drop along them
// lowers the readings.
//
//     G_ij = G_ij / (1 + R_row sum_j G_ij + R_col sum_i G_ij)   [S]
//
// R_row, R_col: resistance of driver or multiplexer and trace [ohm]. The equation is of first order in R G.
// It is exact where a single line is loaded.
// Size: 5 ohm and ten taxels of 0.2 mS make 1 %. Screen-printed silver and analogue switches of 50 to 100
// ohm make 10 to 30 % ("Improving Accuracy in the Readout of Resistive Sensor Arrays"; its review: up to 30
// % in a 4 x 4 array). Under uniform pressure the static curve absorbs 99.9 % of it.

#include <algorithm>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

EffectInfo crosstalkInfo() {
  EffectInfo info;
  info.id = "crosstalk";
  info.summary = "loaded neighbours on the same wires lower a reading";
  info.equation = "G_ij /= 1 + R_row sum_j G_ij + R_col sum_i G_ij";
  info.source = "Ohm's law in the wires, first order; 5 to 100 ohm";
  info.stage = ChainStage::kReadOut;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kAdditive;
  info.parameters = {
      strength("row_resistance", "R_row", {0, 1e4, "ohm"}, 5).within(0.5, 150),
      strength("column_resistance", "R_col", {0, 1e4, "ohm"}, 5).within(0.5, 150),
  };
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kRow, Covariate::kColumn, Covariate::kTotalLoad};
  info.needs = {Evidence::kUnevenLoad};
  info.collinear = {"static_curve", "supply_droop"};
  info.experiment = Experiment::kUnevenLoad;
  return info;
}

class Crosstalk : public Effect {
 public:
  Crosstalk(const EffectValues& values, const EffectContext& context)
      : row_resistance_(values.at("row_resistance")),
        column_resistance_(values.at("column_resistance")),
        row_sum_(context.layout.size.rows),
        column_sum_(context.layout.size.columns) {}

  void apply(const RigSample&, TaxelSignals& signals) override {
    addUp(signals.conductance);
    double* conductance = signals.conductance.data();
    for (const double row : row_sum_) {
      for (const double column : column_sum_) {
        *conductance++ /= 1 + row_resistance_ * row + column_resistance_ * column;
      }
    }
  }

 private:
  void addUp(const std::vector<double>& conductance) {
    std::fill(column_sum_.begin(), column_sum_.end(), 0.0);
    const double* value = conductance.data();
    for (double& row : row_sum_) {
      row = 0;
      for (double& column : column_sum_) {
        row += *value;
        column += *value++;
      }
    }
  }

  double row_resistance_;           // [ohm]
  double column_resistance_;        // [ohm]
  std::vector<double> row_sum_;     // [rows], S
  std::vector<double> column_sum_;  // [columns], S
};

}  // namespace

EffectEntry crosstalk() {
  return {crosstalkInfo(), makeEffect<Crosstalk>};
}

}  // namespace fsr::simulation
