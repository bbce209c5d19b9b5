#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"

namespace fsr::calibration {

/// Errors of the readings of protocols that were left out, of the static answer and with a history model.
class HistoryErrors {
 public:
  /// `highest`: largest pressure of the bags [Pa].
  explicit HistoryErrors(double highest);

  struct Reading {
    double static_answer = 0;  ///< [Pa]
    double answer = 0;         ///< [Pa]
    double truth = 0;          ///< [Pa]
    bool unloading = false;    ///< as the model sees it, see compensation::HistoryModel
    statistics::LoadDirection direction = statistics::LoadDirection::kNone;  ///< of the chamber
    double since_reversal = 0;                                               ///< [s]
  };
  void add(const Reading& reading);
  void merge(const HistoryErrors& other);

  /// The deviations of a model: in each bin of its answer and each direction the absolute error that 68.27 %
  /// of the readings do not exceed. Bins without readings take that of their neighbour.
  void setDeviation(compensation::HistoryModel& model) const;

  /// All readings; loading and unloading; by time since the last reversal. Parts without readings are absent.
  std::vector<HistoryScore::Part> parts() const;

 private:
  static constexpr std::size_t kBins = 12;     // of the answer, in each direction
  static constexpr std::size_t kLevels = 256;  // of the absolute error, evenly spaced in its logarithm

  struct Sum {
    std::uint64_t readings = 0;
    double static_square = 0, square = 0;                                   // [Pa^2]
    std::array<std::array<std::uint64_t, kLevels>, 2 * kBins> errors = {};  // loading, then unloading
  };

  std::size_t bin(const Reading& reading) const;
  std::vector<double> deviation(std::size_t first_bin) const;
  double quantile(std::size_t bin) const;
  double level(std::size_t number) const;

  double highest_;
  std::vector<Sum> parts_;
};

}  // namespace fsr::calibration
