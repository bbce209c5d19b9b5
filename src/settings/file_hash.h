#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace fsr::settings {

/// sha256OfFile() that calls `progress` now and then with the share of the file that was read; none = nobody
/// asks.
std::string sha256OfFile(const std::string& path, std::size_t skip,
                         const std::function<void(double share)>& progress);

}  // namespace fsr::settings
