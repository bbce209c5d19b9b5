#pragma once

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "hdf5/reader.h"
#include "hdf5/writer.h"

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
//     /scores      see scores_hdf5 (absent where not asked for)
//     /budget      pressure, held_out, combined [3]; names, sources, parts, notes [lines]; standard, added
//                  [lines x 3]; /budget/intervals with attribute unit_left_out; units, factor, covered [bins
//                  and all x 2], by_direction [2 x 2], by_taxel [2 x taxels], scale_pressure, scale_factor [bins],
//                  scale_covered [bins and all x 2] (absent without scores and in
//                  earlier files)
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

// Each part has its own source file.
void writeModel(const Calibration& calibration, hdf5::Writer& writer);
void readModel(const hdf5::Reader& reader, Calibration& calibration);
void writeCorrection(const Correction& correction, hdf5::Writer& writer);
Correction readCorrection(const hdf5::Reader& reader, matrix::MatrixSize size);
void writeTables(const compensation::CurvatureTables& tables, hdf5::Writer& writer);
compensation::CurvatureTables readTables(const hdf5::Reader& reader, matrix::MatrixSize size);
void writeRule(const compensation::CurvatureTables& tables, hdf5::Writer& writer);
void readRule(const hdf5::Reader& reader, compensation::CurvatureTables& tables);
void writeHistory(const compensation::HistoryModel& model, hdf5::Writer& writer);
compensation::HistoryModel readHistory(const hdf5::Reader& reader);
void writeHistoryScores(const HistoryScore& score, hdf5::Writer& writer);
HistoryScore readHistoryScores(const hdf5::Reader& reader);
void writeSessionZero(const SessionZero& zero, hdf5::Writer& writer);
SessionZero readSessionZero(const hdf5::Reader& reader);
void writeSessionScores(const SessionScore& score, hdf5::Writer& writer);
SessionScore readSessionScores(const hdf5::Reader& reader);
void writeTemperature(const compensation::TemperatureModel& model, hdf5::Writer& writer);
compensation::TemperatureModel readTemperature(const hdf5::Reader& reader);
void writeTemperatureScores(const TemperatureScore& score, hdf5::Writer& writer);
TemperatureScore readTemperatureScores(const hdf5::Reader& reader);
void writeShape(const compensation::ShapeModel& model, hdf5::Writer& writer);
compensation::ShapeModel readShape(const hdf5::Reader& reader, const matrix::Layout& layout,
                                   std::uint16_t full_scale);
void writeBudget(const ErrorBudget& budget, hdf5::Writer& writer);
ErrorBudget readBudget(const hdf5::Reader& reader, matrix::MatrixSize size);
void writeCoverage(const dataset::Coverage& coverage, hdf5::Writer& writer);
dataset::Coverage readCoverage(const hdf5::Reader& reader,
                               const std::vector<dataset::CurvatureClass>& classes);
void writeScores(const CalibrationScores& scores, hdf5::Writer& writer);
CalibrationScores readScores(const hdf5::Reader& reader, const std::vector<dataset::CurvatureClass>& classes);
void writeStatistics(const compensation::TrainingStatistics& statistics, hdf5::Writer& writer);
/// `cells`: whether to read the sums too, not only the classes.
compensation::TrainingStatistics readStatistics(const hdf5::Reader& reader, matrix::MatrixSize size,
                                                bool cells);
void writeClasses(const std::string& group, const std::vector<dataset::CurvatureClass>& classes,
                  hdf5::Writer& writer);
std::vector<dataset::CurvatureClass> readClasses(const std::string& group, matrix::MatrixSize size,
                                                 const hdf5::Reader& reader);

}  // namespace fsr::calibration
