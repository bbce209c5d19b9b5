#pragma once

#include <cmath>
#include <utility>

#include "blind/protocol.h"

namespace blind {

/// Builds the path of the set pressure piece by piece, beginning at 0 Pa.
class PathBuilder {
 public:
  PathBuilder() { point(0, 0); }

  /// A cycle begins here.
  PathBuilder& cycle() {
    path_.cycle_start.push_back(path_.time.back());
    return *this;
  }
  PathBuilder& hold(double seconds) {
    point(path_.time.back() + seconds, path_.pressure.back());
    return *this;
  }
  /// A straight ramp at `rate` [Pa/s].
  PathBuilder& ramp(double target, double rate) {
    point(path_.time.back() + std::abs(target - path_.pressure.back()) / rate, target);
    return *this;
  }
  /// An exponential approach that has covered 98.2 % of the distance after `seconds`; the rest is a short
  /// ramp.
  PathBuilder& approach(double target, double seconds) {
    constexpr int kPieces = 16;
    const double from = path_.pressure.back(), start = path_.time.back();
    for (int i = 1; i <= kPieces; ++i) {
      const double share = static_cast<double>(i) / kPieces;
      point(start + share * seconds, target + (from - target) * std::exp(-4 * share));
    }
    point(start + 1.05 * seconds, target);
    return *this;
  }
  double pressure() const { return path_.pressure.back(); }
  ChamberPath take() { return std::move(path_); }

 private:
  void point(double time, double pressure) {
    path_.time.push_back(time);
    path_.pressure.push_back(pressure);
  }
  ChamberPath path_;
};

}  // namespace blind
