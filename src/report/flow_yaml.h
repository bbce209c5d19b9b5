#pragma once

#include <string>
#include <utility>
#include <vector>

namespace fsr::report::flow_yaml {

// YAML in flow style, as text: {a: 1, b: [2, 3]}.

/// Five digits; null where it is no finite number.
std::string number(double value);
/// In double quotes where YAML would read it as something else than this text.
std::string text(const std::string& value);
std::string list(const std::vector<std::string>& items);
/// [low, high], or null.
std::string pair(double low, double high);
std::string texts(const std::vector<std::string>& values);
std::string map(const std::vector<std::pair<std::string, std::string>>& entries);

}  // namespace fsr::report::flow_yaml
