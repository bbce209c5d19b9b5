#include "matrix/mesh_place.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
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

}  // namespace fsr::matrix
