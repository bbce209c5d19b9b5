#include <algorithm>
#include <cmath>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

// The readings of the first cycles after mounting differ until the sheet has settled.
//
//     g = g (1 + a (1 + N / (k N_0))^-k),   N = (1 - q) W / (2 P_span) + q L
//     since it was mounted:                 W = sum |dP|
//
// W is the path length of the pressure [Pa]. N is the number of cycles computed from it, so that a partial
// cycle counts in part, or the number L of completed loads, so that the gain steps from load to load.
// k is infinite for an exponential; k = 1 is the hyperbola of a bedding that slows down as it goes on.
// Makers ask for conditioning for this reason: the manual of FlexiForce (rev. G) wants 110 % of the load four
// or five times before use.
// Size: a few per cent, which fade within 3 to 10 cycles (estimate). The sign is free.

namespace {

class BreakIn : public Effect {
 public:
  BreakIn(const EffectValues& values, const EffectContext&)
      : change_(values.at("change")),
        cycles_(values.at("cycles")),
        tail_(values.at("tail")),
        loads_share_(values.at("loads_share")),
        span_(values.at("span")) {
    state_.assign(kState, 0.0);
  }

  void mount(const Mounting&) override {
    for (const auto part : {kPathLength, kHighest, kLowest, kLoads}) state_[part] = 0;
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    if (!sample.first) state_[kPathLength] += std::abs(sample.pressure - state_[kBefore]);
    state_[kBefore] = sample.pressure;
    countLoads(sample.pressure);
    const double by_path = state_[kPathLength] / (2 * span_);
    const double number = by_path + loads_share_ * (state_[kLoads] - by_path);
    const double left =
        std::isinf(tail_) ? std::exp(-number / cycles_) : std::pow(1 + number / (tail_ * cycles_), -tail_);
    for (double& gain : signals.gain) gain *= 1 + change_ * left;
  }

 private:
  // Chamber at the scan before, W, highest pressure of this load, lowest since it was half taken off (0 while
  // it is not) [Pa]; number of completed loads.
  enum { kBefore, kPathLength, kHighest, kLowest, kLoads, kState };
  static constexpr double kRise = 0.05;  // of the highest pressure or of the span: the next load has begun

  // A load is complete when the pressure rises again after at least half of it was taken off.
  void countLoads(double pressure) {
    double& highest = state_[kHighest];
    double& lowest = state_[kLowest];
    highest = std::max(highest, pressure);
    if (highest < kRise * span_ || (lowest == 0 && pressure > highest / 2)) return;
    lowest = lowest == 0 ? std::max(pressure, 1.0) : std::min(lowest, std::max(pressure, 1.0));
    if (pressure < lowest + kRise * highest) return;
    state_[kLoads] += 1;
    highest = pressure;
    lowest = 0;
  }

  double change_;
  double cycles_;       // N_0
  double tail_;         // k
  double loads_share_;  // q
  double span_;         // [Pa]
};

}  // namespace

EffectEntry breakIn() {
  EffectInfo info;
  info.id = "break_in";
  info.summary = "the first cycles after mounting differ";
  info.equation = "g *= 1 + a (1 + N / (k N_0))^-k, N cycles since mounting";
  info.source = "FlexiForce manual: condition four or five times; size estimated";
  info.stage = ChainStage::kGain;
  info.level = EffectLevel::kMount;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("change", "a, at the start", {-0.5, 0.5, ""}, -0.04).within(-0.12, 0.12),
      shape("cycles", "N_0, how fast it settles", {0.1, 1000, "cycles"}, 2).trying({0.3, 1, 2, 4}),
      shape("tail", "k, .inf = exponential", {0.5, INFINITY, ""}, INFINITY).trying({1, INFINITY}),
      shape("loads_share", "q, 0 = path, 1 = completed loads", {0, 1, ""}, 0).trying({0, 1}),
      shape("span", "P_span, peak of a whole cycle", {1e3, 10e6, "Pa"}, kUsualRange).ofRange(),
  };
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kCycle, Covariate::kMount};
  info.needs = {Evidence::kMountLabels, Evidence::kRemounts};
  info.collinear = {"drift", "wear", "temperature"};
  info.experiment = Experiment::kRemount;
  info.slow = true;
  return {info, makeEffect<BreakIn>};
}

// Millions of cycles wear the layers.
//
//     g = g (1 - c (F(N_a + N) / F(10^7))^m),   F(N) = N, or N_f (1 - exp(-N / N_f)) where it fades
//     N = (1 - q) W / (2 P_span) + q I / (P_span T_c / 2),   W = sum |dP|,   I = integral of P dt, P > 0
//
// N: number of cycles, computed from the path length W of the pressure [Pa], from its impulse I [Pa s], or
// from both with the weights 1 - q and q. A triangular cycle to P_span that takes the time T_c counts as one
// in both. N_a: cycles of the sheet before the simulation begins. N_f: number of cycles after which 37 % of
// the wear is still to come; where it is infinite, the wear does not fade. c is the loss in 10 million cycles
// in every form.
// Size: 7 % after 10 million actuations (Tangio TPE-500 v1.8, 2018, no sign given); resistance -10 %
// (Interlink FSR 400 PDS-10004-C: there the reading rises, c is negative). With m = 0.26 that is 0.3 % in
// the 60 cycles of Ahmadizadeh and Menon 2019, and 2 % within 10^5. No published figure tells the forms of
// force sensitive resistors apart; they follow those of machine parts.
// Path length: wear grows with load and sliding distance. J. F. Archard, Contact and rubbing of flat
// surfaces, J. Appl. Phys. 24 (1953) 981-988, doi:10.1063/1.1721448.
// Fading: running-in. C. A. Queener, T. C. Smith, W. L. Mitchell, Transient wear of machine parts, Wear 8
// (1965) 391-400 (from memory, not verified); review: M. M. Khonsari, S. Ghatrehsamani, S. Akbarzadeh, On the
// running-in nature of metallic tribo-components, Wear (2021) 203871, doi:10.1016/j.wear.2021.203871.
// Impulse: damage that accumulates with the time under load, here in proportion to the load (assumption).

namespace {

constexpr double kLifetime = 1e7;  // [cycles]

class Wear : public Effect {
 public:
  Wear(const EffectValues& values, const EffectContext&)
      : loss_(values.at("loss")),
        exponent_(values.at("exponent")),
        age_(values.at("age")),
        cycle_(2 * values.at("span")),
        fading_(values.at("fading")),
        impulse_share_(values.at("impulse_share")),
        cycle_impulse_(values.at("span") * values.at("cycle_duration") / 2) {
    state_.assign(impulse_share_ == 0 ? std::size_t{kWithoutImpulse} : std::size_t{kState}, 0.0);
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    if (!sample.first) state_[kPathLength] += std::abs(sample.pressure - state_[kBefore]);
    if (impulse_share_ != 0) addImpulse(sample);
    state_[kBefore] = sample.pressure;
    const double worn = std::pow(shareOfLifetime(age_ + cycles()), exponent_);
    const double factor = std::max(0.0, 1 - loss_ * worn);
    for (double& gain : signals.gain) gain *= factor;
  }

 private:
  // Chamber at the scan before [Pa], W [Pa], I [Pa s]. The last is not kept where it is not used.
  enum { kBefore, kPathLength, kImpulse, kState };
  static constexpr std::size_t kWithoutImpulse = kImpulse;

  void addImpulse(const RigSample& sample) {
    const double mean = 0.5 * (std::max(state_[kBefore], 0.0) + std::max(sample.pressure, 0.0));
    state_[kImpulse] += mean * sample.elapsed;
  }

  // N.
  double cycles() const {
    const double by_path = state_[kPathLength] / cycle_;
    if (impulse_share_ == 0) return by_path;
    return (1 - impulse_share_) * by_path + impulse_share_ * state_[kImpulse] / cycle_impulse_;
  }

  // F(cycles) / F(10^7).
  double shareOfLifetime(double cycles) const {
    if (std::isinf(fading_)) return cycles / kLifetime;
    return std::expm1(-cycles / fading_) / std::expm1(-kLifetime / fading_);
  }

  double loss_;
  double exponent_;
  double age_;     // [cycles]
  double cycle_;   // path length of the pressure in a whole cycle [Pa]
  double fading_;  // N_f [cycles]
  double impulse_share_;
  double cycle_impulse_;  // impulse of the pressure in a whole cycle [Pa s]
};

}  // namespace

EffectEntry wear() {
  EffectInfo info;
  info.id = "wear";
  info.summary = "sensitivity lost, or won, over millions of cycles";
  info.equation =
      "g *= 1 - c (F(N_a + N) / F(1e7))^m, F(N) = N or N_f (1 - exp(-N / N_f)), N by sum |dP| or by P dt";
  info.source = "Tangio TPE-500 7 %, Interlink FSR 400 -10 % of resistance in 10 million";
  info.stage = ChainStage::kGain;
  info.level = EffectLevel::kRig;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("loss", "c, in 10 million cycles", {-0.5, 0.9, ""}, 0.07).within(-0.2, 0.3),
      shape("exponent", "m", {0.05, 2, ""}, 0.26).trying({0.26, 0.5, 1}),
      shape("age", "N_a, cycles before the simulation begins", {0, 1e9, "cycles"}, 0),
      shape("span", "P_span, peak of a whole cycle", {1e3, 10e6, "Pa"}, kUsualRange).ofRange(),
      shape("fading", "N_f, 37 % of the wear comes later, .inf = it does not fade", {0.1, INFINITY, "cycles"},
            INFINITY)
          .offAt(INFINITY)
          .trying({3, 30, INFINITY}),
      // Not tried: it goes on under a constant load, as creep of the sensitivity does.
      shape("impulse_share", "q, cycles counted by 0 = path length of the pressure, 1 = its impulse",
            {0, 1, ""}, 0)
          .offAt(0),
      shape("cycle_duration", "T_c, duration of a whole cycle, for the impulse", {0.1, 1e6, "s"}, 73),
  };
  info.sign = SignRule::kEither;
  info.depends_on = {Covariate::kAccumulatedChange, Covariate::kCycle, Covariate::kPressure};
  info.needs = {Evidence::kManyCycles, Evidence::kThermometer};
  info.collinear = {"drift", "break_in", "temperature"};
  info.experiment = Experiment::kManyCycles;
  info.slow = true;
  return {info, makeEffect<Wear>};
}

}  // namespace fsr::simulation
