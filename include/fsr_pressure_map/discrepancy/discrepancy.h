#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

struct DiscrepancyOptions {
  /// Ids of effects that the user asks about. DiscrepancyReport::answers has an answer for each of them. If
  /// nothing is found and the recordings cannot show one of them, the verdict is kNotIdentifiable.
  std::vector<std::string> ask;
  std::vector<std::string> leave_out;  ///< ids of effects that are not considered
  bool repeat = false;  ///< after an effect is named, add it and search again until none is named
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0 = one for each core; the results do not depend on it

  // The constants of the decision: levels, sizes that matter, numbers of draws. They are printed with every
  // result. docs/discrepancy.md says what they decide.

  double level = 0.01;     ///< of the test whether anything is missing, and whether anything is left
  double credible = 0.95;  ///< probability that the credible set holds the best explanation
  /// Size at the map below which a discrepancy does not matter [Pa]. NaN = `least_gap_share` of the range of
  /// the chamber's pressure.
  double least_gap = NAN;
  double least_gap_share = 0.002;
  // Shares of what can be closed in held-out cycles.
  double generic_better = 0.1;    ///< generic terms that close so much more than any effect: unknown
  double unknown_below = 0.5;     ///< an effect that leaves something and closes less: unknown
  double wrong_form_below = 0.7;  ///< likewise: wrong form
  /// A second effect must close so much more, unless it is slow and the first is fast.
  double second_adds = 0.05;
  double contender = 0.2;        ///< of the best score: an explanation below it is not weighed by itself
  std::size_t null_draws = 299;  ///< of the parametric bootstrap
  std::size_t resamples = 999;   ///< of the bootstrap over cycles
  std::size_t folds = 5;         ///< of the cross-validation over cycles
  double degrees = 4;            ///< of freedom of the density of a cycle
};

/// A simulation that may lack effects, and measurements of the simulated sheet.
struct DiscrepancyProblem {
  simulation::SimulationSettings simulation;
  std::vector<dataset::Recording> recordings;  ///< one for each bag, all of one matrix
  DiscrepancyOptions options;
  /// The same recordings with the scans near a change of surface, which `recordings` leave out. Simulations
  /// are driven through them, as `simulate --drive` does. Empty = `recordings` have every scan.
  std::vector<dataset::Recording> whole = {};
};

enum class Verdict { kNone, kUnknown, kAmbiguous, kWrongForm, kNamed, kNotIdentifiable };

/// "none", "unknown", "ambiguous", "wrong_form", "named", "not_identifiable".
std::string name(Verdict verdict);

/// A confidence interval, 95 % unless said otherwise. NaN where it is not known.
struct Interval {
  double low = 0;
  double high = 0;
};

struct FittedParameter {
  std::string name;
  double value = 0;
  std::string unit;  ///< as in the library; empty = a pure number
  Interval interval;
};

/// An effect of the verdict.
struct FoundEffect {
  std::string id;
  std::string summary;                      ///< one line from the library
  std::vector<FittedParameter> parameters;  ///< empty where a detector found the effect
  double z = 0;                     ///< of the error that it explains in cycles that it was not fitted to
  double share_of_explainable = 0;  ///< of the explainable error
};

/// An effect that these recordings cannot show.
struct NotIdentifiable {
  std::string id;
  std::string experiment;  ///< experiment that would show it, as in name(Experiment)
  std::string reason;      ///< one sentence
};

/// Answer to a question of the user about one effect.
struct Answer {
  std::string id;
  /// found, not_excluded (it is in the credible set), excluded (it would have been seen from `at_map`),
  /// not_identifiable, in_simulation, left_out.
  std::string answer;
  double at_map = NAN;  ///< of an excluded effect: SmallestSeen::at_map [Pa]
  std::string sentence;
};

/// Test whether what the static curves leave depends on covariates. Terms of these covariates compete with
/// the effects in the same way.
struct CovariateTest {
  std::string covariate;  ///< as in name(Covariate); several are joined by " x "
  /// predictive_density: of terms of the covariates. The others are of a finding that depends on the
  /// covariate: effect, detector, static_curves, odd_taxels.
  std::string method;
  double p = 1;          ///< probability of at least this dependence by chance
  double adjusted = 1;   ///< the same, corrected for the search among all explanations
  double at_map = 0;     ///< rms of what the terms explain, at the map [Pa]
  bool depends = false;  ///< adjusted p <= level, and not smaller than the least gap
};

/// From which size nine of ten such recordings would have shown an effect.
struct SmallestSeen {
  std::string id;
  double at_map = 0;  ///< rms at the map, never below the least gap [Pa]; NaN = no plausible strength shows
};

/// An explanation that is visible, but smaller than the least gap.
struct TooSmall {
  std::string explanation;  ///< ids of effects, or the name of generic terms
  double p = 1;             ///< as CandidateScore::p
  double at_map = 0;        ///< rms at the map [Pa]
  double least_gap = 0;     ///< the least gap of this explanation [Pa]
};

/// Random change of the mean reading that is slower than the noise of single scans. It is a part of the noise
/// model, fitted together with the preferred explanation.
struct Scatter {
  /// cycle_gain: relative gain of each cycle. cycle_offset: offset of each cycle. wandering: slow change
  /// within a cycle, over about a third of its duration.
  std::string part;
  std::string unit;     ///< of `size`: share, or share of full scale
  double size = 0;      ///< standard deviation
  Interval interval;    ///< of `size`. From 0 = it cannot be told from none
  double at_map = 0;    ///< rms at the map [Pa]
  double of_noise = 0;  ///< share of the variance of the whole noise model
  bool seen() const { return interval.low > 0; }
};

/// Where the discrepancy is visible.
struct WhereItShows {
  std::vector<std::size_t> taxels;               ///< row-major; empty = all
  std::vector<std::string> conditions;           ///< surfaces; empty = all
  Interval pressure;                             ///< gauge [Pa]
  std::string direction = "both";                ///< both, loading, unloading
  std::vector<std::pair<double, double>> times;  ///< [s] since the first scan; empty = all
};

/// Share of the gap that is closed on parts that the sizes of the effects were not fitted to. Each surface is
/// predicted from the other surfaces, or each protocol from the other protocols. The choice of the effects
/// and the static curves used all parts. These shares are of traces that are fitted to the mean over the
/// taxels; they are not recomputed by driving the written simulations, as Gap::closed is.
struct HeldOutGap {
  std::string by;     ///< condition, protocol
  double closed = 0;  ///< over all parts
  Interval closed_interval;
  std::vector<std::pair<std::string, double>>
      parts;  ///< each part that was left out, with the share that is closed there
};

/// Range of pressures on a surface [Pa].
struct CoveredPressures {
  std::string surface;
  Interval pressure;  ///< gauge
};

/// Gap on the hold-out scans of one surface [share of full scale].
struct SurfaceGap {
  std::string surface;
  double before = NAN;
  double after = NAN;
};

/// Distance between simulation and measurement, as root mean square over the taxels that its bag does not
/// mask and the scans in DiscrepancyReport::hold_out [share of full scale]. Simulated are the counts of
/// `simulate --drive` without white noise: with `base` before, with `added` after. NaN where nothing was held
/// out.
struct Gap {
  double before = NAN;
  double after = NAN;
  double floor = NAN;  ///< noise that no explanation can remove: the lower end of `floor_bracket`
  /// (before^2 - after^2) / (before^2 - floor^2); may be below 0 or above 1. NaN where no effect was added,
  /// or one that comes and goes at random.
  double closed = NAN;
  Interval before_interval{NAN, NAN}, after_interval{NAN, NAN}, floor_interval{NAN, NAN},
      closed_interval{NAN, NAN};
  double before_pressure = NAN;  ///< the same as a pressure, by the local slope of the static curves [Pa]
  double after_pressure = NAN;
  double floor_pressure = NAN;
  /// What the noise may be: from differences between neighbouring scans, and from the differences between
  /// cycles at the same surface, direction and pressure. The first misses noise that is slower than a scan,
  /// the second contains effects that change from cycle to cycle.
  Interval floor_bracket{NAN, NAN};
  std::vector<SurfaceGap> surfaces;       ///< with hold-out scans, in order of time
  std::size_t left_out = 0;               ///< scans of hold-out cycles beyond the pressures in `covered`
  std::vector<CoveredPressures> covered;  ///< by the cycles that were fitted
  std::vector<std::string> held_out_by;   ///< of cycles, condition, protocol
  std::vector<HeldOutGap> foretold;       ///< for condition and protocol
  std::vector<std::string> missing;       ///< sentences: kinds of data of which nothing could be held out
};

/// Largest error of the pressure in use that the missing effects cause [Pa]. NaN where it is not known.
struct GapInUse {
  std::string situation;  ///< ramp, stance, standing
  double before = 0;      ///< [Pa]
  double after = 0;       ///< [Pa]
};

/// Result of one candidate.
struct CandidateScore {
  std::vector<std::string> ids;  ///< one effect, a pair, or the name of generic terms
  bool generic = false;
  std::string outcome;  ///< named, credible, refused, required_data_missing, does_not_pay
  double nats = 0;      ///< added to the logarithm of the predictive density of cycles it was not fitted to
  double p = 1;         ///< probability of such a score if nothing were missing, corrected for the search
  double z = 0;         ///< mean of the nats by cycle, in standard errors; 0 where it was far behind the best
  double share_of_explainable = 0;  ///< of what can be closed in those cycles
  double at_map = 0;                ///< rms of what it explains, at the map [Pa]
};

/// An experiment that would decide between the credible explanations.
struct NextExperiment {
  std::string protocol;  ///< two_speeds, minor_loops, step_hold, rest, two_ambients, random_order, ...
  std::string sentence;  ///< what to do at the rig, and which explanations it distinguishes
  /// Smallest distance between two explanations in all its cycles, in standard deviations of the noise.
  double separation = 0;
  std::vector<std::pair<std::string, std::string>> separates;  ///< pairs of ids
  int cycles = 0;                                              ///< to be recorded on each surface
  /// Expected probability of the true explanation after it, and after the experiments listed before it.
  double certainty = NAN;
  double entropy_before = NAN;  ///< of the credible set and `unknown`, before it [nats]
  double entropy = NAN;         ///< the same after it, expected [nats]
};

/// Mean residual against one covariate, for figures.
struct ResidualCurve {
  std::string covariate;       ///< as in name(Covariate)
  std::string unit;            ///< of `at`
  std::vector<double> at;      ///< middle of each bin
  std::vector<double> before;  ///< [share of full scale]
  std::vector<double> after;   ///< likewise
  std::vector<double> error;   ///< standard error of both
};

/// A bag, and how often its hold-out cycles were used to compute a gap.
struct InputUse {
  std::string file;
  std::string sha256;
  std::uint64_t scans = 0;
  int hold_out_opened = 0;
};

/// The hold-out cycles of one bag: nothing was fitted to them, and the gap is measured on them.
struct HoldOutCycles {
  std::string file;  ///< base name of the bag
  /// Stamps of the first and the last scan of each cycle, both included [ns since 1970]. A cycle is several
  /// spans where scans beyond the fitted pressures are left out.
  std::vector<std::pair<std::int64_t, std::int64_t>> cycles;
};

/// One round of `repeat`.
struct RepeatStep {
  std::string added;  ///< id, empty in the last round
  std::string sentence;
  double at_map = 0;  ///< rms of what is named or left, at the map [Pa]
};

/// How well the parameters of a prediction are known. Each is a normal variable round its fitted value.
struct ParameterSpread {
  struct Parameter {
    std::size_t effect = 0;  ///< index into Prediction::effects
    std::string name;
    bool logarithmic = false;  ///< the variable is the logarithm of the value, else the value
  };
  std::vector<Parameter> parameters;
  std::vector<std::vector<double>> covariance;  ///< of the variables
  std::size_t cycles = 0;                       ///< that they were fitted to
  /// Variance of the size between groups of cycles, beyond that within them; 0 = fewer than two groups. A
  /// group is the cycles of one mount under one protocol.
  double between = 0;
  std::size_t groups = 0;
};

/// A prediction that is frozen before the next experiment. confirm() compares it with new recordings.
struct Prediction {
  std::vector<simulation::EnabledEffect> effects;              ///< effects of the best explanation
  std::vector<std::vector<simulation::EnabledEffect>> rivals;  ///< the other credible explanations
  /// 95 % predictive interval of the factor by which new recordings find the effects stronger, 1 = as fitted;
  /// for as many cycles under the same protocol.
  Interval size;
  std::string hash;  ///< see hashOf()
  /// Probability of the explanation by `effects`, then of each rival; see weightsOf(). Empty in files of
  /// earlier versions.
  std::vector<double> weights = {};
  ParameterSpread spread = {};  ///< empty in files of earlier versions
};

/// Everything that verdict.yaml, results.json and the report contain.
struct DiscrepancyReport {
  Verdict verdict = Verdict::kNone;
  std::string sentence;  ///< the verdict in words
  std::vector<FoundEffect> effects;
  std::vector<std::vector<std::string>> credible_set;  ///< every explanation that is not excluded, best first
  std::vector<std::string> depends_on;                 ///< covariates, as in name(Covariate)
  std::vector<NotIdentifiable> not_identifiable;
  std::vector<CovariateTest> covariates;
  std::vector<SmallestSeen> smallest_seen;  ///< of each effect that competed
  std::vector<TooSmall> too_small;          ///< only where the verdict would be none without it
  std::vector<Scatter> scatter;             ///< also where nothing is missing; empty with too few cycles
  std::vector<Answer> answers;              ///< to the questions of the user
  /// Rms of what the preferred explanation adds and the static curves cannot take up, at the map [Pa]. Of
  /// generic terms where the verdict is kUnknown. NaN where detectors alone found something, and where
  /// nothing is missing.
  double at_map = NAN;
  double p = 1;          ///< probability of the best score if nothing were missing
  double least_gap = 0;  ///< size at the map below which a discrepancy does not matter [Pa]
  DiscrepancyOptions options;
  WhereItShows where;
  Gap gap;
  std::string recompute;                ///< command that recomputes the gap; empty = the gap is not known
  std::string map_gain;                 ///< sentences, from training with and without; empty = no effect
  std::vector<HoldOutCycles> hold_out;  ///< in time order; bags without a hold-out cycle are left out
  std::vector<GapInUse> in_use;
  std::vector<NextExperiment> next_experiment;  ///< none, one, or two where one is not enough
  std::vector<CandidateScore> candidates;       ///< best first
  std::vector<std::string> tested;              ///< ids of all effects that were considered
  std::vector<std::string> limitations;         ///< sentences
  std::vector<ResidualCurve> curves;
  std::vector<RepeatStep> steps;
  simulation::SimulationSettings
      base;  ///< the given simulation, with its enabled effects fitted to the recordings
  simulation::SimulationSettings added;  ///< `base` with the effects that were found
  Prediction prediction;
  std::vector<InputUse> inputs;
  std::uint64_t seed = 0;
  std::string version;
};

/// Throws InputError with one sentence that names the first problem and what would be right.
void validate(const DiscrepancyProblem& problem);

/// Called repeatedly, always from one thread: `step` is the present step, `share` the share of the work that
/// is done.
using DiscrepancyProgress = std::function<void(const std::string& step, double share)>;

/// Compares the recordings with the simulation, names the effects that the simulation lacks, and measures how
/// much of the gap they close. Calls validate() first. The result does not depend on the number of threads.
DiscrepancyReport investigate(const DiscrepancyProblem& problem, const DiscrepancyProgress& progress = {});

/// What new recordings say of a rival of the predicted explanation.
struct RivalAnswer {
  std::string explanation;
  double nats = 0;  ///< logarithm of its predictive density of the new cycles, less that of the prediction
  bool better = false;  ///< beyond chance
};

/// Result of a comparison of new recordings with a prediction.
struct Confirmation {
  bool passed = false;
  std::string sentence;
  double size = 0;            ///< common factor of the effects' strengths, 1 = as predicted
  Interval interval;          ///< of `size`, by the new recordings alone
  Interval predicted;         ///< where `size` lies in 95 of 100 such recordings if the prediction is right
  double share_of_error = 0;  ///< share of the squared error that the prediction explains without any fit
  double p = 1;               ///< probability of the best score on the new cycles if nothing were missing
  std::vector<RivalAnswer> rivals;
  /// A rival that explains more. It may also be an explanation that excludes the predicted one when the new
  /// recordings are investigated without the prediction. Empty = none.
  std::string best_rival;
};

/// Tests a prediction with recordings that were made after it. `simulation` is the `base` of the report.
/// Throws InputError, also where the hash does not fit the prediction and the simulation.
Confirmation confirm(const Prediction& prediction, const simulation::SimulationSettings& simulation,
                     const std::vector<dataset::Recording>& recordings);

/// SHA-256 of a prediction (without its hash) and of the whole simulation that it was made with, including
/// its taxel curves. Names of files are not part of it.
std::string hashOf(const Prediction& prediction, const simulation::SimulationSettings& simulation);

}  // namespace fsr::discrepancy
