#include <cmath>

#include "simulation/effects/effect_library.h"
#include "statistics/random_stream.h"

namespace fsr::simulation {

// Noise of the reading, independent from scan to scan and from taxel to taxel.
//
//     y = y + sqrt(a^2 + (r y)^2) N   [counts]
//
// a: noise of the electronics [counts]. r: noise of the contacts, as a share of the reading. N: a standard
// normal number.
// Size: boards of 12 bits read to a few counts. Data sheets give the repeatability of a single part as 2 %
// (Interlink FSR 400).

namespace {

class WhiteNoise : public Effect {
 public:
  WhiteNoise(const EffectValues& values, const EffectContext& context)
      : absolute_(values.at("absolute")), relative_(values.at("relative")) {
    for (std::size_t i = 0; i < context.layout.size.taxels(); ++i) {
      streams_.push_back(statistics::randomStream(context.seed, "white_noise", i));
    }
  }

  void apply(const RigSample& sample, TaxelSignals& signals) override {
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      const double relative = relative_ * signals.reading[i];
      const double deviation = std::sqrt(absolute_ * absolute_ + relative * relative);
      signals.reading[i] += deviation * streams_[i].normal(sample.scan);
    }
  }

 private:
  double absolute_;  // [counts]
  double relative_;
  std::vector<statistics::RandomStream> streams_;  // [taxels]
};

}  // namespace

EffectEntry whiteNoise() {
  EffectInfo info;
  info.id = "white_noise";
  info.summary = "independent noise of each reading";
  info.equation = "y += sqrt(a^2 + (r y)^2) N(0, 1)";
  info.source = "Interlink FSR 400: repeatability of a single part 2 %";
  info.stage = ChainStage::kReading;
  info.level = EffectLevel::kTaxel;
  info.kind = EffectKind::kBase;
  info.parameters = {
      scatter("absolute", "a, deviation whatever the reading", {0, 10000, "counts"}, 2),
      scatter("relative", "r, deviation as a share of the reading", {0, 0.5, ""}, 0),
  };
  info.stochastic = true;
  return {info, makeEffect<WhiteNoise>};
}

// The wires pick up the mains frequency, and the scan samples it.
//
//     y_i = y_i + A sin(2 pi f t_i + phi),   t_i = t + (i - (N - 1) / 2) dt   [counts]
//
// i: place of the taxel in the scan, row-major. N: number of taxels. dt: time from one taxel to the next
// [s]. At a scan rate f_s the hum appears at |f - k f_s|. Exactly 50 Hz at exactly 10 Hz is a pattern over
// the rows that does not move; it beats slowly as soon as one of the clocks deviates. A large grid stays
// within 0.2 Hz of 50 or 60 Hz nearly always (not verified).

namespace {

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
  return {info, makeEffect<MainsPickup>};
}

}  // namespace fsr::simulation
