#pragma once

#include <memory>
#include <vector>

#include "blind/hidden.h"
#include "blind/signature.h"
#include "blind/static_fit.h"

namespace blind {

/// A hidden effect with the taxels and surfaces to which it is limited.
struct Placed {
  const HiddenForm* form = nullptr;
  std::uint64_t seed = 0;
  bool carried_over = true;
  std::vector<bool> taxels;    ///< of the matrix
  std::vector<bool> surfaces;  ///< of the campaign

  std::unique_ptr<Hidden> make(const Campaign& campaign, const Sheet& sheet, double strength) const;
};

/// A placed effect with its strength.
struct Active {
  const Placed* placed;
  std::shared_ptr<const Hidden> hidden;
};

/// The sheet in its chamber; gives readings without noise.
class Rig {
 public:
  Rig(const Campaign& campaign, const Sheet& sheet)
      : campaign_(campaign),
        sheet_(sheet),
        curves_(campaign),
        shared_curve_(campaign, StaticFit::kSharedBin) {}

  /// Reading of one taxel at each scan [share of full scale].
  Trace reading(std::size_t taxel, const std::vector<Active>& hidden) const;
  /// Factor by which the hidden effects reduce the noise.
  Trace noiseFactor(std::size_t taxel, const std::vector<Active>& hidden) const;

  Active activate(const Placed& placed, double strength) const {
    return {&placed, placed.make(campaign_, sheet_, strength)};
  }
  /// What an effect alone leaves after the best static fit. Measured on every `stride`-th taxel, or on all of
  /// its taxels where it shows on only a few.
  Signature signature(const Active& active, std::size_t stride) const;
  /// The error that a static calibration makes at the pressure map because of an effect: what the effect
  /// leaves after the static fit, divided by the local slope of the taxel's curve, rms over all taxels and
  /// all scans above kLoaded [Pa, true]. A slope below kFlat of the taxel's mean slope counts as that.
  double errorAtMap(const Active& active, std::size_t stride) const;
  static constexpr double kLoaded = 0.05;  ///< share of the highest pressure
  static constexpr double kFlat = 0.2;
  /// Slope of a taxel's curve at each scan, hidden effects aside [share of full scale / Pa, reduced].
  Trace slope(std::size_t taxel) const;
  /// Residual of one taxel after the static fit that suits the effect.
  Trace residual(const Active& active, std::size_t taxel) const;
  /// What the curves of taxel and surface leave of a small change of a taxel's readings.
  Trace leftOf(std::size_t taxel, const Trace& change) const;
  /// What an effect alone changes in every taxel, including changes that a static curve could absorb.
  Signature difference(const Active& active) const;
  /// The strength at which the effect leaves about `target` [share of full scale], or the largest strength
  /// where it cannot leave that much. For an exact ratio, callers scale the noise to what is left in the end.
  double strengthFor(const Placed& placed, double target, double largest = 3) const;
  /// Likewise for errorAtMap() [Pa].
  double strengthForError(const Placed& placed, double target, double largest) const;

 private:
  template <typename Measure>
  double solve(const Placed& placed, double target, double largest, double near, Measure measure) const;
  template <typename Act>
  void inPlace(const Active& active, std::size_t taxel, Trace& trace, Act act) const;

  const Campaign& campaign_;
  const Sheet& sheet_;
  StaticFit curves_;
  StaticFit shared_curve_;
};

}  // namespace blind
