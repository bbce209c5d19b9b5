// The zero changes with clock time, with or without pressure.

#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

class Drift : public Hidden {
 public:
  void onReading(std::size_t taxel, Trace& reading) const override {
    for (std::size_t scan = 0; scan < reading.size(); ++scan) reading[scan] += share_[taxel] * zero_[scan];
  }

 protected:
  explicit Drift(const HiddenSetup& setup)
      : setup_(setup), random_(setup.seed, "drift"), zero_(setup.campaign.scans()) {
    size_ = random_.uniform(0.02, 0.04) * setup.strength;  // [share of full scale]
    // In half of the sheets all taxels drift equally, in the others each taxel by its own amount.
    const bool common = random_.chance(0.5);
    share_ = taxelScatter(setup, "drift scatter", common ? 0.1 : 0.5);
    parameters_ = {{"size", size_, "share of full scale"}, {"common", common ? 1.0 : 0.0, "1"}};
  }
  HiddenSetup setup_;
  Random random_;
  double size_;
  std::vector<double> share_;  // share of each taxel
  Trace zero_;                 // [share of full scale]
};

class RandomWalk : public Drift {
 public:
  explicit RandomWalk(const HiddenSetup& setup) : Drift(setup) {
    double value = 0, before = 0;
    for (std::size_t scan = 0; scan < zero_.size(); ++scan) {
      const double seconds = setup.campaign.time[scan] - before;
      before = setup.campaign.time[scan];
      value += size_ * std::sqrt(seconds / 1500) * random_.normal();
      zero_[scan] = value;
    }
  }
};

class Settling : public Drift {
 public:
  explicit Settling(const HiddenSetup& setup) : Drift(setup) {
    const double time_constant = random_.uniform(1500, 6000), sign = random_.sign();  // [s]
    const double end = 1 - std::exp(-setup.campaign.time[setup.campaign.first_scans - 1] / time_constant);
    for (std::size_t scan = 0; scan < zero_.size(); ++scan) {
      zero_[scan] = sign * 2 * size_ * (1 - std::exp(-setup.campaign.time[scan] / time_constant)) / end;
    }
    parameters_.push_back({"time_constant", time_constant, "s"});
  }
};

// The zero jumps at random times, within seconds, and stays at the new value.
class Steps : public Drift {
 public:
  explicit Steps(const HiddenSetup& setup) : Drift(setup) {
    const std::size_t number = setup.campaign.first_visits / 2 + 2;
    for (std::size_t i = 0; i < number; ++i) {
      // In the middle of a mount, where the jump shows.
      const Visit& visit = setup.campaign.visits[random_.below(setup.campaign.first_visits)];
      const double share = random_.uniform(0.2, 0.8);
      const double when =
          visit.start + share * static_cast<double>(visit.last - visit.first) * setup.campaign.scan_period;
      const double height = random_.sign() * random_.uniform(0.5, 1) * size_, width = random_.uniform(2, 8);
      for (std::size_t scan = 0; scan < zero_.size(); ++scan) {
        zero_[scan] += height / (1 + std::exp(-(setup.campaign.time[scan] - when) / width));
      }
    }
    parameters_.push_back({"steps", static_cast<double>(number), "1"});
  }
};

// Physical ageing after the sheet was made or warmed: the zero moves with the logarithm of time.
// Source: L. C. E. Struik, Physical Aging in Amorphous Polymers and Other Materials, Elsevier, 1978.
class Ageing : public Drift {
 public:
  explicit Ageing(const HiddenSetup& setup) : Drift(setup) {
    const double age = random_.logUniform(60, 1200), sign = random_.sign();  // [s]
    const double end = std::log1p(setup.campaign.time[setup.campaign.first_scans - 1] / age);
    for (std::size_t scan = 0; scan < zero_.size(); ++scan) {
      zero_[scan] = sign * 2 * size_ * std::log1p(setup.campaign.time[scan] / age) / end;
    }
    parameters_.push_back({"age", age, "s"});
  }
};

// Flicker of the zero over minutes and hours, as a sum of three Ornstein-Uhlenbeck processes.
// Source: R. F. Voss, J. Clarke, Flicker (1/f) noise: equilibrium temperature and resistance fluctuations,
// Phys. Rev. B 13 (1976) 556.
class Flicker : public Drift {
 public:
  explicit Flicker(const HiddenSetup& setup) : Drift(setup) {
    for (const double time_constant : {200.0, 800.0, 3200.0}) {
      double value = random_.normal(), before = 0;
      for (std::size_t scan = 0; scan < zero_.size(); ++scan) {
        const double keep = std::exp(-(setup.campaign.time[scan] - before) / time_constant);
        before = setup.campaign.time[scan];
        value = keep * value + std::sqrt(1 - keep * keep) * random_.normal();
        zero_[scan] += 0.6 * size_ * value;
      }
    }
  }
};

}  // namespace

std::vector<HiddenForm> driftForms() {
  return {{"drift", "random_walk", {"clock_time"}, makeHidden<RandomWalk>},
          {"drift", "exponential", {"clock_time"}, makeHidden<Settling>},
          {"drift", "steps", {"clock_time"}, makeHidden<Steps>},
          {"drift", "ageing", {"clock_time"}, makeHidden<Ageing>},
          inSetB({"drift", "flicker", {"clock_time"}, makeHidden<Flicker>})};
}

}  // namespace blind
