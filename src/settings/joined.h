#pragma once

#include <string>
#include <vector>

namespace fsr::settings {

/// The texts `textOf(item)` of the items with `between` between them.
template <typename Items, typename TextOf>
std::string joinedTexts(const Items& items, TextOf textOf, const std::string& between = ", ") {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : between) + std::string(textOf(item));
  return text;
}

/// The items with `between` between them.
template <typename Items>
std::string joined(const Items& items, const std::string& between = ", ") {
  return joinedTexts(
      items, [](const std::string& item) { return item; }, between);
}

}  // namespace fsr::settings
