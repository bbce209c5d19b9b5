// Two clocks stamp matrix and chamber pressure; one of them is late, equally for all taxels.

#include <algorithm>
#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

class TimeSkew : public Hidden {
 public:
  void onLoad(std::size_t, Trace& load) const override {
    const Campaign& campaign = setup_.campaign;
    for (std::size_t scan = 0; scan < campaign.scans(); ++scan) {
      const Visit& visit = campaign.visits[campaign.visit[scan]];
      const double late = campaign.pressureAt(visit, campaign.time[scan] - delay_[scan]);
      load[scan] += late - campaign.pressure[scan];
    }
  }

 protected:
  explicit TimeSkew(const HiddenSetup& setup)
      : setup_(setup), random_(setup.seed, "time skew"), delay_(setup.campaign.scans()) {
    // Usually the matrix is late (USB); sometimes the chamber's DAQ buffers more.
    const double sign = random_.chance(0.75) ? 1 : -1;
    mean_ = sign * random_.uniform(0.12, 0.35) * setup.strength;
    parameters_ = {{"mean_delay", mean_, "s"}};
  }
  HiddenSetup setup_;
  Random random_;
  Trace delay_;  // delay of the matrix relative to the chamber [s]
  double mean_;
};

// One clock runs faster than the other and is set again at every mount.
class TwoClocks : public TimeSkew {
 public:
  explicit TwoClocks(const HiddenSetup& setup) : TimeSkew(setup) {
    const double spread = random_.uniform(0.1, 0.4);  // relative change of the delay within a mount
    for (const Visit& visit : setup.campaign.visits) {
      const auto scans = static_cast<double>(visit.last - visit.first);
      for (std::size_t scan = visit.first; scan < visit.last; ++scan) {
        const double share = static_cast<double>(scan - visit.first) / scans - 0.5;
        delay_[scan] = mean_ * (1 + spread * share);
      }
    }
    parameters_.push_back({"spread", spread, "1"});
  }
};

// Each start of the two programs gives a different delay.
class ByMount : public TimeSkew {
 public:
  explicit ByMount(const HiddenSetup& setup) : TimeSkew(setup) {
    for (const Visit& visit : setup.campaign.visits) {
      const double delay = mean_ * random_.uniform(0.8, 1.2);
      for (std::size_t scan = visit.first; scan < visit.last; ++scan) delay_[scan] = delay;
    }
  }
};

// Scans wait in a buffer until it is full; the first one waits longest.
class Buffered : public TimeSkew {
 public:
  explicit Buffered(const HiddenSetup& setup) : TimeSkew(setup) {
    const std::size_t length = 3 + random_.below(4);
    for (std::size_t scan = 0; scan < delay_.size(); ++scan) {
      const auto waiting = static_cast<double>(length - 1 - scan % length);
      delay_[scan] = mean_ * (0.7 + 0.6 * waiting / static_cast<double>(length - 1));
    }
    parameters_.push_back({"buffer", static_cast<double>(length), "scans"});
  }
};

// A free-running clock that a time service sets back at intervals: the delay is a saw tooth.
// Source: D. L. Mills, Internet time synchronization: the Network Time Protocol, IEEE Trans. Commun. 39
// (1991) 1482.
class SetBack : public TimeSkew {
 public:
  explicit SetBack(const HiddenSetup& setup) : TimeSkew(setup) {
    const double interval = random_.uniform(16, 64), phase = random_.uniform();  // [s]
    for (std::size_t scan = 0; scan < delay_.size(); ++scan) {
      const double turns = setup.campaign.time[scan] / interval + phase;
      delay_[scan] = mean_ * (0.6 + 0.8 * (turns - std::floor(turns)));
    }
    parameters_.push_back({"interval", interval, "s"});
  }
};

// Frames wait in a queue: each waits for the work that those before it left.
// Source: D. V. Lindley, The theory of queues with a single server, Proc. Camb. Phil. Soc. 48 (1952) 277.
class Queue : public TimeSkew {
 public:
  explicit Queue(const HiddenSetup& setup) : TimeSkew(setup) {
    double waiting = 0, mean = 0;
    for (double& delay : delay_) {
      const double service = -0.85 * std::log(random_.uniform());  // [periods]
      waiting = std::min(40.0, std::max(0.0, waiting + service - 1));
      delay = waiting;
      mean += waiting / static_cast<double>(delay_.size());
    }
    for (double& delay : delay_) delay = mean_ * (0.7 + 0.3 * delay / std::max(mean, 1e-9));
  }
};

HiddenForm form(const char* name, std::unique_ptr<Hidden> (*make)(const HiddenSetup&)) {
  return {"time_skew", name, {"pressure_rate"}, make};
}

}  // namespace

std::vector<HiddenForm> timeSkewForms() {
  return {form("two_clocks", makeHidden<TwoClocks>), form("by_mount", makeHidden<ByMount>),
          form("buffered", makeHidden<Buffered>), form("set_back", makeHidden<SetBack>),
          inSetB(form("queue", makeHidden<Queue>))};
}

}  // namespace blind
