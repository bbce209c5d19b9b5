#include "simulation/taxel_curves.h"

#include <algorithm>
#include <cmath>

#include "dataset/table_reader.h"
#include "settings/text.h"

namespace fsr::simulation {

namespace {

constexpr std::size_t kLabels = 2;  // columns before the taxels: curvature, load

// Solves a tridiagonal system that is diagonally dominant, with equal elements above and below the diagonal.
std::vector<double> solveTridiagonal(std::vector<double> diagonal, const std::vector<double>& beside,
                                     std::vector<double> right) {
  for (std::size_t k = 1; k < diagonal.size(); ++k) {
    const double factor = beside[k - 1] / diagonal[k - 1];
    diagonal[k] -= factor * beside[k - 1];
    right[k] -= factor * right[k - 1];
  }
  for (std::size_t k = diagonal.size(); k-- > 0;) {
    if (k + 1 < diagonal.size()) right[k] -= beside[k] * right[k + 1];
    right[k] /= diagonal[k];
  }
  return right;
}

}  // namespace

std::size_t TaxelCurves::nearestIndex(double curvature) const {
  const auto nearer = [&](const OnSurface& a, const OnSurface& b) {
    return std::abs(a.curvature - curvature) < std::abs(b.curvature - curvature);
  };
  return static_cast<std::size_t>(std::min_element(surfaces.begin(), surfaces.end(), nearer) -
                                  surfaces.begin());
}

std::vector<double> splineBends(const std::vector<double>& knots) {
  const std::size_t size = knots.size();
  std::vector<double> bends(size * size, 0.0);
  if (size < 3) return bends;
  const auto width = [&](std::size_t k) { return knots[k + 1] - knots[k]; };
  std::vector<double> diagonal(size - 2), beside(size - 2);
  for (std::size_t k = 0; k + 2 < size; ++k) {
    diagonal[k] = (width(k) + width(k + 1)) / 3;
    beside[k] = width(k + 1) / 6;
  }
  for (std::size_t j = 0; j < size; ++j) {  // the spline that is 1 at knot j and 0 at all others
    std::vector<double> right(size - 2, 0.0);
    if (j + 2 < size) right[j] = 1 / width(j);
    if (j > 0 && j + 1 < size) right[j - 1] = -1 / width(j - 1) - 1 / width(j);
    if (j > 1) right[j - 2] = 1 / width(j - 1);
    const std::vector<double> bend = solveTridiagonal(diagonal, beside, std::move(right));
    for (std::size_t k = 0; k < bend.size(); ++k) bends[(k + 1) * size + j] = bend[k];
  }
  return bends;
}

SplineWeights splineWeights(const std::vector<double>& knots, double at) {
  const auto next =
      static_cast<std::size_t>(std::upper_bound(knots.begin(), knots.end(), at) - knots.begin());
  SplineWeights weights;
  weights.knot = std::clamp<std::size_t>(next, 1, knots.size() - 1) - 1;
  const double low = knots[weights.knot], width = knots[weights.knot + 1] - low;
  const double above = (at - low) / width, below = 1 - above;
  weights.below = below;
  weights.above = above;
  const double square = width * width / 6;
  if (at < knots.front()) {  // the tangent at the first knot, where the second derivative is 0
    weights.above_bend = -square * above;
  } else if (at > knots.back()) {
    weights.below_bend = -square * below;
  } else {
    weights.below_bend = square * below * (below * below - 1);
    weights.above_bend = square * above * (above * above - 1);
  }
  return weights;
}

LoadCurves::LoadCurves(const TaxelCurves::OnSurface& surface, std::size_t taxels)
    : knots_(surface.load), taxels_(taxels), values_(surface.added), bends_(values_.size(), 0.0) {
  const std::size_t size = knots_.size();
  const std::vector<double> bends = splineBends(knots_);
  for (std::size_t k = 0; k < size; ++k) {
    for (std::size_t j = 0; j < size; ++j) {
      const double weight = bends[k * size + j];
      for (std::size_t t = 0; t < taxels; ++t) bends_[k * taxels + t] += weight * values_[j * taxels + t];
    }
  }
}

double LoadCurves::at(std::size_t taxel, double load) const {
  if (knots_.size() < 2) return values_[taxel];
  const SplineWeights w = splineWeights(knots_, load);
  const std::size_t below = w.knot * taxels_ + taxel, above = below + taxels_;
  return w.below * values_[below] + w.above * values_[above] + w.below_bend * bends_[below] +
         w.above_bend * bends_[above];
}

std::string taxelCurvesText(const TaxelCurves& curves) {
  std::string text =
      "# What each taxel reads beyond the static law of the simulation beside this file [share of full "
      "scale]\n"
      "curvature_per_m,load_Pa";
  for (std::size_t t = 0; t < curves.taxels; ++t) text += ",taxel_" + std::to_string(t);
  for (const TaxelCurves::OnSurface& surface : curves.surfaces) {
    for (std::size_t k = 0; k < surface.load.size(); ++k) {
      text += "\n" + settings::numberText(surface.curvature) + "," + settings::numberText(surface.load[k]);
      for (std::size_t t = 0; t < curves.taxels; ++t) {
        text += "," + settings::numberText(surface.added[k * curves.taxels + t]);
      }
    }
  }
  return text + "\n";
}

TaxelCurves readTaxelCurves(const std::string& path) {
  dataset::TableReader table(path);
  TaxelCurves curves;
  if (table.columns() <= kLabels)
    throw settings::InputError(path + ": has no column for a taxel after curvature and load");
  curves.taxels = table.columns() - kLabels;
  while (table.next()) {
    const double curvature = table.number(0), load = table.number(1);
    if (curves.surfaces.empty() || curves.surfaces.back().curvature != curvature) {
      curves.surfaces.push_back({curvature, {}, {}});
    }
    TaxelCurves::OnSurface& surface = curves.surfaces.back();
    if (!surface.load.empty() && load <= surface.load.back()) {
      throw table.error(1, "must be above the row before it");
    }
    surface.load.push_back(load);
    for (std::size_t t = 0; t < curves.taxels; ++t) surface.added.push_back(table.number(kLabels + t));
  }
  if (curves.surfaces.empty()) throw settings::InputError(path + ": holds no row");
  return curves;
}

}  // namespace fsr::simulation
