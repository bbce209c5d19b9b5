#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "regression/code_statistics.h"

namespace fsr::regression {

/// Held-out errors of one model by code, and the table of deviations that follows from them.
class HeldOutErrors {
 public:
  explicit HeldOutErrors(std::uint16_t full_scale) : codes_(full_scale + 1u) {}

  /// Adds the errors of `pressure` [codes] [Pa] on the readings of the next section. The model behind
  /// `pressure` must not have been trained on that section.
  void addSection(const CodeStatistics& held_out, const std::vector<double>& pressure);

  /// Whether no section had a reading.
  bool empty() const;

  /// All sections.
  static constexpr std::size_t kNoneLeftOut = static_cast<std::size_t>(-1);

  /// One standard deviation of a held-out reading at each code [Pa], > 0. It is the root mean squared error
  /// of the code, shrunk towards that of neighbouring codes where the code is rare, and towards that of all
  /// codes where the neighbourhood is rare. It is scaled so that 68 % of the errors are within one deviation
  /// (see DeviationScale), and it is at least the pressure step of one count at that code and at least 1 Pa.
  ///
  /// `pressure` [codes] is the model's answer; its slope gives the step. The errors of section `left_out` are
  /// not used.
  std::vector<float> deviation(const std::vector<double>& pressure,
                               std::size_t left_out = kNoneLeftOut) const;

 private:
  // Errors of one code in one section: number, mean and standard deviation [Pa].
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
