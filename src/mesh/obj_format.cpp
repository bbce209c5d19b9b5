#include <cmath>

#include "fsr_pressure_map/settings/input_error.h"
#include "mesh/mesh_formats.h"
#include "mesh/mesh_words.h"

namespace fsr::mesh {

namespace {

using Polygon = std::vector<std::size_t>;

// The vertex of "7", "7/1/3" or "-1", which is the last one so far; from 0.
std::size_t vertexOf(std::string_view word, std::size_t vertices) {
  std::string_view first = word.substr(0, word.find('/'));
  const double index = numberOf(std::string(first));
  const double vertex = index < 0 ? double(vertices) + index : index - 1;
  if (!(vertex >= 0 && vertex < 4e9) || std::floor(vertex) != vertex)
    throw settings::InputError("has a face with the vertex " + std::string(first) + ", but there are " +
                               std::to_string(vertices) + " before it, counted from 1");
  return std::size_t(vertex);
}

}  // namespace

std::vector<Point> objCorners(const std::string& bytes) {
  std::vector<Point> vertices, corners;
  std::vector<Polygon> polygons;
  for (std::string_view text = bytes; !text.empty();) {
    Words words(takeLine(text));
    const std::string_view kind = words.next();
    if (kind == "v") vertices.push_back(words.point());
    if (kind != "f") continue;
    Polygon polygon;
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
      polygon.push_back(vertexOf(word, vertices.size()));
    polygons.push_back(std::move(polygon));
  }
  for (const Polygon& polygon : polygons) addPolygon(vertices, polygon, corners);
  return corners;
}

}  // namespace fsr::mesh
