#include "ros/tools/tools.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "dataset/recording_builder.h"
#include "dataset/table_recording.h"
#include "fsr_pressure_map/settings/input_error.h"
#include "ros/bags/bag_writer.h"
#include "settings/command_line.h"

namespace fsr_ros {

namespace {

fsr::settings::CommandLine commandLine() {
  fsr::settings::CommandLine line(
      "csv_to_bag", "TABLE --columns ROLE=COLUMN[:UNIT],... --output BAG",
      "Converts a text table (plain or .gz) with one row for each scan, as LabVIEW and spreadsheets "
      "write it, to a bag.\nRoles: time (s, ms, us, min), reading (counts, V, mV, S, mS, uS, ohm, kohm, "
      "Mohm; "
      "one for each taxel),\nreference (kPa, Pa, MPa, bar, mbar, psi, mmHg, N, or e.g. 2500Pa for "
      "each unit), reference_time (as time),\ncurvature (1/m, 1/cm), temperature (C, K, F), surface, mount. "
      "COLUMN is a name "
      "or a number from 1; reading=FIRST-LAST takes all columns from one to another.");
  line.option("columns", "LIST", "e.g. time=1:ms,reading=force_V:V,reference=pressure:bar")
      .output("output", "BAG", "file to write")
      .option("separator", "NAME", "comma, semicolon, tab or space (detected from the first row)")
      .option("header", "yes|no", "whether the first row names the columns (detected from the first row)")
      .option("skip-lines", "N", "number of lines before the table (0)")
      .flag("decimal-comma", "numbers are written 3,14")
      .flag("skip-bad-rows", "leave out rows with errors, and print how many")
      .option("matrix", "ROWSxCOLUMNS", "size of the matrix; the readings are row-major (one row)")
      .option("pitch", "M", "distance of neighbouring taxels [m] (0.010)")
      .option(
          "range", "LOW,HIGH",
          "readings [counts, V or S] at count 0 and at full scale (0 and a round number); 5,0 if the reading "
          "falls with pressure")
      .option("full-scale", "N", "largest count, if the readings are counts (4095, or 65535)")
      .option("area", "M2", "area on which a reference in N acts [m^2] (1e-4)")
      .flag("absolute", "the reference is absolute pressure, not gauge")
      .option("ambient", "PA", "ambient pressure [Pa] (101325)")
      .option("curvature", "1/M", "curvature of the surface, if no column holds it [1/m]; 0 = flat (unknown)")
      .option("surface", "NAME", "name of the surface, if no column holds it")
      .option("start", "SECONDS",
              "stamp of time 0, in seconds since 1970 (946684800 = 2000-01-01; 0 if the times are seconds "
              "since 1970)")
      .option("reference-rate", "HZ",
              "rate of a reference without times, which begins with the first row [1/s]; without it, the "
              "reference is of the scan in its row, or has the column reference_time")
      .option("reference-offset", "SECONDS", "added to the times of the reference [s] (0)")
      .option("namespace", "NAME", "namespace of the topics (fsr)")
      .option("sensor-id", "ID", "sensor_id of matrix_info")
      .option("serial", "TEXT", "serial number in matrix_info");
  return line;
}

// "A<between>B" as two numbers.
std::pair<double, double> twoNumbers(const fsr::settings::CommandLine& line, const std::string& name,
                                     char between, const std::string& right) {
  std::istringstream text(line.text(name, ""));
  double first = 0, second = 0;
  char separator = 0;
  if (!(text >> first >> separator >> second) || separator != between || text.peek() != EOF) {
    throw fsr::settings::InputError("--" + name + " is \"" + line.text(name, "") + "\", but must be " +
                                    right);
  }
  return {first, second};
}

fsr::dataset::TableFormat formatIn(const fsr::settings::CommandLine& line) {
  fsr::dataset::TableFormat format;
  static const std::map<std::string, char> separators = {
      {"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"space", ' '}};
  if (line.has("separator"))
    format.separator = separators.at(line.choice("separator", {"comma", "semicolon", "tab", "space"}, ""));
  format.decimal_comma = line.has("decimal-comma");
  format.skip_lines = static_cast<std::size_t>(line.integer("skip-lines", 0, {0, 1e6, ""}));
  using Header = fsr::dataset::TableFormat::Header;
  if (line.has("header"))
    format.header = line.choice("header", {"yes", "no"}, "") == "yes" ? Header::kYes : Header::kNo;
  return format;
}

fsr::matrix::MatrixSize matrixIn(const fsr::settings::CommandLine& line) {
  if (!line.has("matrix")) return {};
  const auto [rows, columns] = twoNumbers(line, "matrix", 'x', "e.g. 7x10: rows and columns, 1 to 64 each");
  for (const double side : {rows, columns}) {
    if (side < 1 || side > fsr::matrix::kMaxMatrixSide || side != std::floor(side)) {
      throw fsr::settings::InputError("--matrix is " + line.text("matrix", "") +
                                      ", but must have 1 to 64 rows and columns");
    }
  }
  return {static_cast<std::uint16_t>(rows), static_cast<std::uint16_t>(columns)};
}

fsr::dataset::TablePlan planFrom(const fsr::settings::CommandLine& line) {
  fsr::dataset::TablePlan plan;
  plan.columns = fsr::dataset::parseColumns(line.requiredText("columns"));
  plan.format = formatIn(line);
  plan.matrix = matrixIn(line);
  plan.pitch = line.number("pitch", plan.pitch, {1e-4, 1, "m"});
  plan.area = line.number("area", plan.area, {1e-9, 100, "m^2"});
  plan.surface = line.text("surface", "");
  if (line.has("start")) plan.start_ns = std::llround(1e9 * line.number("start", 0, {0, 4e9, "s"}));
  if (line.has("reference-rate")) {
    plan.reference_rate = line.number("reference-rate", 1, {1e-6, 1e6, "1/s"});
  }
  plan.reference_offset = line.number("reference-offset", 0, {-1e9, 1e9, "s"});
  plan.skip_bad_rows = line.has("skip-bad-rows");
  if (line.has("absolute"))
    plan.ambient_pressure = line.number("ambient", fsr::dataset::kStandardAmbient, {3e4, 2e5, "Pa"});
  if (line.has("curvature")) plan.curvature = line.number("curvature", 0, {-100, 100, "1/m"});
  if (line.has("full-scale")) {
    plan.full_scale = static_cast<std::uint16_t>(line.integer("full-scale", 0, {1, 65535, ""}));
  }
  if (line.has("range")) {
    plan.range = twoNumbers(line, "range", ',', "e.g. 0,5: the readings at count 0 and at full scale");
    if (plan.range->first == plan.range->second) {
      throw fsr::settings::InputError("--range is " + line.text("range", "") +
                                      ", but its two numbers must differ");
    }
  }
  return plan;
}

BagOptions bagOptions(const fsr::settings::CommandLine& line, const fsr::dataset::ReadingScale& scale) {
  BagOptions options;
  options.topics = line.text("namespace", "fsr");
  options.ambient_pressure = line.number("ambient", fsr::dataset::kStandardAmbient, {3e4, 2e5, "Pa"});
  if (scale.unit == "V") options.reference_voltage = std::abs(scale.high - scale.low);
  // The resistance with which the output is full scale at the largest conductance.
  if (scale.unit == "S") options.feedback_resistance = 1 / std::max(scale.low, scale.high);
  options.session.session_id = "table";
  options.session.use = "bench";
  return options;
}

void report(const fsr::dataset::TableRecording& table, const std::string& output, std::ostream& out) {
  const fsr::dataset::Recording& recording = table.recording;
  double longest = 0;
  for (std::size_t i = 1; i < recording.scans(); ++i)
    longest = std::max(longest, recording.time[i] - recording.time[i - 1]);
  out << recording.scans() << " scans of " << fsr::matrix::sizeText(recording.layout.size) << " taxels over "
      << recording.time.back() << " s, " << recording.conditions.size() << " surface(s); longest step "
      << longest << " s\n"
      << table.scale.text() << "\n";
  if (table.area) out << "reference = force / " << *table.area << " m^2 (--area)\n";
  if (table.unix_time) out << "the times are taken as seconds since 1970; give --start if they are not\n";
  if (table.no_reference > 0) {
    out << table.no_reference << " scans left out, which are before or after the reference\n";
  }
  if (table.skipped > 0) out << table.skipped << " rows left out\n";
  out << "written: " << std::filesystem::absolute(output).string() << "\n";
}

}  // namespace

int csvToBagTool(int argc, const char* const* argv, std::ostream& out) {
  fsr::settings::CommandLine line = commandLine();
  if (!line.parse(argc, argv, out)) return 0;
  if (line.files().size() != 1) throw fsr::settings::InputError("give one TABLE; see csv_to_bag --help");
  const std::string output = line.requiredText("output");
  fsr::dataset::TableRecording table = fsr::dataset::readTable(line.files().front(), planFrom(line));
  table.recording.sensor.sensor_id = line.text("sensor-id", "");
  table.recording.sensor.serial = line.text("serial", "");
  writeBag(output, table.recording, bagOptions(line, table.scale));
  report(table, output, out);
  return 0;
}

}  // namespace fsr_ros
