// Each load reduces the sensitivity permanently. The loss depends on the load history, not on clock time.

#include <algorithm>
#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

class Wear : public Hidden {
 public:
  void onGain(std::size_t taxel, Trace& gain) const override {
    for (std::size_t scan = 0; scan < gain.size(); ++scan)
      gain[scan] *= 1 - size_ * scatter_[taxel] * lost_[scan];
  }

 protected:
  explicit Wear(const HiddenSetup& setup)
      : setup_(setup),
        random_(setup.seed, "wear"),
        scatter_(taxelScatter(setup, "wear scatter", 0.15)),
        lost_(setup.campaign.scans()) {
    // More than in data sheets; otherwise a campaign of some dozens of cycles could not show it.
    size_ = random_.uniform(0.02, 0.04) * setup.strength;  // loss at the end
    parameters_ = {{"lost_by_the_end", size_, "1"}};
  }
  void endAtOne() {
    const double end = lost_[setup_.campaign.first_scans - 1];
    for (double& lost : lost_) lost /= end;
  }
  HiddenSetup setup_;
  Random random_;
  std::vector<double> scatter_;
  Trace lost_;  // 0 at the start, 1 at the end of the first protocol
  double size_;
};

// Damage by pressure peaks: high peaks count much more than low ones, and each further peak damages less.
class Peaks : public Wear {
 public:
  explicit Peaks(const HiddenSetup& setup) : Wear(setup) {
    const Trace& pressure = setup.campaign.pressure;
    double damage = 0, high = 0;
    for (std::size_t scan = 0; scan < lost_.size(); ++scan) {
      high = std::max(high, pressure[scan]);
      if (pressure[scan] < 0.8 * high) {  // the peak is over
        damage += std::pow(high / kPeak, 3);
        high = pressure[scan];
      }
      lost_[scan] = 1 - std::pow(1 + damage, -0.15);
    }
    endAtOne();
  }
};

// A power of the path length of the pressure, weighted more at high pressure.
class LoadedDistance : public Wear {
 public:
  explicit LoadedDistance(const HiddenSetup& setup) : Wear(setup) {
    const double power = random_.uniform(0.45, 0.7);
    double distance = 0;
    for (std::size_t scan = 0; scan < lost_.size(); ++scan) {
      const double share = setup.campaign.pressure[scan] / kPeak;
      distance += share * std::abs(setup.campaign.rate[scan]) * setup.campaign.scan_period / kPeak;
      lost_[scan] = std::pow(distance, power);
    }
    parameters_.push_back({"power", power, "1"});
    endAtOne();
  }
};

// Exponential approach to a final loss that is still far away.
class WornOff : public Wear {
 public:
  explicit WornOff(const HiddenSetup& setup) : Wear(setup) {
    double distance = 0;
    for (double& lost : lost_) {
      const auto scan = static_cast<std::size_t>(&lost - lost_.data());
      distance += std::abs(setup.campaign.rate[scan]) * setup.campaign.scan_period;
      lost = distance;
    }
    const double scale = lost_[setup.campaign.first_scans - 1] * random_.uniform(0.5, 1);
    for (double& lost : lost_) lost = 1 - std::exp(-lost / scale);
    parameters_.push_back({"scale", scale, "Pa"});
    endAtOne();
  }
};

// Rubbed off in proportion to load and distance.
// Source: J. F. Archard, Contact and rubbing of flat surfaces, J. Appl. Phys. 24 (1953) 981.
class Rubbed : public Wear {
 public:
  explicit Rubbed(const HiddenSetup& setup) : Wear(setup) {
    double done = 0;
    for (std::size_t scan = 0; scan < lost_.size(); ++scan) {
      const double share = std::max(0.0, setup.campaign.pressure[scan] / kPeak);
      done += share * std::abs(setup.campaign.rate[scan]) * setup.campaign.scan_period / kPeak;
      lost_[scan] = done;
    }
    endAtOne();
  }
};

// Cracks that grow with a power of the load's range, the faster the longer they are.
// Source: P. Paris, F. Erdogan, A critical analysis of crack propagation laws, J. Basic Eng. 85 (1963) 528.
class Cracks : public Wear {
 public:
  explicit Cracks(const HiddenSetup& setup) : Wear(setup) {
    const double power = random_.uniform(2, 3.5), growth = random_.uniform(1, 2.5);
    double total = 0;
    for (std::size_t scan = 0; scan < lost_.size(); ++scan) {
      const double share = std::max(0.0, setup.campaign.pressure[scan] / kPeak);
      total += std::pow(share, power - 1) * std::abs(setup.campaign.rate[scan]) * setup.campaign.scan_period /
               kPeak;
      lost_[scan] = total;
    }
    const double end = lost_[setup.campaign.first_scans - 1];
    for (double& lost : lost_) lost = std::expm1(growth * lost / end);
    parameters_.push_back({"power", power, "1"});
    parameters_.push_back({"growth", growth, "1"});
    endAtOne();
  }
};

}  // namespace

std::vector<HiddenForm> wearForms() {
  const std::vector<std::string> covariates = {"accumulated_pressure"};
  return {{"wear", "peaks", covariates, makeHidden<Peaks>},
          {"wear", "loaded_distance", covariates, makeHidden<LoadedDistance>},
          {"wear", "worn_off", covariates, makeHidden<WornOff>},
          {"wear", "rubbed", covariates, makeHidden<Rubbed>},
          inSetB({"wear", "cracks", covariates, makeHidden<Cracks>})};
}

}  // namespace blind
