// Rate-independent loops of loading against unloading. A sheet reads higher during unloading.

#include <algorithm>
#include <cmath>
#include <utility>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

// Preisach operator with congruent, asymmetric loops, by its Everett function
//     E(a, b) = x^2 / (1 + x) (1 + c (a + b - peak) / peak),  x = (a - b) / d:
// the output increases by 2 E along a branch from the last extremum. Passing an older extremum deletes it.
class PreisachState {
 public:
  PreisachState(double scale, double lopsided) : scale_(scale), lopsided_(lopsided) {}

  void step(double input, double) {
    if (input > input_) turnTo(+1, input);
    if (input < input_) turnTo(-1, input);
    input_ = input;
  }
  double output() const {
    const Extremum& last = memory_.back();
    return last.output + direction_ * 2 * everett(std::max(input_, last.input), std::min(input_, last.input));
  }
  // Midway between the branches of the full loop. It depends on the load alone and so belongs to the static
  // curve.
  double middle() const {
    const double high = std::max(input_, kPeak);
    return everett(std::max(input_, 0.0), std::min(input_, 0.0)) + everett(high, 0) - everett(high, input_);
  }

 private:
  struct Extremum {
    double input, output;
  };
  double everett(double high, double low) const {
    const double x = (high - low) / scale_;
    return x * x / (1 + x) * (1 + lopsided_ * (high + low - kPeak) / kPeak);
  }
  void turnTo(int direction, double input) {
    if (direction != direction_) {
      memory_.push_back({input_, output()});
      direction_ = direction;
    }
    // A branch that leaves its inner loop continues the branch before that loop.
    while (memory_.size() >= 3 && direction * (input - memory_[memory_.size() - 2].input) >= 0) {
      memory_.resize(memory_.size() - 2);
    }
  }

  double scale_, lopsided_;
  double input_ = 0;
  int direction_ = +1;
  std::vector<Extremum> memory_ = {{0, 0}};
};

// Duhem's differential model: the output moves from one branch to the other within a length of load.
struct DuhemState {
  double length;  // [Pa]
  double arm = 0;
  double load = 0;
  void step(double input, double) {
    const double reach = std::sqrt(std::max(input, 0.0) / kPeak) * (input < load ? 1.0 : -1.0);
    if (input != load) arm = reach + (arm - reach) * std::exp(-std::abs(input - load) / length);
    load = input;
  }
};

// Loading always follows the same curve; only unloading lags behind.
struct OneSidedState {
  double length;  // [Pa]
  double lag = 0;
  double load = 0;
  void step(double input, double) {
    const bool down = input < load;
    const double reach = down ? 1.5 * std::pow(std::max(input, 0.0) / kPeak, 0.7) : 0.0;
    const double within = down ? length : 0.3 * length;
    if (input != load) lag = reach + (lag - reach) * std::exp(-std::abs(input - load) / within);
    load = input;
  }
};

// Bouc and Wen's hysteresis: dz/dx = 1 - |z|^n (0.5 + 0.5 sign(z dx)), with the load as x.
// Source: Y. K. Wen, Method for random vibration of hysteretic systems, J. Eng. Mech. Div. ASCE 102 (1976)
// 249.
struct BoucWenState {
  double length;    // load over which a branch closes [Pa]
  double exponent;  // n
  double z = 0;
  double load = 0;
  void step(double input, double) {
    // Steps of at most a tenth of the length, so that the sum stays on the branch.
    const double way = (input - load) / length;
    const int pieces = 1 + static_cast<int>(std::abs(way) / 0.1);
    for (int i = 0; i < pieces; ++i) {
      const double dx = way / pieces;
      z += dx * (1 - std::pow(std::abs(z), exponent) * (z * dx > 0 ? 1.0 : 0.0));
      z = std::clamp(z, -1.0, 1.0);
    }
    load = input;
  }
  // Unloading reads higher; without load the loop is closed.
  double output() const { return (1 - z) * std::pow(std::clamp(load / kPeak, 0.0, 1.2), 0.6); }
};

// Jiles and Atherton's equation: an anhysteretic curve, here Langevin's, that pinning keeps the output from.
// Source: D. C. Jiles, D. L. Atherton, Theory of ferromagnetic hysteresis, J. Magn. Magn. Mater. 61
// (1986) 48.
struct JilesAthertonState {
  double pinning;  // k, share of the peak
  double shape;    // a, share of the peak
  double output = 0;
  double load = 0;  // share of the peak
  void step(double input, double) {
    const double next = std::max(input, 0.0) / kPeak;
    const double way = next - load;
    const int pieces = 1 + static_cast<int>(std::abs(way) / 0.01);
    for (int i = 0; i < pieces; ++i) {
      load += way / pieces;
      const double off = anhysteretic(load) - output;
      // Only what lies ahead moves the output.
      if (off * way > 0) output += std::abs(way / pieces) / pinning * off;
    }
    load = next;
  }
  double anhysteretic(double at) const {
    const double x = at / shape;
    return x < 1e-3 ? x / 3 : 1 / std::tanh(x) - 1 / x;
  }
  double lag() const { return output - anhysteretic(load); }
};

// Adds size * value(state), with a state that starts as `fresh`.
template <typename State, typename Value>
class Loop : public Hidden {
 public:
  Loop(const HiddenSetup& setup, double size, const std::vector<HiddenParameter>& parameters, State fresh,
       Value value)
      : setup_(setup),
        size_(size * setup.strength),
        scatter_(taxelScatter(setup, "loop scatter", 0.1)),
        fresh_(std::move(fresh)),
        value_(value) {
    parameters_ = {{"loop_size", size_, "Pa"}};
    parameters_.insert(parameters_.end(), parameters.begin(), parameters.end());
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    const Trace before = load;
    const double size = size_ * scatter_[taxel];
    follow(
        setup_, fresh_, [&](std::size_t scan) { return before[scan]; },
        [&](std::size_t scan, const State& state) { load[scan] += size * value_(state); });
  }

 private:
  HiddenSetup setup_;
  double size_;  // [Pa]
  std::vector<double> scatter_;
  State fresh_;
  Value value_;
};

template <typename State, typename Value>
std::unique_ptr<Hidden> loop(const HiddenSetup& setup, double size,
                             const std::vector<HiddenParameter>& parameters, State fresh, Value value) {
  return std::make_unique<Loop<State, Value>>(setup, size, parameters, std::move(fresh), value);
}

double draw(const HiddenSetup& setup, const char* purpose, double low, double high) {
  return Random(setup.seed, purpose).uniform(low, high);
}

std::unique_ptr<Hidden> preisach(const HiddenSetup& setup) {
  const double scale = draw(setup, "preisach scale", 180e3, 350e3);
  const double lopsided = draw(setup, "preisach side", -0.3, 0.3);
  return loop(setup, draw(setup, "preisach", 35e3, 55e3),
              {{"scale", scale, "Pa"}, {"lopsided", lopsided, "1"}}, PreisachState(scale, lopsided),
              [](const PreisachState& state) { return state.output() - state.middle(); });
}

std::unique_ptr<Hidden> duhem(const HiddenSetup& setup) {
  const double length = draw(setup, "duhem length", 60e3, 180e3);
  return loop(setup, draw(setup, "duhem", 15e3, 28e3), {{"length", length, "Pa"}}, DuhemState{length},
              [](const DuhemState& state) { return state.arm; });
}

std::unique_ptr<Hidden> oneSided(const HiddenSetup& setup) {
  const double length = draw(setup, "one-sided length", 80e3, 200e3);
  return loop(setup, draw(setup, "one-sided", 20e3, 35e3), {{"length", length, "Pa"}}, OneSidedState{length},
              [](const OneSidedState& state) { return state.lag; });
}

std::unique_ptr<Hidden> boucWen(const HiddenSetup& setup) {
  const double length = draw(setup, "bouc-wen length", 60e3, 160e3);
  const double exponent = draw(setup, "bouc-wen exponent", 1, 2);
  return loop(setup, draw(setup, "bouc-wen", 12e3, 22e3),
              {{"length", length, "Pa"}, {"exponent", exponent, "1"}}, BoucWenState{length, exponent},
              [](const BoucWenState& state) { return state.output(); });
}

std::unique_ptr<Hidden> jilesAtherton(const HiddenSetup& setup) {
  const double pinning = draw(setup, "pinning", 0.12, 0.3), shape = draw(setup, "langevin", 0.15, 0.4);
  return loop(setup, draw(setup, "jiles-atherton", 60e3, 100e3),
              {{"pinning", pinning * kPeak, "Pa"}, {"langevin_scale", shape * kPeak, "Pa"}},
              JilesAthertonState{pinning, shape},
              [](const JilesAthertonState& state) { return state.lag(); });
}

HiddenForm form(const char* name, std::unique_ptr<Hidden> (*make)(const HiddenSetup&)) {
  HiddenForm form{"hysteresis", name, {"direction", "pressure"}, make};
  form.may_be_local = form.has_state = true;
  return form;
}

}  // namespace

std::vector<HiddenForm> hysteresisForms() {
  return {form("preisach", preisach), form("duhem", duhem), form("one_sided", oneSided),
          form("bouc_wen", boucWen), inSetB(form("jiles_atherton", jilesAtherton))};
}

}  // namespace blind
