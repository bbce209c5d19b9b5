// The reading is higher on the way down than on the way up, at any speed.
//
//     u = P_e - h sum_i w_i (P_e - play_{r_i}(P_e)),   r_i = R i / n,  w_i = 1 / n,  i = 1 .. n = 6
//
// A Prandtl-Ishlinskii operator with h of its weight spread over the plays and 1 - h without memory.
// Once every play has turned round, the branches lie 2 h sum_i w_i r_i apart [Pa]: this is set as a share
// `loop_width` of the `span`. Size: Tangio TPE-500 5 %, Interlink FSR 400 10 %, FlexiForce A201 < 4.5 %
// of full scale (data sheets; FlexiForce's from memory, not verified). Source of the operator: M. Brokate,
// J. Sprekels, Hysteresis and Phase Transitions, Springer 1996.

#include <sstream>

#include "fsr_pressure_map/rheology/play_operator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/simulation/effects/effect_library.h"

namespace fsr {

namespace {

constexpr int kPlays = 6;

EffectInfo info() {
  EffectInfo info;
  info.id = "hysteresis";
  info.summary = "loading against unloading, whatever the rate";
  info.equation = "u = P_e - h sum_i w_i (P_e - play_{r_i}(P_e))";
  info.source = "Prandtl-Ishlinskii; Tangio TPE-500 5 % FS, Interlink FSR 400 10 % FS";
  info.stage = ChainStage::kMemory;
  info.level = EffectLevel::kRig;
  info.parameters = {
      {"loop_width", "distance of the branches of a wide loop, share of the span", {0, 0.5, ""}, 0.05, 0},
      {"span", "pressure that loop_width is a share of", {1e3, 10e6, "Pa"}, 620e3},
      {"reach", "R, half the way after a turn over which the loop opens", {100, 10e6, "Pa"}, 150e3},
  };
  return info;
}

PrandtlIshlinskii plays(double reach) {
  std::vector<double> radii;
  for (int i = 1; i <= kPlays; ++i) radii.push_back(reach * i / kPlays);
  return {radii, std::vector<double>(kPlays, 1.0 / kPlays)};
}

class Hysteresis : public Effect {
 public:
  Hysteresis(const EffectValues& values, const EffectContext& context)
      : plays_(plays(values.at("reach"))),
        share_(values.at("loop_width") * values.at("span") / plays_.fullLoopWidth()) {
    // With more than all of its weight on the plays, the load would fall while the pressure rises.
    if (share_ > 1) {
      std::ostringstream sentence;
      sentence << "effects.hysteresis: loop_width is " << values.at("loop_width") << ", but must be at most "
               << plays_.fullLoopWidth() / values.at("span") << " with this span and reach";
      throw InputError(sentence.str());
    }
    state_.assign(context.layout.size.taxels() * plays_.stateSize(), 0.0);
  }

  void apply(const RigMoment&, TaxelSignals& signals) override {
    double* state = state_.data();
    for (double& load : signals.load) {
      load -= share_ * (load - plays_.step(load, state));
      state += plays_.stateSize();
    }
  }

 private:
  PrandtlIshlinskii plays_;
  double share_;  // h
};

}  // namespace

EffectEntry hysteresis() {
  return {info(), makeEffect<Hysteresis>};
}

}  // namespace fsr
