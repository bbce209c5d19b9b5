#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/error_budget.h"

namespace fsr::calibration {

/// "that of the tables", or "that of the tables times 0.92 to 1.31 by pressure".
std::string deviationText(const DeviationScale& scale);

/// Counts the readings by |error| / deviation, in cells of 1/64 of an octave (1.1 %), and finds the factors
/// of ErrorIntervals from them. Its memory does not grow with the number of readings.
class IntervalTally {
 public:
  static constexpr std::size_t kCells = 640;  ///< from 1/32 to 32; the outer ones contain the rest
  static constexpr std::size_t kDirections = 2;
  static constexpr std::size_t kHalves = 2;  ///< of a bin: the scale of the deviation differs between them

  /// Readings of one taxel.
  class Taxel {
   public:
    /// `tally` must outlive the object.
    explicit Taxel(const IntervalTally& tally) : tally_(&tally), counts_(tally.counts_.size()) {}

    /// `pressure`: the answer [Pa]; `ratio`: |error| / deviation. One that is not finite is left out.
    void add(std::size_t unit, double pressure, statistics::LoadDirection direction, double ratio);

   private:
    friend class IntervalTally;
    const IntervalTally* tally_;
    std::vector<std::uint32_t> counts_;  // [units][bins][halves][directions][cells]
  };

  /// No units: nothing is counted. `highest`: pressure of training [Pa].
  IntervalTally(IntervalUnit unit, std::size_t units, std::size_t taxels, double highest);

  std::size_t units() const { return units_; }
  /// Each taxel once. Different taxels may be added at the same time.
  void add(std::size_t taxel, const Taxel& readings);
  ErrorIntervals summarise() const;

 private:
  using Shares = std::array<double, kCells>;  // of the readings at or below each cell

  // Of each unit that has readings in the bins from first to last.
  std::vector<Shares> sharesOf(std::size_t first, std::size_t last) const;
  // By unit; no value for one without readings.
  std::vector<std::optional<Shares>> sharesByUnit(std::size_t first, std::size_t last) const;
  // Middle of a bin, and of its lower (0) or upper (1) half [Pa].
  double middleOf(std::size_t bin) const;
  double middleOf(std::size_t bin, std::size_t half) const;
  // `skipped`: number of a unit that is left out; units_ = none.
  DeviationScale factorsWithout(std::size_t skipped,
                                const std::vector<std::vector<std::optional<Shares>>>& of_bin) const;
  DeviationScale scale() const;
  static std::optional<std::size_t> thresholdOf(const std::vector<const Shares*>& units, double level);
  static BinIntervals intervalsOf(const std::vector<Shares>& units);
  void coverDirections(ErrorIntervals& intervals) const;
  void coverTaxels(ErrorIntervals& intervals) const;

  IntervalUnit unit_;
  std::size_t units_;
  double highest_;  // [Pa]
  std::mutex adding_;
  std::vector<std::uint64_t> counts_;               // of all taxels, as Taxel::counts_
  std::vector<std::vector<std::uint32_t>> taxels_;  // [taxels], of all units: [bins][cells]
};

}  // namespace fsr::calibration
