#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "regression/code_statistics.h"

namespace fsr::regression {

/// Held-out errors of one model by code, and the deviation table that they make.
class HeldOutErrors {
 public:
  explicit HeldOutErrors(std::uint16_t full_scale) : codes_(full_scale + 1u) {}

  /// Errors of `pressure` [Pa, one for each code] on the readings of the next section, none of which
  /// the model behind `pressure` has seen.
  void addSection(const CodeStatistics& held_out, const std::vector<double>& pressure);

  /// No section had a reading.
  bool empty() const;

  /// All sections.
  static constexpr std::size_t kNoneLeftOut = static_cast<std::size_t>(-1);

  /// One standard deviation of a held-out reading at each code [Pa], > 0: the root of the code's
  /// mean squared error, drawn towards that of its neighbourhood where the code is rare and, where
  /// the neighbourhood is rare, towards that of all codes; scaled along the codes so that 68 % of the
  /// errors lie within one (see DeviationScale); never below the pressure step of one count there, nor
  /// below 1 Pa.
  ///
  /// `pressure` is the model's answer at each code, whose slope gives the step. The errors of section
  /// `left_out` do not enter.
  std::vector<float> deviation(const std::vector<double>& pressure,
                               std::size_t left_out = kNoneLeftOut) const;

 private:
  // The errors of one code in one section: their number, mean and spread about the mean [Pa].
  struct Errors {
    std::uint16_t code;
    double count;
    double mean;
    double spread;
  };

  template <typename Visit>
  void forEach(std::size_t left_out, Visit visit) const;
  // Of each code.
  struct Sums {
    std::vector<double> count;
    std::vector<double> squares;  // [Pa^2]
  };
  Sums sums(std::size_t left_out) const;
  std::vector<double> rootMeanSquare(const Sums& sums, std::size_t window) const;
  std::vector<double> scale(const Sums& sums, const std::vector<double>& root, std::size_t left_out) const;

  std::size_t codes_;
  std::vector<std::vector<Errors>> sections_;
};

}  // namespace fsr::regression
