#include "blind/rig.h"

#include <algorithm>
#include <cmath>

namespace blind {

std::unique_ptr<Hidden> Placed::make(const Campaign& campaign, const Sheet& sheet, double strength) const {
  return form->make({campaign, sheet, seed, strength, carried_over});
}

template <typename Act>
void Rig::inPlace(const Active& active, std::size_t taxel, Trace& trace, Act act) const {
  const Placed& placed = *active.placed;
  if (!placed.taxels[taxel]) return;
  const bool everywhere =
      std::find(placed.surfaces.begin(), placed.surfaces.end(), false) == placed.surfaces.end();
  if (everywhere) {
    act(*active.hidden, trace);
    return;
  }
  const Trace before = trace;
  act(*active.hidden, trace);
  for (const Visit& visit : campaign_.visits) {
    if (placed.surfaces[visit.surface]) continue;
    const auto first = static_cast<std::ptrdiff_t>(visit.first),
               last = static_cast<std::ptrdiff_t>(visit.last);
    std::copy(before.begin() + first, before.begin() + last, trace.begin() + first);
  }
}

Trace Rig::reading(std::size_t taxel, const std::vector<Active>& hidden) const {
  Trace load(campaign_.scans()), gain(campaign_.scans());
  for (std::size_t scan = 0; scan < load.size(); ++scan) {
    const std::size_t surface = campaign_.visits[campaign_.visit[scan]].surface;
    load[scan] = campaign_.pressure[scan] + sheet_.preload(taxel, surface);
    gain[scan] = sheet_.gain(taxel, surface);
  }
  for (const Active& active : hidden) {
    inPlace(active, taxel, load, [&](const Hidden& effect, Trace& trace) { effect.onLoad(taxel, trace); });
    inPlace(active, taxel, gain, [&](const Hidden& effect, Trace& trace) { effect.onGain(taxel, trace); });
  }
  Trace reading(load.size());
  for (std::size_t scan = 0; scan < load.size(); ++scan) {
    reading[scan] = sheet_.zero(taxel) + gain[scan] * sheet_.rise(taxel, load[scan]);
  }
  for (const Active& active : hidden) {
    inPlace(active, taxel, reading,
            [&](const Hidden& effect, Trace& trace) { effect.onReading(taxel, trace); });
  }
  return reading;
}

Trace Rig::noiseFactor(std::size_t taxel, const std::vector<Active>& hidden) const {
  Trace factor(campaign_.scans(), 1.0);
  for (const Active& active : hidden) {
    inPlace(active, taxel, factor, [&](const Hidden& effect, Trace& trace) { effect.onNoise(taxel, trace); });
  }
  return factor;
}

Trace Rig::residual(const Active& active, std::size_t taxel) const {
  const std::vector<std::size_t> own = active.hidden->taxels();
  const bool shows = own.empty() || std::find(own.begin(), own.end(), taxel) != own.end();
  if (!shows || !active.placed->taxels[taxel]) return Trace(campaign_.scans(), 0.0);
  const Trace base = reading(taxel, {});
  if (active.placed->form->left_after == LeftAfter::kCurveShared) {
    return shared_curve_.residualOfSharedCurve(base, reading(taxel, {active}), sheet_.zero(taxel));
  }
  return curves_.residualOfCurves(base, reading(taxel, {active}));
}

Trace Rig::leftOf(std::size_t taxel, const Trace& change) const {
  const Trace base = reading(taxel, {});
  Trace with = base;
  for (std::size_t scan = 0; scan < with.size(); ++scan) with[scan] += change[scan];
  return curves_.residualOfCurves(base, with);
}

Signature Rig::signature(const Active& active, std::size_t stride) const {
  Signature signature(campaign_);
  const std::size_t step = active.hidden->taxels().empty() ? stride : 1;
  for (std::size_t taxel = 0; taxel < campaign_.taxels(); taxel += step) {
    signature.add(taxel, residual(active, taxel));
  }
  return signature;
}

Signature Rig::difference(const Active& active) const {
  Signature signature(campaign_);
  for (std::size_t taxel = 0; taxel < campaign_.taxels(); ++taxel) {
    Trace with = reading(taxel, {active});
    const Trace base = reading(taxel, {});
    for (std::size_t scan = 0; scan < with.size(); ++scan) with[scan] -= base[scan];
    signature.add(taxel, with);
  }
  return signature;
}

Trace Rig::slope(std::size_t taxel) const {
  constexpr double kStep = 3e3;  // [Pa]
  Trace slope(campaign_.scans());
  for (std::size_t scan = 0; scan < slope.size(); ++scan) {
    const std::size_t surface = campaign_.visits[campaign_.visit[scan]].surface;
    const double load = campaign_.pressure[scan] + sheet_.preload(taxel, surface);
    const double rise = sheet_.rise(taxel, load + kStep) - sheet_.rise(taxel, load - kStep);
    slope[scan] = sheet_.gain(taxel, surface) * rise / (2 * kStep);
  }
  return slope;
}

double Rig::errorAtMap(const Active& active, std::size_t stride) const {
  double squares = 0, number = 0;
  const std::size_t step = active.hidden->taxels().empty() ? stride : 1;
  for (std::size_t taxel = 0; taxel < campaign_.taxels(); taxel += step) {
    const Trace left = residual(active, taxel), slopes = slope(taxel);
    const double least = kFlat * sheet_.rise(taxel, kPeak) / kPeak;
    for (std::size_t scan = 0; scan < left.size(); ++scan) {
      if (campaign_.pressure[scan] < kLoaded * kPeak) continue;
      squares += std::pow(left[scan] / std::max(slopes[scan], least), 2);
      number += 1;
    }
  }
  return number > 0 ? campaign_.pascal * std::sqrt(squares / number) : 0;
}

double Rig::strengthFor(const Placed& placed, double target, double largest) const {
  const std::size_t stride = 1 + campaign_.taxels() / 15;
  return solve(placed, target, largest, 0.02,
               [&](const Active& active) { return signature(active, stride).rms(); });
}

double Rig::strengthForError(const Placed& placed, double target, double largest) const {
  const std::size_t stride = 1 + campaign_.taxels() / 15;
  return solve(placed, target, largest, 0.01,
               [&](const Active& active) { return errorAtMap(active, stride); });
}

// Secant steps in logarithms, limited to the bracket known so far: what a fault leaves does not increase
// smoothly with its duration.
template <typename Measure>
double Rig::solve(const Placed& placed, double target, double largest, double near, Measure measure) const {
  constexpr double kLeast = 1e-4;
  double low = kLeast, high = largest, strength = 1, power = 1, last_strength = 0, last_left = 0;
  for (int round = 0; round < 12; ++round) {
    const double left = measure(activate(placed, strength));
    if (std::abs(left / target - 1) < near) break;
    (left < target ? low : high) = strength;
    if (last_strength > 0 && left > 0 && last_left > 0) {
      power = std::clamp(std::log(left / last_left) / std::log(strength / last_strength), 0.3, 2.0);
    }
    last_strength = strength;
    last_left = left;
    strength = left > 0 ? strength * std::pow(target / left, 1 / power) : high;
    if (strength <= low || strength >= high) strength = std::sqrt(low * high);
    if (high / low < 1 + near) break;
  }
  return strength;
}

}  // namespace blind
