#pragma once

#include <cstdint>
#include <string>

#include "blind/campaign.h"

namespace blind {

/// The noise of a sheet and its read-out, up to a common factor: coloured and white noise of each
/// taxel, something common to all, all of it growing with the reading; and a gain that scatters from
/// cycle to cycle. Nothing in it is slower than some ten seconds but the gain of a whole cycle, so
/// that over blocks of minutes it is white: what is slower is drift, and drift is never noise here.
///
/// Coloured noise: "ar1", first order; "ar2", second order, with a broad peak; "flicker", 1/f from
/// 0.02 Hz to the scan rate, as a sum of first-order ones.
class Noise {
 public:
  Noise(const Campaign& campaign, std::uint64_t seed);

  /// Noise of one taxel, of unit variance where a reading is half of full scale.
  Trace ofTaxel(std::size_t taxel, const Trace& reading) const;

  const std::string& colour() const { return colour_; }
  double colouredShare() const { return coloured_; }  ///< of the variance
  double cycleGain() const { return cycle_gain_; }  ///< deviation of the cycles' gain, in units of the noise

 private:
  Trace coloured(Random& random) const;
  Trace firstOrder(double keep, Random& random) const;
  Trace secondOrder(Random& random) const;

  const Campaign& campaign_;
  std::uint64_t seed_;
  std::string colour_;
  double coloured_, common_share_, absolute_, cycle_gain_;
  double keep_, damping_, peak_;  // of the coloured noise's filters
  Trace common_;
  std::vector<double> gain_of_cycle_;
};

/// Noise of the chamber's transducer and its converter [Pa]: a little white noise, then a step.
class ReferenceError {
 public:
  explicit ReferenceError(std::uint64_t seed);
  /// A straight-line error and some curvature: what no second reference shows.
  double systematic(double pressure) const;
  double measured(double pressure, Random& random) const;

 private:
  double offset_, slope_, bend_, noise_, step_;
};

}  // namespace blind
