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
#include "study/decisions.h"
#include "study/study_plan.h"

namespace fsr::study {

struct StudyProblem {
  std::vector<dataset::Recording> recordings;
  StudyPlan plan;
  std::string simulation;  ///< name of the simulated rig that made the recordings; empty = real bags
};

/// One method's held-out errors.
struct StudyScore {
  std::string id;      ///< readable: baseline, per_curvature, ...
  std::string label;   ///< the paper's: "Method 1"
  std::string model;   ///< linear, grnn, forest
  std::string scored;  ///< whether models' scores were averaged or readings pooled, a phrase
  std::size_t scans = 0;
  std::vector<double> r2;            ///< of each taxel that takes part
  std::vector<double> rmse_percent;  ///< likewise
  statistics::Spread r2_spread;
  statistics::Spread rmse_percent_spread;
  statistics::BinnedErrors errors;  ///< of all taxels [Pa]
  statistics::ErrorSummary first_cycle;
  statistics::ErrorSummary later_cycles;
  std::size_t worst_taxel = 0;  ///< the one of the largest RMSE%
  double worst_rmse_percent = 0;
  statistics::BootstrapResult rmse_percent_interval;  ///< of the mean over taxels, readings of a model pooled
  statistics::BootstrapResult rmse_interval;          ///< of the RMSE of all readings [Pa]
  std::vector<double> bandwidth;                      ///< of each fold
};

/// RMSE% of `first` less that of `second`, with its interval, by resampling whole units.
struct StudyDifference {
  std::string first;
  std::string second;
  statistics::BootstrapResult rmse_percent;
};

/// One question of the paper.
struct StudyComparison {
  std::string id;  ///< algorithms, flat_against_all, methods, one_hot
  std::string title;
  std::vector<StudyScore> scores;
  statistics::PaperRuleResult r2;  ///< as published, taxels treated as independent
  statistics::PaperRuleResult rmse_percent;
  std::vector<StudyDifference> differences;  ///< beside it: of each pair
};

/// RMSE% over the grid of bandwidths, the data being the paper's.
struct BandwidthCurve {
  std::string id;
  std::string label;
  std::vector<double> rmse_percent;  ///< mean over taxels, for each of StudyPlan::bandwidths
};

/// The methods on all scans, bandwidth chosen by nested cross-validation, held out in one way.
struct SplitResult {
  std::string id;
  std::string description;
  std::vector<std::string> folds;
  std::vector<StudyScore> scores;
};

/// The number to quote: the best method where the data are held out as hard as they permit, in the split
/// where the best method errs most.
struct StudyHeadline {
  std::string split;
  std::string method;
  double rmse = 0;  ///< [Pa]
  statistics::BootstrapResult interval;
  std::string text;
};

/// What figures of one taxel show.
struct TaxelResponse {
  std::size_t taxel = 0;
  struct Curve {
    std::string surface;
    double curvature = 0;          ///< [1/m]
    std::vector<double> time;      ///< [s]
    std::vector<double> pressure;  ///< [Pa]
    std::vector<double> counts;
  };
  std::vector<Curve> curves;  ///< of each class, the middle section
  struct Prediction {
    std::string surface;
    double curvature = 0;                   ///< [1/m]
    std::vector<double> time;               ///< [s]
    std::vector<double> reference;          ///< [Pa]
    std::vector<double> without_curvature;  ///< baseline [Pa], held out
    std::vector<double> with_curvature;     ///< method 1 [Pa], held out
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
  std::vector<std::size_t> taxels;  ///< that take part
  std::vector<StudyComparison> comparisons;
  std::vector<BandwidthCurve> bandwidths;
  std::vector<SplitResult> splits;  ///< easiest first
  StudyHeadline headline;
  TaxelResponse response;
  std::vector<StudyDecision> decisions;
  std::vector<std::string> unmatchable;
  std::vector<std::string> holds_for;  ///< sentences on what the numbers do not say
  std::vector<std::string> warnings;
};

/// `stage` in words; done of total. Called from one thread at a time.
using StudyProgress = std::function<void(const std::string& stage, std::size_t done, std::size_t total)>;

/// Throws InputError: one sentence that names the first thing in the way. The same numbers on any number of
/// threads.
StudyResult study(const StudyProblem& problem, const StudyProgress& progress = {});

}  // namespace fsr::study
