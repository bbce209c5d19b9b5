#pragma once

#include <cstdint>
#include <string_view>

namespace fsr::statistics {

/// Increment and output function of SplitMix64.
constexpr std::uint64_t kSplitMixIncrement = 0x9E3779B97F4A7C15u;
inline std::uint64_t splitMix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

/// Random numbers by position: the n-th number of a stream is a function of the stream's key and n only. So
/// the numbers of a simulation, a fold or a bootstrap do not depend on the order of the calls or on the
/// number of threads, and there is no generator state to save. Numbers are those of SplitMix64. Source: G.
/// Steele, D. Lea, C. Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t key = 0) : key_(key) {}

  std::uint64_t bits(std::uint64_t position) const {
    return splitMix(key_ + (position + 1) * kSplitMixIncrement);
  }
  /// Uniform in the open interval (0, 1).
  double uniform(std::uint64_t position) const;
  /// Standard normal.
  double normal(std::uint64_t position) const;

 private:
  std::uint64_t key_;
};

/// The stream for a purpose (`name`, e.g. "white_noise") and one of its members (e.g. a taxel), derived from
/// the seed of the whole run. Streams of different purposes and members are independent.
RandomStream randomStream(std::uint64_t seed, std::string_view name, std::uint64_t member = 0);

/// Quantile of the standard normal distribution, `probability` in (0, 1); relative error about 1e-16.
/// Source: M. Wichura, Algorithm AS 241, Applied Statistics 37 (1988) 477-484, PPND16.
double normalQuantile(double probability);

}  // namespace fsr::statistics
