#include "report/result_json.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "settings/number_text.h"
#include "settings/text.h"

namespace fsr::report {

namespace {

// Whether YAML reads a text without quotes as this text; also a stamp with nanoseconds, which is a number.
bool isPlain(const std::string& value) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '.' || c == ' ' || c == '-' || c == '/';
  };
  static const std::vector<std::string> kReserved = {"null", "true", "false", "yes", "no",
                                                     "on",   "off",  "y",     "n"};
  constexpr std::size_t kNanoseconds = 9;
  const std::size_t point = value.find('.');
  if (point != std::string::npos && point + 1 + kNanoseconds == value.size() &&
      value.find_first_not_of("0123456789.") == std::string::npos)
    return true;
  std::string lower = value;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  const bool starts_well = !value.empty() && std::isalpha(static_cast<unsigned char>(value[0]));
  return starts_well && value.back() != ' ' && std::all_of(value.begin(), value.end(), plain) &&
         std::find(kReserved.begin(), kReserved.end(), lower) == kReserved.end();
}

// An interval without ends.
bool isNowhere(const Json& list) {
  return list.size() == 2 && std::all_of(list.begin(), list.end(), [](const Json& one) {
           return one.is_number_float() && !std::isfinite(one.get<double>());
         });
}

std::string flowText(const Json& value, int digits) {
  if (value.is_number_float()) return yamlNumber(value.get<double>(), digits);
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    return isPlain(text) ? text : settings::quotedText(text);
  }
  if (!value.is_structured()) return value.dump();
  if (digits != kAllDigits && isNowhere(value)) return "null";
  std::string all;
  for (const auto& [key, one] : value.items()) {
    all += (all.empty() ? "" : ", ") + (value.is_object() ? key + ": " : "") + flowText(one, digits);
  }
  return value.is_object() ? "{" + all + "}" : "[" + all + "]";
}

}  // namespace

std::string yamlNumber(double value, int digits) {
  if (digits == kAllDigits) return settings::numberText(value);
  if (!std::isfinite(value)) return "null";
  const std::string shortest = settings::roundedText(value, digits);
  const std::size_t exponent = shortest.find('e');
  if (exponent == std::string::npos) return shortest;
  if (std::abs(value) < 1) {  // YAML 1.1 reads 1e-06 as a text: a number with an exponent needs a point
    return shortest.find('.') != std::string::npos
               ? shortest
               : shortest.substr(0, exponent) + ".0" + shortest.substr(exponent);
  }
  return settings::fixedText(std::stod(shortest), 0);
}

std::string yamlText(const Json& members, int digits) {
  std::string text;
  for (const auto& [key, value] : members.items()) {
    text += key + ":";
    if (value.is_array() && !value.empty() && value.front().is_object()) {
      for (const Json& one : value) text += "\n  - " + flowText(one, digits);
      text += "\n";
    } else {
      text += " " + flowText(value, digits) + "\n";
    }
  }
  return text;
}

Json pick(const Json& from, const std::vector<std::string>& keys) {
  Json picked = from.is_array() ? Json::array() : Json::object();
  if (from.is_array()) {
    for (const Json& one : from) picked.push_back(pick(one, keys));
    return picked;
  }
  for (const std::string& key : keys) {
    const std::size_t equal = key.find('=');
    picked[key.substr(equal == std::string::npos ? 0 : equal + 1)] = from.at(key.substr(0, equal));
  }
  return picked;
}

Json orElse(const Json& value, const Json& otherwise) {
  return value.empty() || value == "" ? otherwise : value;
}

}  // namespace fsr::report
