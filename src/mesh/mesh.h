#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fsr::mesh {

using Point = Eigen::Vector3d;
/// Vertices of a triangle, counter-clockwise for a viewer on the side of its normal.
using Triangle = std::array<std::uint32_t, 3>;

/// A surface of triangles. Triangles that share a corner share its vertex.
struct Mesh {
  std::vector<Point> vertices;  ///< [m]
  std::vector<Triangle> triangles;
  /// The triangles around vertex v are around[first[v]] to around[first[v + 1] - 1].
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> around;

  /// Length of the diagonal of the box around the vertices [m].
  double diameter() const;
};

/// Makes a mesh of triangles that are given by three corners each [m]. Corners closer than 1e-6 of the mesh's
/// diameter become one vertex, so that the triangles of an STL file, which has no common vertices, are
/// connected. Triangles without area are left out.
Mesh weld(const std::vector<Point>& corners);

/// A point of a mesh.
struct MeshPoint {
  Point point;               ///< [m]
  std::size_t triangle = 0;  ///< number of the triangle that it lies on
  double distance = 0;       ///< from the point that was asked for [m]
};

/// The point of the mesh that is closest to `point`. The mesh has a triangle.
MeshPoint closestPoint(const Mesh& mesh, const Point& point);

/// Normal of a triangle, whose length is twice its area [m^2].
Point areaNormal(const Mesh& mesh, const Triangle& triangle);

/// Collects the vertices around a point.
class PatchFinder {
 public:
  explicit PatchFinder(const Mesh& mesh) : mesh_(mesh), seen_(mesh.vertices.size(), 0) {}

  /// The vertices within `radius` [m] of `centre` that edges inside this ball connect with `seed`. The other
  /// wall of a thin socket therefore does not belong to them. Empty where `seed` is outside the ball.
  std::vector<std::uint32_t> patch(const Point& centre, double radius, std::uint32_t seed);
  /// The vertex closest to `centre`, found by descending along edges from `start`.
  std::uint32_t closestVertex(const Point& centre, std::uint32_t start) const;

 private:
  const Mesh& mesh_;
  std::vector<std::uint32_t> seen_;  // number of the last call that saw the vertex
  std::uint32_t call_ = 0;
};

}  // namespace fsr::mesh
