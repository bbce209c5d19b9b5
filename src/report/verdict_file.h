#pragma once

#include <string>
#include <vector>

#include "dataset/protocols.h"
#include "fsr_pressure_map/discrepancy/discrepancy.h"

namespace fsr::report {

/// The text of verdict.yaml; null = absent:
///
///     verdict: named                # none, unknown, ambiguous, wrong_form, named, not_identifiable
///     effects:
///       - id: hysteresis
///         parameters: [{name: loop_width, value: 0.062, unit: ..., interval: [0.058, 0.067]}]
///         evidence: {z: 14.1, share_of_ceiling: 0.93}
///     credible_set: [[hysteresis]]  # all explanations that are not excluded, best first
///     depends_on: [direction, pressure]
///     p: 0.0033                     # probability of the best score if nothing were missing
///     at_map: 21000                 # rms of what is missing, at the map [Pa]
///     least_gap: 1240               # what is smaller than this does not matter [Pa]
///     in_use: [{situation: ramp, before: 21000, after: 5000}]        # largest errors [Pa]
///     smallest_seen: [{id: creep, at_map: 700}]  # sizes from which effects would have been seen [Pa]
///     too_small: []                 # what is visible, but smaller than the least gap
///     scatter: [{part: cycle_gain, size: 0.012, unit: share, interval: [0.009, 0.016], at_map: 3100}]
///     asked: [{id: crosstalk, answer: not_identifiable}]
///     not_identifiable: [{id: crosstalk, experiment: uneven_load}]
///     where: {taxels: all, conditions: all, pressure: [0, 620000], direction: both, time: all}
///     gap: {before: 0.031, ..., closed_interval: [0.9, 0.94], unit: fraction of full scale, ...}
///                                   # surfaces: [{surface: flat, before: 0.03, after: 0.007}]
///                                   # covered: [{surface: flat, pressure: [0, 620000]}], left_out: 0
///     hold_out:                     # the gap is measured on these spans: stamps of first and last scan [s]
///       - {file: 1_flat.bag, cycles: [[946684875.100000000, 946684950.000000000]]}
///     recompute: rosrun ...         # the command that recomputes the gap
///     next_experiment: null         # or {protocol: two_speeds, sentence: ..., separation: 6.2, cycles: 20,
///                                   # certainty: 0.98, entropy: [0.8, 0.05], then: null}
///     prediction: {size: [0.93, 1.08], weights: [0.8, 0.2]}  # what new bags are held against; or null
///     seed: 1
///     version: 0.1.0
///     inputs: [{file: 1_flat.bag, sha256: ..., show_opened: 1}]
///
/// Numbers have five digits; results.json has all digits.
std::string verdictText(const discrepancy::DiscrepancyReport& report);

/// The part of a verdict.yaml that is needed to compare new recordings with it.
struct VerdictFile {
  std::string verdict;
  std::vector<std::string> effects;  ///< ids
  std::vector<std::vector<std::string>> credible_set;
  std::vector<discrepancy::InputUse> inputs;
  double gap_before = 0, gap_after = 0;  ///< as stated [share of full scale]; NaN where null
  std::vector<discrepancy::SurfaceGap> gap_surfaces;
  std::vector<discrepancy::HoldOutCycles> hold_out;  ///< stamps to the nanosecond
  std::uint64_t seed = 0;
  std::string version;
};

/// Reads a verdict.yaml. Unknown and missing keys, values of another kind, and ids that are not in the
/// library raise InputError: one sentence that names file, field and what would be right.
VerdictFile readVerdict(const std::string& path);

/// A prediction that was frozen with its verdict, before the recordings that test it were made.
struct FrozenPrediction {
  discrepancy::Prediction prediction;
  std::string verdict_sha256;  ///< of verdict.yaml's bytes
  /// Of the cycles that it was made from, see dataset::pacesOf(). Empty in files of earlier versions.
  std::vector<dataset::CycleCourse> paces = {};
  /// SHA-256 of the readings of each recording that it was made from. Empty in files of earlier versions.
  std::vector<std::string> readings_sha256 = {};
};

/// The text of prediction.yaml, with all digits of every number:
///
///     verdict_sha256: ...
///     effects: {hysteresis: {loop_width: 0.062, ...}}
///     rivals: [{creep: {...}}]
///     size: [0.9, 1.1]       # 95 % predictive interval of the effects' common factor, 1 = as fitted
///     weights: [0.8, 0.2]    # probability of the effects and of each rival
///     spread: {cycles: 24, groups: 6, between: 1e-4, parameters: [{effect: 0, name: loop_width,
///              logarithmic: false, covariance: [1.2e-06, ...]}, ...]}
///     paces: [{speed: 17000, dwell: 2, peak: 620000}, ...]   # of the cycles [Pa/s, s, Pa]
///     readings_sha256: [..., ...]   # of the readings of each bag
///     hash: ...              # of all above the paces, and of the simulation that it completes
///
/// Files of earlier versions have neither weights nor spread nor paces nor readings.
std::string predictionText(const FrozenPrediction& frozen);

/// Reads prediction.yaml. Unknown keys are errors. Throws InputError that names file, field, value and what
/// would be right.
FrozenPrediction readPrediction(const std::string& path);

}  // namespace fsr::report
