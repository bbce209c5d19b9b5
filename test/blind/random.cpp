#include "blind/random.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace blind {

namespace {

// Seeds that differ in one bit, or purposes that differ in one letter, must give independent streams. The
// bytes are hashed one by one (FNV-1a), then passed through a strong mixing function.
std::uint64_t stir(std::uint64_t state, std::uint64_t value) {
  for (int byte = 0; byte < 8; ++byte) state = (state ^ ((value >> (8 * byte)) & 0xFF)) * 0x100000001B3u;
  return state;
}

std::uint64_t keyOf(std::uint64_t seed, std::string_view purpose, std::uint64_t member) {
  std::uint64_t state = stir(0xCBF29CE484222325u, seed);
  for (const char letter : purpose) state = stir(state, static_cast<unsigned char>(letter));
  state = stir(state, member);
  state = (state ^ (state >> 33)) * 0xFF51AFD7ED558CCDu;
  return state ^ (state >> 33);
}

}  // namespace

std::uint64_t hashOf(std::string_view text) {
  std::uint64_t state = 0xCBF29CE484222325u;
  for (const char letter : text) state = (state ^ static_cast<unsigned char>(letter)) * 0x100000001B3u;
  return state;
}

Random::Random(std::uint64_t seed, std::string_view purpose, std::uint64_t member)
    : engine_(keyOf(seed, purpose, member)) {}

double Random::uniform() {
  return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53;
}

double Random::logUniform(double low, double high) {
  return low * std::exp(std::log(high / low) * uniform());
}

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double x, y, square;
  do {
    x = uniform(-1, 1);
    y = uniform(-1, 1);
    square = x * x + y * y;
  } while (square >= 1);
  const double scale = std::sqrt(-2 * std::log(square) / square);
  spare_ = y * scale;
  has_spare_ = true;
  return x * scale;
}

std::size_t Random::below(std::size_t number) {
  return std::min(number - 1, static_cast<std::size_t>(uniform() * static_cast<double>(number)));
}

std::vector<std::size_t> Random::order(std::size_t size) {
  std::vector<std::size_t> members(size);
  std::iota(members.begin(), members.end(), std::size_t{0});
  for (std::size_t i = size; i > 1; --i) std::swap(members[i - 1], members[below(i)]);
  return members;
}

std::vector<std::size_t> Random::choose(std::size_t number, std::size_t size) {
  std::vector<std::size_t> members = order(size);
  members.resize(std::min(number, size));
  std::sort(members.begin(), members.end());
  return members;
}

}  // namespace blind
