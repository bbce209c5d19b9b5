#pragma once

#include <string>
#include <vector>

namespace fsr::settings {

/// The items with `between` between them.
inline std::string joined(const std::vector<std::string>& items, const std::string& between = ", ") {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : between) + item;
  return text;
}

}  // namespace fsr::settings
