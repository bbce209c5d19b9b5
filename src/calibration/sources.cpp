#include "calibration/sources.h"

#include "dataset/conditioning.h"
#include "dataset/mounts.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"

namespace fsr::calibration {

void requireMatrix(const Calibration& calibration, const dataset::Recording& recording) {
  if (recording.layout.size == calibration.layout.size &&
      recording.full_scale == calibration.tables.full_scale)
    return;
  throw settings::InputError(
      recording.name + ": has " + matrix::sizeText(recording.layout.size) + " taxels up to " +
      std::to_string(recording.full_scale) + " counts, but the calibration is for " +
      matrix::sizeText(calibration.layout.size) + " up to " + std::to_string(calibration.tables.full_scale));
}

void requireFit(const Calibration& calibration, const dataset::Recording& recording) {
  if (recording.pressure.empty()) {
    throw settings::InputError(recording.name +
                               ": has no chamber_pressure, so there is no reference for the maps; "
                               "without a chamber use check_bag --use socket");
  }
  requireMatrix(calibration, recording);
}

Provenance provenanceOf(const std::vector<dataset::Recording>& recordings,
                        const CalibrationOptions& options) {
  Provenance provenance;
  provenance.tool_version = FSR_VERSION;
  provenance.date = options.date.empty() ? settings::nowText() : options.date;
  provenance.seed = options.seed;
  for (const dataset::Recording& recording : recordings) {
    provenance.bags.push_back({recording.name, recording.sha256, recording.scans()});
  }
  provenance.conditioning = dataset::conditioningSentences(dataset::findConditioning(recordings));
  return provenance;
}

dataset::SensorIdentity identityOf(const std::vector<dataset::Recording>& recordings) {
  dataset::SensorIdentity identity;
  const auto fill = [](std::string& field, const std::string& value) {
    if (field.empty()) field = value;
  };
  for (const dataset::Recording& recording : recordings) {
    fill(identity.sensor_id, recording.sensor.sensor_id);
    fill(identity.serial, recording.sensor.serial);
    fill(identity.firmware, recording.sensor.firmware);
    fill(identity.model, recording.sensor.model);
    fill(identity.sealing, recording.sensor.sealing);
    fill(identity.transducer, recording.sensor.transducer);
  }
  return identity;
}

std::vector<std::uint8_t> unionOfMasks(const std::vector<dataset::Recording>& recordings,
                                       std::size_t taxels) {
  std::vector<std::uint8_t> mask(taxels, 0);
  for (const dataset::Recording& recording : recordings) {
    for (std::size_t taxel = 0; taxel < recording.mask.size(); ++taxel) mask[taxel] |= recording.mask[taxel];
  }
  return mask;
}

std::vector<std::string> warningsOf(const std::vector<dataset::Recording>& recordings,
                                    const std::vector<dataset::Sections>& sections) {
  std::vector<std::string> warnings;
  const std::vector<dataset::MountRemark> differing = dataset::remarksOnDifferingMounts(recordings);
  // First, because a summary prints the first ones only.
  for (const dataset::MountRemark& remark : differing) {
    if (remark.certain()) warnings.push_back(remark.sentence);
  }
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (const std::string& warning : recordings[r].warnings) {
      warnings.push_back(recordings[r].name + ": " + warning);
    }
    warnings.insert(warnings.end(), sections[r].warnings.begin(), sections[r].warnings.end());
  }
  for (const dataset::MountRemark& remark : dataset::remarksOnMounts(recordings)) {
    warnings.push_back(remark.sentence);
  }
  for (const dataset::MountRemark& remark : differing) {
    if (!remark.certain()) warnings.push_back(remark.sentence);
  }
  return warnings;
}

}  // namespace fsr::calibration
