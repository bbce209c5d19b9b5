#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compensation/even_line.h"
#include "compensation/history_operators.h"
#include "fsr_pressure_map/compensation/history.h"

namespace fsr::compensation {

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

}  // namespace fsr::compensation
