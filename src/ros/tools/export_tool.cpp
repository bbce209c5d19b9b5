#include "ros/tools/tools.h"

#include <filesystem>
#include <iomanip>
#include <memory>
#include <sstream>
#include <vector>

#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/scan_source.h"
#include "ros/tools/tool_options.h"
#include "settings/command_line.h"

namespace fsr_ros {

namespace {

namespace fs = std::filesystem;
using fsr::exports::ScanFormat;

fsr::settings::CommandLine options(const std::vector<ScanFormat>& formats) {
  std::ostringstream purpose;
  purpose << "Writes a recording in a format that other programs read without ROS. FORMAT is\n";
  for (const ScanFormat& format : formats) {
    purpose << "  " << std::left << std::setw(10) << format.name << " " << format.summary << "\n";
  }
  purpose << "docs/exports.md describes every column and dataset.";
  fsr::settings::CommandLine line("export", "BAG... --to FORMAT --output PATH", purpose.str());
  line.option("to", "FORMAT", "format to write")
      .output("output", "PATH", "file to write; an existing file is replaced")
      .input("calibration", "FILE",
             "compute the maps with this calibration instead of using recorded ones; several sheets: A,B")
      .option("from", "S", "start, in seconds since the first scan (0)")
      .option("until", "S", "end, in seconds since the first scan (all)")
      .option("rate", "HZ", "largest number of scans a second (all)")
      .option("map", "TOPIC", "topic of the maps, if a bag holds several (pressure_map)")
      .input("regions", "FILE", "statistics, trial: regions of the sheet (whole matrix alone)")
      .option("unit", "UNIT",
              "statistics, trial: pressures in kPa or mmHg, also those of --contact and --above (kPa)")
      .option("contact", "P", "statistics, trial: a taxel is in contact from this pressure on (10 kPa)")
      .option("above", "P", "trial: pressure for the time above it")
      .option("step-force", "N", "trial: force on the whole matrix from which a step counts (found)");
  return addBagOptions(line);
}

ScanSelection selectionOf(const fsr::settings::CommandLine& line) {
  ScanSelection selection;
  selection.progress = toolProgress();
  const BagReadOptions how = bagReadOptions(line);
  selection.topics = how.topics;
  selection.map = line.text("map", selection.map);
  selection.calibrations = line.list("calibration");
  selection.ambient = how.ambient_pressure;
  selection.from = line.number("from", 0, {0, 1e9, "s"});
  selection.until = line.number("until", selection.until, {0, 1e9, "s"});
  selection.rate = line.number("rate", 0, {1e-3, 1e5, "Hz"});
  if (selection.from > selection.until) {
    throw fsr::settings::InputError("--from is " + line.text("from", "0") +
                                    ", but must not be later than --until, " + line.text("until", ""));
  }
  return selection;
}

fsr::exports::StatisticsOptions statisticsOf(const fsr::settings::CommandLine& line,
                                             const std::string& format) {
  if (format != "trial") line.refuse({"above", "step-force"}, "goes with --to trial");
  if (format != "trial" && format != "statistics")
    line.refuse({"regions", "unit", "contact"}, "goes with --to statistics or --to trial");
  fsr::exports::StatisticsOptions options;
  options.regions = line.text("regions", "");
  const std::string unit = line.choice("unit", fsr::view::pressureUnitNames(), fsr::view::name(options.unit));
  options.unit = fsr::view::pressureUnitOf(unit);
  const double pascals = fsr::view::pascals(options.unit);
  const fsr::settings::Range range{0, 1e7 / pascals, unit};
  options.contact_threshold = pascals * line.number("contact", options.contact_threshold / pascals, range);
  options.above = pascals * line.number("above", options.above / pascals, range);
  options.step_force = line.number("step-force", options.step_force, {0, 1e6, "N"});
  return options;
}

void writeScans(const ScanFormat& format, const fsr::settings::CommandLine& line, std::ostream& out) {
  if (!format.several_recordings && line.files().size() != 1) {
    throw fsr::settings::InputError("--to " + format.name + " takes one file, but " +
                                    std::to_string(line.files().size()) + " are given");
  }
  ScanSelection selection = selectionOf(line);
  fsr::exports::StatisticsOptions options = statisticsOf(line, format.name);
  std::vector<std::vector<std::string>> sheets(line.files().size(), {selection.topics});
  for (std::size_t i = 0; format.several_sheets && i < sheets.size(); ++i) {
    const std::vector<std::string> found = sheetsIn(line.files()[i], selection);
    if (found.size() > 0) sheets[i] = found;
    options.sheets = options.sheets || found.size() > 1;
  }
  const std::unique_ptr<fsr::exports::ScanSink> sink = format.open(line.requiredText("output"), options);
  std::size_t scans = 0;
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    selection.several_sheets = sheets[i].size() > 1;
    for (const std::string& sheet : sheets[i]) {
      selection.topics = sheet;
      scans += sendScans(line.files()[i], selection, *sink);
    }
  }
  if (scans == 0) {
    throw fsr::settings::InputError(line.files().front() +
                                    ": holds no scan between --from and --until; choose a longer interval");
  }
  sink->finish();
  out << scans << " scans written to " << fullPath(line.text("output", "")) << std::endl;
}

}  // namespace

int exportTool(int argc, const char* const* argv, std::ostream& out, const std::vector<ScanFormat>& formats) {
  fsr::settings::CommandLine line = options(formats);
  if (!line.parse(argc, argv, out)) return 0;
  std::vector<std::string> names;
  for (const ScanFormat& format : formats) names.push_back(format.name);
  const std::string name = line.choice("to", names, line.requiredText("to"));
  if (line.files().empty()) throw fsr::settings::InputError("give at least one BAG; see export --help");
  for (const ScanFormat& format : formats) {
    if (format.name == name) writeScans(format, line, out);
  }
  return 0;
}

}  // namespace fsr_ros
