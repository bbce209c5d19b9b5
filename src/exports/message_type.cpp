#include "exports/message_type.h"

#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr::exports {

namespace {

constexpr int kDeepest = 16;  // levels of messages in messages; a type with more contains itself

const std::map<std::string, Scalar>& scalars() {
  static const std::map<std::string, Scalar> kScalars = {
      {"bool", Scalar::kBool},        {"int8", Scalar::kInt8},     {"byte", Scalar::kInt8},
      {"uint8", Scalar::kUint8},      {"char", Scalar::kUint8},    {"int16", Scalar::kInt16},
      {"uint16", Scalar::kUint16},    {"int32", Scalar::kInt32},   {"uint32", Scalar::kUint32},
      {"int64", Scalar::kInt64},      {"uint64", Scalar::kUint64}, {"float32", Scalar::kFloat32},
      {"float64", Scalar::kFloat64},  {"string", Scalar::kString}, {"time", Scalar::kTime},
      {"duration", Scalar::kDuration}};
  return kScalars;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// The texts of a definition by type, including that of the message itself.
std::map<std::string, std::string> textsOf(const std::string& name, const std::string& definition) {
  std::map<std::string, std::string> texts;
  std::istringstream lines(definition);
  std::string line, current = name;
  texts[current];
  while (std::getline(lines, line)) {
    if (line.rfind("=====", 0) == 0) continue;
    if (line.rfind("MSG: ", 0) == 0) {
      current = trimmed(line.substr(5));
      texts[current];
      continue;
    }
    texts[current] += line + '\n';
  }
  return texts;
}

class Parser {
 public:
  Parser(const std::string& name, const std::string& definition) : texts_(textsOf(name, definition)) {}

  MessageType run(const std::string& name) {
    MessageType type{name, fieldsOf(name, "", false, 0), 0};
    type.count = count_;
    return type;
  }

 private:
  std::vector<MessageField> fieldsOf(const std::string& name, const std::string& prefix, bool repeated,
                                     int depth) {
    if (depth > kDeepest) throw settings::InputError("the message type " + name + " contains itself");
    std::vector<MessageField> fields;
    std::istringstream lines(texts_.at(name));
    for (std::string line; std::getline(lines, line);) {
      if (auto field = parse(line, name, prefix, repeated, depth)) fields.push_back(std::move(*field));
    }
    return fields;
  }

  // None for a constant, a comment or an empty line.
  std::optional<MessageField> parse(const std::string& line, const std::string& owner,
                                    const std::string& prefix, bool repeated, int depth) {
    const std::size_t hash = line.find('#');
    std::istringstream words(line.substr(0, hash));
    std::string type, name;
    if (line.substr(0, hash).find('=') != std::string::npos || !(words >> type)) return {};
    if (!(words >> name))
      throw settings::InputError("the definition of " + owner + " has an invalid line: \"" + line + "\"");
    MessageField field;
    field.name = prefix + name;
    if (hash != std::string::npos) field.comment = trimmed(line.substr(hash + 1));
    field.repeated = repeated;
    field.id = count_++;
    takeArray(type, field);
    const auto scalar = scalars().find(type);
    field.nested = scalar == scalars().end();
    if (!field.nested) {
      field.scalar = scalar->second;
    } else {
      const bool many = repeated || field.count != MessageField::Count::kOne;
      field.fields = fieldsOf(fullName(type, owner), field.name + '.', many, depth + 1);
    }
    return field;
  }

  static void takeArray(std::string& type, MessageField& field) {
    const std::size_t bracket = type.find('[');
    if (bracket == std::string::npos) return;
    const std::string size = type.substr(bracket + 1, type.find(']') - bracket - 1);
    field.count = size.empty() ? MessageField::Count::kAny : MessageField::Count::kFixed;
    field.fixed = size.empty() ? 0 : std::strtoull(size.c_str(), nullptr, 10);
    type.resize(bracket);
  }

  std::string fullName(const std::string& type, const std::string& owner) const {
    const std::string package = owner.substr(0, owner.find('/'));
    for (const std::string& name : {type, package + '/' + type, "std_msgs/" + type}) {
      if (texts_.count(name) > 0) return name;
    }
    throw settings::InputError("the definition of " + owner + " lacks the type " + type);
  }

  std::map<std::string, std::string> texts_;
  std::size_t count_ = 0;
};

struct Nothing {
  void count(const MessageField&, std::uint32_t) {}
  void values(const MessageField&, const char*, std::size_t) {}
  void text(const MessageField&, std::string_view) {}
};

}  // namespace

std::size_t sizeOf(Scalar scalar) {
  switch (scalar) {
    case Scalar::kBool:
    case Scalar::kInt8:
    case Scalar::kUint8:
      return 1;
    case Scalar::kInt16:
    case Scalar::kUint16:
      return 2;
    case Scalar::kInt32:
    case Scalar::kUint32:
    case Scalar::kFloat32:
      return 4;
    case Scalar::kString:
      return 0;
    default:
      return 8;
  }
}

MessageType parseMessageType(const std::string& name, const std::string& definition) {
  return Parser(name, definition).run(name);
}

bool isMessageOf(const MessageType& type, std::string_view bytes) {
  Nothing visitor;
  return visitMessage(type, bytes, visitor);
}

}  // namespace fsr::exports
