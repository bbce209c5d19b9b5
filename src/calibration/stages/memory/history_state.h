#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
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

  EvenPlace placeOf(double x) const { return place(x, first_, per_unit_, values_.size()); }
  /// The line through `values`, one for each knot.
  static double between(const std::vector<double>& values, const EvenPlace& place) {
    return values[place.below] + place.share * (values[place.below + 1] - values[place.below]);
  }
  double at(const EvenPlace& place) const { return between(values_, place); }
  double operator()(double x) const { return at(placeOf(x)); }

 private:
  double first_ = 0;
  double per_unit_ = 0;  // knots for each unit
  std::vector<double> values_;
};

/// The course of one taxel, as training and the live map follow it.
struct HistoryTaxel {
  enum class Known : std::uint8_t { kNothing, kRest, kReadings };

  Known known = Known::kNothing;  ///< of the time before its next reading
  bool open = false;              ///< something of its operators is open
  double last = 0;                ///< x of its last reading [Pa]
  double at = 0;                  ///< time of its last reading [s]
  double limit = 0;               ///< least pressure of its last saturated scan [Pa]
  double limited_at = -std::numeric_limits<double>::infinity();  ///< time of that scan [s]
};

/// Inputs between scans that are further apart are not known [s].
constexpr double kLongestGap = 60;

/// Play operators and fading memories that are driven by one input. The operators are constant. The caller
/// stores two arrays with a number for each operator, plays first: `state`, the estimate, and `open`, what is
/// not known of it. A play lies within `open` [unit of the input] of its state; `open` of a memory is the
/// share of its value that stems from inputs that were not seen, 0 to 1.
class HistoryOperators {
 public:
  using Step = rheology::ExponentialMemory::Step;

  /// `radii` [in the unit of the input], `time_constants` [s], each above 0, else std::invalid_argument.
  /// `highest`: largest input that the sheet knows.
  HistoryOperators(std::vector<double> radii, const std::vector<double>& time_constants,
                   double highest = std::numeric_limits<double>::infinity());

  std::size_t size() const { return radii_.size() + memories_.size(); }
  std::size_t plays() const { return radii_.size(); }
  std::size_t memories() const { return memories_.size(); }

  /// A first input `x` on a sheet that was conditioned: earlier inputs went from 0 to more than 2 r, and
  /// never beyond `highest`. A play is known at rest, x = 0, where it is on the branch of unloading. Under
  /// load it lies between the branches; it starts in the middle. Memories start as after a long time at x.
  void start(double x, double* state, double* open) const {
    for (std::size_t j = 0; j < radii_.size(); ++j)
      setPlay(possible(x, -kNone, radii_[j]), state[j], open[j]);
    for (std::size_t k = radii_.size(); k < size(); ++k) state[k] = x, open[k] = 1;
  }

  /// The steps of the memories over `duration` [s], 0 or more; `steps` has memories() entries.
  void stepsOver(double duration, Step* steps) const {
    for (std::size_t k = 0; k < memories_.size(); ++k) steps[k] = memories_[k].over(duration);
  }

  /// Changes a state of which all is known, for an input that went linearly from `from` to `to`.
  void advance(double from, double to, const Step* steps, double* state) const {
    for (std::size_t j = 0; j < radii_.size(); ++j) state[j] = rheology::playStep(to, radii_[j], state[j]);
    advanceMemories(from, to, steps, state);
  }

  /// The same where some of it is open. A play is monotone in its state, so the ends of its interval are
  /// advanced like plays. They meet once the input has covered 2 r.
  void advanceOpen(double from, double to, const Step* steps, double* state, double* open) const {
    for (std::size_t j = 0; j < radii_.size(); ++j)
      setPlay({rheology::playStep(to, radii_[j], state[j] - open[j]),
               rheology::playStep(to, radii_[j], state[j] + open[j])},
              state[j], open[j]);
    advanceMemories(from, to, steps, state);
    for (std::size_t k = 0; k < memories_.size(); ++k) {
      double& share = open[radii_.size() + k];
      share *= 1 - steps[k].fade;
      if (share < kNothing) share = 0;  // a smaller number would be slow to compute with
    }
  }

  /// The same over a spell in which the input was not seen. It came from `limit` or more to `to`; -infinity =
  /// nothing is known.
  void advanceUnseen(double from, double to, double limit, const Step* steps, double* state,
                     double* open) const {
    for (std::size_t j = 0; j < radii_.size(); ++j)
      setPlay(possible(to, limit, radii_[j]), state[j], open[j]);
    advanceMemories(from, to, steps, state);
    for (std::size_t k = 0; k < memories_.size(); ++k)
      open[radii_.size() + k] += (1 - open[radii_.size() + k]) * steps[k].fade;
  }

  /// Takes the input `x` at `time` [s] into the course of one sensor; training and live maps call this alone.
  /// `before`: time of the scan before [s]. `steps`: of the time between both. `stepsOf(duration)` returns a
  /// pointer to the steps over a spell without inputs [s].
  template <typename StepsOf>
  void meet(HistoryTaxel& own, double x, double time, double before, const Step* steps, StepsOf&& stepsOf,
            double* state, double* open) const;

  static constexpr double kNone = std::numeric_limits<double>::infinity();
  static constexpr double kNothing = 1e-12;  // share of a memory

 private:
  struct Span {
    double low, high;
  };
  // Where a play can be at the input x, after one of `limit` or more; how much more is then not known.
  Span possible(double x, double limit, double r) const {
    const double high = x + r, top = limit > -kNone ? kNone : std::max(highest_, x);
    const double low = std::min(high, std::max({r, x - r, limit - r}));
    return {low, std::max(low, std::min(high, top - r))};
  }
  static void setPlay(const Span& span, double& state, double& open) {
    state = (span.low + span.high) / 2;
    open = (span.high - span.low) / 2;
  }
  // Whether more than a thousandth of an operator is open.
  bool isOpen(const double* open) const {
    constexpr double kNearlyAll = 1e-3;
    for (std::size_t j = 0; j < radii_.size(); ++j)
      if (open[j] > kNearlyAll * radii_[j]) return true;
    return std::any_of(open + radii_.size(), open + size(), [](double share) { return share > kNearlyAll; });
  }
  void advanceMemories(double from, double to, const Step* steps, double* state) const {
    double* const memory = state + radii_.size();
    for (std::size_t k = 0; k < memories_.size(); ++k) memory[k] = steps[k](from, to, memory[k]);
  }

  std::vector<double> radii_;
  std::vector<rheology::ExponentialMemory> memories_;
  double highest_;
};

template <typename StepsOf>
void HistoryOperators::meet(HistoryTaxel& own, double x, double time, double before, const Step* steps,
                            StepsOf&& stepsOf, double* state, double* open) const {
  if (own.known != HistoryTaxel::Known::kReadings) {
    start(x, state, open);
    own.open = own.known == HistoryTaxel::Known::kNothing;
    own.known = HistoryTaxel::Known::kReadings;
  } else if (own.at < before || time - own.at > kLongestGap) {
    if (!own.open) std::fill_n(open, size(), 0.0);
    advanceUnseen(own.last, x, own.limited_at == before ? own.limit : -kNone, stepsOf(time - own.at), state,
                  open);
    own.open = true;
  } else if (own.open) {
    advanceOpen(own.last, x, steps, state, open);
  } else {
    advance(own.last, x, steps, state);
  }
  if (own.open) own.open = isOpen(open);
  own.last = x;
  own.at = time;
}

/// The standard deviation of an answer from what is open of its operators [Pa]. A load that turned more
/// than 2 r ago left a play at an end of its interval, so its deviation is half the interval. The operators
/// err in the same direction, since the same earlier load moved them all, so their parts add up.
class OpenDeviation {
 public:
  /// `weights` of the operators, plays first; `radii` of the plays; `spreads` of the memories, see
  /// HistoryModel.
  OpenDeviation(std::vector<double> weights, const std::vector<double>& radii,
                const std::vector<double>& spreads);
  double operator()(const double* open) const {
    double sum = 0;
    for (std::size_t k = 0; k < each_.size(); ++k) sum += each_[k] * open[k];
    return sum;
  }
  /// Of the operators, the share that is known where this deviation [Pa] is open. The correction c is the
  /// operators' mean in training with its sign reversed, so it is used as far as they are known: where
  /// nothing is, the static answer stands.
  double knownShare(double deviation) const { return 1 - std::min(deviation * per_whole_, 1.0); }

 private:
  std::vector<double> each_;  // of open = 1 [Pa]
  double per_whole_ = 0;      // 1 / deviation where all is open
};

/// The deviation of an answer from its settled deviation and that of what is open [Pa]. The operators are at
/// one of the ends of what is possible, and the settled error, where it comes from their weights, has the
/// side of that end. If it does in half of the cases and has either side in the others, 68.27 % of the errors
/// are within the open deviation and 0.8 settled ones. Where little is open, the squares add.
double withOpen(double settled, double open);
/// The settled deviation with which an error is just within withOpen() [Pa].
double withoutOpen(double error, double open);

/// What HistoryState says of a reading.
enum class HistoryAnswer : std::uint8_t {
  kNoReading,  ///< the static answer stands
  kOpen,       ///< corrected, but not settled
  kSettled,    ///< what is open makes the deviation at most twice the settled one
};

/// The memory of every taxel of a live map. All memory is allocated by the constructor.
///
/// A taxel has the model's answer from its first reading on. What is not known of the time before makes its
/// deviation larger, and less so as the load moves and time passes. The same holds after a spell in which the
/// taxel had no reading: its state steps over the spell as if the load had changed evenly.
class HistoryState {
 public:
  /// `model` must be present().
  HistoryState(const HistoryModel& model, std::size_t taxels);

  /// Forgets the readings of all taxels, or of one.
  void forget() noexcept;
  void forget(std::size_t taxel) noexcept { taxels_[taxel].known = HistoryTaxel::Known::kNothing; }
  /// The sheet has lain at rest for long: with their next reading all is known of all taxels.
  void rest() noexcept;

  /// Begins the scan of `time` [s]. Time that runs back forgets all readings.
  void beginScan(double time) noexcept;

  /// Corrects the static answer of one taxel in the scan that was begun. `frozen`, or a pressure that is not
  /// finite: the reading is none, and `pressure` and `deviation` [Pa] stay as they are.
  HistoryAnswer correct(std::size_t taxel, bool frozen, float& pressure, float& deviation) noexcept;

  /// The reading is saturated, and `pressure` [Pa] a lower limit.
  void atLeast(std::size_t taxel, double pressure) noexcept;

 private:
  using Steps = std::vector<HistoryOperators::Step>;

  const HistoryOperators::Step* stepsOfSpell(double duration) noexcept;
  void setKnown(HistoryTaxel::Known known) noexcept;

  HistoryOperators operators_;
  std::vector<double> weights_;  // of the operators
  double weight_sum_ = 0;
  EvenLine correction_, least_change_, largest_change_;  // at the same knots
  EvenLine loading_deviation_;
  EvenLine unloading_deviation_;
  OpenDeviation open_deviation_;

  bool started_ = false;
  double time_ = 0;       // of the scan [s]
  double before_ = 0;     // time of the scan before [s]
  double duration_ = -1;  // that steps_ are for [s]
  double spell_ = -1;     // that spell_steps_ are for [s]
  Steps steps_, spell_steps_;
  std::vector<HistoryTaxel> taxels_;  // [taxels]
  std::vector<double> states_;        // [taxels x operators]
  std::vector<double> open_;          // [taxels x operators], while the taxel is open
};

}  // namespace fsr::calibration
