#include "mesh/mesh_file.h"

#include <locale.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>

#include "fsr_pressure_map/settings/input_error.h"
#include "settings/foreign_error.h"
#include "settings/regular_file.h"

namespace fsr::mesh {

namespace {

using settings::InputError;

struct Type {
  std::size_t size;  // [bytes]
  enum { kSigned, kUnsigned, kReal } kind;
};

struct Property {
  std::string name;
  Type type;
  std::optional<Type> count;  // of a list
};

struct Element {
  std::string name;
  double count;
  std::vector<Property> properties;
};

enum class Format { kText, kLittle, kBig };

struct Header {
  Format format = Format::kText;
  std::vector<Element> elements;
};

Type typeOf(std::string_view name) {
  struct Entry {
    std::string_view name, other;
    Type type;
  };
  constexpr std::array<Entry, 8> kTypes = {{{"char", "int8", {1, Type::kSigned}},
                                            {"uchar", "uint8", {1, Type::kUnsigned}},
                                            {"short", "int16", {2, Type::kSigned}},
                                            {"ushort", "uint16", {2, Type::kUnsigned}},
                                            {"int", "int32", {4, Type::kSigned}},
                                            {"uint", "uint32", {4, Type::kUnsigned}},
                                            {"float", "float32", {4, Type::kReal}},
                                            {"double", "float64", {8, Type::kReal}}}};
  for (const Entry& entry : kTypes) {
    if (name == entry.name || name == entry.other) return entry.type;
  }
  throw InputError("has a property of an unknown type in its header");
}

Format formatOf(std::string_view name) {
  if (name == "ascii") return Format::kText;
  if (name == "binary_little_endian") return Format::kLittle;
  if (name == "binary_big_endian") return Format::kBig;
  throw InputError("has an unknown format, but must be ascii, binary_little_endian or binary_big_endian");
}

Property propertyIn(Words& words) {
  Property property;
  std::string_view type = words.next();
  if (type == "list") {
    property.count = typeOf(words.next());
    type = words.next();
  }
  property.type = typeOf(type);
  property.name = words.next();
  return property;
}

// Takes the header from the text.
Header headerIn(std::string_view& text) {
  if (Words(takeLine(text)).next() != "ply") throw InputError("does not begin with \"ply\"");
  Header header;
  while (!text.empty()) {
    Words words(takeLine(text));
    const std::string_view key = words.next();
    if (key == "end_header") return header;
    if (key == "format") {
      header.format = formatOf(words.next());
    } else if (key == "element") {
      const std::string name(words.next());
      header.elements.push_back({name, words.number(), {}});
    } else if (key == "property") {
      if (header.elements.empty()) throw InputError("has a property before the first element in its header");
      header.elements.back().properties.push_back(propertyIn(words));
    }
  }
  throw InputError("has a header without \"end_header\", so it was cut off");
}

template <typename Number>
double numberIn(const char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return double(number);
}

double valueIn(const char* bytes, Type type) {
  const bool is_signed = type.kind == Type::kSigned;
  switch (type.size) {
    case 1:
      return is_signed ? numberIn<std::int8_t>(bytes) : numberIn<std::uint8_t>(bytes);
    case 2:
      return is_signed ? numberIn<std::int16_t>(bytes) : numberIn<std::uint16_t>(bytes);
    case 8:
      return numberIn<double>(bytes);
    default:
      if (type.kind == Type::kReal) return numberIn<float>(bytes);
      return is_signed ? numberIn<std::int32_t>(bytes) : numberIn<std::uint32_t>(bytes);
  }
}

// The values behind the header. Each takes at least a byte of the file.
class Values {
 public:
  Values(std::string_view bytes, Format format) : format_(format), words_(bytes) {}

  double next(Type type) {
    if (format_ == Format::kText) return words_.number();
    std::string_view& bytes = words_.rest();
    if (bytes.size() < type.size) throw InputError("ends before its last element, so it was cut off");
    std::array<char, 8> value{};
    std::copy_n(bytes.data(), type.size, value.data());
    bytes.remove_prefix(type.size);
    if (format_ == Format::kBig) std::reverse(value.data(), value.data() + type.size);
    return valueIn(value.data(), type);
  }

  // A whole number from 0, e.g. the length of a list.
  std::size_t whole(Type type) {
    const double value = next(type);
    if (!(value >= 0 && value < 5e9) || std::floor(value) != value)
      throw InputError("has a length or vertex number that is no whole number from 0");
    return std::size_t(value);
  }

 private:
  Format format_;
  Words words_;
};

Point vertexIn(const Element& element, Values& values) {
  Point point = Point::Zero();
  for (const Property& property : element.properties) {
    const std::size_t count = property.count ? values.whole(*property.count) : 1;
    for (std::size_t i = 0; i < count; ++i) {
      const double value = values.next(property.type);
      for (int axis = 0; axis < 3; ++axis) {
        if (property.name == std::string(1, "xyz"[axis])) point[axis] = value;
      }
    }
  }
  return point;
}

std::vector<std::size_t> faceIn(const Element& element, Values& values) {
  std::vector<std::size_t> face;
  for (const Property& property : element.properties) {
    const bool vertices = property.name == "vertex_indices" || property.name == "vertex_index";
    const std::size_t count = property.count ? values.whole(*property.count) : 1;
    for (std::size_t i = 0; i < count; ++i) {
      if (vertices) {
        face.push_back(values.whole(property.type));
      } else {
        values.next(property.type);
      }
    }
  }
  return face;
}

}  // namespace

std::vector<Point> plyCorners(const std::string& bytes) {
  std::string_view text = bytes;
  const Header header = headerIn(text);
  Values values(text, header.format);
  std::vector<Point> vertices, corners;
  std::vector<std::vector<std::size_t>> faces;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;  // its elements take no bytes
    for (double i = 0; i < element.count; ++i) {
      if (element.name == "face") {
        faces.push_back(faceIn(element, values));
      } else {
        const Point point = vertexIn(element, values);
        if (element.name == "vertex") vertices.push_back(point);
      }
    }
  }
  for (const auto& face : faces) addPolygon(vertices, face, corners);
  return corners;
}

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
