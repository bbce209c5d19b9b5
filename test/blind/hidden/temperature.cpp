// Effect of the sheet's temperature, which lags behind the room's and follows the heating of compressed gas.

#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

constexpr double kReference = 22;  // [degree Celsius]

class Thermal : public Hidden {
 protected:
  explicit Thermal(const HiddenSetup& setup)
      : setup_(setup),
        random_(setup.seed, "thermal"),
        scatter_(taxelScatter(setup, "thermal scatter", 0.15)) {
    // Data sheets state a decrease at both ends of the range, so either sign is possible.
    slope_ = random_.sign() * random_.uniform(2.5e-3, 4e-3) * setup.strength;  // [1/K]
    parameters_ = {{"slope", slope_, "1/K"}};
  }
  double warmer(std::size_t scan) const { return setup_.campaign.temperature[scan] - kReference; }

  HiddenSetup setup_;
  Random random_;
  std::vector<double> scatter_;
  double slope_;
};

// A parabola about an optimum temperature.
class Quadratic : public Thermal {
 public:
  explicit Quadratic(const HiddenSetup& setup) : Thermal(setup), bend_(slope_ * random_.uniform(0.02, 0.05)) {
    parameters_.push_back({"bend", bend_, "1/K^2"});
  }
  void onGain(std::size_t taxel, Trace& gain) const override {
    for (std::size_t scan = 0; scan < gain.size(); ++scan) {
      const double dt = warmer(scan);
      gain[scan] *= 1 + scatter_[taxel] * (slope_ + bend_ * dt) * dt;
    }
  }

 private:
  double bend_;  // [1/K^2]
};

// A power of the absolute temperature of the ink, which follows the surface of the sheet with a lag.
class LaggedPower : public Thermal {
 public:
  explicit LaggedPower(const HiddenSetup& setup) : Thermal(setup), lagged_(setup.campaign.scans()) {
    const double lag = random_.uniform(60, 200);  // [s]
    for (const Visit& visit : setup.campaign.visits) {
      double value = setup.campaign.temperature[visit.first];
      for (std::size_t scan = visit.first; scan < visit.last; ++scan) {
        value +=
            (setup.campaign.temperature[scan] - value) * (1 - std::exp(-setup.campaign.scan_period / lag));
        lagged_[scan] = value;
      }
    }
    parameters_.push_back({"lag", lag, "s"});
  }
  void onGain(std::size_t taxel, Trace& gain) const override {
    const double zero = 273.15, power = slope_ * (zero + kReference) * scatter_[taxel];
    for (std::size_t scan = 0; scan < gain.size(); ++scan) {
      gain[scan] *= std::pow((lagged_[scan] + zero) / (kReference + zero), power);
    }
  }

 private:
  Trace lagged_;  // [degree Celsius]
};

// The zero of the read-out changes together with the gain of the ink.
class ZeroAndGain : public Thermal {
 public:
  explicit ZeroAndGain(const HiddenSetup& setup) : Thermal(setup), zero_(slope_ * random_.uniform(0.2, 0.5)) {
    parameters_.push_back({"zero", zero_, "share of full scale / K"});
  }
  void onGain(std::size_t taxel, Trace& gain) const override {
    for (std::size_t scan = 0; scan < gain.size(); ++scan)
      gain[scan] *= 1 + scatter_[taxel] * slope_ * warmer(scan);
  }
  void onReading(std::size_t, Trace& reading) const override {
    for (std::size_t scan = 0; scan < reading.size(); ++scan) reading[scan] += zero_ * warmer(scan);
  }

 private:
  double zero_;  // [share of full scale / K]
};

// Hopping between carbon particles: ln G = - (T0 / T)^(1/4), with T0 from the slope at the reference.
// Source: N. F. Mott, Conduction in non-crystalline materials, Phil. Mag. 19 (1969) 835.
class Hopping : public Thermal {
 public:
  explicit Hopping(const HiddenSetup& setup) : Thermal(setup) {}
  void onGain(std::size_t taxel, Trace& gain) const override {
    const double reference = 273.15 + kReference;
    const double root = 4 * slope_ * scatter_[taxel] * reference;  // (T0 / reference)^(1/4), with its sign
    for (std::size_t scan = 0; scan < gain.size(); ++scan) {
      gain[scan] *= std::exp(root * (1 - std::pow(reference / (reference + warmer(scan)), 0.25)));
    }
  }
};

// Sheet and backing expand differently: warmth changes the preload, most where the sheet is bent.
// Source: S. Timoshenko, Analysis of bi-metal thermostats, J. Opt. Soc. Am. 11 (1925) 233.
class Mismatch : public Thermal {
 public:
  explicit Mismatch(const HiddenSetup& setup)
      : Thermal(setup), pressure_(slope_ * random_.uniform(250e3, 400e3)) {
    parameters_.push_back({"preload", pressure_, "Pa / K"});
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    for (std::size_t scan = 0; scan < load.size(); ++scan) {
      const double bent = 0.5 + setup_.campaign.curvature(scan) / 20;
      load[scan] += pressure_ * bent * scatter_[taxel] * warmer(scan);
    }
  }

 private:
  double pressure_;  // [Pa / K]
};

}  // namespace

std::vector<HiddenForm> temperatureForms() {
  return {{"temperature", "quadratic", {"temperature"}, makeHidden<Quadratic>},
          {"temperature", "lagged_power", {"temperature"}, makeHidden<LaggedPower>},
          {"temperature", "zero_and_gain", {"temperature"}, makeHidden<ZeroAndGain>},
          {"temperature", "hopping", {"temperature"}, makeHidden<Hopping>},
          inSetB({"temperature", "mismatch", {"temperature"}, makeHidden<Mismatch>})};
}

}  // namespace blind
