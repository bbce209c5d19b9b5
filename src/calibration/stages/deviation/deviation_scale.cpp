#include <algorithm>
#include <cmath>

#include "calibration/stages/deviation/deviation_text.h"
#include "settings/number_text.h"

namespace fsr::calibration {

namespace {

double factorOf(const BinScale& bin) {
  return std::isnan(bin.factor) ? 1 : bin.factor;
}

}  // namespace

bool DeviationScale::present() const {
  return std::any_of(bins.begin(), bins.end(),
                     [](const BinScale& bin) { return !std::isnan(bin.pressure) && factorOf(bin) != 1; });
}

double DeviationScale::at(double pressure) const {
  const BinScale* below = nullptr;
  for (const BinScale& bin : bins) {
    if (std::isnan(bin.pressure)) continue;
    if (!(pressure > bin.pressure)) {
      if (below == nullptr) return factorOf(bin);
      const double share = (pressure - below->pressure) / (bin.pressure - below->pressure);
      return factorOf(*below) + share * (factorOf(bin) - factorOf(*below));
    }
    below = &bin;
  }
  return below == nullptr ? 1 : factorOf(*below);
}

std::string deviationText(const DeviationScale& scale) {
  const std::string tables = "that of the tables";
  if (!scale.present()) return tables;
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const BinScale& bin : scale.bins) {
    if (std::isnan(bin.pressure)) continue;
    low = std::min(low, factorOf(bin)), high = std::max(high, factorOf(bin));
  }
  return tables + " times " + settings::fixedText(low, 2) + " to " + settings::fixedText(high, 2) +
         " by pressure";
}

}  // namespace fsr::calibration
