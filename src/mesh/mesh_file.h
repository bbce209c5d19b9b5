#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mesh/mesh.h"

namespace fsr::mesh {

/// The words of a text, divided by blanks and ends of lines. The text is part of a std::string, so that a
/// null or a blank follows each word.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  /// Empty at the end.
  std::string_view next();
  /// Throws InputError where the next word is no number. It may be nan or inf.
  double number();
  Point point() {
    const double x = number(), y = number();
    return {x, y, number()};
  }
  /// What follows the last word.
  std::string_view& rest() { return text_; }

 private:
  std::string_view text_;
};

/// The first line of a text, without its end; `text` is then what follows.
std::string_view takeLine(std::string_view& text);

/// Throws InputError unless the whole word is a number.
double numberOf(std::string_view word);

// Readers of one format each: the corners of the triangles, three each, in the unit of the file. Polygons are
// cut into triangles that share their first corner. They throw InputError, without the name of the file.
// Coordinates may be nan or inf. Time and memory are proportional to the length of the file, whatever numbers
// it states.

std::vector<Point> stlCorners(const std::string& bytes);  ///< text, or binary
std::vector<Point> objCorners(const std::string& bytes);  ///< v and f; everything else is ignored
std::vector<Point> plyCorners(const std::string& bytes);  ///< text, or binary of either byte order

/// Adds a polygon of vertices to the corners. Throws InputError for an index beyond the vertices.
void addPolygon(const std::vector<Point>& vertices, const std::vector<std::size_t>& polygon,
                std::vector<Point>& corners);

/// Reads the triangles of an STL, PLY or OBJ file, text or binary. Polygons are cut into triangles that share
/// a corner.
/// `unit`: length of the file's unit [m]. Throws InputError where the file cannot be read, is of another
/// kind, or holds no triangle or a coordinate that is not a finite number.
Mesh readMesh(const std::string& path, double unit);

}  // namespace fsr::mesh
