#include "fsr_pressure_map/statistics/pressure_bins.h"

#include <algorithm>

namespace fsr::statistics {

std::size_t pressureBin(double pressure) {
  const auto above = std::upper_bound(kPressureBinEdges.begin() + 1, kPressureBinEdges.end(), pressure);
  return static_cast<std::size_t>(above - kPressureBinEdges.begin()) - 1;
}

std::string pressureBinName(std::size_t bin) {
  const auto kilopascal = [](double edge) { return std::to_string(static_cast<int>(edge / 1e3)); };
  const std::string low = kilopascal(kPressureBinEdges.at(bin));
  return bin + 1 == kPressureBins ? low + "+" : low + "-" + kilopascal(kPressureBinEdges[bin + 1]);
}

}  // namespace fsr::statistics
