#pragma once

#include <tuple>

#include "study/study_pieces.h"

// The members of the types that the file of a shard of a study holds. One list serves writing and reading.
namespace fsr::report {

template <typename T, typename M>
struct Field {
  const char* name;
  M T::*member;
};

template <typename T, typename M>
constexpr Field<T, M> field(const char* name, M T::*member) {
  return {name, member};
}

/// `list`: a tuple of Field.
template <typename T>
struct Fields;

template <>
struct Fields<statistics::Spread> {
  using Of = statistics::Spread;
  static constexpr auto list = std::make_tuple(field("mean", &Of::mean), field("deviation", &Of::deviation));
};

template <>
struct Fields<statistics::ErrorSummary> {
  using Of = statistics::ErrorSummary;
  static constexpr auto list =
      std::make_tuple(field("count", &Of::count), field("bias", &Of::bias), field("rmse", &Of::rmse),
                      field("limit_low", &Of::limit_low), field("limit_high", &Of::limit_high),
                      field("p95_absolute", &Of::p95_absolute));
};

template <>
struct Fields<statistics::BinnedErrors::Directions> {
  using Of = statistics::BinnedErrors::Directions;
  static constexpr auto list = std::make_tuple(field("all", &Of::all), field("loading", &Of::loading),
                                               field("unloading", &Of::unloading));
};

template <>
struct Fields<statistics::BinnedErrors> {
  using Of = statistics::BinnedErrors;
  static constexpr auto list = std::make_tuple(field("whole", &Of::whole), field("bins", &Of::bins));
};

template <>
struct Fields<statistics::BootstrapResult> {
  using Of = statistics::BootstrapResult;
  static constexpr auto list = std::make_tuple(
      field("estimate", &Of::estimate), field("low", &Of::low), field("high", &Of::high),
      field("standard_error", &Of::standard_error), field("method", &Of::method), field("level", &Of::level),
      field("units", &Of::units), field("resamples", &Of::resamples));
};

template <>
struct Fields<statistics::PaperRuleOptions> {
  using Of = statistics::PaperRuleOptions;
  static constexpr auto list =
      std::make_tuple(field("level", &Of::level), field("normality_of", &Of::normality));
};

template <>
struct Fields<regression::GrnnOptions> {
  using Of = regression::GrnnOptions;
  static constexpr auto list =
      std::make_tuple(field("bandwidth", &Of::bandwidth), field("spread", &Of::spread),
                      field("distance", &Of::distance), field("weighting", &Of::weighting));
};

template <>
struct Fields<regression::ForestOptions> {
  using Of = regression::ForestOptions;
  static constexpr auto list = std::make_tuple(
      field("trees", &Of::trees), field("minimum_leaf", &Of::minimum_leaf),
      field("leaf_count", &Of::leaf_count), field("sampling", &Of::sampling), field("seed", &Of::seed));
};

// Without the number of threads, which changes no number, and the date, which stands in the provenance.
template <>
struct Fields<study::StudyPlan> {
  using Of = study::StudyPlan;
  static constexpr auto list = std::make_tuple(
      field("study", &Of::name), field("sections", &Of::sections), field("down_sampling", &Of::down_sampling),
      field("method_4", &Of::binary_share), field("range", &Of::range), field("grnn", &Of::grnn),
      field("forest", &Of::forest), field("tests", &Of::tests), field("bandwidths", &Of::bandwidths),
      field("bandwidth_taxels", &Of::bandwidth_taxels), field("resamples", &Of::resamples),
      field("beyond_the_paper", &Of::beyond_the_paper), field("figure_taxel", &Of::figure_taxel),
      field("seed", &Of::seed));
};

template <>
struct Fields<calibration::SourceBag> {
  using Of = calibration::SourceBag;
  static constexpr auto list =
      std::make_tuple(field("name", &Of::name), field("sha256", &Of::sha256), field("scans", &Of::scans));
};

template <>
struct Fields<calibration::Provenance> {
  using Of = calibration::Provenance;
  static constexpr auto list = std::make_tuple(
      field("tool_version", &Of::tool_version), field("date", &Of::date), field("seed", &Of::seed),
      field("bags", &Of::bags), field("conditioning", &Of::conditioning));
};

template <>
struct Fields<calibration::HistoryScore::Protocol> {
  using Of = calibration::HistoryScore::Protocol;
  static constexpr auto list = std::make_tuple(field("name", &Of::name), field("rmse", &Of::rmse),
                                               field("corrected_rmse", &Of::corrected_rmse));
};

template <>
struct Fields<calibration::HistoryScore::Part> {
  using Of = calibration::HistoryScore::Part;
  static constexpr auto list = std::make_tuple(
      field("name", &Of::name), field("readings", &Of::readings), field("static_rmse", &Of::static_rmse),
      field("rmse", &Of::rmse), field("within_one_deviation", &Of::within_one_deviation));
};

template <>
struct Fields<calibration::HistoryScore> {
  using Of = calibration::HistoryScore;
  static constexpr auto list = std::make_tuple(
      field("choice", &Of::choice), field("protocols", &Of::protocols), field("parts", &Of::parts));
};

template <>
struct Fields<dataset::SensorIdentity> {
  using Of = dataset::SensorIdentity;
  static constexpr auto list = std::make_tuple(
      field("sensor_id", &Of::sensor_id), field("serial", &Of::serial), field("firmware", &Of::firmware),
      field("model", &Of::model), field("sealing", &Of::sealing), field("transducer", &Of::transducer));
};

template <>
struct Fields<dataset::CurvatureClass> {
  using Of = dataset::CurvatureClass;
  static constexpr auto list =
      std::make_tuple(field("surface", &Of::surface), field("curvature", &Of::curvature));
};

template <>
struct Fields<matrix::MatrixSize> {
  using Of = matrix::MatrixSize;
  static constexpr auto list = std::make_tuple(field("rows", &Of::rows), field("columns", &Of::columns));
};

template <>
struct Fields<matrix::Layout> {
  using Of = matrix::Layout;
  static constexpr auto list = std::make_tuple(field("size", &Of::size), field("pitch_x", &Of::pitch_x),
                                               field("pitch_y", &Of::pitch_y));
};

template <>
struct Fields<study::StudyClass> {
  using Of = study::StudyClass;
  static constexpr auto list = std::make_tuple(field("condition", &Of::condition), field("scans", &Of::scans),
                                               field("cycles", &Of::cycles), field("mounts", &Of::mounts));
};

template <>
struct Fields<study::StudyDecision> {
  using Of = study::StudyDecision;
  static constexpr auto list =
      std::make_tuple(field("subject", &Of::subject), field("paper", &Of::paper), field("study", &Of::study));
};

template <>
struct Fields<study::StudyScore> {
  using Of = study::StudyScore;
  static constexpr auto list = std::make_tuple(
      field("id", &Of::id), field("label", &Of::label), field("model", &Of::model),
      field("scored", &Of::scored), field("scans", &Of::scans), field("r2", &Of::r2),
      field("rmse_percent", &Of::rmse_percent), field("r2_spread", &Of::r2_spread),
      field("rmse_percent_spread", &Of::rmse_percent_spread), field("errors", &Of::errors),
      field("first_cycle", &Of::first_cycle), field("later_cycles", &Of::later_cycles),
      field("worst_taxel", &Of::worst_taxel), field("worst_rmse_percent", &Of::worst_rmse_percent),
      field("rmse_percent_interval", &Of::rmse_percent_interval), field("rmse_interval", &Of::rmse_interval),
      field("bandwidth", &Of::bandwidth));
};

template <>
struct Fields<study::BandwidthCurve> {
  using Of = study::BandwidthCurve;
  static constexpr auto list = std::make_tuple(field("id", &Of::id), field("label", &Of::label),
                                               field("rmse_percent", &Of::rmse_percent));
};

template <>
struct Fields<study::SplitResult> {
  using Of = study::SplitResult;
  static constexpr auto list = std::make_tuple(field("id", &Of::id), field("description", &Of::description),
                                               field("folds", &Of::folds), field("scores", &Of::scores));
};

template <>
struct Fields<study::CurvatureError> {
  using Of = study::CurvatureError;
  static constexpr auto list =
      std::make_tuple(field("relative", &Of::relative), field("absolute", &Of::absolute));
};

template <>
struct Fields<study::CurvatureErrorScore> {
  using Of = study::CurvatureErrorScore;
  static constexpr auto list = std::make_tuple(
      field("error", &Of::error), field("rmse_percent", &Of::rmse_percent), field("rmse", &Of::rmse),
      field("rmse_interval", &Of::rmse_interval), field("rmse_of_class", &Of::rmse_of_class),
      field("moved", &Of::moved), field("stated", &Of::stated));
};

template <>
struct Fields<study::CurvatureErrorCurve> {
  using Of = study::CurvatureErrorCurve;
  static constexpr auto list =
      std::make_tuple(field("id", &Of::id), field("label", &Of::label), field("scores", &Of::scores));
};

template <>
struct Fields<study::TaxelResponse::Curve> {
  using Of = study::TaxelResponse::Curve;
  static constexpr auto list = std::make_tuple(
      field("surface", &Of::surface), field("curvature", &Of::curvature), field("time", &Of::time),
      field("pressure", &Of::pressure), field("counts", &Of::counts));
};

template <>
struct Fields<study::TaxelResponse::Prediction> {
  using Of = study::TaxelResponse::Prediction;
  static constexpr auto list = std::make_tuple(
      field("surface", &Of::surface), field("curvature", &Of::curvature), field("time", &Of::time),
      field("reference", &Of::reference), field("without_curvature", &Of::without_curvature),
      field("with_curvature", &Of::with_curvature));
};

template <>
struct Fields<study::TaxelResponse> {
  using Of = study::TaxelResponse;
  static constexpr auto list = std::make_tuple(field("taxel", &Of::taxel), field("curves", &Of::curves),
                                               field("prediction", &Of::prediction));
};

// What the pieces tell is empty in the frame, and not stored.
template <>
struct Fields<study::StudyResult> {
  using Of = study::StudyResult;
  static constexpr auto list = std::make_tuple(
      field("plan", &Of::plan), field("simulation", &Of::simulation), field("provenance", &Of::provenance),
      field("sensor", &Of::sensor), field("layout", &Of::layout), field("classes", &Of::classes),
      field("scans", &Of::scans), field("cycles", &Of::cycles), field("mounts", &Of::mounts),
      field("taxels", &Of::taxels), field("splits", &Of::splits), field("history", &Of::history),
      field("decisions", &Of::decisions), field("unmatchable", &Of::unmatchable),
      field("holds_for", &Of::holds_for), field("warnings", &Of::warnings));
};

template <>
struct Fields<study::CycleSums::Values> {
  using Of = study::CycleSums::Values;
  static constexpr auto list = std::make_tuple(
      field("taxels", &Of::taxels), field("models", &Of::models), field("cycles", &Of::cycles),
      field("range", &Of::range), field("squares", &Of::squares), field("readings", &Of::readings));
};

template <>
struct Fields<study::CycleUnits> {
  using Of = study::CycleUnits;
  static constexpr auto list = std::make_tuple(field("mount", &Of::mount), field("by_mount", &Of::by_mount));
};

template <>
struct Fields<study::ScoredMethod> {
  using Of = study::ScoredMethod;
  static constexpr auto list = std::make_tuple(field("score", &Of::score), field("sums", &Of::sums));
};

template <>
struct Fields<study::StudyPiece> {
  using Of = study::StudyPiece;
  static constexpr auto list =
      std::make_tuple(field("part", &Of::part), field("compared", &Of::compared),
                      field("bandwidths", &Of::bandwidths), field("held_out", &Of::held_out),
                      field("with_history", &Of::with_history), field("history", &Of::history),
                      field("curvature_errors", &Of::curvature_errors), field("response", &Of::response));
};

template <>
struct Fields<study::StudyParts> {
  using Of = study::StudyParts;
  static constexpr auto list =
      std::make_tuple(field("frame", &Of::frame), field("units", &Of::units),
                      field("pieces_of_study", &Of::pieces_of_study), field("computed", &Of::computed));
};

}  // namespace fsr::report
