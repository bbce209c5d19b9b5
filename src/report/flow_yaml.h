#pragma once

#include <string>
#include <utility>
#include <vector>

namespace fsr::report::flow_yaml {

// Text of YAML in flow style: {a: 1, b: [2, 3]}.

/// A number with five digits; null if it is not finite.
std::string number(double value);
/// A text; in double quotes if YAML would read it as something else.
std::string text(const std::string& value);
std::string list(const std::vector<std::string>& items);
/// [low, high], or null.
std::string pair(double low, double high);
std::string texts(const std::vector<std::string>& values);
std::string map(const std::vector<std::pair<std::string, std::string>>& entries);

}  // namespace fsr::report::flow_yaml
