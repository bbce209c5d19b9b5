#include "mesh/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace fsr::mesh {

namespace {

constexpr double kSamePoint = 1e-6;  // distance of equal corners, as a share of the mesh's diameter

struct Box {
  Point low = Point::Zero(), high = Point::Zero();

  double diagonal() const { return (high - low).norm(); }
};

Box boxAround(const std::vector<Point>& points) {
  if (points.empty()) return {};
  Box box{points.front(), points.front()};
  for (const Point& point : points) {
    box.low = box.low.cwiseMin(point);
    box.high = box.high.cwiseMax(point);
  }
  return box;
}

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t side : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(side)) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

// Gives equal points the same number. The points lie in a grid of cells that are as long as the largest
// distance of equal points, so an equal point is in the same cell or in a neighbour of it.
class Welder {
 public:
  Welder(double distance, const Point& low) : distance_(distance), low_(low) {}

  std::uint32_t number(const Point& point) {
    const Cell centre = cellOf(point);
    for (int i = 0; i < 27; ++i) {
      const Cell cell{centre[0] + i % 3 - 1, centre[1] + i / 3 % 3 - 1, centre[2] + i / 9 - 1};
      const auto found = cells_.find(cell);
      if (found != cells_.end() && (points_[found->second] - point).norm() <= distance_) return found->second;
    }
    const auto number = static_cast<std::uint32_t>(points_.size());
    points_.push_back(point);
    cells_.emplace(centre, number);
    return number;
  }

  std::vector<Point> take() { return std::move(points_); }

 private:
  Cell cellOf(const Point& point) const {
    const Eigen::Vector3d cell = ((point - low_) / distance_).array().floor();
    return {static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
            static_cast<std::int64_t>(cell.z())};
  }

  double distance_;
  Point low_;  // corner of the box around the points: a cell's number is at most 1 / kSamePoint
  std::vector<Point> points_;
  std::unordered_map<Cell, std::uint32_t, CellHash> cells_;
};

void listTrianglesAround(Mesh& mesh) {
  mesh.first.assign(mesh.vertices.size() + 1, 0);
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) ++mesh.first[vertex + 1];
  }
  for (std::size_t i = 1; i < mesh.first.size(); ++i) mesh.first[i] += mesh.first[i - 1];
  std::vector<std::uint32_t> next(mesh.first.begin(), mesh.first.end() - 1);
  mesh.around.resize(mesh.triangles.size() * 3);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i])
      mesh.around[next[vertex]++] = static_cast<std::uint32_t>(i);
  }
}

// C. Ericson, Real-Time Collision Detection (2005), section 5.1.5.
Point closestOfTriangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double whole = va + vb + vc;
  return a + vb / whole * ab + vc / whole * ac;
}

}  // namespace

double Mesh::diameter() const {
  return boxAround(vertices).diagonal();
}

Mesh weld(const std::vector<Point>& corners) {
  Mesh mesh;
  const Box box = boxAround(corners);
  const double same = kSamePoint * box.diagonal();
  if (!(same > 0)) return mesh;
  Welder welder(same, box.low);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const Triangle triangle{welder.number(corners[i]), welder.number(corners[i + 1]),
                            welder.number(corners[i + 2])};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    mesh.triangles.push_back(triangle);
  }
  mesh.vertices = welder.take();
  listTrianglesAround(mesh);
  return mesh;
}

MeshPoint closestPoint(const Mesh& mesh, const Point& point) {
  MeshPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Point candidate = closestOfTriangle(point, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    const double distance = (candidate - point).norm();
    if (distance < best.distance) best = {candidate, i, distance};
  }
  return best;
}

Point areaNormal(const Mesh& mesh, const Triangle& triangle) {
  const Point& a = mesh.vertices[triangle[0]];
  return (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
}

std::vector<std::uint32_t> PatchFinder::patch(const Point& centre, double radius, std::uint32_t seed) {
  ++call_;
  std::vector<std::uint32_t> found;
  const auto visit = [&](std::uint32_t vertex) {
    if (seen_[vertex] == call_) return;
    seen_[vertex] = call_;
    if ((mesh_.vertices[vertex] - centre).norm() <= radius) found.push_back(vertex);
  };
  visit(seed);
  for (std::size_t next = 0; next < found.size(); ++next) {
    const std::uint32_t vertex = found[next];
    for (std::uint32_t i = mesh_.first[vertex]; i < mesh_.first[vertex + 1]; ++i) {
      for (const std::uint32_t neighbour : mesh_.triangles[mesh_.around[i]]) visit(neighbour);
    }
  }
  return found;
}

std::uint32_t PatchFinder::closestVertex(const Point& centre, std::uint32_t start) const {
  for (;;) {
    std::uint32_t best = start;
    double distance = (mesh_.vertices[start] - centre).norm();
    for (std::uint32_t i = mesh_.first[start]; i < mesh_.first[start + 1]; ++i) {
      for (const std::uint32_t neighbour : mesh_.triangles[mesh_.around[i]]) {
        const double candidate = (mesh_.vertices[neighbour] - centre).norm();
        if (candidate < distance) {
          best = neighbour;
          distance = candidate;
        }
      }
    }
    if (best == start) return best;
    start = best;
  }
}

}  // namespace fsr::mesh
