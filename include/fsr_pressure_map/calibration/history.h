#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fsr::calibration {

/// What the memory of the sheet is described by.
enum class HistoryFamily : std::uint8_t {
  kNone,      ///< nothing: the static answer
  kPlays,     ///< a loop that does not depend on time: play operators
  kMemories,  ///< creep or relaxation: exponentially fading memories
  kBoth,
};

/// The id that files and options use: none, plays, memories, both.
std::string historyName(HistoryFamily family);

/// Throws InputError that lists the names.
HistoryFamily historyFromName(const std::string& name);

/// The part of the pressure that depends on earlier readings, the same for all taxels:
///
///     p = x + c(x) + sum_j w_j (play_{r_j}(x) - x) + sum_k v_k (ema_{tau_k}(x) - x)
///
/// x [Pa] is the static answer of the taxel's table. The plays and the memories are driven by x and never by
/// p, so |p| is bounded wherever x is. For a Prandtl-Ishlinskii loop and for creep as a sum of exponentials
/// this form contains the exact inverse (M. Brokate and J. Sprekels, Hysteresis and Phase Transitions, 1996,
/// ch. 2; the poles and zeros of 1 + sum a_i / (1 + s tau_i) interlace). c(x) corrects the static answer,
/// because a table that was trained without memory contains the mean memory of its training.
struct HistoryModel {
  HistoryFamily family = HistoryFamily::kNone;
  std::vector<double> knot;  ///< of c, evenly spaced, ascending [Pa]; two or more unless family is kNone
  std::vector<double> correction;  ///< c at each knot, constant beyond them [Pa]
  /// The smallest and the largest p - x of training at each knot [Pa]: p - x is limited to them, since
  /// weights that fit one course of loads need not fit a wider one. Empty, as in files of earlier versions:
  /// no limits.
  std::vector<double> least_change, largest_change;
  std::vector<double> radius;  ///< of the plays, above 0 [Pa]
  std::vector<double> play_weight;
  std::vector<double> time_constant;  ///< of the memories, above 0 [s]
  std::vector<double> memory_weight;
  /// Of each memory: root mean square of its distance from x in training [Pa]. It is the deviation of a
  /// memory of which nothing is known. Empty, as in files of earlier versions: that of inputs evenly between
  /// the knots.
  std::vector<double> memory_spread;
  /// Of a reading of a protocol that training left out, by pressure, constant beyond the knots: where the
  /// sheet is being loaded, and where it is being unloaded. It is being unloaded where the first operator, a
  /// play if there is one, lies above x.
  std::vector<double> deviation_knot;       ///< evenly spaced, ascending [Pa]
  std::vector<double> loading_deviation;    ///< [Pa]
  std::vector<double> unloading_deviation;  ///< [Pa]

  bool present() const { return family != HistoryFamily::kNone; }
};

}  // namespace fsr::calibration
