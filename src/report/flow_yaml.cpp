#include "report/flow_yaml.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "settings/number_text.h"
#include "settings/yaml_text.h"

namespace fsr::report::flow_yaml {

namespace {

constexpr int kDigits = 5;

bool isPlain(const std::string& value) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '.' || c == ' ' || c == '-' || c == '/';
  };
  static const std::vector<std::string> kReserved = {"null", "true", "false", "yes", "no",
                                                     "on",   "off",  "y",     "n"};
  std::string lower = value;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  const bool starts_well = !value.empty() && std::isalpha(static_cast<unsigned char>(value[0]));
  return starts_well && value.back() != ' ' && std::all_of(value.begin(), value.end(), plain) &&
         std::find(kReserved.begin(), kReserved.end(), lower) == kReserved.end();
}

}  // namespace

std::string number(double value) {
  if (!std::isfinite(value)) return "null";
  const std::string shortest = settings::roundedText(value, kDigits);
  const std::size_t exponent = shortest.find('e');
  if (exponent == std::string::npos) return shortest;
  if (std::abs(value) < 1) {  // YAML 1.1 reads 1e-06 as a text: a number with an exponent needs a point
    return shortest.find('.') != std::string::npos
               ? shortest
               : shortest.substr(0, exponent) + ".0" + shortest.substr(exponent);
  }
  return settings::fixedText(std::stod(shortest), 0);
}

std::string text(const std::string& value) {
  return isPlain(value) ? value : settings::quotedText(value);
}

std::string list(const std::vector<std::string>& items) {
  std::string all;
  for (const std::string& item : items) all += (all.empty() ? "" : ", ") + item;
  return "[" + all + "]";
}

std::string pair(double low, double high) {
  return std::isfinite(low) || std::isfinite(high) ? list({number(low), number(high)}) : "null";
}

std::string texts(const std::vector<std::string>& values) {
  std::vector<std::string> items;
  for (const std::string& value : values) items.push_back(text(value));
  return list(items);
}

std::string map(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string all;
  for (const auto& [key, value] : entries) all += (all.empty() ? "" : ", ") + key + ": " + value;
  return "{" + all + "}";
}

}  // namespace fsr::report::flow_yaml
