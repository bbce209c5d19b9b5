#include <algorithm>
#include <cmath>

#include "calibration/file/calibration_hdf5.h"
#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::calibration {

namespace {

constexpr const char* kCorrectionGroup = "/correction";

std::vector<double> readColumn(const hdf5::Reader& reader, const char* name, matrix::MatrixSize size) {
  const std::string path = std::string(kCorrectionGroup) + "/" + name;
  std::vector<double> values = reader.dataset<double>(path, {size.taxels()});
  if (std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
    return values;
  throw settings::InputError("its " + path + " is not finite");
}

}  // namespace

void writeCorrection(const Correction& correction, hdf5::Writer& writer) {
  if (!correction.present()) return;
  const std::string group = kCorrectionGroup;
  writer.group(group);
  writer.attribute(group, "meaning",
                   "the tables are those of the calibration `parent` at (reading - offset) / gain; scores, "
                   "coverage and provenance are the parent's");
  writer.attribute(group, "parent", correction.parent);
  writer.attribute(group, "parent_date", correction.parent_date);
  writer.attribute(group, "date", correction.date);
  writer.attribute(group, "tool_version", correction.tool_version);
  writer.attribute(group, "by_taxel", correction.by_taxel ? 1 : 0);
  writer.attribute(group, "cycles", correction.cycles);
  writer.attribute(group, "expected_rmse", std::vector<double>{correction.expected_rmse});
  writer.attribute(group, "rmse_before", std::vector<double>{correction.rmse_before});
  writer.attribute(group, "rmse", std::vector<double>{correction.rmse});
  writer.attribute(group, "rmse_unit", "Pa");
  writer.attribute(group, "rmse_meaning",
                   "of the recheck: stated by the parent, had by the parent, and of the corrected tables on "
                   "cycles that were left out");
  writer.dataset(group + "/gain", correction.gain, {correction.gain.size()}, "",
                 "of each taxel: readings of today over those of the parent's training");
  writer.dataset(group + "/offset", correction.offset, {correction.offset.size()}, "counts",
                 "likewise, added");
  writer.texts(group + "/surfaces", correction.surfaces, "on which the sheet was rechecked");
  std::vector<std::string> names, hashes;
  std::vector<std::uint64_t> scans;
  for (const SourceBag& bag : correction.bags) {
    names.push_back(bag.name);
    hashes.push_back(bag.sha256);
    scans.push_back(bag.scans);
  }
  writer.texts(group + "/bags", names, "base names of the bags of the recheck");
  writer.texts(group + "/sha256", hashes, "of each bag's bytes; empty where it came over topics");
  writer.dataset(group + "/scans", scans, {scans.size()}, "", "of each bag");
}

Correction readCorrection(const hdf5::Reader& reader, matrix::MatrixSize size) {
  Correction correction;
  if (!reader.has(kCorrectionGroup)) return correction;
  const std::string group = kCorrectionGroup;
  correction.parent = reader.text(group, "parent");
  if (correction.parent.empty())
    throw settings::InputError("its " + group + " parent is empty, but must be the id of a calibration");
  correction.parent_date = reader.text(group, "parent_date");
  correction.date = reader.text(group, "date");
  correction.tool_version = reader.text(group, "tool_version");
  correction.by_taxel = reader.integer(group, "by_taxel") != 0;
  correction.cycles = reader.integer(group, "cycles");
  correction.expected_rmse = reader.numbers(group, "expected_rmse", 1)[0];
  correction.rmse_before = reader.numbers(group, "rmse_before", 1)[0];
  correction.rmse = reader.numbers(group, "rmse", 1)[0];
  correction.gain = readColumn(reader, "gain", size);
  correction.offset = readColumn(reader, "offset", size);
  correction.surfaces = reader.texts(group + "/surfaces");
  const std::vector<std::string> names = reader.texts(group + "/bags");
  const std::vector<std::string> hashes = reader.texts(group + "/sha256");
  const auto scans = reader.dataset<std::uint64_t>(group + "/scans", {names.size()});
  if (hashes.size() != names.size())
    throw settings::InputError("its " + group + "/sha256 does not fit " + group + "/bags");
  for (std::size_t i = 0; i < names.size(); ++i) correction.bags.push_back({names[i], hashes[i], scans[i]});
  return correction;
}

}  // namespace fsr::calibration
