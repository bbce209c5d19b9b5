// Rate-independent loops of loading against unloading. A sheet reads higher during unloading.

#include <algorithm>
#include <cmath>

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

class Loop : public Hidden {
 protected:
  Loop(const HiddenSetup& setup, double size)
      : setup_(setup), size_(size * setup.strength), scatter_(taxelScatter(setup, "loop scatter", 0.1)) {
    parameters_ = {{"loop_size", size_, "Pa"}};
  }
  template <typename State, typename Value>
  void addTo(Trace& load, std::size_t taxel, const State& fresh, Value value) const {
    const Trace before = load;
    const double size = size_ * scatter_[taxel];
    follow(
        setup_, fresh, [&](std::size_t scan) { return before[scan]; },
        [&](std::size_t scan, const State& state) { load[scan] += size * value(state); });
  }
  HiddenSetup setup_;
  double size_;  // [Pa]
  std::vector<double> scatter_;
};

class Preisach : public Loop {
 public:
  explicit Preisach(const HiddenSetup& setup)
      : Loop(setup, Random(setup.seed, "preisach").uniform(35e3, 55e3)),
        scale_(Random(setup.seed, "preisach scale").uniform(180e3, 350e3)),
        lopsided_(Random(setup.seed, "preisach side").uniform(-0.3, 0.3)) {
    parameters_.push_back({"scale", scale_, "Pa"});
    parameters_.push_back({"lopsided", lopsided_, "1"});
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    const auto loop = [](const PreisachState& state) { return state.output() - state.middle(); };
    addTo(load, taxel, PreisachState(scale_, lopsided_), loop);
  }

 private:
  double scale_, lopsided_;
};

class Duhem : public Loop {
 public:
  explicit Duhem(const HiddenSetup& setup)
      : Loop(setup, Random(setup.seed, "duhem").uniform(15e3, 28e3)),
        length_(Random(setup.seed, "duhem length").uniform(60e3, 180e3)) {
    parameters_.push_back({"length", length_, "Pa"});
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    addTo(load, taxel, DuhemState{length_}, [](const DuhemState& state) { return state.arm; });
  }

 private:
  double length_;
};

class OneSided : public Loop {
 public:
  explicit OneSided(const HiddenSetup& setup)
      : Loop(setup, Random(setup.seed, "one-sided").uniform(20e3, 35e3)),
        length_(Random(setup.seed, "one-sided length").uniform(80e3, 200e3)) {
    parameters_.push_back({"length", length_, "Pa"});
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    addTo(load, taxel, OneSidedState{length_}, [](const OneSidedState& state) { return state.lag; });
  }

 private:
  double length_;
};

HiddenForm form(const char* name, std::unique_ptr<Hidden> (*make)(const HiddenSetup&)) {
  HiddenForm form{"hysteresis", name, {"direction", "pressure"}, make};
  form.may_be_local = form.has_state = true;
  return form;
}

}  // namespace

std::vector<HiddenForm> hysteresisForms() {
  return {form("preisach", makeHidden<Preisach>), form("duhem", makeHidden<Duhem>),
          form("one_sided", makeHidden<OneSided>)};
}

}  // namespace blind
