#include "calibration/file/calibration_hdf5.h"
#include "regression/regressors.h"

namespace fsr::calibration {

namespace {

constexpr char kModelGroup[] = "/model";

class ModelWriter : public regression::OptionWriter {
 public:
  explicit ModelWriter(hdf5::Writer& writer) : writer_(writer) {}
  void text(const std::string& name, const std::string& value) override {
    writer_.attribute(kModelGroup, name, value);
  }
  void integer(const std::string& name, std::uint64_t value) override {
    writer_.attribute(kModelGroup, name, value);
  }
  void number(const std::string& name, double value) override {
    writer_.attribute(kModelGroup, name, std::vector<double>{value});
  }

 private:
  hdf5::Writer& writer_;
};

class ModelReader : public regression::OptionReader {
 public:
  explicit ModelReader(const hdf5::Reader& reader) : reader_(reader) {}
  std::string text(const std::string& name) const override { return reader_.text(kModelGroup, name); }
  std::uint64_t integer(const std::string& name) const override { return reader_.integer(kModelGroup, name); }
  double number(const std::string& name) const override { return reader_.numbers(kModelGroup, name, 1)[0]; }

 private:
  const hdf5::Reader& reader_;
};

// The entries whose options are in a file of this model. Options of GRNN and forest are in every file.
std::vector<const regression::RegressorEntry*> entriesIn(const regression::RegressorOptions& options) {
  std::vector<const regression::RegressorEntry*> entries;
  for (const regression::RegressorEntry& entry : regression::packageRegressors().entries) {
    if (entry.in_every_file) entries.push_back(&entry);
  }
  const regression::RegressorEntry* const own = regression::tableOf(options).find(options.name);
  if (own != nullptr && !own->in_every_file) entries.push_back(own);
  return entries;
}

}  // namespace

void writeModel(const Calibration& calibration, hdf5::Writer& writer) {
  const regression::RegressorOptions& options = calibration.regressor;
  writer.attribute("/", "model", options.name);
  writer.attribute("/", "bandwidth", std::vector<double>{options.grnn.bandwidth});
  writer.group(kModelGroup);
  writer.attribute(kModelGroup, "bandwidth_chosen", calibration.bandwidth_chosen ? 1 : 0);
  ModelWriter model(writer);
  for (const regression::RegressorEntry* entry : entriesIn(options)) {
    if (entry->write != nullptr) entry->write(options, model);
  }
}

// If the model is unknown to this version, its tables can be used, but it cannot be trained.
void readModel(const hdf5::Reader& reader, Calibration& calibration) {
  regression::RegressorOptions& options = calibration.regressor;
  options.name = reader.text("/", "model");
  options.grnn.bandwidth = reader.numbers("/", "bandwidth", 1)[0];
  if (!reader.has(kModelGroup)) return;  // files of the first version, all of a GRNN with default options
  calibration.bandwidth_chosen = reader.integer(kModelGroup, "bandwidth_chosen") != 0;
  const ModelReader model(reader);
  for (const regression::RegressorEntry* entry : entriesIn(options)) {
    if (entry->read != nullptr) entry->read(model, options);
  }
}

}  // namespace fsr::calibration
