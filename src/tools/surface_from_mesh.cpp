#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"
#include "fsr_pressure_map/view/bent_sheet.h"
#include "mesh/mesh_file.h"
#include "mesh/mesh_surface.h"
#include "settings/command_line.h"
#include "settings/number_text.h"
#include "settings/replace_file.h"

namespace {

namespace mesh = fsr::mesh;
using fsr::settings::CommandLine;

CommandLine commandLine() {
  CommandLine line("surface_from_mesh",
                   "MESH --units mm|cm|m|inch --at X,Y,Z --row-direction DX,DY,DZ --output SURFACE.yaml",
                   "Makes a surface file from a scan or drawing of the surface (.stl, .ply or .obj): lays "
                   "the matrix on the "
                   "mesh and writes the curvature of each taxel with its standard deviation.");
  line.option("units", "UNIT", "unit of the mesh's coordinates: mm, cm, m or inch")
      .option("at", "X,Y,Z", "where the middle of the matrix lies, in the mesh's coordinates and unit")
      .option("row-direction", "DX,DY,DZ",
              "direction of the rows (increasing column index), in the mesh's coordinates")
      .output("output", "FILE", "surface file to write")
      .option("side", "outside|inside",
              "the matrix lies on the side to which the normals of the triangles point (outside), or on the "
              "other side (outside)")
      .option("rows", "N", "rows of the matrix (7)")
      .option("columns", "N", "columns of the matrix (10)")
      .option("pitch-x", "M", "distance of neighbouring taxels along a row [m] (0.010)")
      .option("pitch-y", "M", "distance of neighbouring taxels along a column [m] (0.010)")
      .option("fit-radius", "M",
              "the curvature of a taxel is that of the mesh within this distance [m] (the larger pitch)");
  return line;
}

mesh::Point pointIn(const CommandLine& line, const std::string& name) {
  const std::string text = line.requiredText(name);
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  mesh::Point point;
  char first = 0, second = 0;
  if (!(stream >> point.x() >> first >> point.y() >> second >> point.z()) || first != ',' || second != ',' ||
      stream.peek() != EOF || !point.allFinite()) {
    throw fsr::settings::InputError("--" + name + " is \"" + text +
                                    "\", but must be three numbers: X,Y,Z, e.g. 12.5,-3,80");
  }
  return point;
}

mesh::SheetPlace placeIn(const CommandLine& line, double unit) {
  mesh::SheetPlace place;
  place.layout.size.rows =
      static_cast<std::uint16_t>(line.integer("rows", 7, {1, fsr::matrix::kMaxMatrixSide, ""}));
  place.layout.size.columns =
      static_cast<std::uint16_t>(line.integer("columns", 10, {1, fsr::matrix::kMaxMatrixSide, ""}));
  place.layout.pitch_x = line.number("pitch-x", place.layout.pitch_x, {1e-4, 1, "m"});
  place.layout.pitch_y = line.number("pitch-y", place.layout.pitch_y, {1e-4, 1, "m"});
  if (line.has("fit-radius")) place.radius = line.number("fit-radius", 0, {1e-4, 1, "m"});
  place.at = unit * pointIn(line, "at");
  place.row_direction = pointIn(line, "row-direction");
  if (!(place.row_direction.norm() > 0))
    throw fsr::settings::InputError("--row-direction is 0,0,0, but must be a direction");
  place.along_normals = line.choice("side", {"outside", "inside"}, "outside") == "outside";
  return place;
}

// The path of the mesh as seen from the surface file, so that both can be moved together.
std::string pathBeside(const std::filesystem::path& file, const std::filesystem::path& output) {
  return std::filesystem::absolute(file)
      .lexically_normal()
      .lexically_proximate(std::filesystem::absolute(output).lexically_normal().parent_path())
      .string();
}

// How far rviz, which bends the sheet by the curvatures of the file, draws a taxel from its place on the mesh
// [m].
double drawnGap(const mesh::MeshSurface& made, const fsr::matrix::Layout& layout) {
  const std::vector<fsr::view::TaxelPose> poses = fsr::view::bendSheet(layout, made.surface);
  const mesh::Frame& middle = made.sheet.middle;
  double largest = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto& [x, y, z] = poses[i].position;
    const mesh::Point drawn = middle.origin + middle.axes * mesh::Point(x, y, z);
    largest = std::max(largest, (drawn - made.sheet.taxels[i].fit.frame.origin).norm());
  }
  return largest;
}

int surfaceFromMeshTool(int argc, const char* const* argv) {
  CommandLine line = commandLine();
  if (!line.parse(argc, argv, std::cout)) return 0;
  if (line.files().size() != 1)
    throw fsr::settings::InputError("give one mesh (.stl, .ply or .obj); see surface_from_mesh --help");
  const std::filesystem::path file = line.files().front();
  const std::filesystem::path output = line.requiredText("output");
  const mesh::MeshUnit unit = mesh::meshUnit(line.requiredText("units"));
  const mesh::SheetPlace place = placeIn(line, unit.length);
  line.requireWritable(output.string());

  const mesh::Mesh triangles = mesh::readMesh(file.string(), unit.length);
  const mesh::MeshOrigin origin{
      file.filename().string(),  pathBeside(file, output),  unit, place.at / unit.length, place.row_direction,
      triangles.vertices.size(), triangles.triangles.size()};
  const mesh::MeshSurface surface = [&] {
    try {
      return mesh::surfaceFromMesh(triangles, place, output.stem().string());
    } catch (const fsr::settings::InputError& error) {
      throw fsr::settings::InputError(file.string() + ": " + error.what());
    }
  }();
  fsr::settings::replaceFile(output.string(), mesh::surfaceFileText(surface, place, origin));
  std::cout << mesh::surfaceReport(surface, place, origin) << "rviz draws each taxel within "
            << fsr::settings::roundedText(1e3 * drawnGap(surface, place.layout), 2)
            << " mm of its place on the mesh\n"
            << "\nwritten: " << std::filesystem::absolute(output).lexically_normal().string() << "\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return fsr::settings::runTool("surface_from_mesh", [&] { return surfaceFromMeshTool(argc, argv); });
}
