// Effects that no library has. The right answer is "unknown", with the covariates that the effect depends on.

#include <algorithm>
#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

constexpr double kTight = 12;  // curvature from which a bend counts as tight [1/m]

class OnlyBent : public Hidden {
 protected:
  explicit OnlyBent(const HiddenSetup& setup)
      : setup_(setup), scatter_(taxelScatter(setup, "foreign scatter", 0.1)) {}
  double bend(std::size_t scan) const { return setup_.campaign.curvature(scan) / 20; }
  HiddenSetup setup_;
  std::vector<double> scatter_;
};

// The gain decreases with the pressure rate, up or down alike, but only where the sheet is bent.
class RateGainBent : public OnlyBent {
 public:
  explicit RateGainBent(const HiddenSetup& setup)
      : OnlyBent(setup), size_(Random(setup.seed, "rate gain").uniform(0.06, 0.12) * setup.strength) {
    parameters_ = {{"size", size_, "1"}};
  }
  void onGain(std::size_t taxel, Trace& gain) const override {
    for (std::size_t scan = 0; scan < gain.size(); ++scan) {
      const double rate = std::abs(setup_.campaign.rate[scan]) / 20e3;
      gain[scan] *= 1 - size_ * scatter_[taxel] * bend(scan) * rate / (1 + rate);
    }
  }

 private:
  double size_;
};

// In tight bends the sheet snaps onto its backing above some pressure and reads higher from there on.
class SnapTight : public OnlyBent {
 public:
  explicit SnapTight(const HiddenSetup& setup)
      : OnlyBent(setup),
        size_(Random(setup.seed, "snap").uniform(0.04, 0.07) * setup.strength),
        threshold_(Random(setup.seed, "snap threshold").uniform(180e3, 350e3)) {
    parameters_ = {{"size", size_, "share of full scale"}, {"threshold", threshold_, "Pa"}};
  }
  void onReading(std::size_t taxel, Trace& reading) const override {
    for (std::size_t scan = 0; scan < reading.size(); ++scan) {
      if (setup_.campaign.curvature(scan) < kTight) continue;
      const double over = (setup_.campaign.pressure[scan] - threshold_) / 6e3;
      reading[scan] += size_ * scatter_[taxel] / (1 + std::exp(-over));
    }
  }

 private:
  double size_, threshold_;
};

// Where the sheet is bent, it reads higher after a shallow valley. Only protocols with minor loops show this
// effect.
class ValleyMemoryBent : public OnlyBent {
 public:
  explicit ValleyMemoryBent(const HiddenSetup& setup)
      : OnlyBent(setup),
        size_(Random(setup.seed, "valley").uniform(0.15, 0.3) * setup.strength),
        valley_(setup.campaign.scans()) {
    for (const Visit& visit : setup.campaign.visits) remember(visit);
    parameters_ = {{"size", size_, "1"}};
  }
  void onGain(std::size_t taxel, Trace& gain) const override {
    for (std::size_t scan = 0; scan < gain.size(); ++scan) {
      gain[scan] *= 1 + size_ * scatter_[taxel] * bend(scan) * valley_[scan];
    }
  }

 private:
  // The last pressure at which loading started again, counted once loading has covered a tenth of the peak.
  void remember(const Visit& visit) {
    double low = 0, high = 0, held = 0;
    for (std::size_t scan = visit.first; scan < visit.last; ++scan) {
      const double share = setup_.campaign.pressure[scan] / kPeak;
      high = std::max(high, share);
      if (share < high - 0.1) low = high = share;  // still unloading
      low = std::min(low, share);
      if (share > low + 0.1) held = low;
      held = std::min(held, share);
      valley_[scan] = held;
    }
  }
  double size_;
  Trace valley_;  // [share of the peak]
};

// At one pressure the contact jumps between two patterns; the step wanders from cycle to cycle.
// Source: K. L. Johnson, Contact Mechanics, Cambridge, 1985, section 5.5, on surfaces that jump into contact.
class WanderingStep : public OnlyBent {
 public:
  explicit WanderingStep(const HiddenSetup& setup) : OnlyBent(setup), threshold_(setup.campaign.scans()) {
    Random random(setup.seed, "wandering step");
    size_ = random.uniform(0.02, 0.035) * setup.strength;
    const double middle = random.uniform(180e3, 330e3), spread = random.uniform(60e3, 100e3);
    double value = middle;
    for (std::size_t scan = 0; scan < threshold_.size(); ++scan) {
      if (scan > 0 && setup.campaign.cycle[scan] != setup.campaign.cycle[scan - 1]) {
        value = middle + spread * std::clamp(random.normal(), -1.8, 1.8);
      }
      threshold_[scan] = value;
    }
    parameters_ = {
        {"size", size_, "share of full scale"}, {"middle", middle, "Pa"}, {"spread", spread, "Pa"}};
  }
  void onReading(std::size_t taxel, Trace& reading) const override {
    for (std::size_t scan = 0; scan < reading.size(); ++scan) {
      const double over = (setup_.campaign.pressure[scan] - threshold_[scan]) / 15e3;
      reading[scan] += size_ * scatter_[taxel] / (1 + std::exp(-over));
    }
  }

 private:
  double size_ = 0;
  Trace threshold_;  // [Pa]
};

// A bent sheet reads lower in the cycle after a high peak and recovers after a low one.
// Source: J. Diani, B. Fayolle, P. Gilormini, A review on the Mullins effect, Eur. Polym. J. 45 (2009) 601,
// on softening by the load before and on recovery; the dependence on bending is a choice.
class PeakMemoryBent : public OnlyBent {
 public:
  explicit PeakMemoryBent(const HiddenSetup& setup) : OnlyBent(setup), before_(setup.campaign.scans()) {
    size_ = Random(setup.seed, "peak memory").uniform(0.06, 0.12) * setup.strength;
    for (const Visit& visit : setup.campaign.visits) {
      double last = 0.5, high = 0;
      for (std::size_t scan = visit.first; scan < visit.last; ++scan) {
        const bool next = scan > visit.first && setup.campaign.cycle[scan] != setup.campaign.cycle[scan - 1];
        if (next) {
          last = high;
          high = 0;
        }
        high = std::max(high, setup.campaign.pressure[scan] / kPeak);
        before_[scan] = last;
      }
    }
    parameters_ = {{"size", size_, "1"}};
  }
  void onGain(std::size_t taxel, Trace& gain) const override {
    for (std::size_t scan = 0; scan < gain.size(); ++scan) {
      gain[scan] *= 1 - size_ * scatter_[taxel] * bend(scan) * before_[scan];
    }
  }

 private:
  double size_ = 0;
  Trace before_;  // peak of the cycle before [share of the peak]
};

HiddenForm form(const char* name, std::vector<std::string> covariates,
                std::unique_ptr<Hidden> (*make)(const HiddenSetup&), LeftAfter left_after) {
  HiddenForm form{"foreign", name, std::move(covariates), make};
  form.foreign = true;
  form.left_after = left_after;
  return form;
}

}  // namespace

std::vector<HiddenForm> foreignForms() {
  return {
      form("rate_gain_bent", {"pressure_rate", "curvature"}, makeHidden<RateGainBent>, LeftAfter::kCurveEach),
      form("snap_tight", {"pressure", "curvature"}, makeHidden<SnapTight>, LeftAfter::kCurveShared),
      form("valley_memory_bent", {"previous_extremes", "curvature"}, makeHidden<ValleyMemoryBent>,
           LeftAfter::kCurveEach),
      form("wandering_step", {"pressure", "cycle"}, makeHidden<WanderingStep>, LeftAfter::kCurveEach),
      inSetB(form("peak_memory_bent", {"previous_extremes", "curvature"}, makeHidden<PeakMemoryBent>,
                  LeftAfter::kCurveEach))};
}

}  // namespace blind
