// Gas leaks under the sheet. The load on a taxel is the chamber pressure minus the cavity pressure, which
// follows the chamber within minutes to hours.

#include <algorithm>
#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

// Leak through an orifice, subsonic: flow proportional to the root of the pressure difference.
struct OrificeState {
  double rate;  // in peak pressures a second, at a difference of the peak [1/s]
  double cavity = 0;
  void step(double pressure, double seconds) {
    const double drive = (pressure - cavity) / kPeak;
    const double flow = kPeak * rate * std::copysign(std::sqrt(std::abs(drive)), drive) * seconds;
    const bool past = std::abs(flow) > std::abs(pressure - cavity);
    cavity = past ? pressure : cavity + flow;
  }
};

// Leak along a narrow gap, laminar and compressible: flow proportional to the difference of the squares.
struct LaminarState {
  double rate;     // [1/s]
  double ambient;  // [Pa]
  double cavity = 0;
  void step(double pressure, double seconds) {
    const double outside = pressure + ambient, inside = cavity + ambient;
    const double share = rate * seconds * (outside + inside) / kPeak;
    cavity += (pressure - cavity) * (1 - std::exp(-share));
  }
};

// The rim fills first, the middle fills from the rim.
struct TwoChamberState {
  double to_rim, to_middle;  // [1/s]
  double rim = 0, middle = 0;
  void step(double pressure, double seconds) {
    const double before = rim;
    rim += (pressure - rim) * (1 - std::exp(-seconds * to_rim));
    middle += (before - middle) * (1 - std::exp(-seconds * to_middle));
  }
};

// A nozzle that is choked while the absolute pressure behind it is below 0.528 of that before it.
// Source: ISO 6358-1:2013, sonic conductance with an elliptic law below the critical pressure ratio.
struct ChokedState {
  double rate;     // [1/s]
  double ambient;  // [Pa]
  double cavity = 0;
  void step(double pressure, double seconds) {
    constexpr double kCritical = 0.528;
    const double before = std::max(pressure, cavity) + ambient, behind = std::min(pressure, cavity) + ambient;
    const double over = std::max(0.0, (behind / before - kCritical) / (1 - kCritical));
    const double flow = rate * before * std::sqrt(std::max(0.0, 1 - over * over)) * seconds;
    const double ahead = pressure - cavity;
    cavity += std::abs(flow) > std::abs(ahead) ? ahead : std::copysign(flow, ahead);
  }
};

// Gas diffuses through a porous backing: the series of a slab of which one face follows the chamber.
// Source: J. Crank, The Mathematics of Diffusion, 2nd edition, Oxford, 1975, chapter 4.
struct PorousState {
  double rate;  // of the slowest term [1/s]
  double lag[4] = {0, 0, 0, 0};
  void step(double pressure, double seconds) {
    for (int k = 0; k < 4; ++k) {
      const double odd = 2 * k + 1;
      lag[k] += (pressure - lag[k]) * (1 - std::exp(-seconds * rate * odd * odd));
    }
  }
  double cavity() const {
    const double weights = 1 + 1 / 9.0 + 1 / 25.0 + 1 / 49.0;
    return (lag[0] + lag[1] / 9 + lag[2] / 25 + lag[3] / 49) / weights;
  }
};

class Leak : public Hidden {
 public:
  void onLoad(std::size_t, Trace& load) const override {
    for (std::size_t scan = 0; scan < load.size(); ++scan) load[scan] -= cavity_[scan];
  }

 protected:
  explicit Leak(const HiddenSetup& setup) : setup_(setup), cavity_(setup.campaign.scans()) {
    rate_ = setup.strength / Random(setup.seed, "leak").uniform(2000, 5000);
    parameters_ = {{"rate", rate_, "1/s"}};
  }
  template <typename State, typename Use>
  void fill(const State& fresh, Use use) {
    const Trace& pressure = setup_.campaign.pressure;
    follow(
        setup_, fresh, [&](std::size_t scan) { return pressure[scan]; }, use);
  }
  HiddenSetup setup_;
  double rate_;   // [1/s]
  Trace cavity_;  // [Pa]
};

class Orifice : public Leak {
 public:
  explicit Orifice(const HiddenSetup& setup) : Leak(setup) {
    fill(OrificeState{rate_}, [&](std::size_t scan, const OrificeState& s) { cavity_[scan] = s.cavity; });
  }
};

class Laminar : public Leak {
 public:
  explicit Laminar(const HiddenSetup& setup) : Leak(setup) {
    fill(LaminarState{rate_, setup.campaign.ambient()},
         [&](std::size_t scan, const LaminarState& s) { cavity_[scan] = s.cavity; });
  }
};

class Choked : public Leak {
 public:
  explicit Choked(const HiddenSetup& setup) : Leak(setup) {
    fill(ChokedState{rate_, setup.campaign.ambient()},
         [&](std::size_t scan, const ChokedState& s) { cavity_[scan] = s.cavity; });
  }
};

class Porous : public Leak {
 public:
  explicit Porous(const HiddenSetup& setup) : Leak(setup) {
    fill(PorousState{rate_}, [&](std::size_t scan, const PorousState& s) { cavity_[scan] = s.cavity(); });
  }
};

class TwoChamber : public Leak {
 public:
  explicit TwoChamber(const HiddenSetup& setup) : Leak(setup), middle_(setup.campaign.scans()) {
    const double further = 1 / Random(setup.seed, "middle").uniform(100, 400);  // [1/s]
    parameters_.push_back({"rim_to_middle", further, "1/s"});
    fill(TwoChamberState{rate_, further}, [&](std::size_t scan, const TwoChamberState& s) {
      cavity_[scan] = s.rim;
      middle_[scan] = s.middle;
    });
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    const double share = depth(taxel);
    for (std::size_t scan = 0; scan < load.size(); ++scan) {
      load[scan] -= cavity_[scan] + share * (middle_[scan] - cavity_[scan]);
    }
  }

 private:
  // 0 on the outermost taxels, 1 in the middle of the sheet.
  double depth(std::size_t taxel) const {
    const fsr::matrix::Layout& layout = setup_.campaign.layout;
    const double rows = layout.size.rows - 1.0, columns = layout.size.columns - 1.0;
    const double row = layout.row({taxel}), column = layout.column({taxel});
    const double nearest = std::min({row, rows - row, column, columns - column});
    return std::min(1.0, nearest / std::max(1.0, std::floor(std::min(rows, columns) / 2)));
  }
  Trace middle_;  // [Pa]
};

HiddenForm form(const char* name, std::unique_ptr<Hidden> (*make)(const HiddenSetup&)) {
  HiddenForm form{"seal_leak", name, {"time_since_reversal"}, make};
  form.has_state = true;
  return form;
}

}  // namespace

std::vector<HiddenForm> sealLeakForms() {
  return {form("orifice", makeHidden<Orifice>), form("laminar", makeHidden<Laminar>),
          form("two_chamber", makeHidden<TwoChamber>), form("porous", makeHidden<Porous>),
          inSetB(form("choked", makeHidden<Choked>))};
}

}  // namespace blind
