#include "ros/messages/message_reader.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "fsr_pressure_map/settings/input_error.h"

namespace fsr_ros {

namespace {

constexpr int kDeepest = 16;  // levels of messages in messages; a type with more contains itself

// Sizes of the types that are not themselves messages [bytes]; 0 = a text.
const std::map<std::string, std::size_t>& scalarSizes() {
  static const std::map<std::string, std::size_t> kSizes = {
      {"bool", 1},    {"int8", 1},   {"byte", 1},   {"uint8", 1},   {"char", 1},   {"int16", 2},
      {"uint16", 2},  {"int32", 4},  {"uint32", 4}, {"int64", 8},   {"uint64", 8}, {"float32", 4},
      {"float64", 8}, {"string", 0}, {"time", 8},   {"duration", 8}};
  return kSizes;
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

  std::vector<MessageField> fieldsOf(const std::string& name, int depth) {
    if (depth > kDeepest) throw fsr::settings::InputError("the message type " + name + " contains itself");
    std::vector<MessageField> fields;
    std::istringstream lines(texts_.at(name));
    for (std::string line; std::getline(lines, line);) {
      if (auto field = parse(line, name, depth)) fields.push_back(std::move(*field));
    }
    return fields;
  }

 private:
  // None for a constant, a comment or an empty line.
  std::optional<MessageField> parse(const std::string& line, const std::string& owner, int depth) {
    const std::string code = line.substr(0, line.find('#'));
    std::istringstream words(code);
    std::string type, name;
    if (code.find('=') != std::string::npos || !(words >> type)) return {};
    if (!(words >> name))
      throw fsr::settings::InputError("the definition of " + owner + " has an invalid line: \"" + line + "\"");
    MessageField field;
    takeArray(type, field);
    const auto scalar = scalarSizes().find(type);
    field.nested = scalar == scalarSizes().end();
    if (field.nested) {
      field.fields = fieldsOf(fullName(type, owner), depth + 1);
    } else {
      field.size = scalar->second;
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
    throw fsr::settings::InputError("the definition of " + owner + " lacks the type " + type);
  }

  std::map<std::string, std::string> texts_;
};

bool takeLength(std::string_view& bytes, std::uint32_t& length) {
  if (bytes.size() < sizeof(length)) return false;
  std::memcpy(&length, bytes.data(), sizeof(length));
  bytes.remove_prefix(sizeof(length));
  return true;
}

bool takeScalars(std::size_t size, std::size_t count, std::string_view& bytes) {
  if (size > 0) {
    if (count > bytes.size() / size) return false;
    bytes.remove_prefix(count * size);
    return true;
  }
  for (; count > 0; --count) {
    std::uint32_t length = 0;
    if (!takeLength(bytes, length) || length > bytes.size()) return false;
    bytes.remove_prefix(length);
  }
  return true;
}

bool takeFields(const std::vector<MessageField>& fields, std::string_view& bytes) {
  for (const MessageField& field : fields) {
    std::size_t count = field.fixed;
    if (field.count == MessageField::Count::kAny) {
      std::uint32_t length = 0;
      if (!takeLength(bytes, length)) return false;
      count = length;
    }
    if (!field.nested) {
      if (!takeScalars(field.size, count, bytes)) return false;
      continue;
    }
    if (field.fields.empty()) continue;  // an empty message has no bytes
    for (; count > 0; --count) {
      if (!takeFields(field.fields, bytes)) return false;
    }
  }
  return true;
}

}  // namespace

MessageType parseMessageType(const std::string& name, const std::string& definition) {
  return {Parser(name, definition).fieldsOf(name, 0)};
}

bool isMessageOf(const MessageType& type, std::string_view bytes) {
  return takeFields(type.fields, bytes) && bytes.empty();
}

bool hadDefinition(const std::string& type, const std::string& md5sum) {
  static const std::set<std::pair<std::string, std::string>> definitions = {
      // Without FLAG_HISTORY_SHORT.
      {"fsr_pressure_map/PressureMap", "50c65025fc4b01118cf4b0ef3469834e"},
  };
  return definitions.count({type, md5sum}) > 0;
}

std::size_t fieldsAdded(const std::string& type, const std::string& md5sum) {
  // Without parent and corrected.
  const bool info =
      type == "fsr_pressure_map/CalibrationInfo" && md5sum == "883c2521a8e1943b05728716309ddb06";
  return info ? 2 : 0;
}

}  // namespace fsr_ros
