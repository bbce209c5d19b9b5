#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "fsr_pressure_map/settings/input_error.h"
#include "mesh/mesh_file.h"

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

}  // namespace fsr::mesh
