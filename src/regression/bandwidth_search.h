#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "regression/code_statistics.h"
#include "regression/cross_validation.h"
#include "regression/grnn/grnn.h"

namespace fsr::regression {

/// Held-out readings, for the errors of tables on them: number and mean pressure of each code, and the
/// scatter about these means, which no table reduces.
class TestedCodes {
 public:
  void add(const CodeStatistics& readings);
  double readings() const { return readings_; }
  /// Sum of the squared errors of a table with a pressure for each code [Pa^2].
  double squares(const std::vector<double>& pressure) const;

 private:
  std::vector<std::uint16_t> code_;
  std::vector<double> count_, mean_;  // mean [Pa]
  double readings_ = 0;
  double scatter_ = 0;  // [Pa^2]
};

/// Bandwidths to choose from: powers of two, 2^-10 to 2^1.
std::vector<double> bandwidthGrid();

/// Squared held-out errors of GRNNs of several bandwidths, from which one is chosen. The choice for a
/// held-out section must not use that section. It uses models that were trained without two sections, and
/// their errors on the one of the two that is not held out (nested cross-validation).
class BandwidthErrors {
 public:
  static constexpr std::size_t kNoneLeftOut = static_cast<std::size_t>(-1);

  /// Trains K (K + 1) / 2 models of each bandwidth for K sections. `options` gives everything but the
  /// bandwidth. Throws InputError if the options are not mergeable or a bandwidth is not permitted.
  BandwidthErrors(const std::vector<CodeStatistics>& sections, std::uint16_t full_scale,
                  const GrnnOptions& options, const std::vector<double>& grid);

  /// Adds the errors of another model, e.g. of another taxel, for a common choice. Grid and number of
  /// sections must be the same.
  void add(const BandwidthErrors& other);

  /// Sum of squared errors over all sections but `left_out` [Pa^2]. None of the models was trained on
  /// `left_out`.
  double squares(std::size_t bandwidth, std::size_t left_out = kNoneLeftOut) const;

  /// Bandwidth with the smallest sum of squares, the largest of equal ones; kPaperBandwidth if there is
  /// nothing to hold out.
  double best(std::size_t left_out = kNoneLeftOut) const;

  const std::vector<double>& grid() const { return grid_; }

 private:
  // Errors on section `tested` of the model trained without it and without `left_out`.
  double& at(std::size_t bandwidth, std::size_t tested, std::size_t left_out);

  std::vector<double> grid_;
  std::size_t sections_;
  std::vector<double>
      squares_;  // [bandwidths x tested x left out]; left out = tested: only that section is left out
};

}  // namespace fsr::regression
