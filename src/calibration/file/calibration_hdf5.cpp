#include "calibration/file/calibration_hdf5.h"

#include <memory>
#include <utility>

#include "compensation/training_statistics.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

constexpr char kCurvatureRule[] =
    "a taxel's curvature is the principal curvature of largest magnitude of [[x, xy], [xy, y]], sign kept: "
    "positive where the sheet is convex towards +z";
constexpr char kUse[] = "research use, not for diagnosis or fitting decisions";

void writeSensor(const dataset::SensorIdentity& sensor, hdf5::Writer& writer) {
  writer.group("/sensor");
  writer.attribute("/sensor", "sensor_id", sensor.sensor_id);
  writer.attribute("/sensor", "serial", sensor.serial);
  writer.attribute("/sensor", "firmware", sensor.firmware);
  writer.attribute("/sensor", "model", sensor.model);
  writer.attribute("/sensor", "sealing", sensor.sealing);
  writer.attribute("/sensor", "transducer", sensor.transducer);
}

dataset::SensorIdentity readSensor(const hdf5::Reader& reader) {
  return {reader.text("/sensor", "sensor_id"), reader.text("/sensor", "serial"),
          reader.text("/sensor", "firmware"),  reader.text("/sensor", "model"),
          reader.text("/sensor", "sealing"),   reader.text("/sensor", "transducer")};
}

void writeLayout(const Calibration& calibration, hdf5::Writer& writer) {
  const matrix::Layout& layout = calibration.layout;
  writer.group("/layout");
  writer.attribute("/layout", "rows", layout.size.rows);
  writer.attribute("/layout", "columns", layout.size.columns);
  writer.attribute("/layout", "pitch_x", std::vector<double>{layout.pitch_x});
  writer.attribute("/layout", "pitch_y", std::vector<double>{layout.pitch_y});
  writer.attribute("/layout", "unit", "m");
  writer.dataset("/layout/no_model", calibration.no_model, {calibration.no_model.size()}, "",
                 "1 = masked, or the reading never changed: the taxel has no model");
  writer.dataset("/layout/masked", calibration.masked, {calibration.masked.size()}, "",
                 "1 = masked in the bags");
}

void requireNoneOrEach(std::size_t values, matrix::MatrixSize size) {
  if (values == 0 || values == size.taxels()) return;
  throw settings::InputError("its /layout/masked has " + std::to_string(values) +
                             " values, but must have one for each of " + std::to_string(size.taxels()) +
                             " taxels");
}

std::uint16_t readSide(const hdf5::Reader& reader, const std::string& name) {
  const std::uint64_t side = reader.integer("/layout", name);
  if (side < 1 || side > matrix::kMaxMatrixSide) {
    throw settings::InputError("its /layout " + name + " is " + std::to_string(side) + ", but must be 1 to " +
                               std::to_string(matrix::kMaxMatrixSide));
  }
  return static_cast<std::uint16_t>(side);
}

matrix::Layout readLayout(const hdf5::Reader& reader) {
  matrix::Layout layout;
  layout.size = {readSide(reader, "rows"), readSide(reader, "columns")};
  layout.pitch_x = reader.numbers("/layout", "pitch_x", 1)[0];
  layout.pitch_y = reader.numbers("/layout", "pitch_y", 1)[0];
  return layout;
}

void writeTrained(const TrainedRanges& trained, hdf5::Writer& writer) {
  const auto interval = [&](const std::string& name, const TrainedInterval& values, const std::string& unit) {
    writer.attribute("/trained", name, std::vector<double>{values.low, values.high});
    writer.attribute("/trained", name + "_unit", unit);
  };
  writer.group("/trained");
  writer.attribute("/trained", "meaning", "lowest and highest value of training; NaN = not recorded");
  interval("pressure", trained.pressure, "Pa");
  interval("pressure_rate", trained.pressure_rate, "Pa/s");
  interval("curvature", trained.curvature, "1/m");
  interval("temperature", trained.temperature, "degree Celsius");
}

TrainedRanges readTrained(const hdf5::Reader& reader) {
  const auto interval = [&](const std::string& name) {
    const std::vector<double> values = reader.numbers("/trained", name, 2);
    return TrainedInterval{values[0], values[1]};
  };
  return {interval("pressure"), interval("pressure_rate"), interval("curvature"), interval("temperature")};
}

void writeProvenance(const Calibration& calibration, hdf5::Writer& writer) {
  const Provenance& provenance = calibration.provenance;
  std::vector<std::string> names, hashes;
  std::vector<std::uint64_t> scans;
  for (const SourceBag& bag : provenance.bags) {
    names.push_back(bag.name);
    hashes.push_back(bag.sha256);
    scans.push_back(bag.scans);
  }
  writer.group("/provenance");
  writer.attribute("/provenance", "tool_version", provenance.tool_version);
  writer.attribute("/provenance", "date", provenance.date);
  writer.attribute("/provenance", "seed", provenance.seed);
  writer.texts("/provenance/bags", names, "base names");
  writer.texts("/provenance/sha256", hashes, "of each bag's bytes; empty where it came over topics");
  writer.dataset("/provenance/scans", scans, {scans.size()}, "", "used of each bag");
  writer.texts("/provenance/warnings", calibration.warnings, "what training warned of");
  if (!provenance.conditioning.empty())
    writer.texts("/provenance/conditioning", provenance.conditioning, "whether each session began with it");
}

Provenance readProvenance(const hdf5::Reader& reader) {
  Provenance provenance;
  provenance.tool_version = reader.text("/provenance", "tool_version");
  provenance.date = reader.text("/provenance", "date");
  provenance.seed = reader.integer("/provenance", "seed");
  const std::vector<std::string> names = reader.texts("/provenance/bags");
  const std::vector<std::string> hashes = reader.texts("/provenance/sha256");
  const auto scans = reader.dataset<std::uint64_t>("/provenance/scans", {names.size()});
  if (hashes.size() != names.size())
    throw settings::InputError("its /provenance/sha256 does not fit /provenance/bags");
  for (std::size_t i = 0; i < names.size(); ++i) provenance.bags.push_back({names[i], hashes[i], scans[i]});
  if (reader.has("/provenance/conditioning"))
    provenance.conditioning = reader.texts("/provenance/conditioning");
  return provenance;
}

// The hash of the file does not cover the schema's number, so the content has to agree with it.
void requireSchema(const hdf5::Reader& reader, std::uint64_t schema) {
  const bool history = reader.has("/history") || reader.has("/temperature");
  if (reader.has("/rule") == (schema >= kFirstSchemaWithRule) &&
      history == (schema >= kFirstSchemaWithHistory))
    return;
  throw settings::InputError("is damaged: its first line names schema " + std::to_string(schema) +
                             ", but its content is of another; copy the file again or train again");
}

}  // namespace

void writeCalibration(const Calibration& calibration, hdf5::Writer& writer) {
  writer.attribute("/", "scheme", compensation::schemeName(calibration.tables.scheme));
  writeModel(calibration, writer);
  writer.attribute("/", "folds", calibration.folds);
  writer.attribute("/", "full_scale", calibration.tables.full_scale);
  writer.attribute("/", "curvature_rule", kCurvatureRule);
  writer.attribute("/", "use", kUse);
  writer.attribute("/", "scored", calibration.scores.conditions.empty() ? 0 : 1);
  writeSensor(calibration.sensor, writer);
  writeLayout(calibration, writer);
  writeTrained(calibration.trained, writer);
  writeProvenance(calibration, writer);
  writeCorrection(calibration.correction, writer);
  writeTables(calibration.tables, writer);
  writeRule(calibration.tables, writer);
  writeHistory(calibration.history, writer);
  writeSessionZero(calibration.session_zero, writer);
  writeTemperature(calibration.temperature, writer);
  writeShape(calibration.shape, writer);
  writeCoverage(calibration.coverage, writer);
  if (!calibration.scores.conditions.empty()) {
    writeScores(calibration.scores, writer);
    writeHistoryScores(calibration.scores.history, writer);
    writeSessionScores(calibration.scores.session, writer);
    writeBudget(calibration.budget, writer);
    writeTemperatureScores(calibration.scores.temperature, writer);
  }
  static const compensation::TrainingStatistics none;
  writeStatistics(calibration.statistics ? *calibration.statistics : none, writer);
}

Calibration readCalibration(const hdf5::Reader& reader, std::uint64_t schema, CalibrationParts parts,
                            const regression::RegressorTable* regressors) {
  requireSchema(reader, schema);
  Calibration calibration;
  calibration.regressor.table = regressors;
  readModel(reader, calibration);
  calibration.folds = reader.integer("/", "folds");
  calibration.sensor = readSensor(reader);
  calibration.layout = readLayout(reader);
  calibration.no_model = reader.dataset<std::uint8_t>("/layout/no_model", {calibration.layout.size.taxels()});
  if (reader.has("/layout/masked")) {
    calibration.masked = reader.dataset<std::uint8_t>("/layout/masked", reader.shape("/layout/masked"));
    requireNoneOrEach(calibration.masked.size(), calibration.layout.size);
  }
  calibration.trained = readTrained(reader);
  calibration.provenance = readProvenance(reader);
  calibration.correction = readCorrection(reader, calibration.layout.size);
  calibration.warnings = reader.texts("/provenance/warnings");
  calibration.tables = readTables(reader, calibration.layout.size);
  if (schema >= kFirstSchemaWithRule) readRule(reader, calibration.tables);
  calibration.tables.curvature_low = calibration.trained.curvature.low;
  calibration.tables.curvature_high = calibration.trained.curvature.high;
  compensation::TrainingStatistics statistics =
      readStatistics(reader, calibration.layout.size, parts == CalibrationParts::kAll);
  calibration.coverage = readCoverage(reader, statistics.classes);
  calibration.history = readHistory(reader);
  calibration.session_zero = readSessionZero(reader);
  calibration.temperature = readTemperature(reader);
  calibration.shape = readShape(reader, calibration.layout, calibration.tables.full_scale);
  if (reader.integer("/", "scored") != 0) {
    calibration.scores = readScores(reader, statistics.classes);
    calibration.scores.history = readHistoryScores(reader);
    calibration.scores.session = readSessionScores(reader);
    calibration.budget = readBudget(reader, calibration.layout.size);
    calibration.scores.temperature = readTemperatureScores(reader);
  }
  statistics.full_scale = calibration.tables.full_scale;
  if (parts == CalibrationParts::kAll) {
    calibration.statistics = std::make_shared<const compensation::TrainingStatistics>(std::move(statistics));
  }
  return calibration;
}

}  // namespace fsr::calibration
