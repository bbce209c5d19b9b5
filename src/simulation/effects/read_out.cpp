#include <algorithm>
#include <cmath>
#include <numeric>

#include "fsr_pressure_map/settings/input_error.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

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

namespace {

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
  return {info, makeEffect<Crosstalk>};
}

// The voltage that drives the matrix falls when much of the sheet is loaded.
//
//     G_i = G_i (1 - r sum_k G_k)   [S]
//
// r: internal resistance of the supply that drives the matrix [ohm]. The reference of the converter stays
// constant.
// Size: less than 1 %; 0.3 ohm and 70 taxels of 0.2 mS make 0.4 % (estimate).

namespace {

class SupplyDroop : public Effect {
 public:
  SupplyDroop(const EffectValues& values, const EffectContext&) : resistance_(values.at("resistance")) {}

  void apply(const RigSample&, TaxelSignals& signals) override {
    auto& conductance = signals.conductance;
    const double total = std::accumulate(conductance.begin(), conductance.end(), 0.0);
    const double left = std::max(0.0, 1 - resistance_ * total);
    for (double& value : conductance) value *= left;
  }

 private:
  double resistance_;  // [ohm]
};

}  // namespace

EffectEntry supplyDroop() {
  EffectInfo info;
  info.id = "supply_droop";
  info.summary = "the driving voltage sinks with the total load";
  info.equation = "G_i *= 1 - r sum_k G_k";
  info.source = "estimate, below 1 %";
  info.stage = ChainStage::kReadOut;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kAdditive;
  info.parameters = {strength("resistance", "r", {0, 1000, "ohm"}, 0.3).within(0.05, 5)};
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kTotalLoad};
  info.needs = {Evidence::kUnevenLoad};
  info.collinear = {"static_curve", "crosstalk"};
  info.experiment = Experiment::kUnevenLoad;
  return {info, makeEffect<SupplyDroop>};
}

// Zero-potential read-out and analogue-to-digital converter: counts are proportional to the conductance.
//
//     y = full_scale V / V_ref,  V = V_ref R_f G   [counts]
//
// The reference of the converter also drives the matrix, so that V_ref cancels. After all effects of the
// reading the chain rounds y to whole counts and clips it to 0 .. full_scale. One count of 12 bits is 0.024
// % of full scale. Circuit: Fig. 2 of Ahmadizadeh and Menon 2019.

namespace {

class Converter : public Effect {
 public:
  Converter(const EffectValues& values, const EffectContext&)
      : counts_per_siemens_(values.at("full_scale") * values.at("feedback_resistance")),
        offset_(values.at("offset")) {
    if (values.at("full_scale") != std::floor(values.at("full_scale"))) {
      throw settings::InputError("effects.converter: full_scale must be a whole number of counts, e.g. 4095");
    }
  }

  void apply(const RigSample&, TaxelSignals& signals) override {
    for (std::size_t i = 0; i < signals.reading.size(); ++i) {
      signals.reading[i] = counts_per_siemens_ * signals.conductance[i] + offset_;
    }
  }

 private:
  double counts_per_siemens_;
  double offset_;  // [counts]
};

}  // namespace

EffectEntry converter() {
  EffectInfo info;
  info.id = "converter";
  info.summary = "conductance to counts; rounding and clipping at the end of the chain";
  info.equation = "y = full_scale R_f G + offset";
  info.source = "zero-potential circuit of the paper's Fig. 2";
  info.stage = ChainStage::kSample;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kBase;
  info.required = true;
  info.parameters = {
      shape("full_scale", "largest count", {1, 65535, "counts"}, 4095),
      shape("feedback_resistance", "R_f", {1, 1e9, "ohm"}, 3600),
      strength("offset", "reading at no conductance", {0, 65535, "counts"}, 0).within(0, 500),
  };
  return {info, makeEffect<Converter>};
}

// The amplifier reaches its voltage limit below the full scale of the converter.
//
//     y = y / (1 + (y / y_s)^q)^(1 / q)   [counts],   q infinite: y = min(y, y_s)
//
// This is a smooth limit at y_s; a larger q makes it sharper. Clipping at the full scale of the converter
// always acts and is not an effect.

namespace {

class Saturation : public Effect {
 public:
  Saturation(const EffectValues& values, const EffectContext&)
      : level_(values.at("level")), sharpness_(values.at("sharpness")) {}

  void apply(const RigSample&, TaxelSignals& signals) override {
    for (double& reading : signals.reading) {
      if (std::isinf(sharpness_)) {
        reading = std::min(reading, level_);
      } else if (reading > 0) {
        reading /= std::pow(1 + std::pow(reading / level_, sharpness_), 1 / sharpness_);
      }
    }
  }

 private:
  double level_;  // [counts]
  double sharpness_;
};

}  // namespace

EffectEntry saturation() {
  EffectInfo info;
  info.id = "saturation";
  info.summary = "the amplifier limits high readings";
  info.equation = "y = y / (1 + (y / y_s)^q)^(1 / q)";
  info.source = "form: any smooth limit; level of the circuit";
  info.stage = ChainStage::kReading;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kDetector;
  info.parameters = {
      strength("level", "y_s, .inf = none", {1, INFINITY, "counts"}, 2500)
          .offAt(INFINITY)
          .within(100, 65535)
          .inBaseFit(8),
      shape("sharpness", "q, .inf = hard", {1, INFINITY, ""}, 8).trying({4, 8, INFINITY}).inBaseFit(9),
  };
  info.depends_on = {Covariate::kCode, Covariate::kPressure};
  info.collinear = {"static_curve", "trapped_gas"};
  info.detector = Detector::kSaturation;
  return {info, makeEffect<Saturation>};
}

}  // namespace fsr::simulation
