#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "fsr_pressure_map/settings/input_error.h"

namespace test_support {

/// Whether the text has all of these parts. A failure says which one is missing, and the text.
inline testing::AssertionResult holds(const std::string& text, std::initializer_list<std::string> parts) {
  for (const std::string& part : parts) {
    if (text.find(part) == std::string::npos)
      return testing::AssertionFailure() << part << "\nis not in\n" << text;
  }
  return testing::AssertionSuccess();
}

/// The sentence of the InputError that `call` throws; `otherwise` where it throws none.
template <typename Call>
std::string refusal(const Call& call, const std::string& otherwise = "") {
  try {
    call();
  } catch (const fsr::settings::InputError& error) {
    return error.what();
  }
  return otherwise;
}

}  // namespace test_support
