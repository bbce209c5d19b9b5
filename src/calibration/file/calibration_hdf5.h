#pragma once

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "hdf5/members.h"

namespace fsr::calibration {

// The content of a calibration file, schema 3; without /history and /temperature it is one of schema 2:
//
//     /            attributes scheme, model, bandwidth, folds, full_scale, curvature_rule, use
//     /model       attributes bandwidth_chosen, spread, distance, weighting, trees, minimum_leaf, leaf_rule
//                  (absent in the first files)
//     /sensor      attributes sensor_id, serial, firmware, model, sealing, transducer
//     /layout      attributes rows, columns, pitch_x [m], pitch_y [m]; no_model, masked [taxels]
//     /trained     attributes pressure, pressure_rate, curvature, temperature: lowest, highest
//     /provenance  attributes tool_version, date, seed; bags, sha256, scans [bags]; warnings; conditioning
//     /correction  attributes parent, parent_date, date, tool_version, by_taxel, cycles, expected_rmse, ...;
//                  gain, offset [taxels], surfaces, bags, sha256, scans (absent where nothing was corrected)
//     /tables      surfaces [models], curvature [models x (1 or taxels)],
//                  pressure, deviation, support [taxels x models x codes], trained_codes [taxels x models x
//                  2]
//     /rule        attribute blend; model_of_class, length_scale, law_curvature, law_gain, law_offset,
//                  unseen_pressure, unseen_deviation, log_weight where the scheme has them (absent in schema
//                  1: nearest)
//     /history     attribute family; knot, correction, radius, play_weight, time_constant, memory_weight,
//                  deviation_knot, loading_deviation, unloading_deviation (absent without a model of
//                  the sheet's memory)
//     /session     attributes tare, rmse_without, rmse (absent where no tare is expected)
//     /temperature attributes sensitivity, reference, lag, low, high, spread (absent without a model of the
//                  temperature)
//     /shape       attributes missing, family, ...; curvature, mounts, gain, zero_share, error_between
//     [surfaces],
//                  surfaces, used, scale, history [taxels], rest [surfaces x taxels] (absent in earlier
//                  files)
//     /coverage    scans, cycles [classes x bins x 2], totals, pressure, thin
//     /scores      see scoresMembers() (absent where not asked for)
//     /budget      pressure, held_out, combined [3]; names, sources, parts, notes [lines]; standard, added
//                  [lines x 3]; /budget/intervals with attribute unit_left_out; units, factor, covered [bins
//                  and all x 2], by_direction [2 x 2], by_taxel [2 x taxels], scale_pressure, scale_factor
//                  [bins], scale_covered [bins and all x 2] (absent without scores and in earlier files)
//     /statistics  surfaces, curvature of the classes; first [taxels x classes x sections + 1] and the rows
//                  code, count, sum that it points into; square_high, square_low of the rows with count > 1
//
// Taxels are row-major. Numbers carry `unit`, everything says its `meaning`.
//
// The number of the schema is in the user block (see calibration_file.h).
constexpr std::uint64_t kCalibrationSchema = 3;
constexpr std::uint64_t kOldestSchema = 1;
constexpr std::uint64_t kFirstSchemaWithRule = 2;
/// An older version would leave history and temperature out in silence, so a file with one of them has a
/// schema of its own.
constexpr std::uint64_t kFirstSchemaWithHistory = 3;

void writeCalibration(const Calibration& calibration, hdf5::Writer& writer);

/// Reads content of `schema`, kOldestSchema to kCalibrationSchema. `regressors` as in loadCalibration().
/// Throws InputError that names what is missing or does not fit.
Calibration readCalibration(const hdf5::Reader& reader, std::uint64_t schema, CalibrationParts parts,
                            const regression::RegressorTable* regressors);

// The members of each part, written or read by the same list (see hdf5::Members). What is absent stays as it
// is.
void ruleMembers(hdf5::Members& file, compensation::CurvatureTables& tables);
void historyMembers(hdf5::Members& file, HistoryModel& model);
/// `tables`: number of them.
void sessionMembers(hdf5::Members& file, SessionZero& zero, std::size_t tables);
void temperatureMembers(hdf5::Members& file, TemperatureModel& model);
void shapeMembers(hdf5::Members& file, ShapeModel& model);
void coverageMembers(hdf5::Members& file, dataset::Coverage& coverage,
                     const std::vector<dataset::CurvatureClass>& classes);
void scoresMembers(hdf5::Members& file, CalibrationScores& scores,
                   const std::vector<dataset::CurvatureClass>& classes);
void budgetMembers(hdf5::Members& file, ErrorBudget& budget, std::size_t taxels);
void temperatureScoresMembers(hdf5::Members& file, TemperatureScore& score);
void classesMembers(hdf5::Members& file, std::vector<dataset::CurvatureClass>& classes, std::size_t taxels);
void tablesMembers(hdf5::Members& file, compensation::CurvatureTables& tables);
/// `cells`: whether to read the sums too, not only the classes.
void statisticsMembers(hdf5::Members& file, compensation::TrainingStatistics& statistics, std::size_t taxels,
                       bool cells);

}  // namespace fsr::calibration
