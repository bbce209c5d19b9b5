#pragma once

#include <memory>
#include <vector>

#include "blind/hidden.h"
#include "blind/signature.h"
#include "blind/static_fit.h"

namespace blind {

/// A hidden effect with the places that it is confined to.
struct Placed {
  const HiddenForm* form = nullptr;
  std::uint64_t seed = 0;
  bool carried_over = true;
  std::vector<bool> taxels;    ///< of the matrix
  std::vector<bool> surfaces;  ///< of the campaign

  std::unique_ptr<Hidden> make(const Campaign& campaign, const Sheet& sheet, double strength) const;
};

/// A hidden effect of a certain strength, in its place.
struct Active {
  const Placed* placed;
  std::shared_ptr<const Hidden> hidden;
};

/// The sheet in its chamber: readings without noise.
class Rig {
 public:
  Rig(const Campaign& campaign, const Sheet& sheet)
      : campaign_(campaign),
        sheet_(sheet),
        curves_(campaign),
        shared_curve_(campaign, StaticFit::kSharedBin) {}

  /// Reading of one taxel at each scan [share of full scale].
  Trace reading(std::size_t taxel, const std::vector<Active>& hidden) const;
  /// By how much the hidden effects quieten the noise.
  Trace noiseFactor(std::size_t taxel, const std::vector<Active>& hidden) const;

  Active activate(const Placed& placed, double strength) const {
    return {&placed, placed.make(campaign_, sheet_, strength)};
  }
  /// What an effect alone leaves after the best static fit, measured on every `stride`-th taxel, but
  /// on all where it shows on a few only.
  Signature signature(const Active& active, std::size_t stride) const;
  /// What an effect alone changes, static curve or not, of every taxel.
  Signature difference(const Active& active) const;
  /// The strength at which it leaves about `target` [share of full scale]; where it cannot leave that
  /// much, the largest. Whoever needs it exactly sets the noise by what is left in the end.
  double strengthFor(const Placed& placed, double target) const;

 private:
  Trace residual(const Active& active, std::size_t taxel) const;
  template <typename Act>
  void inPlace(const Active& active, std::size_t taxel, Trace& trace, Act act) const;

  const Campaign& campaign_;
  const Sheet& sheet_;
  StaticFit curves_;
  StaticFit shared_curve_;
};

}  // namespace blind
