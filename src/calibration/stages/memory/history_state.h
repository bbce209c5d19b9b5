#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/calibration/history.h"
#include "rheology/memory.h"

namespace fsr::calibration {

/// Place of a number between evenly spaced knots.
struct EvenPlace {
  std::size_t below = 0;  ///< knot below; at most the last but one
  double share = 0;       ///< of the knot above, 0 to 1
};

/// A line of straight pieces between evenly spaced knots, constant beyond them.
class EvenLine {
 public:
  EvenLine() = default;
  /// `knots`: two or more, evenly spaced and ascending, one for each of `values`.
  EvenLine(const std::vector<double>& knots, std::vector<double> values)
      : first_(knots.front()),
        per_unit_(static_cast<double>(knots.size() - 1) / (knots.back() - knots.front())),
        values_(std::move(values)) {}

  static EvenPlace place(double x, double first, double per_unit, std::size_t knots) {
    const double last = static_cast<double>(knots - 1);
    const double at = std::min(std::max((x - first) * per_unit, 0.0), last);
    const auto below = std::min(static_cast<std::size_t>(at), knots - 2);
    return {below, at - static_cast<double>(below)};
  }

  double operator()(double x) const {
    const EvenPlace at = place(x, first_, per_unit_, values_.size());
    return values_[at.below] + at.share * (values_[at.below + 1] - values_[at.below]);
  }

 private:
  double first_ = 0;
  double per_unit_ = 0;  // knots for each unit
  std::vector<double> values_;
};

/// Play operators and fading memories that are driven by one input. The operators are constant; the caller
/// stores the state, one number for each operator, plays first.
class HistoryOperators {
 public:
  /// `radii` [in the unit of the input], `time_constants` [s], each above 0, else std::invalid_argument.
  HistoryOperators(std::vector<double> radii, const std::vector<double>& time_constants);

  std::size_t size() const { return radii_.size() + memories_.size(); }
  std::size_t plays() const { return radii_.size(); }
  std::size_t memories() const { return memories_.size(); }

  /// Sets the state as after a long time at the input `x`.
  void start(double x, double* state) const {
    for (std::size_t k = 0; k < size(); ++k) state[k] = x;
  }

  /// Sets the state for a first input `x` on a sheet that was conditioned: no input is ever below 0, and
  /// there was one above 2 r before. Then a play is never below r, and it lies between max(r, x - r) and x +
  /// r; it starts in the middle. At x = 0 this is x + r: the branch of unloading. Memories start as after a
  /// long time at x.
  void startConditioned(double x, double* state) const {
    start(x, state);
    for (std::size_t j = 0; j < radii_.size(); ++j)
      state[j] = std::max(x, std::min(radii_[j] + x / 2, radii_[j] + x));
  }

  /// The steps of the memories over `duration` [s], 0 or more; `steps` has memories() entries.
  void stepsOver(double duration, rheology::ExponentialMemory::Step* steps) const {
    for (std::size_t k = 0; k < memories_.size(); ++k) steps[k] = memories_[k].over(duration);
  }

  /// Changes the state of the plays for an input that went to `to`.
  void advancePlays(double to, double* state) const {
    for (std::size_t j = 0; j < radii_.size(); ++j) state[j] = rheology::playStep(to, radii_[j], state[j]);
  }

  /// Changes the state for an input that went linearly from `from` to `to`.
  void advance(double from, double to, const rheology::ExponentialMemory::Step* steps, double* state) const {
    advancePlays(to, state);
    double* const memory = state + radii_.size();
    for (std::size_t k = 0; k < memories_.size(); ++k) memory[k] = steps[k](from, to, memory[k]);
  }

 private:
  std::vector<double> radii_;
  std::vector<rheology::ExponentialMemory> memories_;
};

/// The memory of every taxel of a live map. All memory is allocated by the constructor.
///
/// A taxel is settled once what is not known of the time before its first reading no longer matters: after
/// HistoryModel::settlingTime(), and once HistoryModel::playsOwe() less than the smallest deviation. That is
/// so after a wide change of load, and at rest, where the plays cannot be elsewhere. Until then the static
/// answer stands. The same holds after a spell in which the taxel alone had no reading: its state steps over
/// the spell as if the load had changed evenly, and it is settled again once what is not known of the spell
/// no longer matters.
class HistoryState {
 public:
  /// `model` must be present().
  HistoryState(const HistoryModel& model, std::size_t taxels);

  /// Forgets the readings of all taxels, or of one.
  void forget() noexcept;
  void forget(std::size_t taxel) noexcept { known_[taxel] = Known::kNothing; }
  /// The sheet has lain at rest for long: with their next reading all taxels are settled there.
  void rest() noexcept;

  /// Begins the scan of `time` [s]. Time that runs back, or a gap longer than the settling time of the
  /// memories (without memories: than kLongestGap), forgets all readings.
  void beginScan(double time) noexcept;

  /// Corrects the static answer of one taxel in the scan that was begun; `pressure` and `deviation` [Pa] are
  /// changed only if the taxel is settled. Returns whether it is. `frozen`, or a pressure that is not finite:
  /// the reading is none, and the taxel is not settled.
  bool correct(std::size_t taxel, bool frozen, float& pressure, float& deviation) noexcept;

  /// The reading is saturated, and `pressure` [Pa] a lower limit. Plays that the way
  /// back from there to the next reading moves are settled then.
  void atLeast(std::size_t taxel, double pressure) noexcept;

  static constexpr double kLongestGap = 60;  ///< [s]

 private:
  enum class Known : std::uint8_t { kNothing, kRest, kReadings };
  static constexpr double kNoLimit = 1e30;  // [Pa]
  struct Taxel {
    double last = 0;           // x of its last reading [Pa]
    double at = 0;             // time of its last reading [s]
    double lowest = 0;         // x since the first reading, or since a spell without one [Pa]
    double highest = 0;        // likewise
    double since = 0;          // time from which on the memories know their input [s]
    double limit = -kNoLimit;  // of atLeast(), since its last reading [Pa]
    bool settled = false;
  };

  using Steps = std::vector<rheology::ExponentialMemory::Step>;

  bool settled(const Taxel& taxel) const noexcept;
  const Steps& stepsOfSpell(double duration) noexcept;
  double memoriesMiss(const Steps& steps) const noexcept;

  HistoryModel model_;
  HistoryOperators operators_;
  std::vector<double> weights_;  // of the operators
  double weight_sum_ = 0;
  EvenLine correction_;
  EvenLine loading_deviation_;
  EvenLine unloading_deviation_;
  double settling_time_;  // [s]
  double allowed_;        // that the plays may owe [Pa]
  double longest_gap_;    // [s]

  bool started_ = false;
  double time_ = 0;       // of the scan [s]
  double before_ = 0;     // time of the scan before [s]
  double duration_ = -1;  // that steps_ are for [s]
  double spell_ = -1;     // that spell_steps_ are for [s]
  Steps steps_, spell_steps_;
  std::vector<Known> known_;    // [taxels]
  std::vector<Taxel> taxels_;   // [taxels]
  std::vector<double> states_;  // [taxels x operators]
};

}  // namespace fsr::calibration
