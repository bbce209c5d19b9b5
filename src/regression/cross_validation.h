#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsr_pressure_map/regression/code_table.h"
#include "regression/code_statistics.h"
#include "regression/regressor.h"

namespace fsr::regression {

/// Share of the readings within one deviation, as for a normal distribution.
constexpr double kShareWithinOneDeviation = 0.6827;

/// Scales root mean squared errors so that kShareWithinOneDeviation of the errors are within one deviation.
/// For normally distributed errors the factor is 1; for errors from hysteresis or from a long rest it is not.
/// The factor is found in up to 16 groups of neighbouring codes, so that the share is right at rest as well
/// as at full load. In a small group the factor is shrunk towards that of all readings.
class DeviationScale {
 public:
  /// `readings` [codes]: number of readings at each code.
  explicit DeviationScale(const std::vector<double>& readings);

  /// `weight` readings at `code` have an error of `ratio` root mean squares, of either sign.
  void add(std::uint16_t code, double ratio, double weight);

  /// The factor at each code: at the centre of a group that of the group, interpolated between centres. 1
  /// everywhere if nothing was added.
  std::vector<double> factors() const;

 private:
  static constexpr std::size_t kGroups = 16;
  static constexpr std::size_t kBins = 512;
  using Histogram = std::array<double, kBins>;

  static double quantile(const Histogram& histogram);

  std::vector<std::uint8_t> group_of_code_;
  std::array<double, kGroups> readings_{};
  std::array<double, kGroups> centre_{};  // mean code
  std::vector<Histogram> ratios_;
};

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

/// A model trained without one section.
struct HeldOutModel {
  std::vector<double> pressure;  ///< of each code [Pa]; empty = no readings were left to train on
  std::vector<float>
      deviation;  ///< of each code [Pa], from the errors on the other sections; empty = not asked for
};

/// One model of one taxel with its held-out deviation.
struct CrossValidatedModel {
  CodeTable table;                     ///< trained on everything
  std::vector<HeldOutModel> held_out;  ///< one for each section
};

/// Whether each held-out model gets a deviation of its own, which scores need.
enum class HeldOutDeviation { kNo, kYes };

/// Assembles the models of a cross-validation: `whole` was trained on all sections, `held_out` [sections]
/// without that section, empty if no readings were left. `sections` has at least one reading in all. If only
/// one section has readings, nothing can be held out, and the deviation is that of the training readings.
CrossValidatedModel assembleModel(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale,
                                  const Fit& whole, std::vector<std::vector<double>> held_out,
                                  HeldOutDeviation held_out_deviation);

}  // namespace fsr::regression
