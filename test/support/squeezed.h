#pragma once

#include <string>

namespace test_support {

/// The text with one space where it has several: the cells of a table without their widths.
inline std::string squeezed(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c != ' ' || result.empty() || result.back() != ' ') result += c;
  }
  return result;
}

}  // namespace test_support
