#include "exports/exact_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace fsr::exports {

namespace {

template <typename T>
std::string shortest(T value) {
  if (std::isnan(value)) return "NA";
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace

std::string exactText(float value) {
  return shortest(value);
}

std::string exactText(double value) {
  return shortest(value);
}

std::string secondsText(std::int64_t nanoseconds) {
  constexpr std::int64_t kSecond = 1000000000;
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%s%lld.%09lld", nanoseconds < 0 ? "-" : "",
                std::llabs(nanoseconds / kSecond), std::llabs(nanoseconds % kSecond));
  return text.data();
}

}  // namespace fsr::exports
