// Noise of the reading, independent from scan to scan and from taxel to taxel.
//
//     y = y + sqrt(a^2 + (r y)^2) N   [counts]
//
// a: noise of the electronics [counts]. r: noise of the contacts, as a share of the reading. N: a standard
// normal number.
// Size: boards of 12 bits read to a few counts. Data sheets give the repeatability of a single part as 2 %
// (Interlink FSR 400).

#include <cmath>

#include "simulation/effects/effect_library.h"
#include "statistics/random_stream.h"

namespace fsr::simulation {

namespace {

EffectInfo whiteNoiseInfo() {
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
  return info;
}

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
  return {whiteNoiseInfo(), makeEffect<WhiteNoise>};
}

}  // namespace fsr::simulation
