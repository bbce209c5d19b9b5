#include "calibration/stages/session/tare.h"

#include <yaml-cpp/yaml.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "calibration/stages/session/session_rests.h"
#include "dataset/count_readers.h"
#include "fsr_pressure_map/calibration/calibrator.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "settings/number_text.h"
#include "settings/regular_file.h"
#include "settings/replace_file.h"
#include "settings/settings.h"

namespace fsr::calibration {

namespace {

bool hasReading(const map::PressureMap& map, std::size_t taxel) {
  constexpr std::uint16_t kFailed = map::taxel_flag::kDead | map::taxel_flag::kStuck;
  return std::isfinite(map.pressure[taxel]) && (map.flags[taxel] & kFailed) == 0;
}

}  // namespace

double meanCurvature(const matrix::Surface& surface) {
  double sum = 0;
  for (const matrix::Curvature& curvature : surface.curvature) sum += matrix::principalCurvature(curvature);
  return surface.known() ? sum / static_cast<double>(surface.curvature.size()) : 0.0;
}

bool holds(const Tare& tare, const std::string& calibration, const matrix::Surface& surface) {
  return tare.calibration == calibration && tare.surface == surface.name && tare.mount == surface.mount &&
         std::abs(tare.curvature - meanCurvature(surface)) <= kTareCurvatureTolerance;
}

std::vector<float> restOfTraining(const SessionZero& zero, const Calibrator& calibrator) {
  const std::vector<ClassChoice>& choices = calibrator.choices();
  std::vector<float> rest(choices.size(), 0.0F);
  const std::size_t classes = zero.at_rest.size() / rest.size();
  if (classes == 0) return rest;  // not known
  for (std::size_t taxel = 0; taxel < rest.size(); ++taxel)
    rest[taxel] = zero.at_rest[taxel * classes + std::min(choices[taxel].curvature_class, classes - 1)];
  return rest;
}

TareMeasurement::TareMeasurement(const matrix::Layout& layout, const TareOptions& options)
    : layout_(layout), options_(options), moments_(layout.size.taxels()) {}

bool TareMeasurement::add(const map::PressureMap& map, double time) noexcept {
  if (map.layout.size != layout_.size) return false;
  if (scans_ == 0 || time < start_) {
    moments_.assign(moments_.size(), {});
    scans_ = 0;
    start_ = time;
  }
  for (std::size_t taxel = 0; taxel < moments_.size(); ++taxel) {
    if (hasReading(map, taxel)) moments_[taxel].add(map.pressure[taxel]);
  }
  ++scans_;
  return scans_ >= options_.least_scans && time - start_ >= options_.window;
}

std::vector<float> TareMeasurement::offset(const std::vector<float>& standing,
                                           const std::vector<float>& training) const {
  std::vector<float> result = standing.empty() ? std::vector<float>(moments_.size(), 0.0f) : standing;
  std::size_t read = 0;
  for (std::size_t taxel = 0; taxel < moments_.size(); ++taxel) {
    const statistics::RunningMoments& m = moments_[taxel];
    if (m.count == 0) continue;
    ++read;
    const double offset = result[taxel] + m.mean;
    if (std::abs(offset) > options_.limit) {
      throw settings::InputError("the tare is refused: " + place(taxel) + " reads " +
                                 settings::roundedPressure(offset, 3) + " at rest, but must be within " +
                                 settings::roundedPressure(options_.limit, 3) + " (~tare_limit)");
    }
    const double scatter = m.deviation();
    if (scatter > options_.scatter) {
      throw settings::InputError("the tare is refused: " + place(taxel) + " scatters by " +
                                 settings::roundedPressure(scatter, 3) +
                                 " as on a limb, but must be within " +
                                 settings::roundedPressure(options_.scatter, 3) + " (~tare_scatter)");
    }
    result[taxel] = static_cast<float>(offset) - (training.empty() ? 0.0F : training[taxel]);
  }
  if (read == 0)
    throw settings::InputError("the tare is refused: no taxel has a reading, but at least one must");
  return result;
}

std::string TareMeasurement::place(std::size_t taxel) const {
  return "the taxel in row " + std::to_string(layout_.row({taxel})) + ", column " +
         std::to_string(layout_.column({taxel}));
}

// The file of a tare:
//
//     format: fsr_pressure_map tare 1
//     calibration: 3f2a...      # id of the calibration it belongs to
//     surface: cylinder_7cm
//     mount: 2
//     curvature: 14.2857        # principal, mean over the taxels [1/m]
//     date: 2024-05-17T09:30:00Z
//     rows: 7
//     columns: 10
//     offset: [...]             # row-major [Pa]

namespace {

constexpr char kFormat[] = "fsr_pressure_map tare 1";
const settings::Range kSide{1, matrix::kMaxMatrixSide, ""};
const settings::Range kMount{0, std::numeric_limits<std::uint32_t>::max(), ""};
const settings::Range kOffset{-1e6, 1e6, "Pa"};
const settings::Range kBend{-1e3, 1e3, "1/m"};

}  // namespace

void saveTare(const Tare& tare, const std::string& path) {
  YAML::Emitter out;
  out << YAML::BeginMap;
  out << YAML::Key << "format" << YAML::Value << kFormat;
  out << YAML::Key << "calibration" << YAML::Value << YAML::DoubleQuoted << tare.calibration;
  out << YAML::Key << "surface" << YAML::Value << YAML::DoubleQuoted << tare.surface;
  out << YAML::Key << "mount" << YAML::Value << tare.mount;
  out << YAML::Key << "curvature" << YAML::Value << tare.curvature;
  out << YAML::Key << "date" << YAML::Value << YAML::DoubleQuoted << tare.date;
  out << YAML::Key << "rows" << YAML::Value << tare.size.rows;
  out << YAML::Key << "columns" << YAML::Value << tare.size.columns;
  out << YAML::Key << "offset" << YAML::Value << YAML::Flow << tare.offset;
  out << YAML::EndMap << YAML::Newline;
  settings::replaceFile(path, out.c_str());
}

void requireTareOrNothing(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status found = std::filesystem::status(path, error);
  if (found.type() == std::filesystem::file_type::not_found) return;
  const bool tare = std::filesystem::is_regular_file(found) &&
                    settings::kindOfFile(path) == settings::kindOf(std::string("format: ") + kFormat);
  if (tare) return;
  throw settings::InputError(path +
                             ": is no tare, so it is neither replaced nor removed; give another file with "
                             "~tare_file");
}

Tare loadTare(const std::string& path) {
  const settings::Settings settings = settings::Settings::fromFile(path);
  settings.choice("format", {kFormat});
  Tare tare;
  tare.calibration = settings.text("calibration");
  tare.surface = settings.text("surface");
  tare.mount = static_cast<std::uint32_t>(settings.integer("mount", kMount));
  tare.curvature = settings.number("curvature", kBend);
  tare.date = settings.text("date");
  tare.size.rows = static_cast<std::uint16_t>(settings.integer("rows", kSide));
  tare.size.columns = static_cast<std::uint16_t>(settings.integer("columns", kSide));
  for (const double value : settings.numbers("offset", kOffset)) {
    tare.offset.push_back(static_cast<float>(value));
  }
  if (tare.offset.size() != tare.size.taxels()) {
    throw settings.error("offset", "must have rows x columns values, " + std::to_string(tare.size.taxels()));
  }
  settings.refuseUnknown();
  return tare;
}

std::vector<float> tareAtStart(const Calibration& calibration, const dataset::Recording& recording,
                               std::size_t condition) {
  if (!calibration.session_zero.expected()) return {};
  const std::vector<std::size_t> rest = restAtStart(recording, condition);
  if (rest.empty()) return {};
  const std::size_t taxels = recording.layout.size.taxels();
  Calibrator calibrator(calibration.tables, calibration.layout);
  calibrator.setMask(recording.mask);
  calibrator.setSurface(recording.conditions[condition], recording.time[rest.front()]);
  map::PressureMap map;
  std::vector<double> sum(taxels, 0), count(taxels, 0);
  dataset::ScanCounts counts(recording);
  for (const std::size_t scan : rest) {
    calibrator.calibrate({recording.layout.size, recording.full_scale, counts[scan], taxels},
                         recording.time[scan], map);
    for (std::size_t i = 0; i < taxels; ++i) {
      if (!std::isfinite(map.pressure[i]) || (map.flags[i] & map::taxel_flag::kSaturated) != 0) continue;
      sum[i] += double(map.pressure[i]) - recording.pressure[scan];
      count[i] += 1;
    }
  }
  const std::vector<float> training = restOfTraining(calibration.session_zero, calibrator);
  std::vector<float> offset(taxels, 0.0F);
  for (std::size_t i = 0; i < taxels; ++i) {
    if (count[i] > 0) offset[i] = static_cast<float>(sum[i] / count[i]) - training[i];
  }
  return offset;
}

}  // namespace fsr::calibration
