// Mains hum on the wires. Sampled once a scan it appears as a slow beat; its phase shifts from taxel to taxel
// in the order of the scan.

#include <algorithm>
#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

class Pickup : public Hidden {
 public:
  void onReading(std::size_t taxel, Trace& reading) const override {
    const fsr::matrix::Layout& layout = setup_.campaign.layout;
    const double size = size_ * row_[layout.row({taxel})];
    const double later = 2 * M_PI * mains_ * taxel_time_ * static_cast<double>(taxel);
    for (std::size_t scan = 0; scan < reading.size(); ++scan) {
      reading[scan] += size * wave(scan, phase_[scan] + later);
    }
  }

 protected:
  explicit Pickup(const HiddenSetup& setup)
      : setup_(setup), random_(setup.seed, "mains"), phase_(setup.campaign.scans()) {
    size_ = random_.uniform(0.008, 0.015) * setup.strength;
    const double most = 0.9 * setup.campaign.scan_period / static_cast<double>(setup.campaign.taxels());
    taxel_time_ = std::min(random_.uniform(0.2e-3, 1.1e-3), most);
    mains_ = random_.chance(0.7) ? 50 : 60;
    for (std::size_t i = 0; i < setup.campaign.layout.size.rows; ++i)
      row_.push_back(random_.uniform(0.5, 1.5));
    parameters_ = {{"amplitude", size_, "share of full scale"},
                   {"mains", mains_, "Hz"},
                   {"time_per_taxel", taxel_time_, "s"}};
  }
  virtual double wave(std::size_t, double phase) const { return std::sin(phase); }

  // Phase of the hum at each scan, for a frequency of `mains_` + off(scan) [Hz].
  template <typename Off>
  void integrate(Off off) {
    double turns = random_.uniform();
    double before = 0;
    for (std::size_t scan = 0; scan < phase_.size(); ++scan) {
      const double now = setup_.campaign.time[scan];
      turns += (mains_ + off(scan)) * (now - before);
      turns -= std::floor(turns);
      phase_[scan] = 2 * M_PI * turns;
      before = now;
    }
  }
  // One step of an Ornstein-Uhlenbeck process about 0 with a deviation and a time constant [s].
  double wander(double value, double deviation, double time_constant) {
    const double keep = std::exp(-setup_.campaign.scan_period / time_constant);
    return keep * value + deviation * std::sqrt(1 - keep * keep) * random_.normal();
  }

  HiddenSetup setup_;
  Random random_;
  double size_ = 0;        // [share of full scale]
  double taxel_time_ = 0;  // time from one taxel of a scan to the next [s]
  double mains_ = 50;      // [Hz]
  std::vector<double> row_;
  Trace phase_;
};

// Constant mains frequency; the phase of the coupling takes a random walk.
class WanderingPhase : public Pickup {
 public:
  explicit WanderingPhase(const HiddenSetup& setup) : Pickup(setup) {
    const double beat = random_.sign() * random_.logUniform(0.02, 0.4);  // [Hz]
    integrate([&](std::size_t) { return beat; });
    const double pace = random_.uniform(0.02, 0.08);  // a scan [rad]
    double walk = 0;
    for (double& phase : phase_) {
      walk += pace * random_.normal();
      phase += walk;
    }
    parameters_.push_back({"beat", beat, "Hz"});
    parameters_.push_back({"walk", pace, "rad a scan"});
  }
};

// The frequency of the grid varies about its nominal value.
class WanderingGrid : public Pickup {
 public:
  explicit WanderingGrid(const HiddenSetup& setup) : Pickup(setup) {
    const double deviation = random_.uniform(0.015, 0.03);  // [Hz]
    double off = 0;
    integrate([&](std::size_t) {
      off = wander(off, deviation, 60);
      return off;
    });
    parameters_.push_back({"frequency_deviation", deviation, "Hz"});
  }
};

// Hum of a rectifier: even harmonics with a slowly varying amplitude.
class Swelling : public Pickup {
 public:
  explicit Swelling(const HiddenSetup& setup) : Pickup(setup), swell_(setup.campaign.scans()) {
    const double beat = random_.sign() * random_.logUniform(0.02, 0.3);  // [Hz]
    integrate([&](std::size_t) { return beat; });
    double slow = 0;
    for (double& swell : swell_) {
      slow = wander(slow, 0.35, 90);
      swell = 1 + slow;
    }
    parameters_.push_back({"beat", beat, "Hz"});
  }

 private:
  double wave(std::size_t scan, double phase) const override {
    return swell_[scan] * 1.8 * (std::abs(std::sin(phase)) - 2 / M_PI) + 0.4 * swell_[scan] * std::sin(phase);
  }
  Trace swell_;
};

// Hum of a supply with a capacitor behind its rectifier: the fundamental with odd harmonics.
// Source: IEC 61000-3-2:2018, which limits these harmonics; their shares here are a choice.
class OddHarmonics : public Pickup {
 public:
  explicit OddHarmonics(const HiddenSetup& setup) : Pickup(setup) {
    const double beat = random_.sign() * random_.logUniform(0.02, 0.3);  // [Hz]
    integrate([&](std::size_t) { return beat; });
    double walk = 0;
    for (double& phase : phase_) {
      walk = wander(walk, 0.5, 120);
      phase += walk;
    }
    parameters_.push_back({"beat", beat, "Hz"});
  }

 private:
  double wave(std::size_t, double phase) const override {
    return std::sin(phase) + 0.8 * std::sin(3 * phase) + 0.45 * std::sin(5 * phase) +
           0.2 * std::sin(7 * phase);
  }
};

// A machine on the same line switches on and off: the hum's amplitude has two levels.
// Source: S. Machlup, Noise in semiconductors: spectrum of a two-parameter random signal, J. Appl. Phys. 25
// (1954) 341, for the process between the levels.
class Switched : public Pickup {
 public:
  explicit Switched(const HiddenSetup& setup) : Pickup(setup), level_(setup.campaign.scans()) {
    const double deviation = random_.uniform(0.01, 0.03);  // [Hz]
    double off = 0;
    integrate([&](std::size_t) {
      off = wander(off, deviation, 60);
      return off;
    });
    const double stay = random_.uniform(15, 90);  // [s]
    bool on = random_.chance(0.5);
    for (double& level : level_) {
      if (random_.chance(1 - std::exp(-setup.campaign.scan_period / stay))) on = !on;
      level = on ? 1.5 : 0.3;
    }
    parameters_.push_back({"stay", stay, "s"});
  }

 private:
  double wave(std::size_t scan, double phase) const override { return level_[scan] * std::sin(phase); }
  Trace level_;
};

HiddenForm form(const char* name, std::unique_ptr<Hidden> (*make)(const HiddenSetup&)) {
  return {"mains_pickup", name, {"row", "clock_time"}, make};
}

}  // namespace

std::vector<HiddenForm> mainsPickupForms() {
  return {form("wandering_phase", makeHidden<WanderingPhase>),
          form("wandering_grid", makeHidden<WanderingGrid>), form("swelling", makeHidden<Swelling>),
          form("odd_harmonics", makeHidden<OddHarmonics>), inSetB(form("switched", makeHidden<Switched>))};
}

}  // namespace blind
