#include "statistics/random_stream.h"

#include <array>
#include <cmath>

namespace fsr::statistics {

namespace {

// FNV-1a, 64 bits.
std::uint64_t hash(std::string_view text) {
  std::uint64_t value = 0xCBF29CE484222325u;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return value;
}

using Polynomial = std::array<double, 8>;  // coefficients from the constant term upwards

double evaluate(const Polynomial& p, double x) {
  return ((((((p[7] * x + p[6]) * x + p[5]) * x + p[4]) * x + p[3]) * x + p[2]) * x + p[1]) * x + p[0];
}

// Numerators and denominators of AS 241's three ranges: centre, shoulder, tail.
constexpr Polynomial kA{3.3871328727963666080e0, 1.3314166789178437745e2, 1.9715909503065514427e3,
                        1.3731693765509461125e4, 4.5921953931549871457e4, 6.7265770927008700853e4,
                        3.3430575583588128105e4, 2.5090809287301226727e3};
constexpr Polynomial kB{1.0,
                        4.2313330701600911252e1,
                        6.8718700749205790830e2,
                        5.3941960214247511077e3,
                        2.1213794301586595867e4,
                        3.9307895800092710610e4,
                        2.8729085735721942674e4,
                        5.2264952788528545610e3};
constexpr Polynomial kC{1.42343711074968357734e0,  4.63033784615654529590e0, 5.76949722146069140550e0,
                        3.64784832476320460504e0,  1.27045825245236838258e0, 2.41780725177450611770e-1,
                        2.27238449892691845833e-2, 7.74545014278341407640e-4};
constexpr Polynomial kD{1.0,
                        2.05319162663775882187e0,
                        1.67638483018380384940e0,
                        6.89767334985100004550e-1,
                        1.48103976427480074590e-1,
                        1.51986665636164571966e-2,
                        5.47593808499534494600e-4,
                        1.05075007164441684324e-9};
constexpr Polynomial kE{6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,
                        2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                        2.71155556874348757815e-5, 2.01033439929228813265e-7};
constexpr Polynomial kF{1.0,
                        5.99832206555887937690e-1,
                        1.36929880922735805310e-1,
                        1.48753612908506148525e-2,
                        7.86869131145613259100e-4,
                        1.84631831751005468180e-5,
                        1.42151175831644588870e-7,
                        2.04426310338993978564e-15};

double tailQuantile(double tail_probability) {
  const double r = std::sqrt(-std::log(tail_probability));
  return r <= 5 ? evaluate(kC, r - 1.6) / evaluate(kD, r - 1.6) : evaluate(kE, r - 5) / evaluate(kF, r - 5);
}

}  // namespace

double normalQuantile(double probability) {
  const double q = probability - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * evaluate(kA, r) / evaluate(kB, r);
  }
  return q < 0 ? -tailQuantile(probability) : tailQuantile(1 - probability);
}

double RandomStream::uniform(std::uint64_t position) const {
  return (static_cast<double>(bits(position) >> 11) + 0.5) * 0x1p-53;
}

double RandomStream::normal(std::uint64_t position) const {
  return normalQuantile(uniform(position));
}

RandomStream randomStream(std::uint64_t seed, std::string_view name, std::uint64_t member) {
  const std::uint64_t purpose = splitMix(splitMix(seed + kSplitMixIncrement) ^ hash(name));
  return RandomStream(splitMix(purpose + (member + 1) * kSplitMixIncrement));
}

}  // namespace fsr::statistics
