#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "blind/campaign.h"

namespace blind {

/// Where an effect shows. It is judged by what the effect leaves after the static fit, or, for an effect
/// that is static itself, by what it changes (readings without noise). The key states the same rule:
///
/// - taxels and surfaces: those whose rms is at least kShare of the largest;
/// - pressures: from the lowest to the highest bin of kBin whose rms is at least kPressureShare of the
/// largest;
/// - direction: a single one where the other has less than kDirectionShare of the squares.
class Signature {
 public:
  explicit Signature(const Campaign& campaign);
  void add(std::size_t taxel, const Trace& residual);

  double rms() const;  ///< over all scans of the taxels that were added [share of full scale]
  std::vector<std::size_t> taxels() const;
  std::vector<std::size_t> surfaces() const;
  std::pair<double, double> pressures() const;  ///< [Pa]
  std::string direction() const;                ///< both, loading or unloading

  static constexpr double kShare = 0.1;
  static constexpr double kPressureShare = 0.25;
  static constexpr double kDirectionShare = 0.1;
  static constexpr double kBin = 25e3;  ///< [Pa]

 private:
  struct Squares {
    double sum = 0;
    double number = 0;
    double rms() const;
  };
  using Table = std::map<std::size_t, Squares>;
  static std::vector<std::size_t> above(const Table& table, double share);

  const Campaign& campaign_;
  Squares all_, loading_, unloading_;
  Table by_taxel_, by_surface_, by_bin_;
};

}  // namespace blind
