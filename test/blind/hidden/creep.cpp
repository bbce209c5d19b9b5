// The reading increases under constant load.

#include <algorithm>
#include <array>
#include <cmath>

#include "blind/hidden/forms.h"

namespace blind {

namespace {

// Power law J(t) ~ t^n over seven decades: one lag for each decade from 10 ms to 10^5 s.
struct PowerLawState {
  static constexpr std::size_t kDecades = 8;
  std::array<double, kDecades> weight{};
  std::array<double, kDecades> rate{};  // [1/s]
  std::array<double, kDecades> lag{};

  explicit PowerLawState(double exponent) {
    for (std::size_t k = 0; k < kDecades; ++k) {
      const double time_constant = std::pow(10.0, static_cast<double>(k) - 2);  // [s]
      rate[k] = 1 / time_constant;
      weight[k] = std::pow(time_constant, exponent);
    }
  }
  void step(double input, double seconds) {
    for (std::size_t k = 0; k < kDecades; ++k) {
      const double x = seconds * rate[k];
      lag[k] += (input - lag[k]) * (x < 0.02 ? x - x * x / 2 : 1 - std::exp(-x));
    }
  }
  double sum() const {
    double total = 0;
    for (std::size_t k = 0; k < kDecades; ++k) total += weight[k] * lag[k];
    return total;
  }
};

// Logarithmic growth: dx/dt = load exp(-x) / t0 gives ln(1 + t / t0) under constant load. Without load it
// recovers with a time constant.
struct LogTimeState {
  double start;    // t0 [s]
  double healing;  // [s]
  double x = 0;
  void step(double input, double seconds) {
    const double share = std::clamp(input / kPeak, 0.0, 1.2);
    // The exact solution over one step, because the first growth may be faster than the scan rate.
    x = std::log(std::exp(x) + share * seconds / start);
    x -= x * std::max(0.0, 1 - 3 * share) * (1 - std::exp(-seconds / healing));
  }
};

// A softening driven by the root of the load; it increases faster than it decreases.
struct SofteningState {
  double up, down;  // [s]
  double x = 0;
  void step(double input, double seconds) {
    const double drive = std::sqrt(std::max(input, 0.0) / kPeak);
    x += (drive - x) * (1 - std::exp(-seconds / (drive > x ? up : down)));
  }
};

// Kohlrausch's stretched exponential exp(-(t / t0)^0.5), as a sum of lags: its distribution of time constants
// is t^0.5 exp(-t / (4 t0)) for each unit of ln t. Source: G. Williams, D. C. Watts, Non-symmetrical
// dielectric relaxation behaviour arising from a simple empirical decay function, Trans. Faraday Soc. 66
// (1970) 80.
struct StretchedState {
  static constexpr std::size_t kLags = 14;
  std::array<double, kLags> weight{}, rate{}, lag{};
  explicit StretchedState(double start) {
    double total = 0;
    for (std::size_t k = 0; k < kLags; ++k) {
      const double relative = std::pow(2.0, static_cast<double>(k) - 9);  // 1/512 to 16 of t0
      rate[k] = 1 / (relative * start);
      weight[k] = std::sqrt(relative) * std::exp(-relative / 4);
      total += weight[k];
    }
    for (double& w : weight) w /= total;
  }
  void step(double input, double seconds) {
    for (std::size_t k = 0; k < kLags; ++k) lag[k] += (input - lag[k]) * (1 - std::exp(-seconds * rate[k]));
  }
  double sum() const {
    double total = 0;
    for (std::size_t k = 0; k < kLags; ++k) total += weight[k] * lag[k];
    return total;
  }
};

// Flow over barriers that the load lowers: dx/dt = rate sinh((load - x) / scale).
// Source: H. Eyring, Viscosity, plasticity, and diffusion as examples of absolute reaction rates, J. Chem.
// Phys. 4 (1936) 283.
struct EyringState {
  double rate;   // [1/s]
  double scale;  // share of the peak
  double x = 0;  // share of the peak
  void step(double input, double seconds) {
    const double share = std::clamp(input / kPeak, 0.0, 1.3);
    const int pieces = 1 + static_cast<int>(std::min(seconds / 0.2, 20.0));
    for (int i = 0; i < pieces; ++i) {
      const double ahead = share - x;
      const double way = rate * scale * std::sinh(std::clamp(ahead / scale, -30.0, 30.0)) * seconds / pieces;
      x += std::abs(way) > std::abs(ahead) ? ahead : way;
    }
  }
};

class Creep : public Hidden {
 protected:
  Creep(const HiddenSetup& setup, double size)
      : setup_(setup), size_(size * setup.strength), scatter_(taxelScatter(setup, "creep scatter", 0.1)) {
    parameters_ = {{"size", size_, "1"}};
  }
  HiddenSetup setup_;
  double size_;
  std::vector<double> scatter_;
};

class PowerLawCreep : public Creep {
 public:
  explicit PowerLawCreep(const HiddenSetup& setup)
      : Creep(setup, Random(setup.seed, "creep size").uniform(0.012, 0.02)),
        exponent_(Random(setup.seed, "creep exponent").uniform(0.06, 0.16)) {
    parameters_.push_back({"exponent", exponent_, "1"});
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    const Trace before = load;
    follow(
        setup_, PowerLawState(exponent_), [&](std::size_t scan) { return before[scan]; },
        [&](std::size_t scan, const PowerLawState& s) { load[scan] += size_ * scatter_[taxel] * s.sum(); });
  }

 private:
  double exponent_;
};

class LogTimeCreep : public Creep {
 public:
  explicit LogTimeCreep(const HiddenSetup& setup)
      : Creep(setup, Random(setup.seed, "creep size").uniform(0.012, 0.022)),
        fresh_{Random(setup.seed, "creep start").logUniform(0.3, 2),
               Random(setup.seed, "healing").uniform(20, 80)} {
    parameters_.push_back({"start", fresh_.start, "s"});
    parameters_.push_back({"healing", fresh_.healing, "s"});
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    const Trace before = load;
    follow(
        setup_, fresh_, [&](std::size_t scan) { return before[scan]; },
        [&](std::size_t scan, const LogTimeState& state) {
          load[scan] *= 1 + size_ * scatter_[taxel] * state.x;
        });
  }

 private:
  LogTimeState fresh_;
};

class Softening : public Creep {
 public:
  explicit Softening(const HiddenSetup& setup)
      : Creep(setup, Random(setup.seed, "creep size").uniform(0.05, 0.09)),
        fresh_{Random(setup.seed, "up").uniform(25, 60), Random(setup.seed, "down").uniform(90, 200)} {
    parameters_.push_back({"up", fresh_.up, "s"});
    parameters_.push_back({"down", fresh_.down, "s"});
  }
  void onGain(std::size_t taxel, Trace& gain) const override {
    const Trace& pressure = setup_.campaign.pressure;
    follow(
        setup_, fresh_, [&](std::size_t scan) { return pressure[scan]; },
        [&](std::size_t scan, const SofteningState& state) {
          gain[scan] *= 1 + size_ * scatter_[taxel] * state.x;
        });
  }

 private:
  SofteningState fresh_;
};

class StretchedCreep : public Creep {
 public:
  explicit StretchedCreep(const HiddenSetup& setup)
      : Creep(setup, Random(setup.seed, "creep size").uniform(0.08, 0.14)),
        start_(Random(setup.seed, "stretched start").logUniform(5, 60)) {
    parameters_.push_back({"start", start_, "s"});
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    const Trace before = load;
    follow(
        setup_, StretchedState(start_), [&](std::size_t scan) { return before[scan]; },
        [&](std::size_t scan, const StretchedState& s) { load[scan] += size_ * scatter_[taxel] * s.sum(); });
  }

 private:
  double start_;
};

class EyringCreep : public Creep {
 public:
  explicit EyringCreep(const HiddenSetup& setup)
      : Creep(setup, Random(setup.seed, "creep size").uniform(0.08, 0.15)),
        fresh_{Random(setup.seed, "eyring rate").logUniform(2e-4, 2e-3),
               Random(setup.seed, "eyring scale").uniform(0.08, 0.16)} {
    parameters_.push_back({"rate", fresh_.rate, "1/s"});
    parameters_.push_back({"scale", fresh_.scale * kPeak, "Pa"});
  }
  void onLoad(std::size_t taxel, Trace& load) const override {
    const Trace before = load;
    follow(
        setup_, fresh_, [&](std::size_t scan) { return before[scan]; },
        [&](std::size_t scan, const EyringState& s) { load[scan] += size_ * scatter_[taxel] * s.x * kPeak; });
  }

 private:
  EyringState fresh_;
};

HiddenForm form(const char* name, std::unique_ptr<Hidden> (*make)(const HiddenSetup&)) {
  HiddenForm form{"creep", name, {"time_since_reversal"}, make};
  form.may_be_local = form.has_state = true;
  return form;
}

}  // namespace

std::vector<HiddenForm> creepForms() {
  return {form("power_law", makeHidden<PowerLawCreep>), form("log_time", makeHidden<LogTimeCreep>),
          form("multiplicative", makeHidden<Softening>), form("stretched", makeHidden<StretchedCreep>),
          inSetB(form("eyring", makeHidden<EyringCreep>))};
}

}  // namespace blind
