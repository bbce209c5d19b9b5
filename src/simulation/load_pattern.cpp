#include "fsr_pressure_map/simulation/simulation_settings.h"
#include "simulation/read_settings.h"

#include <cmath>

namespace fsr::simulation {

namespace {

constexpr int kPointsASide = 16;  // of each cell, to tell how much of it is loaded

bool loaded(const LoadPattern& pattern, double x, double y) {
  const double right = x - pattern.centre.x, up = y - pattern.centre.y;
  if (pattern.kind == LoadPattern::Kind::kDisc) return std::hypot(right, up) <= pattern.radius;
  return right * std::cos(pattern.angle) + up * std::sin(pattern.angle) >= 0;
}

double share(const LoadPattern& pattern, const matrix::Layout& layout, matrix::Position cell) {
  int inside = 0;
  for (int i = 0; i < kPointsASide; ++i) {
    for (int k = 0; k < kPointsASide; ++k) {
      const double x = cell.x + layout.pitch_x * ((i + 0.5) / kPointsASide - 0.5);
      const double y = cell.y + layout.pitch_y * ((k + 0.5) / kPointsASide - 0.5);
      inside += int{loaded(pattern, x, y)};
    }
  }
  return inside / double{kPointsASide * kPointsASide};
}

}  // namespace

LoadPattern readLoadPattern(const settings::Settings& settings) {
  const settings::Range place{-10, 10, "m"};
  LoadPattern pattern;
  const bool disc = settings.has("disc");
  if (disc == settings.has("edge")) {
    throw settings.error(disc ? "edge" : "disc", "give exactly one of disc and edge");
  }
  pattern.kind = disc ? LoadPattern::Kind::kDisc : LoadPattern::Kind::kEdge;
  const settings::Settings form = settings.section(disc ? "disc" : "edge");
  pattern.centre = {form.number("x", place, 0), form.number("y", place, 0)};
  if (disc) {
    pattern.radius = form.number("radius", {1e-4, 10, "m"});
  } else {
    pattern.angle = form.number("angle", {-2 * M_PI, 2 * M_PI, "rad"}, 0);
  }
  return pattern;
}

std::vector<double> loadShares(const LoadPattern& pattern, const matrix::Layout& layout) {
  std::vector<double> shares(layout.size.taxels(), 1.0);
  if (pattern.kind == LoadPattern::Kind::kUniform) return shares;
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = share(pattern, layout, layout.position({i}));
  return shares;
}

}  // namespace fsr::simulation
