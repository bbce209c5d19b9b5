#include "blind/noise.h"

#include <array>
#include <cmath>

namespace blind {

namespace {

// Time constants of the components of flicker noise [s]: a factor of 4 apart, with equal variances.
constexpr std::array<double, 4> kFlicker = {0.12, 0.5, 2.0, 8.0};

}  // namespace

Noise::Noise(const Campaign& campaign, std::uint64_t seed, double most_cycle_gain)
    : campaign_(campaign), seed_(seed) {
  Random random(seed, "noise");
  const std::array<const char*, 3> colours = {"ar1", "ar2", "flicker"};
  colour_ = colours[random.below(colours.size())];
  coloured_ = random.uniform(0.3, 0.7);
  common_share_ = random.uniform(0, 0.05);
  absolute_ = random.uniform(0.3, 0.8);
  cycle_gain_ = random.uniform(0.1, most_cycle_gain);
  keep_ = random.uniform(0.3, 0.8);
  damping_ = random.uniform(0.6, 0.85);
  peak_ = random.uniform(0.3, 1.5);  // [rad a scan]
  Random shared(seed, "common noise");
  common_ = firstOrder(0.5, shared);
  Random cycles(seed, "cycle gain");
  for (std::uint32_t i = 0; i <= campaign.cycle.back(); ++i) gain_of_cycle_.push_back(cycles.normal());
}

Trace Noise::firstOrder(double keep, Random& random) const {
  Trace values(campaign_.scans());
  const double fresh = std::sqrt(1 - keep * keep);
  double value = random.normal();
  for (double& out : values) {
    out = value;
    value = keep * value + fresh * random.normal();
  }
  return values;
}

// x[i] = a x[i-1] + b x[i-2] + e, poles at damping exp(+- i peak), scaled to unit variance.
Trace Noise::secondOrder(Random& random) const {
  const double a = 2 * damping_ * std::cos(peak_), b = -damping_ * damping_;
  const double variance = (1 - b) / ((1 + b) * ((1 - b) * (1 - b) - a * a));
  Trace values(campaign_.scans());
  double last = 0, before = 0;
  for (double& out : values) {
    const double now = a * last + b * before + random.normal();
    before = last;
    last = now;
    out = now / std::sqrt(variance);
  }
  return values;
}

Trace Noise::coloured(Random& random) const {
  if (colour_ == "ar1") return firstOrder(keep_, random);
  if (colour_ == "ar2") return secondOrder(random);
  Trace sum(campaign_.scans());
  for (const double time_constant : kFlicker) {
    const Trace part = firstOrder(std::exp(-campaign_.scan_period / time_constant), random);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i] / std::sqrt(kFlicker.size());
  }
  return sum;
}

Trace Noise::ofTaxel(std::size_t taxel, const Trace& reading) const {
  Random random(seed_, "noise of a taxel", taxel);
  const double level = 1 + 0.15 * random.uniform(-1, 1);
  Trace noise = coloured(random);
  const double white = std::sqrt(1 - coloured_ - common_share_);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const double sum =
        std::sqrt(coloured_) * noise[i] + white * random.normal() + std::sqrt(common_share_) * common_[i];
    const double growth = absolute_ + (1 - absolute_) * 2 * reading[i];
    const double gain = cycle_gain_ * gain_of_cycle_[campaign_.cycle[i]] * 2 * reading[i];
    noise[i] = level * growth * sum + gain;
  }
  return noise;
}

ReferenceError::ReferenceError(std::uint64_t seed) {
  Random random(seed, "reference");
  offset_ = 400 * random.normal();
  slope_ = 1e-3 * random.normal();
  bend_ = 500 * random.normal();
  noise_ = random.uniform(40, 120);
  step_ = random.chance(0.5) ? 280 : 70;  // 14 or 16 bits
}

double ReferenceError::systematic(double pressure) const {
  const double x = pressure / kPeak;
  return offset_ + slope_ * pressure + bend_ * x * (1 - x);
}

double ReferenceError::measured(double pressure, Random& random) const {
  const double value = pressure + systematic(pressure) + noise_ * random.normal();
  return step_ * std::round(value / step_);
}

double between(const std::vector<Sample>& samples, double time, std::size_t& piece) {
  while (piece + 2 < samples.size() && samples[piece + 1].time <= time) ++piece;
  const Sample &a = samples[piece], &b = samples[piece + 1];
  return a.value + (b.value - a.value) * (time - a.time) / (b.time - a.time);
}

ReferenceChannel::ReferenceChannel(const RigPlan& plan, const Campaign& campaign, std::uint64_t seed)
    : plan_(plan.reference), peak_(plan.peak) {
  Random random(seed, "reference channel");
  const double step = 1.6 * peak_ / std::pow(2.0, plan_.bits);
  for (const Visit& visit : campaign.visits) {
    const double end = campaign.time[visit.last - 1] + 1 / plan_.rate;
    std::vector<Sample> samples;
    for (double time = visit.start - (0.2 + random.uniform()) / plan_.rate; time < end || samples.size() < 2;
         time += 1 / plan_.rate) {
      double value = 0;
      for (int i = -3; i <= 3; ++i) {
        value += campaign.pascal * campaign.pressureAt(visit, time + i / 7.0 * plan_.averaged) / 7;
      }
      value += systematic(value) + plan_.noise * peak_ * random.normal();
      samples.push_back({time, step * std::round(value / step)});
    }
    std::size_t piece = 0;
    for (std::size_t scan = visit.first; scan < visit.last; ++scan) {
      const double seen = between(samples, campaign.time[scan], piece);
      const double truth = campaign.pascal * campaign.pressure[scan];
      at_scans_.push_back(seen);
      error_.push_back((seen - truth - systematic(truth)) / campaign.pascal);
    }
    samples_.push_back(std::move(samples));
  }
}

double ReferenceChannel::systematic(double pressure) const {
  const double x = pressure / peak_;
  return peak_ * (plan_.offset + plan_.slope * x + 4 * plan_.bend * x * (1 - x));
}

}  // namespace blind
