#include "matrix/surface_file.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

namespace fsr::matrix {

namespace {

using Vector = Eigen::Vector3d;

// Directions are written with six decimals; this is far beyond their rounding.
constexpr double kNotPerpendicular = 1e-3;

const settings::Range kPositionRange{-1000, 1000, "m"};
const settings::Range kDirectionRange{-1, 1, ""};

Vector vectorIn(const settings::Settings& settings, const std::string& key, const settings::Range& range) {
  const std::vector<double> values = settings.numbers(key, range);
  if (values.size() != 3) throw settings.error(key, "must be a list of three numbers: x, y, z");
  return {values[0], values[1], values[2]};
}

Vector directionIn(const settings::Settings& settings, const std::string& key) {
  const Vector direction = vectorIn(settings, key, kDirectionRange);
  if (std::abs(direction.norm() - 1) > kNotPerpendicular)
    throw settings.error(key, "must be a direction of length 1");
  return direction.normalized();
}

Eigen::Quaterniond orientationIn(const settings::Settings& settings) {
  const Vector row = directionIn(settings, "row"), normal = directionIn(settings, "normal");
  if (std::abs(row.dot(normal)) > kNotPerpendicular)
    throw settings.error("row", "must be perpendicular to mesh.normal");
  Eigen::Matrix3d axes;
  axes.col(2) = normal;
  axes.col(1) = normal.cross(row).normalized();
  axes.col(0) = axes.col(1).cross(normal);
  return Eigen::Quaterniond(axes).normalized();
}

Pose poseOf(const Vector& position, const Eigen::Quaterniond& turn) {
  return {{position.x(), position.y(), position.z()}, {turn.x(), turn.y(), turn.z(), turn.w()}};
}

}  // namespace

Pose inverse(const Pose& pose) {
  const auto& [x, y, z, w] = pose.quaternion;
  const Eigen::Quaterniond back = Eigen::Quaterniond(w, x, y, z).conjugate();
  const auto& [px, py, pz] = pose.position;
  return poseOf(-(back * Vector(px, py, pz)), back);
}

Pose onLimb(const Surface& surface, double around, double along) {
  constexpr double kFlat = 1.0, kRadiusOfFlat = 0.07;  // [1/m], [m]
  const Curvature middle = surface.known() ? surface.curvature[surface.curvature.size() / 2] : Curvature{};
  const bool along_columns = std::abs(middle.x) >= std::abs(middle.y);  // the axis
  const double curvature = along_columns ? middle.x : middle.y;
  const double radius = std::abs(curvature) < kFlat ? kRadiusOfFlat : 1 / std::abs(curvature);
  const Vector outwards(std::cos(around), std::sin(around), 0), axis = Vector::UnitZ();
  Eigen::Matrix3d axes;
  axes.col(2) = curvature < 0 ? Vector(-outwards) : outwards;
  axes.col(along_columns ? 1 : 0) = axis;
  axes.col(along_columns ? 0 : 1) = along_columns ? axis.cross(axes.col(2)) : axes.col(2).cross(axis);
  return poseOf(radius * outwards + along * axis, Eigen::Quaterniond(axes));
}

std::optional<MeshPlace> readMeshPlace(const settings::Settings& settings) {
  if (!settings.has("mesh")) return std::nullopt;
  const settings::Settings section = settings.section("mesh");
  MeshPlace place;
  const std::filesystem::path file = section.text("file");
  if (file.empty()) throw section.error("file", "must be the name of the mesh");
  place.file = (std::filesystem::absolute(settings.origin()).parent_path() / file).lexically_normal();
  place.unit = section.number("unit", {1e-6, 1000, "m"});
  place.matrix = poseOf(vectorIn(section, "middle", kPositionRange), orientationIn(section));
  return place;
}

std::optional<MeshPlace> readMeshPlaceFile(const std::string& path) {
  return readMeshPlace(settings::Settings::fromFile(path));
}

namespace {

const settings::Range kCurvatureRange{-kMaxCurvature, kMaxCurvature, "1/m (a bend radius of 10 mm or more)"};
const settings::Range kDeviationRange{0.0, kMaxCurvature, "1/m"};

Curvature cylinder(const settings::Settings& settings) {
  const double radius = settings.number("radius", {1.0 / kMaxCurvature, 1000.0, "m"});
  const bool along_y = settings.choice("axis", {"x", "y"}) == "y";
  const bool outside = settings.choice("side", {"outside", "inside"}, "outside") == "outside";
  const double bend = outside ? 1.0 / radius : -1.0 / radius;
  return along_y ? Curvature{bend, 0, 0} : Curvature{0, bend, 0};
}

Curvature twoPlanes(const settings::Settings& settings) {
  return {settings.number("x", kCurvatureRange), settings.number("y", kCurvatureRange),
          settings.number("xy", kCurvatureRange, 0.0)};
}

std::vector<double> oneForEachTaxel(const settings::Settings& settings, const std::string& key,
                                    MatrixSize size, const settings::Range& range = kCurvatureRange) {
  const std::vector<double> values = settings.numbers(key, range);
  if (values.size() != size.taxels()) {
    throw settings.error(key, "must have one value for each of the " + std::to_string(size.taxels()) +
                                  " taxels of a " + sizeText(size) + " matrix, row after row");
  }
  return values;
}

// Sets curvature and, where it is given, the deviation of each taxel.
void readTaxels(const settings::Settings& settings, MatrixSize size, Surface& surface) {
  surface.curvature.resize(size.taxels());
  const auto x = oneForEachTaxel(settings, "x", size);
  const auto y =
      settings.has("y") ? oneForEachTaxel(settings, "y", size) : std::vector<double>(x.size(), 0.0);
  const auto xy =
      settings.has("xy") ? oneForEachTaxel(settings, "xy", size) : std::vector<double>(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) surface.curvature[i] = {x[i], y[i], xy[i]};
  if (settings.has("deviation"))
    surface.deviation = oneForEachTaxel(settings, "deviation", size, kDeviationRange);
}

int countForms(const settings::Settings& settings) {
  return int{settings.has("flat")} + int{settings.has("cylinder")} + int{settings.has("two_planes")} +
         int{settings.has("taxels")};
}

void readForm(const settings::Settings& settings, MatrixSize size, Surface& surface) {
  if (countForms(settings) != 1) {
    throw settings::InputError(settings.origin() + ": the surface has " +
                               std::to_string(countForms(settings)) +
                               " forms, but exactly one of flat, cylinder, two_planes, taxels must be given");
  }
  if (settings.has("taxels")) return readTaxels(settings.section("taxels"), size, surface);
  if (settings.has("cylinder")) {
    surface.curvature = {cylinder(settings.section("cylinder"))};
  } else if (settings.has("two_planes")) {
    surface.curvature = {twoPlanes(settings.section("two_planes"))};
  } else if (settings.flag("flat", true)) {
    surface.curvature = {Curvature{}};
  } else {
    throw settings.error("flat", "must be true or left out");
  }
}

}  // namespace

Surface readSurface(const settings::Settings& settings, MatrixSize size) {
  Surface surface;
  surface.name = settings.text("surface");
  readForm(settings, size, surface);
  if (settings.has("deviation")) {
    if (!surface.deviation.empty())
      throw settings.error("deviation", "taxels.deviation is given, too; keep one of them");
    surface.deviation = {settings.number("deviation", kDeviationRange)};
  }
  return surface;
}

bool hasSurfaceForm(const settings::Settings& settings) {
  return countForms(settings) > 0;
}

std::vector<std::string> surfacesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& file : std::filesystem::directory_iterator(folder, failed)) {
    if (file.path().extension() == ".yaml") names.push_back(file.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Surface readSurfaceFile(const std::string& path, MatrixSize size) {
  const settings::Settings settings = settings::Settings::fromFile(path);
  const Surface surface = readSurface(settings, size);
  readMeshPlace(settings);
  settings.refuseUnknown();
  return surface;
}

}  // namespace fsr::matrix
