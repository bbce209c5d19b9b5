#pragma once

#include <Eigen/Dense>
#include <vector>

#include "discrepancy/fit/static_fit.h"
#include "discrepancy/samples/measured.h"
#include "fsr_pressure_map/simulation/effect_info.h"

namespace fsr::discrepancy {

/// Static curves of every taxel, fitted to the cycles that are not held out.
class TaxelFit {
 public:
  TaxelFit(const Measured& measured, const StaticFit& fit);

  /// Reading of every taxel minus its static curve [share of full scale]; 0 for taxels not used.
  void residuals(std::size_t sample, std::vector<double>& result) const;

  /// Mean squared deviation of single scans from the mean of their sample [share of full scale, squared].
  /// No explanation can account for this noise.
  double within() const { return within_; }

 private:
  void judgeWithin();

  const Measured& measured_;
  const StaticFit& fit_;
  std::vector<Eigen::MatrixXd> coefficients_;  // of each group, [coefficients x taxels]
  double within_ = 0;
};

/// How strongly a trace appears in every taxel, on every class of curvature.
struct Spread {
  Eigen::MatrixXd amplitude;  ///< [taxels x classes], 1 = as in the trace; NaN for taxels not used
  Eigen::MatrixXd error;      ///< standard error, assuming white noise
  double square = 0;          ///< mean square of the readings' residual over single scans
  double local = 1;           ///< mean square of the amplitude / its squared mean: 1 if all taxels agree
};
Spread spreadOf(const Measured& measured, const TaxelFit& taxels, const Trace& trace);

/// Taxels, rows or columns that deviate from the others, whatever the reason. They are reported when no
/// effect of the library describes a fault.
struct OddTaxels {
  std::vector<std::size_t> taxels;                           ///< row-major indices, ascending; empty = none
  simulation::Covariate by = simulation::Covariate::kTaxel;  ///< or kRow, kColumn
  double share = 0;  ///< share of the readings' squared error that these taxels alone cause
};

/// Tests the residual of every taxel from its static curves, after the mean residual of all taxels has been
/// subtracted. A taxel that hardly responds to the pressure while others do is odd as well.
OddTaxels findOddTaxels(const Measured& measured, const TaxelFit& taxels);

}  // namespace fsr::discrepancy
