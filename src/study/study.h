#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/dataset/recording.h"
#include "fsr_pressure_map/statistics/metrics.h"
#include "statistics/bootstrap.h"
#include "statistics/paper_rule.h"
#include "study/paper.h"
#include "study/study_plan.h"

namespace fsr::study {

struct StudyProblem {
  std::vector<dataset::Recording> recordings;
  StudyPlan plan;
  std::string simulation;  ///< name of the simulated rig that made the recordings; empty = real bags
};

/// Held-out errors of one method.
struct StudyScore {
  std::string id;      ///< baseline, per_curvature, ...
  std::string label;   ///< name in the paper, e.g. "Method 1"
  std::string model;   ///< linear, grnn, forest
  std::string scored;  ///< a phrase: whether the models' scores were averaged or their readings pooled
  std::size_t scans = 0;
  std::vector<double> r2;            ///< of each studied taxel
  std::vector<double> rmse_percent;  ///< likewise
  statistics::Spread r2_spread;
  statistics::Spread rmse_percent_spread;
  statistics::BinnedErrors errors;  ///< of all taxels [Pa]
  statistics::ErrorSummary first_cycle;
  statistics::ErrorSummary later_cycles;
  std::size_t worst_taxel = 0;  ///< taxel with the largest RMSE%
  double worst_rmse_percent = 0;
  statistics::BootstrapResult rmse_percent_interval;  ///< of the mean over taxels; readings of a model pooled
  statistics::BootstrapResult rmse_interval;          ///< of the RMSE of all readings [Pa]
  std::vector<double> bandwidth;                      ///< of each fold
};

/// RMSE% of `first` minus RMSE% of `second`, with its bootstrap interval over whole cycles or mounts.
struct StudyDifference {
  std::string first;
  std::string second;
  statistics::BootstrapResult rmse_percent;
};

/// One comparison of the paper.
struct StudyComparison {
  std::string id;  ///< algorithms, flat_against_all, methods, one_hot
  std::string title;
  std::vector<StudyScore> scores;
  statistics::PaperRuleResult r2;  ///< tests as published: taxels treated as independent
  statistics::PaperRuleResult rmse_percent;
  std::vector<StudyDifference> differences;  ///< of each pair, by bootstrap
};

/// RMSE% over the grid of bandwidths, with the paper's down-sampling.
struct BandwidthCurve {
  std::string id;
  std::string label;
  std::vector<double> rmse_percent;  ///< mean over taxels, for each of StudyPlan::bandwidths
};

/// Results of one split: all methods on all scans, with bandwidths chosen by nested cross-validation.
struct SplitResult {
  std::string id;
  std::string description;
  std::vector<std::string> folds;
  std::vector<StudyScore> scores;
};

/// How a curvature that a method is told differs from the true one.
struct CurvatureError {
  double relative = 0;  ///< of the true curvature
  double absolute = 0;  ///< [1/m]; positive = rounder

  double told(double curvature) const { return curvature + relative * curvature + absolute; }  ///< [1/m]
};

/// Held-out errors of a method that is told wrong curvatures.
struct CurvatureErrorScore {
  CurvatureError error;
  double rmse_percent = 0;                    ///< mean over taxels
  double rmse = 0;                            ///< of all readings [Pa]
  statistics::BootstrapResult rmse_interval;  ///< [Pa]
  std::vector<double> rmse_of_class;          ///< likewise of each class [classes] [Pa]
  double moved = 0;                           ///< RMS difference from the answers at the true curvature [Pa]
  /// RMS of what the live map adds to the standard deviation of a reading if the message states a deviation
  /// of curvature as large as the error [Pa].
  double stated = 0;
};

/// Error of the map against error of the curvature, for one method.
struct CurvatureErrorCurve {
  std::string id;
  std::string label;
  std::vector<CurvatureErrorScore> scores;
};

/// The result to quote: the best method in the hardest split, i.e. the split where the best method has the
/// largest error.
struct StudyHeadline {
  std::string split;
  std::string method;
  double rmse = 0;  ///< [Pa]
  statistics::BootstrapResult interval;
  std::string text;
};

/// Data for the figures of one taxel.
struct TaxelResponse {
  std::size_t taxel = 0;
  struct Curve {
    std::string surface;
    double curvature = 0;          ///< [1/m]
    std::vector<double> time;      ///< [s]
    std::vector<double> pressure;  ///< [Pa]
    std::vector<double> counts;
  };
  std::vector<Curve> curves;  ///< the middle section of each class
  struct Prediction {
    std::string surface;
    double curvature = 0;                   ///< [1/m]
    std::vector<double> time;               ///< [s]
    std::vector<double> reference;          ///< [Pa]
    std::vector<double> without_curvature;  ///< held-out prediction of the baseline [Pa]
    std::vector<double> with_curvature;     ///< held-out prediction of method 1 [Pa]
  } prediction;
};

struct StudyClass {
  dataset::CurvatureClass condition;
  std::size_t scans = 0;
  std::size_t cycles = 0;
  std::size_t mounts = 0;
};

struct StudyResult {
  StudyPlan plan;
  std::string simulation;
  calibration::Provenance provenance;
  dataset::SensorIdentity sensor;
  matrix::Layout layout;
  std::vector<StudyClass> classes;
  std::size_t scans = 0;
  std::size_t cycles = 0;
  std::size_t mounts = 0;
  std::vector<std::size_t> taxels;  ///< the studied taxels: not masked, and varying on every class
  std::vector<StudyComparison> comparisons;
  std::vector<BandwidthCurve> bandwidths;
  std::vector<SplitResult> splits;  ///< easiest first
  /// How the model of the sheet's memory was chosen for the score `history` of leave_protocol_out, and the
  /// errors of all families on each protocol. Without protocols: `choice` says why it is not assessable; "" =
  /// not asked for.
  calibration::HistoryScore history;
  /// All methods in the first split, each told wrong curvatures; empty without bent classes, or if not asked
  /// for.
  std::vector<CurvatureErrorCurve> curvature_errors;
  StudyHeadline headline;
  TaxelResponse response;
  std::vector<StudyDecision> decisions;
  std::vector<std::string> unmatchable;  ///< only of the simulated rigs that were fitted to the paper
  std::vector<std::string> holds_for;    ///< sentences on the limits of the results
  std::vector<std::string> warnings;
};

/// Called from one thread at a time. `stage` is a phrase; `done` of `total` steps of it are done.
using StudyProgress = std::function<void(const std::string& stage, std::size_t done, std::size_t total)>;

/// Compares the paper's methods and further schemes by cross-validation. The numbers do not depend on the
/// number of threads. Throws InputError with one sentence if the input is unusable.
StudyResult study(const StudyProblem& problem, const StudyProgress& progress = {});

}  // namespace fsr::study
