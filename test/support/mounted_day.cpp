#include "support/mounted_day.h"

#include <fstream>
#include <iterator>
#include <utility>

#include "fsr_pressure_map/simulation/simulate.h"
#include "simulation/settings_text.h"
#include "support/source_dir.h"

namespace test_support {

std::vector<fsr::dataset::Recording> recorded(const MountedDay& day) {
  const std::vector<std::pair<std::string, std::string>> surfaces = {
      {"cylinder_10cm", "cylinder: {radius: 0.10, axis: y}"},
      {"cylinder_6cm", "cylinder: {radius: 0.06, axis: y}"},
      {"flat", "flat: true"},
      {"cylinder_8cm", "cylinder: {radius: 0.08, axis: y}"}};
  constexpr std::size_t kWrongMount = 4;  // counted from 0
  std::string session;
  for (std::size_t mount = 0; mount < static_cast<std::size_t>(day.rounds) * surfaces.size(); ++mount) {
    const auto& declared = surfaces[mount % surfaces.size()];
    const auto& lies_on = day.wrong && mount == kWrongMount ? surfaces[1] : declared;
    session += "  - {surface: " + declared.first + ", pause: 180, " + lies_on.second + "}\n";
  }
  std::ifstream file(sourceDir() + "/config/simulation/" + day.rig + ".yaml");
  const std::string shipped(std::istreambuf_iterator<char>(file), {});
  auto settings = fsr::simulation::readSimulation(fsr::settings::Settings::fromText(
      "simulation: day\nmatrix: {rows: 3, columns: 4}\nboard: {scan_rate: 5}\nprogram:\n"
      "  - cycles: {peak: 620000, rate: 40000, cycles: 3}\n"
      "  - cycles: {peak: 620000, rate: 17000, dwell_peak: 10, cycles: 2}\n"
      "  - hold: {pressure: 310000, rate: 40000, duration: 60}\nsession:\n" +
          session + shipped.substr(shipped.find("effects:")),
      "day.yaml"));
  settings.seed = day.seed;
  std::vector<fsr::dataset::Recording> recordings = fsr::simulation::simulateSession(settings);
  if (day.wrong) recordings[kWrongMount].conditions[0].curvature = recordings[0].conditions[0].curvature;
  return recordings;
}

}  // namespace test_support
