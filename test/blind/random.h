#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

namespace blind {

/// Hash of a text: FNV-1a, 64 bits. The seeds of a case are hashes of its name.
std::uint64_t hashOf(std::string_view text);

/// Random numbers for one purpose and one member (e.g. a taxel), derived from the seed of the case. The
/// engine is the Mersenne Twister of the standard. The distributions are implemented here, because those of
/// the standard library differ between implementations.
class Random {
 public:
  Random(std::uint64_t seed, std::string_view purpose, std::uint64_t member = 0);

  double uniform();  ///< in the open interval (0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double logUniform(double low, double high);
  double normal();  ///< standard normal, by Marsaglia's polar method
  bool chance(double probability) { return uniform() < probability; }
  std::size_t below(std::size_t number);  ///< 0 .. number - 1
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

  /// `number` different members of 0 .. size - 1, in ascending order.
  std::vector<std::size_t> choose(std::size_t number, std::size_t size);
  /// 0 .. size - 1 in random order.
  std::vector<std::size_t> order(std::size_t size);

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace blind
