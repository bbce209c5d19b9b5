// The wires pick up the mains frequency, and the scan samples it.
//
//     y_i = y_i + A sin(2 pi f t_i + phi),   t_i = t + (i - (N - 1) / 2) dt   [counts]
//
// i: place of the taxel in the scan, row-major. N: number of taxels. dt: time from one taxel to the next
// [s]. At a scan rate f_s the hum appears at |f - k f_s|. Exactly 50 Hz at exactly 10 Hz is a pattern over
// the rows that does not move; it beats slowly as soon as one of the clocks deviates. A large grid stays
// within 0.2 Hz of 50 or 60 Hz nearly always (not verified).

#include <cmath>

#include "simulation/effects/effect_library.h"

namespace fsr::simulation {

namespace {

EffectInfo mainsPickupInfo() {
  EffectInfo info;
  info.id = "mains_pickup";
  info.summary = "hum of the mains, folded down by the scan rate";
  info.equation = "y_i += A sin(2 pi f t_i + phi)";
  info.source = "sampling theorem; amplitude estimated";
  info.stage = ChainStage::kReading;
  info.level = EffectLevel::kRow;
  info.kind = EffectKind::kGrid;
  info.parameters = {
      strength("amplitude", "A", {0, 65535, "counts"}, 8).within(1, 400),
      shape("frequency", "f", {0.1, 1000, "Hz"}, 50.05).trying({50, 60}),
      shape("phase", "phi", {-10, 10, "rad"}, 0).trying({0, M_PI / 2}),
      shape("taxel_time", "dt, time to read one taxel", {0, 0.1, "s"}, 5e-4),
  };
  info.sign = SignRule::kEither;  // of the coefficients of sine and cosine
  info.depends_on = {Covariate::kClockTime, Covariate::kRow};
  info.collinear = {"drift"};
  info.experiment = Experiment::kRest;
  info.by_chance = true;
  info.detector = Detector::kMains;
  return info;
}

class MainsPickup : public Effect {
 public:
  MainsPickup(const EffectValues& values, const EffectContext& context)
      : pulsation_(2 * M_PI * values.at("frequency")) {
    const std::size_t taxels = context.layout.size.taxels();
    const double middle = (static_cast<double>(taxels) - 1) / 2;
    for (std::size_t i = 0; i < taxels; ++i) {
      const double after = (static_cast<double>(i) - middle) * values.at("taxel_time");
      const double phase = values.at("phase") + pulsation_ * after;
      sine_.push_back(values.at("amplitude") * std::sin(phase));
      cosine_.push_back(values.at("amplitude") * std::cos(phase));
    }
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    // sin(a + b) taken apart: one sine and cosine a scan.
    const double sine = std::sin(pulsation_ * sample.time);
    const double cosine = std::cos(pulsation_ * sample.time);
    for (std::size_t i = 0; i < sine_.size(); ++i) {
      signals.reading[i] += cosine_[i] * sine + sine_[i] * cosine;
    }
  }

 private:
  double pulsation_;            // [rad/s]
  std::vector<double> sine_;    // [taxels], A sin of the taxel's phase, counts
  std::vector<double> cosine_;  // [taxels], counts
};

}  // namespace

EffectEntry mainsPickup() {
  return {mainsPickupInfo(), makeEffect<MainsPickup>};
}

}  // namespace fsr::simulation
