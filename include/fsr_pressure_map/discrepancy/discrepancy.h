#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/simulation/simulation_settings.h"

namespace fsr::discrepancy {

struct DiscrepancyOptions {
  /// Ids of effects that somebody asks for: where the recordings cannot show one of them, that is the
  /// verdict.
  std::vector<std::string> ask;
  std::vector<std::string> leave_out;  ///< ids that are not in the library for this run
  bool repeat = false;                 ///< add effects until none is left
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0 = one for each core; the numbers do not depend on it
};

/// A simulation that may lack effects, and measurements.
struct DiscrepancyProblem {
  simulation::SimulationSettings simulation;
  std::vector<dataset::Recording> recordings;  ///< one for each bag, of one matrix
  DiscrepancyOptions options;
};

enum class Verdict { kNone, kUnknown, kAmbiguous, kWrongForm, kNamed, kNotIdentifiable };

/// "none", "unknown", "ambiguous", "wrong_form", "named", "not_identifiable".
std::string name(Verdict verdict);

/// 95 % unless said otherwise; NaN where it is not known.
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

/// An effect that is put forward.
struct FoundEffect {
  std::string id;
  std::string summary;                      ///< the library's one line
  std::vector<FittedParameter> parameters;  ///< empty for what a detector found
  double z = 0;                             ///< of what it explains, over cycles that took no part in its fit
  double share_of_ceiling = 0;              ///< of what anything explains
};

/// An effect that these recordings cannot show, or not alone.
struct NotIdentifiable {
  std::string id;
  std::string experiment;  ///< that would show it, as in name(Experiment)
  std::string reason;      ///< one sentence
};

/// Whether what the static curves leave depends on a covariate, asked before any effect is named.
struct CovariateTest {
  std::string covariate;      ///< as in name(Covariate)
  std::string method;         ///< sign_flips, block_bootstrap
  double p = 1;               ///< by chance alone, as much or more
  double adjusted = 1;        ///< by Benjamini and Yekutieli, over all covariates
  double share_of_error = 0;  ///< of the readings' squared error that it explains
  bool depends = false;       ///< adjusted p <= 0.05 and share >= 2 %
};

/// Where the discrepancy shows.
struct WhereItShows {
  std::vector<std::size_t> taxels;               ///< row-major; empty = all
  std::vector<std::string> conditions;           ///< surfaces; empty = all
  Interval pressure;                             ///< gauge [Pa]
  std::string direction = "both";                ///< both, loading, unloading
  std::vector<std::pair<double, double>> times;  ///< [s] since the first scan; empty = all
};

/// How much of the gap is closed where what was found was sized without seeing it: each surface foretold by
/// the others, each protocol by the others. Naming and static curves have seen all of them.
struct HeldOutGap {
  std::string by;     ///< condition, protocol
  double closed = 0;  ///< see Gap; over all parts
  Interval closed_interval;
  std::vector<std::pair<std::string, double>> parts;  ///< what was left out, and how much is closed there
};

/// How far simulation and measurement are apart, as rms over scans and taxels [share of full scale], on
/// data that took no part.
struct Gap {
  double before = 0;
  double after = 0;
  double floor = 0;   ///< what no explanation could undercut
  double closed = 0;  ///< (before^2 - after^2) / (before^2 - floor^2); NaN where that is not defined
  Interval before_interval, after_interval, floor_interval, closed_interval;
  double before_pressure = 0;  ///< the same through the local slope of the curves [Pa]
  double after_pressure = 0;
  double floor_pressure = 0;
  std::vector<std::string> held_out_by;  ///< of cycles, condition, protocol
  std::vector<HeldOutGap> foretold;      ///< of the last two
  std::vector<std::string> missing;      ///< sentences: what no data were held out for
};

/// What the gap costs in use, as the largest error [Pa]; NaN where not known.
struct GapInUse {
  std::string situation;  ///< ramp, stance, standing
  double before = 0;      ///< [Pa]
  double after = 0;       ///< [Pa]
};

/// How one candidate did.
struct CandidateScore {
  std::vector<std::string> ids;  ///< one effect, or a pair
  std::string outcome;           ///< named, credible, refused, not_identifiable, required_data_missing
  double share_of_error = 0;     ///< of the squared error before, held out
  double share_of_ceiling = 0;
  double z = 0;
};

/// What to do at the rig next.
struct NextExperiment {
  std::string protocol;   ///< two_speeds, minor_loops, step_hold, rest, two_ambients, random_order, ...
  std::string sentence;   ///< what to do, and what it tells apart
  double separation = 0;  ///< the smallest, in standard deviations
  std::vector<std::pair<std::string, std::string>> separates;  ///< pairs of ids
};

/// Mean residual over one covariate, for figures.
struct ResidualCurve {
  std::string covariate;       ///< as in name(Covariate)
  std::string unit;            ///< of `at`
  std::vector<double> at;      ///< middle of each bin
  std::vector<double> before;  ///< [share of full scale]
  std::vector<double> after;   ///< likewise
  std::vector<double> error;   ///< standard error of both
};

/// A bag and how often its held-out part was looked at.
struct InputUse {
  std::string file;
  std::string sha256;
  std::uint64_t scans = 0;
  int show_opened = 0;
};

/// The hold-out cycles of one bag: nothing was fitted to them, and the gap is measured on them.
struct HoldOutCycles {
  std::string file;  ///< base name of the bag
  /// Stamps of the first and the last scan of each cycle, both included [ns since 1970].
  std::vector<std::pair<std::int64_t, std::int64_t>> cycles;
};

/// One round of `repeat`.
struct RepeatStep {
  std::string added;  ///< id, empty in the last round
  std::string sentence;
  double share_of_error = 0;
};

/// What was foretold before the next experiment; confirm() holds it against new recordings.
struct Prediction {
  std::vector<simulation::EnabledEffect> effects;              ///< of the best explanation
  std::vector<std::vector<simulation::EnabledEffect>> rivals;  ///< other explanations that were credible
  Interval size;     ///< factor of the first effect's strength, 1 = as fitted
  std::string hash;  ///< SHA-256 of all of the above and the simulation
};

/// Everything that verdict.yaml, results.json and the report say.
struct DiscrepancyReport {
  Verdict verdict = Verdict::kNone;
  std::string sentence;  ///< the verdict in words
  std::vector<FoundEffect> effects;
  std::vector<std::vector<std::string>> credible_set;  ///< every explanation not excluded, best first
  std::vector<std::string> depends_on;                 ///< covariates, as in name(Covariate)
  std::vector<NotIdentifiable> not_identifiable;
  std::vector<CovariateTest> covariates;
  WhereItShows where;
  Gap gap;
  std::vector<HoldOutCycles> hold_out;  ///< in time order; bags without a hold-out cycle are left out
  std::vector<GapInUse> in_use;
  std::vector<NextExperiment> next_experiment;  ///< none or one
  std::vector<CandidateScore> candidates;       ///< best first
  std::vector<std::string> tested;              ///< ids of all effects that were tried
  std::vector<std::string> limitations;         ///< sentences
  std::vector<ResidualCurve> curves;
  std::vector<RepeatStep> steps;
  simulation::SimulationSettings
      base;  ///< the simulation given, its enabled effects fitted to the recordings
  simulation::SimulationSettings added;  ///< `base` with the effects found
  Prediction prediction;
  std::vector<InputUse> inputs;
  std::uint64_t seed = 0;
  std::string version;
};

/// Throws InputError: one sentence that names the first thing in the way and what would be right.
void validate(const DiscrepancyProblem& problem);

/// Called as the work goes on, from one thread: what is being done, and the share done.
using DiscrepancyProgress = std::function<void(const std::string& step, double share)>;

/// Where do they disagree, what is missing, how small is the gap once it is in? Validates first. The
/// same numbers on any number of threads.
DiscrepancyReport investigate(const DiscrepancyProblem& problem, const DiscrepancyProgress& progress = {});

/// What new recordings say of a prediction.
struct Confirmation {
  bool passed = false;
  std::string sentence;
  double size = 0;  ///< of the first effect, 1 = as predicted
  Interval interval;
  double share_of_error = 0;  ///< that the prediction explains, nothing fitted
  /// A rival that explains more; or, asked without knowing what was foretold, an explanation of the new
  /// recordings that excludes it. Empty = none.
  std::string best_rival;
};

/// Whether recordings that nobody had seen bear out what was predicted. `simulation` is the `base` of the
/// report. Throws InputError, also where hash and prediction do not belong together.
Confirmation confirm(const Prediction& prediction, const simulation::SimulationSettings& simulation,
                     const std::vector<dataset::Recording>& recordings);

/// Hash of a prediction made with a simulation.
std::string hashOf(const Prediction& prediction, const simulation::SimulationSettings& simulation);

}  // namespace fsr::discrepancy
