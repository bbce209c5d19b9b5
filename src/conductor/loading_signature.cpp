#include "conductor/loading_signature.h"

#include <algorithm>

#include "conductor/step_watch.h"

namespace fsr::conductor {

namespace {

constexpr double kFirst = 0.1, kLast = 0.9;  // shares of the peak
constexpr double kLevelWidth = (kLast - kFirst) / LoadingSignature::kLevels;

}  // namespace

void LoadingSignature::begin(double peak) {
  peak_ = peak;
  clear();
}

void LoadingSignature::clear() {
  over_ = false;
  for (Bin& bin : bins_) {
    bin.scans = bin.pressure = bin.square = 0;
    std::fill(bin.counts.begin(), bin.counts.end(), 0);
    std::fill(bin.moments.begin(), bin.moments.end(), 0);
  }
}

void LoadingSignature::take(double pressure, const std::uint16_t* counts, std::size_t taxels) {
  if (!(peak_ > 0)) return;
  if (pressure <= kRestLevel) return clear();
  const double share = pressure / peak_;
  over_ = over_ || share >= kLast;
  if (over_ || share < kFirst) return;
  Bin& bin = bins_[std::min(kLevels - 1, static_cast<std::size_t>((share - kFirst) / kLevelWidth))];
  if (bin.counts.size() != taxels) {
    bin = {};
    bin.counts.assign(taxels, 0);
    bin.moments.assign(taxels, 0);
  }
  bin.scans += 1;
  bin.pressure += share;
  bin.square += share * share;
  for (std::size_t t = 0; t < taxels; ++t) {
    bin.counts[t] += counts[t];
    bin.moments[t] += counts[t] * share;
  }
}

Signature LoadingSignature::result() const {
  Signature result;
  for (std::size_t b = 0; b < kLevels; ++b) {
    const Bin& bin = bins_[b];
    if (!over_ || bin.scans < 1 || bin.counts.size() != bins_[0].counts.size()) return {};
    const double mean = bin.pressure / bin.scans;
    const double spread = bin.square - bin.pressure * mean;
    const double middle = kFirst + (static_cast<double>(b) + 0.5) * kLevelWidth;
    for (std::size_t t = 0; t < bin.counts.size(); ++t) {
      const double slope = spread > 0 ? (bin.moments[t] - mean * bin.counts[t]) / spread : 0;
      result.push_back(bin.counts[t] / bin.scans + slope * (middle - mean));
    }
  }
  return result;
}

}  // namespace fsr::conductor
