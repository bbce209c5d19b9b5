#pragma once

#include "fsr_pressure_map/calibration/calibration.h"
#include "fsr_pressure_map/calibration/calibration_file.h"
#include "fsr_pressure_map/calibration/hdf5_reader.h"
#include "fsr_pressure_map/calibration/hdf5_writer.h"

namespace fsr {

// The content of a calibration file, schema 2:
//
//     /            attributes scheme, model, bandwidth, folds, full_scale, curvature_rule, use
//     /model       attributes bandwidth_chosen, spread, distance, weighting, trees, minimum_leaf, leaf_rule
//                  (absent in the first files)
//     /sensor      attributes sensor_id, serial, firmware, model, sealing, transducer
//     /layout      attributes rows, columns, pitch_x [m], pitch_y [m]; no_model, masked [taxels]
//     /trained     attributes pressure, pressure_rate, curvature, temperature: lowest, highest
//     /provenance  attributes tool_version, date, seed; bags, sha256, scans [bags]; warnings
//     /tables      surfaces [models], curvature [models x (1 or taxels)],
//                  pressure, deviation, support [taxels x models x codes], trained_codes [taxels x models x
//                  2]
//     /rule        attribute blend; model_of_class, length_scale, law_curvature, law_gain, law_offset,
//                  unseen_pressure, unseen_deviation, log_weight where the scheme has them (absent in schema
//                  1: nearest)
//     /coverage    scans, cycles [classes x bins x 2], totals, pressure, thin
//     /scores      see scores_hdf5 (absent where not asked for)
//     /statistics  surfaces, curvature of the classes; first [taxels x classes x sections + 1] and the rows
//                  code, count, sum that it points into; square_high, square_low of the rows with count > 1
//
// Taxels are row-major. Numbers carry `unit`, everything says its `meaning`.
constexpr std::uint64_t kCalibrationSchema = 2;

// Stands in every file from schema 2 on, and in none before.
constexpr char kRuleMeaning[] = "how the tables of the classes become the table of any curvature";

void writeCalibration(const Calibration& calibration, Hdf5Writer& writer);

/// Throws InputError that names what is missing or does not fit.
Calibration readCalibration(const Hdf5Reader& reader, CalibrationParts parts);

// Parts with a file of their own.
void writeTables(const CurvatureTables& tables, Hdf5Writer& writer);
CurvatureTables readTables(const Hdf5Reader& reader, MatrixSize size);
void writeRule(const CurvatureTables& tables, Hdf5Writer& writer);
void readRule(const Hdf5Reader& reader, CurvatureTables& tables);
void writeCoverage(const Coverage& coverage, Hdf5Writer& writer);
Coverage readCoverage(const Hdf5Reader& reader, const std::vector<CurvatureClass>& classes);
void writeScores(const CalibrationScores& scores, Hdf5Writer& writer);
CalibrationScores readScores(const Hdf5Reader& reader, const std::vector<CurvatureClass>& classes);
void writeStatistics(const TrainingStatistics& statistics, Hdf5Writer& writer);
/// `cells` = whether to read the sums too, not the classes alone.
TrainingStatistics readStatistics(const Hdf5Reader& reader, MatrixSize size, bool cells);
void writeClasses(const std::string& group, const std::vector<CurvatureClass>& classes, Hdf5Writer& writer);
std::vector<CurvatureClass> readClasses(const std::string& group, MatrixSize size, const Hdf5Reader& reader);

}  // namespace fsr
