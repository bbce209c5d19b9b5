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
  /// The part of ofTaxel() that is a gain of the cycles, which all taxels share.
  double cycleGainAt(std::size_t scan, double reading) const {
    return cycle_gain_ * gain_of_cycle_[campaign_.cycle[scan]] * 2 * reading;
  }
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

/// A sample of a slow channel.
struct Sample {
  double time = 0;  ///< campaign clock [s]
  double value = 0;
};

/// What the chamber's transducer, its converter and its recorder make of the true pressure of a drawn plan:
/// samples at the reference's own rate, centred averages, offset, span and curvature errors, white noise,
/// quantisation.
class ReferenceChannel {
 public:
  ReferenceChannel(const RigPlan& plan, const Campaign& campaign, std::uint64_t seed);
  /// Samples from just before the first to just after the last scan of a visit [Pa, true, gauge].
  const std::vector<Sample>& samples(std::size_t visit) const { return samples_[visit]; }
  /// Interpolated to each scan of the campaign [Pa, true, gauge].
  const Trace& atScans() const { return at_scans_; }
  /// Error at each scan without offset, span and curvature, which a calibration absorbs [Pa, reduced].
  const Trace& error() const { return error_; }

 private:
  double systematic(double pressure) const;

  ReferencePlan plan_;
  double peak_;
  std::vector<std::vector<Sample>> samples_;
  Trace at_scans_, error_;
};

/// Linear interpolation; `piece` is where the last search ended.
double between(const std::vector<Sample>& samples, double time, std::size_t& piece);

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
