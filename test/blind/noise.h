#pragma once

#include <cstdint>
#include <string>

#include "blind/campaign.h"

namespace blind {

/// The noise of a sheet and its read-out, up to a common factor. It has three parts: coloured and white
/// noise of each taxel, noise common to all taxels, and a gain that scatters from cycle to cycle. The first
/// two increase with the reading. Except for the gain of a cycle, nothing in it is slower than about ten
/// seconds, so it is white over blocks of minutes. Slower changes are drift, which is never part of this
/// noise.
///
/// Coloured noise: "ar1", first order; "ar2", second order with a broad peak; "flicker", 1/f from 0.02 Hz to
/// the scan rate, as a sum of first-order processes.
class Noise {
 public:
  /// `most_cycle_gain`: largest deviation of the cycles' gain, in units of the noise.
  Noise(const Campaign& campaign, std::uint64_t seed, double most_cycle_gain = 0.3);

  /// Noise of one taxel, of unit variance where a reading is half of full scale.
  Trace ofTaxel(std::size_t taxel, const Trace& reading) const;

  const std::string& colour() const { return colour_; }
  const Trace& gainOfCycle() const { return gain_of_cycle_; }  ///< standard normal, one for each cycle
  double colouredShare() const { return coloured_; }  ///< share of the variance
  double cycleGain() const { return cycle_gain_; }  ///< deviation of the cycles' gain, in units of the noise

 private:
  Trace coloured(Random& random) const;
  Trace firstOrder(double keep, Random& random) const;
  Trace secondOrder(Random& random) const;

  const Campaign& campaign_;
  std::uint64_t seed_;
  std::string colour_;
  double coloured_, common_share_, absolute_, cycle_gain_;
  double keep_, damping_, peak_;  // filters of the coloured noise
  Trace common_;
  std::vector<double> gain_of_cycle_;
};

/// Error of the chamber's transducer and its converter [Pa]: white noise, then quantisation.
class ReferenceError {
 public:
  explicit ReferenceError(std::uint64_t seed);
  /// A linear error with some curvature, which only a second reference would reveal.
  double systematic(double pressure) const;
  double measured(double pressure, Random& random) const;

 private:
  double offset_, slope_, bend_, noise_, step_;
};

}  // namespace blind
