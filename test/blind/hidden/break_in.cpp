// The first cycles after each mounting differ from the later ones.

#include <algorithm>
#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

class BreakIn : public Hidden {
 public:
  void onGain(std::size_t taxel, Trace& gain) const override {
    for (std::size_t scan = 0; scan < gain.size(); ++scan)
      gain[scan] *= 1 + size_ * scatter_[taxel] * unsettled_[scan];
  }

 protected:
  explicit BreakIn(const HiddenSetup& setup)
      : setup_(setup),
        random_(setup.seed, "break-in"),
        scatter_(taxelScatter(setup, "break-in scatter", 0.15)),
        unsettled_(setup.campaign.scans()) {
    size_ = (random_.chance(0.7) ? -1 : 1) * random_.uniform(0.03, 0.06) * setup.strength;
    settled_after_ = random_.uniform(0.8, 2.5);  // [cycles]
    parameters_ = {{"size", size_, "1"}, {"settled_after", settled_after_, "cycles"}};
  }
  // value(cycles) at each scan. `cycles` counts since the mounting, by path length of the pressure or as
  // whole cycles.
  template <typename Value>
  void run(bool whole_cycles, Value value) {
    for (const Visit& visit : setup_.campaign.visits) {
      double cycles = 0;
      for (std::size_t scan = visit.first; scan < visit.last; ++scan) {
        cycles += std::abs(setup_.campaign.rate[scan]) * setup_.campaign.scan_period / (2 * kPeak);
        unsettled_[scan] = value(whole_cycles ? setup_.campaign.cycle_of_visit[scan] : cycles);
      }
    }
  }
  HiddenSetup setup_;
  Random random_;
  std::vector<double> scatter_;
  Trace unsettled_;  // 1 at the mounting, tends to 0
  double size_, settled_after_;
};

class Hyperbolic : public BreakIn {
 public:
  explicit Hyperbolic(const HiddenSetup& setup) : BreakIn(setup) {
    run(false, [&](double cycles) { return 1 / (1 + cycles / settled_after_); });
  }
};

class Stretched : public BreakIn {
 public:
  explicit Stretched(const HiddenSetup& setup) : BreakIn(setup) {
    run(false, [&](double cycles) { return std::exp(-std::pow(cycles / settled_after_, 0.6)); });
  }
};

class ByWholeCycles : public BreakIn {
 public:
  explicit ByWholeCycles(const HiddenSetup& setup) : BreakIn(setup) {
    run(true, [&](double cycles) { return std::pow(1 + cycles / settled_after_, -1.5); });
  }
};

// Bedding-in that goes on with the logarithm of the cycles, without an end.
// Source: J. Diani, B. Fayolle, P. Gilormini, A review on the Mullins effect, Eur. Polym. J. 45 (2009) 601,
// which reports the slow softening of filled rubber after the first cycles.
class LogCycles : public BreakIn {
 public:
  explicit LogCycles(const HiddenSetup& setup) : BreakIn(setup) {
    run(false,
        [&](double cycles) { return 1 - std::log1p(cycles / (0.3 * settled_after_)) / std::log1p(100.0); });
  }
};

// Softening of filled rubber by the largest load so far: nothing changes until a load exceeds all before it.
// Source: L. Mullins, Softening of rubber by deformation, Rubber Chem. Technol. 42 (1969) 339; with the
// exponential of R. W. Ogden, D. G. Roxburgh, Proc. R. Soc. Lond. A 455 (1999) 2861. A share of the softening
// comes with each cycle at the largest load.
class LargestLoad : public BreakIn {
 public:
  explicit LargestLoad(const HiddenSetup& setup) : BreakIn(setup) {
    for (const Visit& visit : setup.campaign.visits) {
      double soft = 0;
      for (std::size_t scan = visit.first; scan < visit.last; ++scan) {
        const double share = std::max(0.0, setup.campaign.pressure[scan] / kPeak);
        const double way = std::abs(setup.campaign.rate[scan]) * setup.campaign.scan_period / (2 * kPeak);
        soft += std::max(0.0, share - soft) * (1 - std::exp(-3 * way / settled_after_));
        unsettled_[scan] = std::exp(-3 * soft * soft);
      }
    }
  }
};

}  // namespace

std::vector<HiddenForm> breakInForms() {
  return {{"break_in", "hyperbolic", {"cycle"}, makeHidden<Hyperbolic>},
          {"break_in", "stretched", {"cycle"}, makeHidden<Stretched>},
          {"break_in", "whole_cycles", {"cycle"}, makeHidden<ByWholeCycles>},
          {"break_in", "log_cycles", {"cycle"}, makeHidden<LogCycles>},
          inSetB({"break_in", "largest_load", {"cycle"}, makeHidden<LargestLoad>})};
}

}  // namespace blind
