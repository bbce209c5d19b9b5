#pragma once

#include <string>

namespace test_support {

/// The package's folder with its sources, without a slash at the end.
std::string sourceDir();

}  // namespace test_support
