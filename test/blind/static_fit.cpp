#include "blind/static_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace blind {

namespace {

// A point of one surface's curve.
struct CurvePoint {
  double pressure, value, weight;  // [Pa], [share of full scale]
};

// A non-decreasing curve through points of ascending pressure; linear between them and beyond its ends.
struct Curve {
  std::vector<double> pressure, value;

  double slope(std::size_t piece) const {
    const double run = pressure[piece + 1] - pressure[piece];
    return run > 0 ? (value[piece + 1] - value[piece]) / run : 0.0;
  }
  std::size_t pieceAt(double at) const {
    const auto after = std::upper_bound(pressure.begin() + 1, pressure.end() - 1, at);
    return static_cast<std::size_t>(after - pressure.begin()) - 1;
  }
  double operator()(double at) const {
    const std::size_t piece = pieceAt(at);
    return value[piece] + slope(piece) * (at - pressure[piece]);
  }
  // Slope over a range that is wide enough to average the small steps of the curve.
  double slopeAt(double at) const { return ((*this)(at + 5e3) - (*this)(at - 5e3)) / 10e3; }
};

// Curve of one surface from the common one: value = gain * curve(pressure + preload).
struct Bending {
  double gain = 1, preload = 0;
};

Curve poolSurfaces(const std::vector<std::vector<CurvePoint>>& surfaces,
                   const std::vector<Bending>& bending) {
  std::vector<CurvePoint> all;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    for (const CurvePoint& point : surfaces[s]) {
      const double weight = point.weight * bending[s].gain * bending[s].gain;
      all.push_back({point.pressure + bending[s].preload, point.value / bending[s].gain, weight});
    }
  }
  const auto before = [](const CurvePoint& a, const CurvePoint& b) { return a.pressure < b.pressure; };
  std::sort(all.begin(), all.end(), before);
  // Neighbouring points are averaged: points of several surfaces at nearly the same pressure form one knot.
  Curve curve;
  std::vector<double> weights;
  const std::size_t together = 2 * surfaces.size();
  for (std::size_t first = 0; first < all.size(); first += together) {
    double weight = 0, pressure = 0, value = 0;
    for (std::size_t i = first; i < std::min(first + together, all.size()); ++i) {
      weight += all[i].weight;
      pressure += all[i].weight * all[i].pressure;
      value += all[i].weight * all[i].value;
    }
    curve.pressure.push_back(pressure / weight);
    curve.value.push_back(value / weight);
    weights.push_back(weight);
  }
  curve.value = isotonic(curve.value, weights);
  return curve;
}

// One Gauss-Newton step of gain and preload.
void improve(const Curve& curve, const std::vector<CurvePoint>& points, Bending& bending) {
  double gg = 0, gp = 0, pp = 0, g_error = 0, p_error = 0;
  for (const CurvePoint& point : points) {
    const double by_gain = curve(point.pressure + bending.preload);
    const double by_preload = bending.gain * curve.slopeAt(point.pressure + bending.preload);
    const double error = point.value - bending.gain * by_gain;
    gg += point.weight * by_gain * by_gain;
    gp += point.weight * by_gain * by_preload;
    pp += point.weight * by_preload * by_preload;
    g_error += point.weight * by_gain * error;
    p_error += point.weight * by_preload * error;
  }
  const double determinant = gg * pp - gp * gp;
  if (!(determinant > 1e-12 * gg * pp)) return;
  bending.gain += (pp * g_error - gp * p_error) / determinant;
  bending.preload += std::clamp((gg * p_error - gp * g_error) / determinant, -20e3, 20e3);
}

}  // namespace

std::vector<double> isotonic(const std::vector<double>& values, const std::vector<double>& weights) {
  struct Block {
    double mean, weight;
    std::size_t size;
  };
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < values.size(); ++i) {
    blocks.push_back({values[i], weights[i], 1});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].mean > blocks.back().mean) {
      const Block top = blocks.back();
      blocks.pop_back();
      Block& below = blocks.back();
      const double weight = below.weight + top.weight;
      below.mean = (below.mean * below.weight + top.mean * top.weight) / weight;
      below.weight = weight;
      below.size += top.size;
    }
  }
  std::vector<double> fit;
  for (const Block& block : blocks) fit.insert(fit.end(), block.size, block.mean);
  return fit;
}

StaticFit::StaticFit(const Campaign& campaign, double width) : campaign_(campaign) {
  const auto bin = [&](double pressure) { return static_cast<std::size_t>(std::max(0.0, pressure) / width); };
  bins_ = bin(*std::max_element(campaign.pressure.begin(), campaign.pressure.end())) + 1;
  for (std::size_t scan = 0; scan < campaign.scans(); ++scan) {
    cell_.push_back(cell(campaign.visits[campaign.visit[scan]].surface, bin(campaign.pressure[scan])));
  }
}

StaticFit::BinMeans StaticFit::means(const Trace& base, const Trace& reading) const {
  const std::size_t cells = campaign_.surfaces.size() * bins_;
  BinMeans means{std::vector<double>(cells), std::vector<double>(cells), std::vector<double>(cells),
                 std::vector<double>(cells)};
  for (std::size_t scan = 0; scan < cell_.size(); ++scan) {
    means.base[cell_[scan]] += base[scan];
    means.reading[cell_[scan]] += reading[scan];
    means.pressure[cell_[scan]] += campaign_.pressure[scan];
    means.weight[cell_[scan]] += 1;
  }
  for (std::size_t i = 0; i < cells; ++i) {
    const double weight = std::max(1.0, means.weight[i]);
    means.base[i] /= weight;
    means.reading[i] /= weight;
    means.pressure[i] /= weight;
  }
  return means;
}

Trace StaticFit::subtract(const Trace& base, const Trace& reading, const BinMeans& means,
                          const std::vector<double>& fit) const {
  std::vector<Curve> off(campaign_.surfaces.size());  // difference of the fit from the base, over pressure
  for (std::size_t surface = 0; surface < off.size(); ++surface) {
    for (std::size_t i = cell(surface, 0); i < cell(surface + 1, 0); ++i) {
      if (means.weight[i] == 0) continue;
      off[surface].pressure.push_back(means.pressure[i]);
      off[surface].value.push_back(fit[i] - means.base[i]);
    }
  }
  Trace residual(reading.size());
  for (std::size_t scan = 0; scan < reading.size(); ++scan) {
    const Curve& curve = off[campaign_.visits[campaign_.visit[scan]].surface];
    residual[scan] = reading[scan] - base[scan] - curve(campaign_.pressure[scan]);
  }
  return residual;
}

Trace StaticFit::residualOfCurves(const Trace& base, const Trace& reading) const {
  const BinMeans bins = means(base, reading);
  std::vector<double> fit(bins.base.size());
  for (std::size_t surface = 0; surface < campaign_.surfaces.size(); ++surface) {
    std::vector<double> values, weights;
    std::vector<std::size_t> cells;
    for (std::size_t i = cell(surface, 0); i < cell(surface + 1, 0); ++i) {
      if (bins.weight[i] == 0) continue;
      cells.push_back(i);
      values.push_back(bins.reading[i]);
      weights.push_back(bins.weight[i]);
    }
    const std::vector<double> rising = isotonic(values, weights);
    for (std::size_t i = 0; i < cells.size(); ++i) fit[cells[i]] = rising[i];
  }
  return subtract(base, reading, bins, fit);
}

Trace StaticFit::residualOfSharedCurve(const Trace& base, const Trace& reading, double zero) const {
  const BinMeans bins = means(base, reading);
  std::vector<std::vector<CurvePoint>> surfaces(campaign_.surfaces.size());
  for (std::size_t surface = 0; surface < surfaces.size(); ++surface) {
    for (std::size_t i = cell(surface, 0); i < cell(surface + 1, 0); ++i) {
      if (bins.weight[i] > 0)
        surfaces[surface].push_back({bins.pressure[i], bins.reading[i] - zero, bins.weight[i]});
    }
  }
  std::vector<Bending> bending(surfaces.size(), {1, 0});
  for (std::size_t s = 1; s < bending.size(); ++s) bending[s] = {0.9, 30e3};
  Curve curve;
  for (int round = 0; round < 40; ++round) {
    curve = poolSurfaces(surfaces, bending);
    for (std::size_t s = 1; s < surfaces.size(); ++s) improve(curve, surfaces[s], bending[s]);
  }
  curve = poolSurfaces(surfaces, bending);
  std::vector<double> fit(bins.base.size());
  for (std::size_t surface = 0; surface < surfaces.size(); ++surface) {
    for (std::size_t i = cell(surface, 0); i < cell(surface + 1, 0); ++i) {
      fit[i] = zero + bending[surface].gain * curve(bins.pressure[i] + bending[surface].preload);
    }
  }
  return subtract(base, reading, bins, fit);
}

}  // namespace blind
