#include <cstring>

#include "fsr_pressure_map/settings/input_error.h"
#include "mesh/mesh_formats.h"
#include "mesh/mesh_words.h"

namespace fsr::mesh {

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

}  // namespace fsr::mesh
