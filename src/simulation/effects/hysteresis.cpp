// At equal pressure the reading is higher during unloading than during loading, at any speed.
//
//     u = P_e - (1 - v) b,   g = g (1 - v b / P_span),   b = h sum_i w_i (P_e - play_{r_i}(P_e + s r_i)),
//     r_i = R i / n,  w_i = 1 / n,  i = 1 .. n = 6
//
// This is a Prandtl-Ishlinskii operator. The share h of its weight is spread over play operators, and 1 - h
// has no memory. Once all plays have reversed, the branches are 2 h sum_i w_i r_i apart [Pa]. The parameter
// `loop_width` gives this distance as a share of `span`. Loops of FSRs are not symmetric. With s = 1 the
// slack of each play lies above the input: a first loading follows the static curve, and only unloading
// departs from it. With s = 0 both branches depart alike. v: share of the effect that changes the
// sensitivity instead of the load, as friction does.
// Size: 5 % (Tangio TPE-500 data sheet v1.8, 2018, 1 kg), 10 % of the reading (Interlink FSR 400 data sheet
// PDS-10004-C), < 4.5 % of full scale (FlexiForce A201, from memory, not verified).
// Source of the operator: M. Brokate, J. Sprekels, Hysteresis and Phase Transitions, Springer 1996.

#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "rheology/play_operator.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

constexpr int kPlays = 6;

EffectInfo info() {
  EffectInfo info;
  info.id = "hysteresis";
  info.summary = "loading against unloading, whatever the rate";
  info.equation = "u = P_e - h sum_i w_i (P_e - play_{r_i}(P_e + s r_i))";
  info.source = "Prandtl-Ishlinskii; Tangio TPE-500 5 %, Interlink FSR 400 10 %";
  info.stage = ChainStage::kMemory;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("loop_width", "distance of the branches of a wide loop, share of the span", {0, 0.5, ""}, 0.05)
          .within(0.005, 0.2),
      shape("span", "pressure that loop_width is a share of", {1e3, 10e6, "Pa"}, 620e3),
      shape("reach", "R, half the way after a turn over which the loop opens", {100, 10e6, "Pa"}, 150e3)
          .trying({50e3, 100e3, 150e3, 250e3}),
      shape("one_sided", "s, 0 = both branches depart alike, 1 = only unloading", {0, 1, ""}, 0)
          .trying({0, 1}),
      shape("gain_share", "v, 0 = acts like load, 1 = on the sensitivity", {0, 1, ""}, 0).trying({0, 1}),
  };
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kDirection, Covariate::kPressure, Covariate::kPreviousExtremes};
  info.needs = {Evidence::kTwoRampRates};
  info.collinear = {"creep", "time_skew", "seal_leak", "relaxation"};
  info.experiment = Experiment::kTwoRampRates;
  info.mixture = true;
  return info;
}

class Hysteresis : public Effect {
 public:
  Hysteresis(const EffectValues& values, const EffectContext& context) {
    double mean_radius = 0;  // [Pa]
    for (int i = 1; i <= kPlays; ++i) {
      radii_.push_back(values.at("reach") * i / kPlays);
      shifts_.push_back(values.at("one_sided") * radii_.back());
      mean_radius += radii_.back() / kPlays;
    }
    const double widest = 2 * mean_radius / values.at("span");
    weight_ = values.at("loop_width") / widest / kPlays;
    load_share_ = 1 - values.at("gain_share");
    gain_share_ = values.at("gain_share") / values.at("span");
    // With more than all of its weight on the plays, the load would fall while the pressure rises.
    if (load_share_ * values.at("loop_width") > widest) {
      std::ostringstream sentence;
      sentence << "effects.hysteresis: loop_width is " << values.at("loop_width") << ", but must be at most "
               << widest << " with this span and reach";
      throw settings::InputError(sentence.str());
    }
    state_.assign(context.layout.size.taxels() * kPlays, 0.0);
  }

  void apply(const RigSample&, TaxelSignals& signals) override {
    double* play = state_.data();
    for (std::size_t taxel = 0; taxel < signals.load.size(); ++taxel) {
      const double load = signals.load[taxel];
      double behind = 0;
      for (int i = 0; i < kPlays; ++i, ++play) {
        *play = rheology::playStep(load + shifts_[i], radii_[i], *play);
        behind += load - *play;
      }
      signals.load[taxel] -= load_share_ * weight_ * behind;
      signals.gain[taxel] *= 1 - gain_share_ * weight_ * behind;
    }
  }

 private:
  std::vector<double> radii_;   // [plays], Pa
  std::vector<double> shifts_;  // [plays], Pa
  double weight_ = 0;           // h w
  double load_share_ = 1;
  double gain_share_ = 0;  // [1/Pa]
};

}  // namespace

EffectEntry hysteresis() {
  return {info(), makeEffect<Hysteresis>};
}

}  // namespace fsr::simulation
