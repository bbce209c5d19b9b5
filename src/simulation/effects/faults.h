#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "simulation/effect.h"
#include "statistics/random_stream.h"

namespace fsr::simulation {

/// The parameters `taxels`, `first` and `start` that say which taxels are faulty, and since when.
std::vector<EffectParameter> faultyTaxelParameters();

/// The taxels that those parameters pick: `first`, or one by the seed where it is -1, and the others by
/// the seed; none twice. Throws InputError where the matrix has no such taxel.
std::vector<std::size_t> faultyTaxels(const std::string& id, const EffectValues& values,
                                      const EffectContext& context);

/// The parameters `share`, `line`, `burst` and `depth` of a line with a loose contact.
std::vector<EffectParameter> looseLineParameters(const std::string& line);

/// Bursts in which a line loses contact: time is cut into pieces as long as a burst, and each piece is
/// bad with probability `share`, by the seed.
class LooseLine {
 public:
  /// `lines`: how many the matrix has. Throws InputError.
  LooseLine(const std::string& id, std::size_t lines, const EffectValues& values,
            const EffectContext& context);

  std::size_t line() const { return line_; }
  /// What is left of the line's conductance at a rig time [s]; exactly 1 between bursts.
  double contact(double time) const;

 private:
  std::size_t line_;
  double share_;
  double burst_;  // [s]
  double depth_;
  statistics::RandomStream stream_;
};

}  // namespace fsr::simulation
