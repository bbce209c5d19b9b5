#pragma once

#include <map>
#include <string>
#include <vector>

#include "blind/noise.h"
#include "blind/rig.h"
#include "blind/rig_plan.h"

namespace blind {

/// Whether one effect could be told under a protocol, and what against.
struct Told {
  std::string id;
  bool could_be_told = false;
  /// Empty where it could be told; else too_small, one_mount, one_surface, one_pace, no_thermometer or
  /// collinear_with:ID.
  std::string reason;
  std::vector<std::string> confused_with;  ///< nearest first
  double nats = 0;  ///< expected log-likelihood of the effect above that of the static fit alone
  /// Of each rival: expected log-likelihood that it stays below that of the effect [nats], and the share of
  /// the effect's squares that it leaves.
  std::map<std::string, std::pair<double, double>> beyond;
  /// Share of the squares that the other forms of the same effect leave; 1 = there are none that show.
  double own_forms = 1;
  bool hidden = false;  ///< computed for what is hidden, not for a representative
};

struct Identifiability {
  std::vector<Told> effects;
};

/// An effect could be told where every rival leaves at least kNats of expected log-likelihood AND at least
/// kLeftShare of its squares: no library has exactly the hidden form, and what forms of one effect leave of
/// each other is of that size (`own_forms`). A loop at one pace of equal cycles leaves 2 to 12 % beyond a
/// short memory, at two paces with dwells 15 to 22 % (five forms, 4 x 4 taxels, one surface).
constexpr double kNats = 5, kLeftShare = 0.1;

/// What identify() works on, all of it known to the generator only.
struct IdentifiabilityProblem {
  const Campaign& campaign;
  const Sheet& sheet;
  const Rig& rig;
  const RigPlan& plan;
  std::uint64_t seed;
  std::vector<Active> hidden;
  std::vector<double> strengths;  ///< of `hidden`
  /// Everything random in the readings [taxel][scan, share of full scale], without the gain of the cycles.
  const std::vector<Trace>& noise;
  const Trace& reference_error;  ///< [Pa, reduced]
  double cycle_gain;             ///< standard deviation of the gain of a cycle, relative
  double typical_left;           ///< rms after the static fit that representatives have [share of full scale]
};

/// Linear algebra on the noise-free signatures of the case itself.
///
/// 1. Signature of an effect: change of the readings minus the static fit (a monotone curve for each taxel
/// and
///    surface), by ordinary least squares at the full rate, then averaged over blocks of scans.
/// 2. The three leading spatial patterns of the effect's signature (singular vectors over the taxels) make
/// three time
///    traces, "channels". A rival is seen through the same patterns, each with an amplitude of its own, so
///    that how a rival varies from taxel to taxel never tells it apart.
/// 3. Noise of a channel: the case's own noise and the reference's error through the local slope, in blocks,
/// with
///    their long-run variance; the gain of each cycle is a random effect (it is not projected out).
/// 4. What a rival may be: any sum of the signatures of all its forms of set A, with two draws of their
/// parameters
///    each, up to three times their usual size (or that of the hidden effect, where that is larger).
///    Hysteresis, creep, leak and wear keep their sign. Besides, creep has lags of all time constants from
///    0.1 s to 1000 s, up to 15 % of the load each; drift has the first Karhunen-Loeve modes of a random
///    walk; repositioning has a gain and a preload of its own for each mount of a surface that was mounted
///    again; temperature without a thermometer has slow gains and zeros.
/// 5. Expected log-likelihood beyond a rival: half of the squares that bounded least squares leave of the
///    whitened signature.
///
/// Faults and hum are told by what is faster than a block and by their taxels; they are no rivals of effects
/// that all taxels share. Effects that are static themselves have no rivals; they need two surfaces.
Identifiability identify(const IdentifiabilityProblem& problem);

}  // namespace blind
