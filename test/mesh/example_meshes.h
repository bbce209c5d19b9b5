#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "mesh/mesh.h"

namespace test_support {

using fsr::mesh::Point;

/// A point of a surface with parameters u and v [m].
using Surface = std::function<Point(double u, double v)>;

constexpr double kRadius = 0.05;  // of most examples [m]

/// Cylinder of a radius [m] around the z axis; u goes around it, v along it. u = v = 0 is (radius, 0, 0).
inline Surface cylinder(double radius) {
  return [radius](double u, double v) {
    return Point(radius * std::cos(u / radius), radius * std::sin(u / radius), v);
  };
}

/// Cone around the z axis with its apex at the origin; `slant` is the distance [m] of (u, v) = (0, 0) from
/// the apex, u goes around and v away from the apex. u and v are lengths on the cone at that distance.
inline Surface cone(double half_angle, double slant) {
  return [half_angle, slant](double u, double v) {
    const double s = slant + v, around = u / (slant * std::sin(half_angle));
    return Point(s * std::sin(half_angle) * std::cos(around), s * std::sin(half_angle) * std::sin(around),
                 s * std::cos(half_angle));
  };
}

/// Sphere of a radius [m] around the origin; u and v are angles x radius about (radius, 0, 0).
inline Surface sphere(double radius) {
  return [radius](double u, double v) {
    const double a = u / radius, b = v / radius;
    return Point(radius * std::cos(a) * std::cos(b), radius * std::sin(a) * std::cos(b),
                 radius * std::sin(b));
  };
}

/// x = -(a u^2 + b v^2) / 2 over y = u and z = v: its normal at the origin is +x, its curvatures a and b.
inline Surface saddle(double a, double b) {
  return [a, b](double u, double v) { return Point(-0.5 * (a * u * u + b * v * v), u, v); };
}

struct MeshOptions {
  double half_u = 0.065;  ///< the mesh reaches from -half_u to half_u [m]
  double half_v = 0.050;
  double edge = 0.001;   ///< [m]
  double jitter = 0.25;  ///< of the vertices within the surface, in edges: real meshes are irregular
  double noise = 0;      ///< standard deviation of the vertices from the surface [m]
  double hole = 0;       ///< half side of a square hole at `hole_u`, 0 [m]
  double hole_u = 0;
};

/// Corners of the triangles, three each [m]. Their normals point to +u x +v.
inline std::vector<Point> triangles(const Surface& surface, const MeshOptions& options = {}) {
  const int columns = int(std::round(2 * options.half_u / options.edge)) + 1;
  const int rows = int(std::round(2 * options.half_v / options.edge)) + 1;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> shift(-options.jitter, options.jitter);
  std::vector<Point> grid;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double u = -options.half_u + options.edge * (column + shift(random));
      const double v = -options.half_v + options.edge * (row + shift(random));
      const double step = 1e-6;
      const Point across = (surface(u + step, v) - surface(u - step, v))
                               .cross(surface(u, v + step) - surface(u, v - step))
                               .normalized();
      grid.push_back(surface(u, v) + options.noise * normal(random) * across);
    }
  }
  std::vector<Point> corners;
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const double u = -options.half_u + options.edge * (column + 0.5) - options.hole_u;
      const double v = -options.half_v + options.edge * (row + 0.5);
      if (std::abs(u) < options.hole && std::abs(v) < options.hole) continue;
      const std::size_t a = std::size_t(row) * std::size_t(columns) + std::size_t(column);
      const std::size_t b = a + 1, c = a + std::size_t(columns), d = c + 1;
      for (const std::size_t corner : {a, b, d, a, d, c}) corners.push_back(grid[corner]);
    }
  }
  return corners;
}

inline void writeAsciiStl(const std::string& path, const std::vector<Point>& corners, double unit) {
  std::ofstream out(path);
  out.precision(9);
  out << "solid part\n";
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (std::size_t k = i; k < i + 3; ++k) out << "vertex " << corners[k].transpose() / unit << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid part\n";
}

inline void writeFloats(std::ofstream& out, const Point& point) {
  const Eigen::Vector3f single = point.cast<float>();
  out.write(reinterpret_cast<const char*>(single.data()), 12);
}

inline void writeBinaryStl(const std::string& path, const std::vector<Point>& corners, double unit) {
  std::ofstream out(path, std::ios::binary);
  out << std::string(80, ' ');
  const auto count = std::uint32_t(corners.size() / 3);
  out.write(reinterpret_cast<const char*>(&count), 4);
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    writeFloats(out, Point::Zero());
    for (std::size_t k = i; k < i + 3; ++k) writeFloats(out, corners[k] / unit);
    out.write("\0\0", 2);
  }
}

inline void writePly(const std::string& path, const std::vector<Point>& corners, double unit, bool binary) {
  const fsr::mesh::Mesh mesh = fsr::mesh::weld(corners);
  std::ofstream out(path, std::ios::binary);
  out.precision(9);
  out << "ply\nformat " << (binary ? "binary_little_endian" : "ascii") << " 1.0\nelement vertex "
      << mesh.vertices.size() << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
      << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Point& vertex : mesh.vertices) {
    if (binary) {
      writeFloats(out, vertex / unit);
    } else {
      out << vertex.transpose() / unit << '\n';
    }
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    if (binary) {
      out.put(3);
      for (const std::uint32_t vertex : {a, b, c}) out.write(reinterpret_cast<const char*>(&vertex), 4);
    } else {
      out << "3 " << a << ' ' << b << ' ' << c << '\n';
    }
  }
}

inline void writeObj(const std::string& path, const std::vector<Point>& corners, double unit) {
  const fsr::mesh::Mesh mesh = fsr::mesh::weld(corners);
  std::ofstream out(path);
  out.precision(9);
  for (const Point& vertex : mesh.vertices) out << "v " << vertex.transpose() / unit << '\n';
  for (const auto& [a, b, c] : mesh.triangles) out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
}

}  // namespace test_support
