#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/error_budget.h"
#include "fsr_pressure_map/calibration/history.h"
#include "fsr_pressure_map/calibration/shape.h"
#include "fsr_pressure_map/calibration/temperature.h"
#include "fsr_pressure_map/compensation/curvature_tables.h"
#include "fsr_pressure_map/dataset/condition_classes.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/regression/regressor_options.h"
#include "fsr_pressure_map/statistics/metrics.h"

namespace fsr::compensation {
struct TrainingStatistics;
}

namespace fsr::calibration {

/// How the model of the sheet's memory is chosen.
struct HistoryChoice {
  bool automatic = true;  ///< by leaving out whole protocols
  /// The family to take where `automatic` is false; otherwise one to try first, kNone = try all.
  HistoryFamily family = HistoryFamily::kNone;
};

/// Whether the calibration expects a tare at the start of a session.
enum class ZeroChoice {
  kAuto,    ///< unless sessions that were left out speak against it
  kNone,    ///< no
  kSession  ///< yes
};

struct CalibrationOptions {
  compensation::Scheme scheme =
      compensation::Scheme::kInterpolated;  ///< as kPerCurvature on trained surfaces, better between them
  regression::RegressorOptions regressor;   ///< the model; the seed of a forest is `seed`
  /// GRNN: choose the bandwidth by nested cross-validation and ignore that of `regressor`.
  bool choose_bandwidth = true;
  std::size_t folds = 5;   ///< number of sections of each condition, 2 to 20
  bool scores = true;      ///< compute cross-validated scores; the deviation is held out in any case
  std::uint64_t seed = 1;  ///< of the forest; stored in the file
  unsigned threads = 0;    ///< 0 = one for each core; the results do not depend on it
  std::string date;        ///< ISO 8601, UTC; empty = now
  HistoryChoice history = {};
  ZeroChoice zero = ZeroChoice::kAuto;
  /// Whether a model of the temperature is tried where all recordings have temperatures.
  bool temperature = true;
  /// Standard uncertainty of the chamber's transducer, with its constant error, for the error budget [Pa];
  /// NaN = not declared.
  double reference_deviation = std::numeric_limits<double>::quiet_NaN();
};

/// Input of calibrate().
struct CalibrationProblem {
  std::vector<dataset::Recording> recordings;
  CalibrationOptions options;
};

/// Lowest and highest value over training; NaN = not recorded.
struct TrainedInterval {
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();

  bool known() const { return low <= high; }  // false for NaN
  /// NaN changes nothing.
  void include(double value);
};

struct TrainedRanges {
  TrainedInterval pressure;       ///< chamber, gauge [Pa]
  TrainedInterval pressure_rate;  ///< of the chamber over one second, negative while venting [Pa/s]
  TrainedInterval curvature;      ///< principal curvature, of all taxels [1/m]
  TrainedInterval temperature;    ///< [degree Celsius]
};

/// Errors of held-out readings: each section is predicted by models that were trained without it.
struct Score {
  std::uint64_t readings = 0;  ///< scans x taxels
  /// Mean and standard deviation over taxels. The value of a taxel is the mean over its sections; the range
  /// for RMSE% is that of the held-out section.
  statistics::Spread r2;
  statistics::Spread rmse_percent;
  std::size_t worst_taxel = 0;  ///< the taxel with the largest RMSE%
  double worst_rmse_percent = std::numeric_limits<double>::quiet_NaN();
  /// Errors of all taxels and sections together [Pa].
  statistics::BinnedErrors errors;
  /// Share of the readings within one stated deviation; the deviation comes from other sections.
  double within_one_deviation = std::numeric_limits<double>::quiet_NaN();
};

/// One curvature class of the bags, predicted by the scheme.
struct ConditionScore {
  dataset::CurvatureClass condition;
  bool trained =
      true;  ///< false: the model that answers was not trained on this class (flat_only on a bent surface)
  Score score;
};

/// Errors on inner surfaces, each in turn predicted as if it were not in the training: the error to expect on
/// a new curvature.
struct UnseenScore {
  std::uint64_t readings =
      0;  ///< scans x taxels; 0 = there is no inner surface, or the scheme has no classes
  statistics::Spread rmse_percent;  ///< mean and standard deviation over taxels, % of the range of pressure
  double rmse = std::numeric_limits<double>::quiet_NaN();  ///< of all readings together [Pa]
};

/// Errors on another mount: each mount of a surface that was mounted more than once is predicted by models
/// that were trained without it.
struct RemountScore {
  std::uint64_t readings = 0;         ///< scans x taxels; 0 = each surface was mounted once: not assessed
  statistics::Spread rmse_percent{};  ///< mean and standard deviation over taxels, % of the range of pressure
  double rmse = std::numeric_limits<double>::quiet_NaN();  ///< of all readings together [Pa]
};

/// Errors on protocols that training left out, of the static answer and with a model of the sheet's memory.
struct HistoryScore {
  struct Protocol {
    std::string name;  ///< e.g. "ramps of 17 kPa/s"
    /// Of readings, by HistoryFamily [Pa]; that of kNone is the static answer.
    std::array<double, 4> rmse = {};
    double corrected_rmse = 0;  ///< with the correction c alone, without operators [Pa]
  };
  /// Readings of all protocols together, one by one.
  struct Part {
    std::string name;                                                        ///< e.g. "unloading"
    std::uint64_t readings = 0;                                              ///< scans x taxels
    double static_rmse = std::numeric_limits<double>::quiet_NaN();           ///< [Pa]
    double rmse = std::numeric_limits<double>::quiet_NaN();                  ///< with the model [Pa]
    double within_one_deviation = std::numeric_limits<double>::quiet_NaN();  ///< with the model
  };
  std::string choice;  ///< a sentence: what was chosen and why; empty = not asked for
  std::vector<Protocol> protocols;
  std::vector<Part> parts;  ///< whole, by direction, and by time since the last reversal; empty = no model
};

/// Errors on sessions that training left out, without and with a tare at their start. A session is one stay
/// of the sheet: a recording, a surface and a mount.
struct SessionScore {
  struct Session {
    std::string name;            ///< e.g. "a.bag, flat, mount 2"
    std::uint64_t readings = 0;  ///< scans x taxels after the rest at the start
    /// Of the static tables; of the same after a tare; of tables that were trained with the zero of each
    /// session, after a tare [Pa].
    std::array<double, 3> rmse = {};
  };
  std::string choice;             ///< a sentence: what was chosen and why; empty = not asked for
  std::vector<Session> sessions;  ///< empty = no session could be left out
};

/// Errors on protocols and recordings that training left out, without and with a model of the temperature.
struct TemperatureScore {
  struct Group {
    std::string name;    ///< e.g. "ramps of 17 kPa/s", "recording 1_flat.bag"
    double without = 0;  ///< RMSE of readings, full scale = highest pressure [Pa]
    double with = 0;
  };
  std::string choice;  ///< a sentence: what was chosen and why; empty = not asked for, or no thermometer
  std::vector<Group> groups;  ///< empty = not assessed
};

struct CalibrationScores {
  std::vector<ConditionScore> conditions;  ///< empty = not computed
  Score whole;                             ///< all conditions together
  UnseenScore unseen;
  RemountScore remount;
  HistoryScore history;
  SessionScore session;
  TemperatureScore temperature;
};

struct SourceBag {
  std::string name;    ///< base name
  std::string sha256;  ///< hexadecimal; empty if the recording came over topics
  std::uint64_t scans = 0;
};

/// Origin of a calibration.
struct Provenance {
  std::string tool_version;
  std::string date;  ///< ISO 8601, UTC
  std::uint64_t seed = 0;
  std::vector<SourceBag> bags;
  /// Sentences: whether the first loadings of each session were conditioning. Empty = not known, as for files
  /// of earlier versions.
  std::vector<std::string> conditioning = {};
};

/// What a calibration expects of a tare.
enum class SessionTare {
  kNone,         ///< nothing; a tare may be set all the same
  kTablesAlone,  ///< one at the start of a session; the tables are those of kNone
  kTrained       ///< likewise; the tables were trained with the zero of each session
};

/// A tare at rest at the start of a session as part of the model. It subtracts from the answers of a taxel by
/// how much its answer at rest differs from that of the training.
struct SessionZero {
  SessionTare tare = SessionTare::kNone;
  /// Over the readings of sessions that training left out, without and with the tare [Pa]; NaN = none was
  /// left out.
  double rmse_without = std::numeric_limits<double>::quiet_NaN();
  double rmse = std::numeric_limits<double>::quiet_NaN();
  /// [taxels x classes of the tables], taxel by taxel: what the table answers too much at the rests of its
  /// training [Pa]. It is not zero where the sheet has a loop or creeps. Empty = not known, taken as 0.
  std::vector<float> at_rest{};

  bool expected() const { return tare != SessionTare::kNone; }
};

/// How a calibration was made from another one, its parent, after the sheet or the board had changed. Where
/// the sheet reads `reading` today, it read (reading - offset) / gain when the parent was trained, and the
/// tables answer to `reading` what those of the parent answer to that.
struct Correction {
  std::string parent;       ///< id of the parent; empty = the calibration was trained, not corrected
  std::string parent_date;  ///< of its training, ISO 8601, UTC
  std::string date;         ///< of the correction, ISO 8601, UTC
  std::string tool_version;
  bool by_taxel = false;                ///< false: gain and offset of all taxels are the same
  std::vector<double> gain;             ///< [taxels], ratio
  std::vector<double> offset;           ///< [taxels] [counts]
  std::vector<std::string> surfaces{};  ///< on which the sheet was rechecked
  std::vector<SourceBag> bags{};        ///< of the recheck
  std::uint64_t cycles = 0;             ///< of the recheck
  /// Of the recheck's readings: what the parent stated, what it had, and the error of the corrected answer to
  /// cycles that were left out [Pa].
  double expected_rmse = std::numeric_limits<double>::quiet_NaN();
  double rmse_before = std::numeric_limits<double>::quiet_NaN();
  double rmse = std::numeric_limits<double>::quiet_NaN();

  bool present() const { return !parent.empty(); }
};

/// Everything that converts scans to pressure, with its accuracy.
struct Calibration {
  std::string id;  ///< first hex digits of the hash of its file; empty until it is saved or loaded
  regression::RegressorOptions regressor;  ///< the model; for a GRNN with its bandwidth, chosen or given
  bool bandwidth_chosen = false;           ///< from the data, not given by the user
  std::size_t folds = 0;
  dataset::SensorIdentity sensor;
  matrix::Layout layout;
  /// [taxels], 1 = the taxel has no model: masked in the bags, or its reading never changed. Its tables are
  /// NaN.
  std::vector<std::uint8_t> no_model;
  std::vector<std::uint8_t> masked;  ///< [taxels], 1 = masked in the bags
  compensation::CurvatureTables tables;
  HistoryModel history;  ///< of the sheet's memory; family kNone = the tables alone answer
  SessionZero session_zero;
  TemperatureModel temperature;  ///< of the sheet; tables and history are those at T_0
  ShapeModel shape;              ///< how the unloaded sheet reads on each surface
  TrainedRanges trained;
  dataset::Coverage coverage;
  CalibrationScores scores;
  ErrorBudget budget;  ///< absent where scores were not computed
  Provenance provenance;
  Correction correction;  ///< scores, coverage and provenance of a corrected calibration are its parent's
  /// Sums behind the tables, from which merging trains anew. Null: the file was loaded without them.
  std::shared_ptr<const compensation::TrainingStatistics> statistics;
  std::vector<std::string> warnings;  ///< sentences for the user
};

/// Throws InputError: one sentence that names the first problem and what would be right.
void validate(const CalibrationProblem& problem);

/// Called as the training goes on, from one thread at a time. `share`: of the step that is done, 0 to 1.
using CalibrationProgress = std::function<void(const std::string& step, double share)>;

/// Trains a calibration: tables, scores and provenance from recordings. Validates the problem first. The
/// result is the same on any number of threads.
Calibration calibrate(const CalibrationProblem& problem, const CalibrationProgress& progress = {});

}  // namespace fsr::calibration
