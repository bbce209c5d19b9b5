#include "mesh/mesh_file.h"

#include <locale.h>
#include <stdlib.h>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/foreign_error.h"
#include "settings/regular_file.h"

namespace fsr::mesh {

namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";
constexpr std::size_t kShown = 40;  // of a wrong word [bytes]

// The word in quotes, without bytes that a terminal cannot show.
std::string quoted(std::string_view word) {
  std::string text(word.substr(0, kShown));
  std::replace_if(
      text.begin(), text.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?');
  return '"' + text + '"';
}

}  // namespace

std::string_view Words::next() {
  text_.remove_prefix(std::min(text_.find_first_not_of(kBlanks), text_.size()));
  const std::string_view word = text_.substr(0, text_.find_first_of(kBlanks));
  text_.remove_prefix(word.size());
  return word;
}

double Words::number() {
  return numberOf(next());
}

std::string_view takeLine(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

double numberOf(std::string_view word) {
  if (word.empty()) throw settings::InputError("ends where a number must be; it may have been cut off");
  static const locale_t kPoint = newlocale(LC_ALL_MASK, "C", nullptr);  // a decimal comma is no number
  char* end = nullptr;
  const double value = strtod_l(word.data(), &end, kPoint);
  if (end != word.data() + word.size())
    throw settings::InputError("has " + quoted(word) + " where a number must be");
  return value;
}

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

namespace {

// Binary: 80 bytes, the number of triangles, and for each a normal, three corners and two bytes,
// little-endian.
constexpr std::size_t kHead = 84, kFacet = 50, kNormal = 12;

std::vector<Point> textCorners(const std::string& bytes) {
  std::vector<Point> corners;
  Words words(bytes);
  std::string_view last;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    last = word;
    if (word == "vertex") corners.push_back(words.point());
    if (word == "endfacet" && corners.size() % 3 != 0)
      throw settings::InputError("has a facet that is no triangle");
    if (word == "solid" || word == "endsolid") takeLine(words.rest());  // the name may be any words
  }
  if (last != "endsolid") throw settings::InputError("does not end with \"endsolid\", so it was cut off");
  return corners;
}

std::vector<Point> binaryCorners(const std::string& bytes, std::size_t triangles) {
  std::vector<Point> corners;
  corners.reserve(3 * triangles);
  for (std::size_t i = 0; i < triangles; ++i) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      float values[3];
      std::memcpy(values, bytes.data() + kHead + i * kFacet + kNormal + corner * sizeof values,
                  sizeof values);
      corners.emplace_back(values[0], values[1], values[2]);
    }
  }
  return corners;
}

}  // namespace

std::vector<Point> stlCorners(const std::string& bytes) {
  std::uint32_t triangles = 0;
  if (bytes.size() >= kHead)
    std::memcpy(&triangles, bytes.data() + kHead - sizeof triangles, sizeof triangles);
  const std::uint64_t size = kHead + std::uint64_t{triangles} * kFacet;
  // Some programs begin binary files with "solid", too, so the size decides first.
  if (bytes.size() == size) return binaryCorners(bytes, triangles);
  if (Words(bytes).next() == "solid") return textCorners(bytes);
  throw settings::InputError("is no STL file: as text it does not begin with \"solid\", and as binary its " +
                             std::to_string(triangles) + " triangles make " + std::to_string(size) +
                             " bytes, but it has " + std::to_string(bytes.size()));
}

namespace {

constexpr std::uint64_t kLargestFile = 1000000000;  // [bytes]
constexpr double kFarthest = 1e6;                   // from the origin [m]

using Reader = std::vector<Point> (*)(const std::string& bytes);

Reader readerOf(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  if (ending == ".stl") return stlCorners;
  if (ending == ".ply") return plyCorners;
  if (ending == ".obj") return objCorners;
  throw settings::InputError(path + ": ends with \"" + ending +
                             "\", but a mesh must be a .stl, .ply or .obj file");
}

void scale(std::vector<Point>& corners, double unit) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] *= unit;
    if (!corners[i].allFinite()) {
      throw settings::InputError("triangle " + std::to_string(i / 3) +
                                 " has a coordinate that is not a finite number");
    }
    if (corners[i].cwiseAbs().maxCoeff() > kFarthest) {
      throw settings::InputError("triangle " + std::to_string(i / 3) +
                                 " has a coordinate beyond 1000 km; check --units (mm, cm, m or inch)");
    }
  }
}

}  // namespace

void addPolygon(const std::vector<Point>& vertices, const std::vector<std::size_t>& polygon,
                std::vector<Point>& corners) {
  for (const std::size_t vertex : polygon) {
    if (vertex >= vertices.size()) {
      throw settings::InputError("has a face with the vertex " + std::to_string(vertex) +
                                 ", counted from 0, but only " + std::to_string(vertices.size()) +
                                 " vertices");
    }
  }
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    for (const std::size_t vertex : {polygon[0], polygon[i - 1], polygon[i]})
      corners.push_back(vertices[vertex]);
  }
}

Mesh readMesh(const std::string& path, double unit) {
  settings::RegularFile file(path, kLargestFile);
  const Reader read = readerOf(path);
  try {
    std::vector<Point> corners = read(file.rest());
    scale(corners, unit);
    Mesh mesh = weld(corners);
    if (mesh.triangles.empty()) throw settings::InputError("holds no triangles");
    return mesh;
  } catch (const std::exception& error) {
    throw settings::sentenceAbout(path, error);
  }
}

}  // namespace fsr::mesh
