// At equal pressure the reading is higher during unloading than during loading, at any speed.
//
//     u = P_e - (1 - v) b,   g = g (1 - v b / P_span),   b = h sum_i w_i (P_e - play_{r_i}(P_e + s r_i)),
//     r_i = R i / n,  w_i = 1 / n,  i = 1 .. n = 6
//     or, by Rayleigh's law,  r_i = R (i - 1/2) / n,  n = 64
//
// This is a Prandtl-Ishlinskii operator. The share h of its weight is spread over play operators, and 1 - h
// has no memory. Once all plays have reversed, the branches are 2 h sum_i w_i r_i apart [Pa]. The parameter
// `loop_width` gives this distance as a share of `span`. Loops of FSRs are not symmetric. With s = 1 the
// slack of each play lies above the input: a first loading follows the static curve, and only unloading
// departs from it. With s = 0 both branches depart alike. v: share of the effect that changes the
// sensitivity instead of the load, as friction does.
//
// Six plays make loops of straight pieces. A cycle narrower than 2 R / 6 has no loop. With plays of every
// radius from 0 to R, each branch is a parabola until the load is 2 R away from the turning point:
//
//     du = (1 - h) dP + h / (4 R) dP |dP|   [Pa]
//
// This is Rayleigh's law with the initial permeability 1 - h and the Rayleigh constant h / (2 R). A cycle
// over D <= 2 R opens a loop of the width h / (8 R) D^2 [Pa] and the area h / (12 R) D^3 [Pa^2]. The sum over
// 64 radii approximates the parabola; full loops have exactly the width `loop_width`. With `rayleigh` between
// 0 and 1 both forms are added with the weights 1 - rayleigh and rayleigh.
// Size: 5 % (Tangio TPE-500 data sheet v1.8, 2018, 1 kg), 10 % of the reading (Interlink FSR 400 data sheet
// PDS-10004-C), < 4.5 % of full scale (FlexiForce A201, from memory, not verified).
// Source of the operator: M. Brokate, J. Sprekels, Hysteresis and Phase Transitions, Springer 1996.
// Source of the law: Lord Rayleigh, Phil. Mag. 23 (1887) 225-245. It is the simplest case of the play model:
// G. Moree, M. Leijon, Review of Play and Preisach Models for Hysteresis in Magnetic Materials, Materials 16
// (2023) 2422, doi:10.3390/ma16062422.

#include <algorithm>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "rheology/memory.h"
#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

constexpr int kPlays = 6;
constexpr int kRayleighPlays = 64;

/// Plays of the same weight.
struct Plays {
  std::vector<double> radii;   // [Pa]
  std::vector<double> shifts;  // s r [Pa]
  double widest = 0;           // distance of the branches for h = 1, share of the span
  double weight = 0;           // h w

  /// Divides the reach into `number` equal parts with a radius in each. `place`: position of the radius in
  /// its part, 0 = begin, 1 = end.
  Plays(int number, double place, const EffectValues& values) {
    double mean_radius = 0;  // [Pa]
    for (int i = 1; i <= number; ++i) {
      radii.push_back(values.at("reach") * (i - 1 + place) / number);
      shifts.push_back(values.at("one_sided") * radii.back());
      mean_radius += radii.back() / number;
    }
    widest = 2 * mean_radius / values.at("span");
    weight = values.at("loop_width") / widest / number;
  }

  /// Updates the states from `play` on. Returns the sum of load minus state [Pa]. `play` then points behind
  /// the last state.
  double behind(double load, double*& play) const {
    double sum = 0;
    for (std::size_t i = 0; i < radii.size(); ++i, ++play) {
      *play = rheology::playStep(load + shifts[i], radii[i], *play);
      sum += load - *play;
    }
    return sum;
  }
};

class Hysteresis : public Effect {
 public:
  Hysteresis(const EffectValues& values, const EffectContext& context) {
    const double rayleigh = values.at("rayleigh");
    if (rayleigh < 1) add({kPlays, 1, values}, 1 - rayleigh);
    if (rayleigh > 0) add({kRayleighPlays, 0.5, values}, rayleigh);
    load_share_ = 1 - values.at("gain_share");
    gain_share_ = values.at("gain_share") / values.at("span");
    // With more than all of its weight on the plays, the load would fall while the pressure rises.
    if (load_share_ * values.at("loop_width") > widest_) {
      std::ostringstream sentence;
      sentence << "effects.hysteresis: loop_width is " << values.at("loop_width") << ", but must be at most "
               << widest_ << " with this span and reach";
      throw settings::InputError(sentence.str());
    }
    state_.assign(context.layout.size.taxels() * plays_of_taxel_, 0.0);
  }

  void apply(const RigSample&, TaxelSignals& signals) override {
    double* play = state_.data();
    for (std::size_t taxel = 0; taxel < signals.load.size(); ++taxel) {
      const double load = signals.load[taxel];
      double back = 0, lost = 0;  // share of the load [Pa] and of the sensitivity that are subtracted
      for (const Plays& plays : plays_) {
        const double behind = plays.behind(load, play);
        back += load_share_ * plays.weight * behind;
        lost += gain_share_ * plays.weight * behind;
      }
      signals.load[taxel] -= back;
      signals.gain[taxel] *= 1 - lost;
    }
  }

 private:
  void add(Plays plays, double share) {
    plays.weight *= share;
    plays_of_taxel_ += plays.radii.size();
    widest_ = widest_ == 0 ? plays.widest : std::min(widest_, plays.widest);
    plays_.push_back(std::move(plays));
  }

  std::vector<Plays> plays_;  // one or both forms
  std::size_t plays_of_taxel_ = 0;
  double widest_ = 0;  // largest permitted loop_width
  double load_share_ = 1;
  double gain_share_ = 0;  // [1/Pa]
};

}  // namespace

EffectEntry hysteresis() {
  EffectInfo info;
  info.id = "hysteresis";
  info.summary = "loading against unloading, whatever the rate";
  info.equation = "u = P_e - h sum_i w_i (P_e - play_{r_i}(P_e + s r_i))";
  info.source = "Prandtl-Ishlinskii, or Rayleigh 1887; Tangio TPE-500 5 %, Interlink FSR 400 10 %";
  info.stage = ChainStage::kMemory;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("loop_width", "distance of the branches of a wide loop", {0, 0.5, "of span"}, 0.05)
          .within(0.005, 0.2),
      shape("span", "pressure that loop_width is a share of", {1e3, 10e6, "Pa"}, kUsualRange).ofRange(),
      shape("reach", "R, half the way after a turn over which the loop opens", {100, 10e6, "Pa"}, 150e3)
          .trying({50e3, 100e3, 150e3, 250e3})
          .ofRange(),
      shape("one_sided", "s, 0 = both branches depart alike, 1 = only unloading", {0, 1, ""}, 0)
          .trying({0, 1}),
      shape("gain_share", "v, 0 = acts like load, 1 = on the sensitivity", {0, 1, ""}, 0).trying({0, 1}),
      shape("rayleigh", "0 = loops of straight pieces, 1 = loops of parabolas (Rayleigh's law)", {0, 1, ""},
            0)
          .offAt(0)
          .trying({0, 1}),
  };
  info.sign = SignRule::kPositive;
  info.depends_on = {Covariate::kDirection, Covariate::kPressure, Covariate::kPreviousExtremes};
  info.needs = {Evidence::kTwoRampRates};
  info.collinear = {"creep", "time_skew", "seal_leak", "relaxation"};
  info.experiment = Experiment::kTwoRampRates;
  info.mixture = true;
  return {info, makeEffect<Hysteresis>};
}

}  // namespace fsr::simulation
