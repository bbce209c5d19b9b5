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
           LeftAfter::kCurveEach)};
}

}  // namespace blind
