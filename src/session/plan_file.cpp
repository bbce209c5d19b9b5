#include "session/plan.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "matrix/surface_file.h"
#include "settings/number_text.h"
#include "settings/text.h"
#include "simulation/settings_text.h"

namespace fsr::session {

namespace {

namespace fs = std::filesystem;
using settings::numberText;
using settings::Settings;

const settings::Range kPressure{1e3, simulation::kChamberRating,
                                "Pa gauge (the chamber is rated at 793 kPa)"};
const settings::Range kRate{1, 1e7, "Pa/s"};
const settings::Range kSeconds{0, 86400, "s"};
const settings::Range kMountsRange{1, 100, "mounts"};

Conditioning readConditioning(const Settings& settings) {
  Conditioning read;
  read.cycles = static_cast<unsigned>(settings.integer("cycles", {0, 100, "cycles (0 = none)"}, read.cycles));
  read.share_of_peak = settings.number("share_of_peak", {1, 2, "of the largest peak"}, read.share_of_peak);
  read.rate = settings.number("rate", kRate, read.rate);
  read.dwell_peak = settings.number("dwell_peak", kSeconds, read.dwell_peak);
  read.dwell_rest = settings.number("dwell_rest", kSeconds, read.dwell_rest);
  return read;
}

Rests readRests(const Settings& settings) {
  Rests read;
  read.before = settings.number("before", kSeconds, read.before);
  read.after = settings.number("after", kSeconds, read.after);
  return read;
}

Tolerance readTolerance(const Settings& settings) {
  Tolerance read;
  read.peak = settings.number("peak", {0.001, 0.5, "of the peak"}, read.peak);
  read.rate = settings.number("rate", {0.01, 1, "of the rate"}, read.rate);
  read.dwell = settings.number("dwell", {0.1, 600, "s"}, read.dwell);
  return read;
}

matrix::MatrixSize readSize(const Settings& settings, matrix::MatrixSize size) {
  const settings::Range side{1, matrix::kMaxMatrixSide, ""};
  size.rows = static_cast<std::uint16_t>(settings.integer("rows", side, size.rows));
  size.columns = static_cast<std::uint16_t>(settings.integer("columns", side, size.columns));
  return size;
}

// Without a `folder`, surface files are in ../surfaces, seen from the plan.
matrix::Surface surfaceOfPlan(const std::string& name, const std::string& folder, matrix::MatrixSize size,
                              const std::string& origin, const std::string& field) {
  if (!folder.empty()) return surfaceInFolder(name, folder, size, field);
  const fs::path beside = fs::absolute(fs::path(origin).parent_path() / "../surfaces").lexically_normal();
  try {
    return surfaceInFolder(name, beside.string(), size, field);
  } catch (const settings::InputError& error) {
    if (fs::exists(beside / (name + ".yaml"))) throw;  // what is wrong is in the surface file
    throw settings::InputError(std::string(error.what()) +
                               ". This folder is ../surfaces, seen from the plan; another one is given by "
                               "plan_session --surface-folder DIR and session.launch surfaces:=DIR");
  }
}

PlannedSurface readSurface(const Settings& entry, const std::string& folder, matrix::MatrixSize size,
                           const std::string& origin) {
  PlannedSurface read;
  const std::string name = entry.text("surface");
  if (name.empty()) throw entry.error("surface", "must be the name of a surface");
  if (matrix::hasSurfaceForm(entry)) {
    read.surface = matrix::readSurface(entry, size);
  } else {
    // The sentence of error() without its complaint: "FILE: FIELD is VALUE".
    std::string field = entry.error("surface", "").what();
    field.resize(field.size() - std::string(", but ").size());
    read.surface = surfaceOfPlan(name, folder, size, origin, field);
  }
  read.mounts = static_cast<unsigned>(entry.integer("mounts", kMountsRange, read.mounts));
  return read;
}

std::vector<Break> readBreaks(const Settings& settings) {
  std::vector<Break> breaks;
  for (const Settings& entry : settings.sections("breaks")) {
    const auto after = static_cast<unsigned>(entry.integer("after", {1, 1000, ""}));
    breaks.push_back({after, entry.number("duration", {1, 172800, "s"})});
  }
  return breaks;
}

// ---- text ----------------------------------------------------------------------------------------

// A radius that a reader converts back to this curvature [1/m]. Few digits come first: 1/0.07 is 0.07 again.
std::string radiusText(double curvature) {
  for (int digits = 2; digits < 17; ++digits) {
    const std::string text = settings::roundedText(1 / curvature, digits);
    if (text.find('e') == std::string::npos && 1 / std::stod(text) == curvature) return text;
  }
  return "";
}

// "cylinder: {...}" where the surface is one, otherwise empty.
std::string cylinderText(const matrix::Curvature& c) {
  if (c.xy != 0 || (c.x == 0) == (c.y == 0)) return "";
  const double bend = c.x + c.y;
  const std::string radius = radiusText(std::abs(bend));
  if (radius.empty()) return "";
  return "cylinder: {radius: " + radius + ", axis: " + (c.x != 0 ? "y" : "x") +
         (bend < 0 ? ", side: inside}" : "}");
}

std::string listText(const std::vector<matrix::Curvature>& all, double matrix::Curvature::*part) {
  return "[" + settings::joinedTexts(all, [part](const auto& one) { return numberText(one.*part); }) + "]";
}

// Of a surface with one curvature for all taxels.
std::string formText(const matrix::Curvature& c) {
  if (c == matrix::Curvature{}) return "flat: true";
  const std::string cylinder = cylinderText(c);
  if (!cylinder.empty()) return cylinder;
  return "two_planes: {x: " + numberText(c.x) + ", y: " + numberText(c.y) + ", xy: " + numberText(c.xy) + "}";
}

std::string formText(const matrix::Surface& surface) {
  const auto& all = surface.curvature;
  const std::string each = settings::joinedTexts(surface.deviation, numberText);
  const std::string deviation = surface.deviation.size() == 1 ? ", deviation: " + each : "";
  if (all.size() == 1) return formText(all.front()) + deviation;
  return "taxels: {x: " + listText(all, &matrix::Curvature::x) +
         ", y: " + listText(all, &matrix::Curvature::y) + ", xy: " + listText(all, &matrix::Curvature::xy) +
         (surface.deviation.size() > 1 ? ", deviation: [" + each + "]}" : "}" + deviation);
}

std::string text(const Conditioning& c) {
  return "{cycles: " + std::to_string(c.cycles) + ", share_of_peak: " + numberText(c.share_of_peak) +
         ", rate: " + numberText(c.rate) + ", dwell_peak: " + numberText(c.dwell_peak) +
         ", dwell_rest: " + numberText(c.dwell_rest) + "}";
}

std::string yesNo(bool value) {
  return value ? "true" : "false";
}

}  // namespace

matrix::Surface surfaceInFolder(const std::string& name, const std::string& folder, matrix::MatrixSize size,
                                const std::string& field) {
  const fs::path path = fs::path(folder) / (name + ".yaml");
  const bool plain = name.find('/') == std::string::npos;
  if (plain && fs::exists(path)) return matrix::readSurfaceFile(path.string(), size);
  std::string known = settings::joined(matrix::surfacesIn(folder));
  if (known.empty()) known = fs::is_directory(folder) ? "none" : "none, because there is no such folder";
  throw settings::InputError(field + ", but " + folder + " has no file of this surface; it has " + known);
}

SessionPlan readPlan(const Settings& settings, const std::string& surface_folder) {
  SessionPlan plan;
  plan.origin = settings.origin();
  plan.name = settings.text("plan");
  plan.purpose = purposeCalled(settings.choice("purpose", purposeNames(), name(plan.purpose)));
  plan.seed = static_cast<std::uint64_t>(settings.integer("seed", {0, 9e15, ""}, 1));
  plan.drawn_order = settings.choice("order", {"drawn", "listed"}, "drawn") == "drawn";
  plan.repeat_first = settings.flag("repeat_first", plan.repeat_first);
  plan.thermometer = settings.flag("thermometer", plan.thermometer);
  plan.chamber_limit = settings.number("chamber_limit", kPressure, plan.chamber_limit);
  plan.change = settings.number("change", kSeconds, plan.change);
  if (settings.has("matrix")) plan.matrix = readSize(settings.section("matrix"), plan.matrix);
  if (settings.has("conditioning")) plan.conditioning = readConditioning(settings.section("conditioning"));
  if (settings.has("rest")) plan.rest = readRests(settings.section("rest"));
  if (settings.has("tolerance")) plan.tolerance = readTolerance(settings.section("tolerance"));
  for (const Settings& entry : settings.sections("surfaces"))
    plan.surfaces.push_back(readSurface(entry, surface_folder, plan.matrix, plan.origin));
  plan.program = simulation::readChamberProgram(settings.sections("program"));
  if (settings.has("breaks")) plan.breaks = readBreaks(settings);
  settings.refuseUnknown();
  validate(plan);
  return plan;
}

SessionPlan readPlanFile(const std::string& path, const std::string& surface_folder) {
  return readPlan(Settings::fromFile(path), surface_folder);
}

std::string planText(const SessionPlan& plan, const std::vector<std::string>& remarks) {
  std::string text;
  for (const std::string& remark : remarks) text += remark.empty() ? "#\n" : "# " + remark + "\n";
  text += "plan: " + settings::quotedText(plan.name) + "\npurpose: " + name(plan.purpose) +
          "\nseed: " + std::to_string(plan.seed) +
          "  # of the order\norder: " + (plan.drawn_order ? "drawn" : "listed") +
          "\nrepeat_first: " + yesNo(plan.repeat_first) + "\nthermometer: " + yesNo(plan.thermometer) +
          "\nchamber_limit: " + numberText(plan.chamber_limit) +
          "  # gauge [Pa]\nchange: " + numberText(plan.change) +
          "  # to put the sheet on the next surface [s]\nmatrix: {rows: " + std::to_string(plan.matrix.rows) +
          ", columns: " + std::to_string(plan.matrix.columns) + "}\n";
  text += "\n# Before the first recording [Pa/s], [s].\nconditioning: " + session::text(plan.conditioning) +
          "\n# Without load, in each recording [s].\nrest: {before: " + numberText(plan.rest.before) +
          ", after: " + numberText(plan.rest.after) +
          "}\n# Shares of peak and rate, and [s].\ntolerance: {peak: " + numberText(plan.tolerance.peak) +
          ", rate: " + numberText(plan.tolerance.rate) + ", dwell: " + numberText(plan.tolerance.dwell) +
          "}\n\nsurfaces:  # lengths [m], curvatures [1/m]\n";
  for (const PlannedSurface& one : plan.surfaces) {
    text += "  - {surface: " + settings::quotedText(one.surface.name) + ", " + formText(one.surface) +
            ", mounts: " + std::to_string(one.mounts) + "}\n";
  }
  text += "\nprogram:  # on each mount; gauge pressure [Pa], rates [Pa/s], times [s]\n";
  for (const simulation::ProgramPart& part : plan.program)
    text += "  - " + simulation::programText(part) + "\n";
  if (!plan.breaks.empty()) text += "\nbreaks:  # without load, behind this mount [s]\n";
  for (const Break& one : plan.breaks) {
    text += "  - {after: " + std::to_string(one.after) + ", duration: " + numberText(one.duration) + "}\n";
  }
  return text;
}

}  // namespace fsr::session
