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

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <limits>

#include "calibration/tare.h"
#include "settings/file_kind.h"
#include "settings/replace_file.h"
#include "settings/settings.h"

namespace fsr::calibration {

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

}  // namespace fsr::calibration
