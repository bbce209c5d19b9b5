#include "calibration/file/calibration_hdf5.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "compensation/training_statistics.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "regression/regressors.h"

namespace fsr::calibration {

namespace {

constexpr char kCurvatureRule[] =
    "a taxel's curvature is the principal curvature of largest magnitude of [[x, xy], [xy, y]], sign kept: "
    "positive where the sheet is convex towards +z";
constexpr double kMostCounts = 1e9;  // of a gain or offset that is still a number to compute with
constexpr char kUse[] = "research use, not for diagnosis or fitting decisions";

// The options of a regressor, by name.
class OptionMembers : public regression::OptionWriter, public regression::OptionReader {
 public:
  explicit OptionMembers(hdf5::Members& file) : file_(file) {}
  void text(const std::string& name, const std::string& value) override { file_.note(name, value); }
  void integer(const std::string& name, std::uint64_t value) override { file_.attribute(name, value); }
  void number(const std::string& name, double value) override { file_.attribute(name, value); }
  std::string text(const std::string& name) const override { return read<std::string>(name); }
  std::uint64_t integer(const std::string& name) const override { return read<std::uint64_t>(name); }
  double number(const std::string& name) const override { return read<double>(name); }

 private:
  template <typename Value>
  Value read(const std::string& name) const {
    Value value = {};
    file_.attribute(name, value);
    return value;
  }
  hdf5::Members& file_;
};

// The options of GRNN and forest are in every file. If the model is unknown to this version, its tables can
// be used, but it cannot be trained.
void modelMembers(hdf5::Members& file, Calibration& calibration) {
  regression::RegressorOptions& options = calibration.regressor;
  file.attribute("model", options.name);
  file.attribute("bandwidth", options.grnn.bandwidth);
  // Files of the first version have no group: all are of a GRNN with default options.
  if (!file.group("/model")) return;
  file.attribute("bandwidth_chosen", calibration.bandwidth_chosen);
  OptionMembers members(file);
  const regression::RegressorEntry* const own = regression::tableOf(options).find(options.name);
  const auto transfer = [&](const regression::RegressorEntry& entry) {
    if (file.reads() && entry.read != nullptr) entry.read(members, options);
    if (!file.reads() && entry.write != nullptr) entry.write(options, members);
  };
  for (const regression::RegressorEntry& entry : regression::packageRegressors().entries) {
    if (entry.in_every_file) transfer(entry);
  }
  if (own != nullptr && !own->in_every_file) transfer(*own);
}

void sensorMembers(hdf5::Members& file, dataset::SensorIdentity& sensor) {
  file.group("/sensor");
  file.attribute("sensor_id", sensor.sensor_id);
  file.attribute("serial", sensor.serial);
  file.attribute("firmware", sensor.firmware);
  file.attribute("model", sensor.model);
  file.attribute("sealing", sensor.sealing);
  file.attribute("transducer", sensor.transducer);
}

void layoutMembers(hdf5::Members& file, Calibration& calibration) {
  matrix::Layout& layout = calibration.layout;
  file.group("/layout");
  const auto side = [&](const std::string& name, std::uint16_t& value) {
    std::uint64_t number = value;
    file.attribute(name, number);
    file.within(name, {static_cast<double>(number)}, 1, matrix::kMaxMatrixSide);
    value = static_cast<std::uint16_t>(number);
  };
  side("rows", layout.size.rows);
  side("columns", layout.size.columns);
  file.attribute("pitch_x", layout.pitch_x);
  file.attribute("pitch_y", layout.pitch_y);
  file.note("unit", "m");
  const std::size_t taxels = layout.size.taxels();
  file.dataset("no_model", calibration.no_model, {file.reads() ? taxels : calibration.no_model.size()}, "",
               "1 = masked, or the reading never changed: the taxel has no model");
  file.column("masked", calibration.masked, "", "1 = masked in the bags");
  const std::size_t masked = calibration.masked.size();
  file.require(masked == 0 || masked == taxels, "masked",
               "has " + std::to_string(masked) + " values, but must have one for each of " +
                   std::to_string(taxels) + " taxels");
}

void trainedMembers(hdf5::Members& file, TrainedRanges& trained) {
  file.group("/trained");
  file.note("meaning", "lowest and highest value of training; NaN = not recorded");
  const auto interval = [&](const std::string& name, TrainedInterval& values, const std::string& unit) {
    file.numbers(name, std::tie(values.low, values.high));
    file.note(name + "_unit", unit);
  };
  interval("pressure", trained.pressure, "Pa");
  interval("pressure_rate", trained.pressure_rate, "Pa/s");
  interval("curvature", trained.curvature, "1/m");
  interval("temperature", trained.temperature, "degree Celsius");
}

void bagsMembers(hdf5::Members& file, std::vector<SourceBag>& bags, const char* names, const char* scans) {
  file.texts("bags", bags, &SourceBag::name, names);
  file.texts("sha256", bags, &SourceBag::sha256, "of each bag's bytes; empty where it came over topics");
  file.rows<std::uint64_t>("scans", bags, &SourceBag::scans, {bags.size()}, "", scans);
}

void provenanceMembers(hdf5::Members& file, Calibration& calibration) {
  Provenance& provenance = calibration.provenance;
  file.group("/provenance");
  file.attribute("tool_version", provenance.tool_version);
  file.attribute("date", provenance.date);
  file.attribute("seed", provenance.seed);
  bagsMembers(file, provenance.bags, "base names", "used of each bag");
  file.texts("warnings", calibration.warnings, "what training warned of");
  if (file.reads() ? file.has("conditioning") : !provenance.conditioning.empty())
    file.texts("conditioning", provenance.conditioning, "whether each session began with it");
}

void correctionMembers(hdf5::Members& file, Correction& correction, std::size_t taxels) {
  if (!file.group("/correction", correction.present())) return;
  file.note("meaning",
            "the tables are those of the calibration `parent` at (reading - offset) / gain; scores, coverage "
            "and provenance are the parent's");
  file.attribute("parent", correction.parent);
  file.attribute("parent_date", correction.parent_date);
  file.attribute("date", correction.date);
  file.attribute("tool_version", correction.tool_version);
  file.attribute("by_taxel", correction.by_taxel);
  file.attribute("cycles", correction.cycles);
  file.attribute("expected_rmse", correction.expected_rmse);
  file.attribute("rmse_before", correction.rmse_before);
  file.attribute("rmse", correction.rmse);
  file.note("rmse_unit", "Pa");
  file.note("rmse_meaning",
            "of the recheck: stated by the parent, had by the parent, and of the corrected tables on cycles "
            "that were left out");
  file.dataset("gain", correction.gain, {taxels}, "",
               "of each taxel: readings of today over those of the parent's training");
  file.dataset("offset", correction.offset, {taxels}, "counts", "likewise, added");
  file.texts("surfaces", correction.surfaces, "on which the sheet was rechecked");
  bagsMembers(file, correction.bags, "base names of the bags of the recheck", "of each bag");
  file.require(correction.present(), "parent", "is empty, but must be the id of a calibration");
  file.within("gain", correction.gain, -kMostCounts, kMostCounts);
  file.within("offset", correction.offset, -kMostCounts, kMostCounts);
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

// All members, in the order of the file. `schema` and `parts` are those of reading.
void calibrationMembers(hdf5::Members& file, Calibration& calibration, CalibrationParts parts) {
  compensation::CurvatureTables& tables = calibration.tables;
  std::string scheme = compensation::schemeName(tables.scheme);
  std::uint64_t full_scale = tables.full_scale;
  bool scored = !calibration.scores.conditions.empty();
  file.group("/");
  file.attribute("scheme", scheme);
  modelMembers(file, calibration);
  file.group("/");
  file.attribute("folds", calibration.folds);
  file.attribute("full_scale", full_scale);
  file.note("curvature_rule", kCurvatureRule);
  file.note("use", kUse);
  file.attribute("scored", scored);
  sensorMembers(file, calibration.sensor);
  layoutMembers(file, calibration);
  const std::size_t taxels = calibration.layout.size.taxels();
  trainedMembers(file, calibration.trained);
  provenanceMembers(file, calibration);
  correctionMembers(file, calibration.correction, taxels);
  if (file.reads()) {
    tables.scheme = compensation::schemeFromName(scheme);
    tables.size = calibration.layout.size;
    tables.full_scale = static_cast<std::uint16_t>(std::min<std::uint64_t>(full_scale, 65535));
    tables.curvature_low = calibration.trained.curvature.low;
    tables.curvature_high = calibration.trained.curvature.high;
    calibration.shape.layout = calibration.layout;
    calibration.shape.full_scale = tables.full_scale;
    calibration.shape.missing =
        "the calibration file is of an earlier version, which learnt no shape; train again";
  }
  tablesMembers(file, tables);
  ruleMembers(file, tables);
  historyMembers(file, calibration.history);
  sessionMembers(file, calibration.session_zero, tables.tables.size());
  temperatureMembers(file, calibration.temperature);
  shapeMembers(file, calibration.shape);
  compensation::TrainingStatistics statistics;
  if (file.reads()) {  // coverage and scores have a row for each of its classes
    statisticsMembers(file, statistics, taxels, parts == CalibrationParts::kAll);
    statistics.full_scale = tables.full_scale;
  }
  coverageMembers(file, calibration.coverage, statistics.classes);
  if (scored) {
    scoresMembers(file, calibration.scores, statistics.classes);
    budgetMembers(file, calibration.budget, taxels);
    temperatureScoresMembers(file, calibration.scores.temperature);
  }
  if (!file.reads()) {
    const auto* const own = calibration.statistics.get();
    statisticsMembers(file, own ? const_cast<compensation::TrainingStatistics&>(*own) : statistics, taxels,
                      true);
  } else if (parts == CalibrationParts::kAll) {
    calibration.statistics = std::make_shared<const compensation::TrainingStatistics>(std::move(statistics));
  }
}

}  // namespace

void writeCalibration(const Calibration& calibration, hdf5::Writer& writer) {
  hdf5::Members file(writer);
  // One list serves both directions; writing changes nothing.
  calibrationMembers(file, const_cast<Calibration&>(calibration), CalibrationParts::kAll);
}

Calibration readCalibration(const hdf5::Reader& reader, std::uint64_t schema, CalibrationParts parts,
                            const regression::RegressorTable* regressors) {
  requireSchema(reader, schema);
  Calibration calibration;
  calibration.regressor.table = regressors;
  hdf5::Members file(reader);
  calibrationMembers(file, calibration, parts);
  return calibration;
}

}  // namespace fsr::calibration
