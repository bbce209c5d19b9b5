#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fsr::conductor {

/// Counts of every taxel at kLevels pressures of one loading, [levels x taxels]. Two loadings of one surface
/// by one program read the same but for noise, the sheet's memory, and how it lies on the surface.
using Signature = std::vector<double>;

/// Takes the signature of one loading from rest. The way from 10 % to 90 % of the peak is divided into equal
/// bins. In each, a straight line through the counts of a taxel gives its count in the middle of the bin, so
/// that pace and rate of the scans do not matter. Memory does not grow with time.
class LoadingSignature {
 public:
  static constexpr std::size_t kLevels = 4;

  /// Begins anew with another peak, gauge [Pa].
  void begin(double peak);
  /// A scan at a gauge pressure [Pa]. One at rest begins anew; those behind 90 % of the way do not count.
  void take(double pressure, const std::uint16_t* counts, std::size_t taxels);
  /// Empty where the loading was not seen in each bin.
  Signature result() const;

 private:
  struct Bin {
    double scans = 0, pressure = 0, square = 0;  // sums; pressure as a share of the peak
    std::vector<double> counts, moments;         // of each taxel: sums of counts, and of counts x pressure
  };
  void clear();

  double peak_ = 0;  // [Pa]
  bool over_ = false;
  std::array<Bin, kLevels> bins_;
};

}  // namespace fsr::conductor
