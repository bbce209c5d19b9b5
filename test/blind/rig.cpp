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

// Secant steps in logarithms, limited to the bracket known so far: what a fault leaves does not increase
// smoothly with its duration.
double Rig::strengthFor(const Placed& placed, double target) const {
  constexpr double kLeast = 1e-4, kLargest = 3, kNear = 0.02;
  const std::size_t stride = 1 + campaign_.taxels() / 15;
  double low = kLeast, high = kLargest, strength = 1, power = 1, last_strength = 0, last_left = 0;
  for (int round = 0; round < 12; ++round) {
    const double left = signature(activate(placed, strength), stride).rms();
    if (std::abs(left / target - 1) < kNear) break;
    (left < target ? low : high) = strength;
    if (last_strength > 0 && left > 0 && last_left > 0) {
      power = std::clamp(std::log(left / last_left) / std::log(strength / last_strength), 0.3, 2.0);
    }
    last_strength = strength;
    last_left = left;
    strength = left > 0 ? strength * std::pow(target / left, 1 / power) : high;
    if (strength <= low || strength >= high) strength = std::sqrt(low * high);
    if (high / low < 1 + kNear) break;
  }
  return strength;
}

}  // namespace blind
