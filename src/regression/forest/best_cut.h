#pragma once

#include <cstddef>

namespace fsr::regression {

/// Width of the search: arrays extend this many values beyond the end of the run.
constexpr std::size_t kCutLanes = 8;

/// Where to cut a run of entries in two. Values beyond `end` that the search loads must not be sizes between
/// those of `begin` and `end`.
struct CutProblem {
  // [end + kCutLanes] values each
  const double* size;   ///< readings as `minimum_leaf` counts them, of the entries before each
  const double* count;  ///< readings drawn, of the entries before each; may be `size` itself
  const double* sum;    ///< their pressure, of the entries before each
  const double* code;   ///< of each entry; equal codes stand together

  bool codes_repeat;  ///< whether neighbouring entries may have equal codes, which a cut must not separate
  std::size_t begin;  ///< entries begin .. end - 1, at least one
  std::size_t end;
  double minimum_leaf;  ///< size that each side must keep, at least 1
};

constexpr std::size_t kNoCut = 0;

/// The first entry of the right side of the cut that reduces the sum of squared errors most, the lowest of
/// equal ones; kNoCut if no cut reduces it or leaves enough on both sides. The reduction is
///
///     (S_left - n_left mean)^2 n / (n_left n_right);
///
/// fractions are compared by cross-multiplication, without division.
std::size_t bestCut(const CutProblem& problem);

}  // namespace fsr::regression
